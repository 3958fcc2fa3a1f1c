"""The filter's program, run as the kernel runs it, on any machine."""

import errno
import os
import re
import struct
from pathlib import Path

import pytest

from mocap.course.marking.call_filter import FAILING, MACHINES, OPENING, PRETENDING, call_filter

ALLOWED = 0x7FFF0000
FAILED = 0x50000 | errno.EPERM
PRETENDED = 0x50000
READ_AND_CUT = 0o1000  # O_RDONLY | O_TRUNC
OTHER = 0xC0000028  # 32-bit ARM
FLAGS = {"openat": 2, "open": 1}  # openat(folder, path, flags), open(path, flags)
RECENT = {"fchmodat2", "mount_setattr"}  # which older headers lack
HEADERS = {
    "x86_64": Path("/usr/include/x86_64-linux-gnu/asm/unistd_64.h"),
    "aarch64": Path("/usr/include/asm-generic/unistd.h"),
}


def answer(machine, number, arguments=(0,) * 6, kernel=None):
    """Run the program for a machine in a kernel of a machine, as classic BPF does."""
    data = struct.pack("IIQ6Q", number, kernel or MACHINES[machine], 0, *arguments)
    steps = list(struct.iter_unpack("HBBI", call_filter(machine)))
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


@pytest.mark.parametrize("machine", MACHINES)
def test_each_call_gets_its_answer_and_all_others_are_allowed(machine):
    column = list(MACHINES).index(machine)
    expected = {numbers[column]: FAILED for numbers in FAILING.values()}
    expected |= dict.fromkeys(PRETENDING[machine].values(), PRETENDED)
    assert len(expected) == len(FAILING) + len(PRETENDING[machine])
    for number in range(500):
        assert answer(machine, number) == expected.get(number, ALLOWED), number


@pytest.mark.parametrize("machine", MACHINES)
def test_the_numbers_are_those_of_the_kernels_headers(machine):
    if not HEADERS[machine].exists():
        pytest.skip("no headers of the kernel")
    text = HEADERS[machine].read_text()
    numbers = {name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+) (\d+)", text)}
    column = list(MACHINES).index(machine)
    listed = {call: row[column] for call, row in FAILING.items()} | PRETENDING[machine]
    listed |= {call: number for call, (number, _) in OPENING[machine].items()}
    for call, number in listed.items():
        if call in numbers or call not in RECENT:
            assert numbers[call] == number, call


@pytest.mark.parametrize("machine", MACHINES)
def test_a_file_opened_to_read_is_not_cut(machine):
    for call, (number, _) in OPENING[machine].items():
        place = FLAGS[call]
        for flags in range(0o10000):
            arguments = [READ_AND_CUT] * 6  # only the flags count
            arguments[place] = flags
            cuts = flags & 0o1000 and flags & 3 not in (os.O_WRONLY, os.O_RDWR)
            assert answer(machine, number, arguments) == (FAILED if cuts else ALLOWED), oct(flags)


@pytest.mark.parametrize("machine", MACHINES)
def test_calls_in_the_numbers_of_another_machine_fail(machine):
    assert answer(machine, 0) == ALLOWED
    assert answer(machine, 0, kernel=OTHER) == FAILED
    assert answer(machine, 1 << 30) == FAILED
    assert answer(machine, (1 << 30) - 1) == ALLOWED
