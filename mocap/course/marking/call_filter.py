"""The filter of system calls behind which a student's process runs: a program in the kernel's own language.

Before each system call of the process the kernel runs this program, in classic BPF. It sees the number of
the call, the machine whose numbers these are, and the six arguments (`struct seccomp_data`), and answers: the
call is allowed, it fails with EPERM, or it seems to succeed although nothing is done.
"""

from __future__ import annotations

import errno
import struct

# <linux/bpf_common.h>: the codes of the steps.
LOAD = 0x20  # a word of 32 bits, from this byte of `seccomp_data`
AND = 0x54  # of the word and a number
JUMP_IF_EQUAL = 0x15
JUMP_IF_AT_LEAST = 0x35
RETURN = 0x06

# `struct seccomp_data`, in bytes.
CALL_NUMBER = 0
MACHINE = 4
ARGUMENTS = 16
ARGUMENT = 8  # bytes of an argument, of which the first four hold flags

# <linux/seccomp.h>: answers. The low 16 bits of 0x50000 are the error; 0 is none.
ALLOW = 0x7FFF0000
FAIL = 0x50000 | errno.EPERM
PRETEND = 0x50000

# <fcntl.h>
O_ACCMODE = 0o3  # mask of O_RDONLY, which is 0, O_WRONLY and O_RDWR
O_TRUNC = 0o1000

MACHINES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}  # <linux/audit.h>
X32_CALLS = 1 << 30  # from here on: calls of x32, a second set of numbers for the same calls

# Calls that fail: their numbers on x86_64 and aarch64.
FAILING = {
    "kill": (62, 129),
    "tkill": (200, 130),
    "tgkill": (234, 131),
    "rt_sigqueueinfo": (129, 138),
    "rt_tgsigqueueinfo": (297, 240),
    "prlimit64": (302, 261),
    "ptrace": (101, 117),
    "process_vm_readv": (310, 270),
    "process_vm_writev": (311, 271),
    "socket": (41, 198),
    "memfd_create": (319, 279),
    "shmget": (29, 194),
    "mq_open": (240, 180),
    "truncate": (76, 45),
    "unshare": (272, 97),
    "setns": (308, 268),
    "mount": (165, 40),
    "umount2": (166, 39),
    "pivot_root": (155, 41),
    "chroot": (161, 51),
    "add_key": (248, 217),
    "request_key": (249, 218),
    "keyctl": (250, 219),
    "bpf": (321, 280),
    "perf_event_open": (298, 241),
    "pidfd_send_signal": (424, 424),
    "io_uring_setup": (425, 425),
    "open_tree": (428, 428),
    "move_mount": (429, 429),
    "fsopen": (430, 430),
    "openat2": (437, 437),
    "pidfd_getfd": (438, 438),
    "mount_setattr": (442, 442),
}

# Calls that seem to succeed, because much copies a file by them.
PRETENDING = {
    "x86_64": {
        "chmod": 90,
        "fchmod": 91,
        "chown": 92,
        "fchown": 93,
        "lchown": 94,
        "fchownat": 260,
        "fchmodat": 268,
        "fchmodat2": 452,
        "utime": 132,
        "utimes": 235,
        "futimesat": 261,
        "utimensat": 280,
        "setxattr": 188,
        "lsetxattr": 189,
        "fsetxattr": 190,
    },
    "aarch64": {
        "fchmod": 52,
        "fchmodat": 53,
        "fchownat": 54,
        "fchown": 55,
        "utimensat": 88,
        "setxattr": 5,
        "lsetxattr": 6,
        "fsetxattr": 7,
        "fchmodat2": 452,
    },
}

# Calls that open a file: their number, and which of their arguments holds the flags.
OPENING = {"x86_64": {"openat": (257, 2), "open": (2, 1)}, "aarch64": {"openat": (56, 2)}}

STEP = 8  # bytes of a step
Step = tuple[int, int, int, int]  # code, steps to skip if true, steps to skip if false, operand


def call_filter(machine: str) -> bytes:
    """Write the filter's program for a machine of `MACHINES`: `STEP` bytes for each step.

    The calls of `FAILING` fail, those of `PRETENDING` do nothing, and no file is cut that is opened to read.
    Calls with the numbers of another machine fail, as these could mean anything.

    Examples
    --------
    >>> len(call_filter("aarch64")) // STEP
    98
    """
    program = [_load(MACHINE), (JUMP_IF_EQUAL, 1, 0, MACHINES[machine]), _answer(FAIL)]
    program += [_load(CALL_NUMBER), (JUMP_IF_AT_LEAST, 0, 1, X32_CALLS), _answer(FAIL)]
    column = list(MACHINES).index(machine)
    for numbers in FAILING.values():
        program += [_unless(numbers[column], skip=1), _answer(FAIL)]
    for number in PRETENDING[machine].values():
        program += [_unless(number, skip=1), _answer(PRETEND)]
    for number, argument in OPENING[machine].values():
        steps = _refuse_to_cut(ARGUMENTS + ARGUMENT * argument)
        program += [_unless(number, skip=len(steps)), *steps]
    program.append(_answer(ALLOW))
    return b"".join(struct.pack("HBBI", *step) for step in program)


def _refuse_to_cut(flags: int) -> list[Step]:
    """Refuse O_TRUNC with O_RDONLY, and with 3, which is neither reading nor writing; allow other flags."""
    mask = O_TRUNC | O_ACCMODE
    test = [
        _load(flags),
        (AND, 0, 0, mask),
        (JUMP_IF_EQUAL, 1, 0, O_TRUNC),  # to the failure
        _unless(mask, skip=1),
    ]
    return [*test, _answer(FAIL), _answer(ALLOW)]


def _load(offset: int) -> Step:
    """Load the word at this byte of `seccomp_data`."""
    return LOAD, 0, 0, offset


def _unless(value: int, *, skip: int) -> Step:
    """Skip the next steps unless the word is this value."""
    return JUMP_IF_EQUAL, 0, skip, value


def _answer(value: int) -> Step:
    """End the program with an answer."""
    return RETURN, 0, 0, value
