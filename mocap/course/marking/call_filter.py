"""The filter of system calls behind which a student's process runs: a program in the kernel's own language.

Before each system call of the process the kernel runs this program, in classic BPF. It sees the number of
the call, the machine whose numbers these are, and the six arguments (`struct seccomp_data`), and answers: the
call is allowed, it seems to succeed although nothing is done, or it fails with ENOSYS. Nothing is killed.
"""

from __future__ import annotations

import errno
import struct
from collections.abc import Sequence

from mocap.course.marking.system_calls import ALLOWED, CONDITIONS, MACHINES, PRETENDING, Condition

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
ARGUMENT = 8  # bytes of an argument, of which the first four are its low bits

# <linux/seccomp.h>: answers. The low 16 bits of 0x50000 are the error; 0 is none.
ALLOW = 0x7FFF0000
FAIL = 0x50000 | errno.ENOSYS
PRETEND = 0x50000

NUMBERING = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}  # <linux/audit.h>
X32_CALLS = 1 << 30  # from here on: calls of x32, a second set of numbers for the same calls

STEP = 8  # bytes of a step
Step = tuple[int, int, int, int]  # code, steps to skip if true, steps to skip if false, operand


def call_filter(machine: str) -> bytes:
    """Return the filter's program for a machine of `MACHINES`: `STEP` bytes for each step.

    Calls with the numbers of another machine fail, as these could mean anything.

    Examples
    --------
    >>> len(call_filter("aarch64")) // STEP < 4096  # the kernel's limit
    True
    """
    program = [_load(MACHINE), (JUMP_IF_EQUAL, 1, 0, NUMBERING[machine]), _answer(FAIL)]
    program += [_load(CALL_NUMBER), (JUMP_IF_AT_LEAST, 0, 1, X32_CALLS), _answer(FAIL)]
    column = MACHINES.index(machine)
    for numbers in ALLOWED.values():
        program += _if_called(numbers[column], [_answer(ALLOW)])
    for number in PRETENDING[machine].values():
        program += _if_called(number, [_answer(PRETEND)])
    for condition in CONDITIONS.values():
        program += _if_called(condition.numbers[column], _judge_argument(condition))
    program.append(_answer(FAIL))
    return b"".join(struct.pack("HBBI", *step) for step in program)


def _if_called(number: int | None, steps: Sequence[Step]) -> list[Step]:
    """Take these steps, which end in an answer, for a call; none if the machine does not have it."""
    return [] if number is None else [_unless(number, skip=len(steps)), *steps]


def _judge_argument(condition: Condition) -> list[Step]:
    """Allow a call if its argument has one of the values of a condition."""
    steps = [_load(ARGUMENTS + ARGUMENT * condition.argument), (AND, 0, 0, condition.mask)]
    for value in condition.values:
        steps += [_unless(value, skip=1), _answer(ALLOW)]
    return [*steps, _answer(FAIL)]


def _load(offset: int) -> Step:
    """Load the word at this byte of `seccomp_data`."""
    return LOAD, 0, 0, offset


def _unless(value: int, *, skip: int) -> Step:
    """Skip the next steps unless the word is this value."""
    return JUMP_IF_EQUAL, 0, skip, value


def _answer(value: int) -> Step:
    """End the program with an answer."""
    return RETURN, 0, 0, value
