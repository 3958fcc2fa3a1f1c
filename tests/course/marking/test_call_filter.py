"""The filter's program, run as the kernel runs it, on any machine."""

import errno
import os
import re
import struct
from functools import cache
from pathlib import Path

import pytest

from mocap.course.marking.call_filter import NUMBERING, call_filter
from mocap.course.marking.system_calls import ALLOWED, CONDITIONS, MACHINES, PRETENDING

ALLOWED_ANSWER = 0x7FFF0000
FAILED = 0x50000 | errno.ENOSYS
PRETENDED = 0x50000
OTHER = 0xC0000028  # 32-bit ARM
RECENT = {"fchmodat2"}  # which older headers lack
OTHER_NAMES = {"newfstatat": "fstatat"}  # in the headers that all other machines share
REACHING = """
    kill tkill tgkill rt_sigqueueinfo rt_tgsigqueueinfo pidfd_open pidfd_send_signal pidfd_getfd
    setpriority sched_setaffinity sched_setscheduler sched_setparam sched_setattr ioprio_set migrate_pages
    move_pages process_madvise process_mrelease process_vm_readv process_vm_writev ptrace kcmp
    msgget msgsnd msgrcv msgctl semget semop semctl semtimedop shmget shmat shmctl
    mq_open mq_unlink mq_timedsend mq_timedreceive mq_notify flock keyctl add_key request_key
    socket connect bind listen accept accept4 sendmmsg memfd_create memfd_secret userfaultfd
    io_uring_setup bpf perf_event_open fanotify_init inotify_init1 timer_create vmsplice splice
    mount umount2 pivot_root chroot unshare setns clone3 move_mount open_tree fsopen mount_setattr openat2
    open_by_handle_at name_to_handle_at truncate removexattr lremovexattr fremovexattr sync syncfs
    setuid setgid setreuid setresuid setgroups capset personality quotactl swapon reboot syslog acct
    seccomp landlock_create_ruleset membarrier mlock mlockall sethostname settimeofday clock_settime
"""
HEADERS = {
    "x86_64": Path("/usr/include/x86_64-linux-gnu/asm/unistd_64.h"),
    "aarch64": Path("/usr/include/asm-generic/unistd.h"),
}


@cache
def program(machine):
    return list(struct.iter_unpack("HBBI", call_filter(machine)))


def answer(machine, number, arguments=(0,) * 6, kernel=None):
    """Run the program for a machine in a kernel of a machine, as classic BPF does."""
    data = struct.pack("IIQ6Q", number, kernel or NUMBERING[machine], 0, *arguments)
    steps = program(machine)
    at = word = 0
    while True:
        code, if_true, if_false, operand = steps[at]
        at += 1
        match code:
            case 0x20:
                (word,) = struct.unpack_from("I", data, operand)
            case 0x54:
                word &= operand
            case 0x15:
                at += if_true if word == operand else if_false
            case 0x35:
                at += if_true if word >= operand else if_false
            case 0x06:
                return operand


def of(machine, rows):
    """Give the numbers of calls on a machine that has them, by their names."""
    column = MACHINES.index(machine)
    return {name: numbers[column] for name, numbers in rows.items() if numbers[column] is not None}


def headers(machine):
    if not HEADERS[machine].exists():
        pytest.skip("no headers of the kernel")
    text = HEADERS[machine].read_text()
    return {name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+) (\d+)", text)}


@pytest.mark.parametrize("machine", MACHINES)
def test_what_is_not_listed_fails_as_if_the_kernel_did_not_have_it(machine):
    allowed = of(machine, ALLOWED)
    conditional = of(machine, {name: condition.numbers for name, condition in CONDITIONS.items()})
    expected = dict.fromkeys(allowed.values(), ALLOWED_ANSWER)
    expected |= dict.fromkeys(PRETENDING[machine].values(), PRETENDED)
    assert len(expected) == len(allowed) + len(PRETENDING[machine])
    assert not expected.keys() & conditional.values()
    for number in {*range(700)} - {*conditional.values()}:
        assert answer(machine, number) == expected.get(number, FAILED), number


@pytest.mark.parametrize("machine", MACHINES)
def test_no_call_that_reaches_another_process_is_listed(machine):
    numbers = headers(machine)
    unknown = {"open_by_handle_at", "name_to_handle_at"} - numbers.keys()
    for name in {*REACHING.split()} - unknown:
        assert answer(machine, numbers[name]) == FAILED, name


@pytest.mark.parametrize("machine", MACHINES)
def test_the_numbers_are_those_of_the_kernels_headers(machine):
    numbers = headers(machine)
    listed = of(machine, ALLOWED) | of(machine, {n: condition.numbers for n, condition in CONDITIONS.items()})
    for call, number in (listed | PRETENDING[machine]).items():
        name = call if call in numbers else OTHER_NAMES.get(call, call)
        if name in numbers or name not in RECENT:
            assert numbers[name] == number, call
    for name in ALLOWED.keys() - listed.keys():
        assert name not in numbers, name  # a machine that has a call has its number


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("call", CONDITIONS)
def test_of_a_conditional_call_one_argument_counts(call, machine):
    condition = CONDITIONS[call]
    number = condition.numbers[MACHINES.index(machine)]
    if number is None:
        pytest.skip("this machine does not have it")
    tried = {*range(200), *(1 << bit for bit in range(32)), *condition.values, 0x8901, 0x8902, 0x80086601}
    others = [0xFFFFFFFF] * 6
    for value in tried:
        arguments = others.copy()
        arguments[condition.argument] = value | 7 << 32  # the kernel reads the low bits too
        fits = value & condition.mask in condition.values
        assert answer(machine, number, arguments) == (ALLOWED_ANSWER if fits else FAILED), hex(value)


@pytest.mark.parametrize("machine", MACHINES)
def test_a_file_opened_to_read_is_not_cut(machine):
    for call in ("openat", "open"):
        condition = CONDITIONS[call]
        number = condition.numbers[MACHINES.index(machine)]
        if number is None:
            continue
        for flags in range(0o10000):
            arguments = [0] * 6
            arguments[condition.argument] = flags
            cuts = flags & os.O_TRUNC and flags & 3 not in (os.O_WRONLY, os.O_RDWR)
            assert answer(machine, number, arguments) == (FAILED if cuts else ALLOWED_ANSWER), oct(flags)


@pytest.mark.parametrize("machine", MACHINES)
def test_calls_in_the_numbers_of_another_machine_fail(machine):
    read = ALLOWED["read"][MACHINES.index(machine)]
    assert answer(machine, read) == ALLOWED_ANSWER
    assert answer(machine, read, kernel=OTHER) == FAILED
    assert answer(machine, 1 << 30 | read) == FAILED
