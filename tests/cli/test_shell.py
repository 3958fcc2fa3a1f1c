"""The command at a shell: groups of commands, options of all, streams that are closed, signals, statuses."""

import os
import re
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from mocap.cli import typed_commands
from mocap.cli.main import COMMANDS, SHARED_FLAGS
from mocap.cli.typed_commands import Group, read_docstring
from tests.cli.listing import LEAVES, command

POSIX = pytest.mark.skipif(os.name == "nt", reason="a POSIX shell")
MOCAP = [sys.executable, "-m", "mocap"]
GROUPS = [name for runs in COMMANDS.values() for name, run in runs.items() if isinstance(run, Group)]


def shell(line, **settings):
    """Run a line of a POSIX shell, in which $MOCAP is the command."""
    named = os.environ | {"MOCAP": f"'{sys.executable}' -m mocap"}
    line = line.replace("$MOCAP", named["MOCAP"])
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False, **settings)
    return done.returncode, done.stdout, done.stderr


def test_mocap_alone_lists_all_commands_in_groups(run):
    page = run("").out
    assert page == run("--help").out == run("-h").out == run("-q").out
    for title, runs in COMMANDS.items():
        table = page.partition(f"\n{title}:\n")[2].partition("\n\n")[0]
        assert re.findall(r"^  (\w+) ", table, re.MULTILINE) == [*runs]
    assert max(map(len, page.splitlines())) < 80


@pytest.mark.parametrize("name", GROUPS)
def test_a_group_alone_lists_its_commands(run, name):
    page = run(name).out
    assert page == run(f"{name} --help").out == run(f"-v {name}").out
    (group,) = (runs[name] for runs in COMMANDS.values() if name in runs)
    for inner in group.commands:
        assert re.search(rf"^  {inner} ", page, re.MULTILINE)


@pytest.mark.parametrize("name", LEAVES)
def test_each_page_says_what_everything_is_in_80_columns(run, name):
    page = run(f"{name} --help").out
    assert page.startswith("Usage: mocap ") and "\x1b" not in page
    assert all(len(line) < 80 and line == line.rstrip() for line in page.splitlines())
    for argument in command(name).assemble_argument_collection():
        assert not argument.show or argument.parameter.help, argument.names


def functions(commands):
    """Yield the functions of commands, and of those in their groups."""
    for run in commands.values():
        yield from functions(run.commands) if isinstance(run, Group) else [run]


RUNS = [run for runs in COMMANDS.values() for run in functions(runs)]


@pytest.mark.parametrize("run", RUNS, ids=lambda run: run.__name__)
def test_no_line_about_a_parameter_is_left_out_of_its_help(run):
    _, _, rest = read_docstring(run).partition("\n\nParameters\n----------\n")
    parameters, _, _ = rest.partition("\n\nNotes\n-----\n")
    assert typed_commands._PARAMETER.sub("", parameters).strip() == ""


@pytest.mark.parametrize("flag", ["-q", "--quiet"])
@pytest.mark.parametrize("line", ["{flag} {rest}", "{rest} {flag}"])
def test_quiet_leaves_out_warnings(clips, run, flag, line):
    rest = "loop a.bvh --scale 0.0001 -o x.bvh"
    assert "is its scale right?" in run(rest).err
    assert run(line.format(flag=flag, rest=rest)).err == ""


@pytest.mark.parametrize("line", ["-v {rest}", "{rest} --verbose", "graph -v {files}"])
def test_verbose_says_what_is_read_and_how_long_stages_take(clips, run, line):
    files = "a.bvh b.bvh -o g.npz --threshold 5"
    told = run(line.format(rest=f"graph {files}", files=files)).err.splitlines()
    stages = [re.sub(r"[\d.]+ s", "# s", text) for text in told]
    assert stages[:2] == ["mocap: read a.bvh in # s", "mocap: read b.bvh in # s"]
    assert "mocap: reading: 2 in # s" in stages
    assert any(text.startswith("mocap: comparing: ") for text in stages)
    assert stages[-1] == "mocap: done in # s, # s of processor time"
    assert "mocap: done" not in run(f"graph {files}").err


@pytest.mark.parametrize("line", ["--debug info nowhere.bvh", "info nowhere.bvh --debug"])
def test_debug_shows_the_traceback_before_the_sentence(clips, run, line):
    told = run(line, 2).err
    assert told.startswith("Traceback (most recent call last)")
    assert told.splitlines()[-1] == "mocap: Cannot read nowhere.bvh: No such file or directory."


def deep(number):
    return deep(number + 1)


UNEXPECTED = [
    (lambda *_: {}["hips"], "unexpected KeyError: 'hips'"),
    (lambda *_: deep(0), "unexpected RecursionError: maximum recursion depth exceeded"),
    (lambda *_: 1 / 0, "unexpected ZeroDivisionError: division by zero"),
]


@pytest.mark.parametrize(("fails", "sentence"), UNEXPECTED)
def test_what_nobody_expected_is_one_sentence_and_status_1(clips, run, monkeypatch, fails, sentence):
    monkeypatch.setattr("mocap.quality.inspect", fails)
    told = run("info a.bvh", 1).err
    assert told.startswith(f"mocap: {sentence}") and told.endswith("the same with --debug shows where.\n")
    assert told.count("\n") == 1 and len(told) <= 200
    assert "Traceback" in run("info a.bvh --debug", 1).err


def test_a_lack_of_memory_is_told_with_a_remedy(clips, run, monkeypatch):
    def exhaust(*_):
        raise MemoryError

    monkeypatch.setattr("mocap.quality.inspect", exhaust)
    assert run("info a.bvh", 1).err.startswith("mocap: out of memory: try fewer or shorter clips")


def test_an_error_without_a_text_is_told(clips, run, monkeypatch):
    def fail(*_):
        raise AssertionError

    monkeypatch.setattr("mocap.quality.inspect", fail)
    assert "unexpected AssertionError: no further text. This is a bug" in run("info a.bvh", 1).err


@POSIX
@pytest.mark.parametrize(
    ("line", "status", "said"),
    [
        ("$MOCAP info a.bvh >&-", 0, ""),
        ("$MOCAP info a.bvh 2>&- >&-", 0, ""),
        ("$MOCAP info nowhere.bvh 2>&-", 2, ""),
        ("$MOCAP info a.bvh > /dev/full", 2, "mocap: Cannot write the output: No space left on device.\n"),
        ("$MOCAP info a.bvh | head -0; exit ${PIPESTATUS[0]}", 141, ""),
        ("$MOCAP --help | head -0; exit ${PIPESTATUS[0]}", 141, ""),
    ],
)
def test_a_stream_that_is_closed_or_full_ends_without_a_traceback(clips, line, status, said):
    if "/dev/full" in line and not Path("/dev/full").exists():
        pytest.skip("Linux only")
    code, _, told = shell(line)
    assert (code, told) == (status, said)


@POSIX
@pytest.mark.parametrize("out", [">&-", "| head -0; exit ${PIPESTATUS[0]}"])
def test_a_file_is_saved_although_nobody_reads_the_output(clips, out):
    """Each line is written at once: the first one finds the pipe closed, before the file is saved."""
    line = f"PYTHONUNBUFFERED=1 $MOCAP graph a.bvh b.bvh --threshold 5 -o g.npz {out}"
    code, _, told = shell(line)
    assert (code, told) == (0 if out == ">&-" else 141, "")
    assert (clips / "g.npz").stat().st_size > 1000


@POSIX
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_signal_ends_a_long_command_and_leaves_no_half_of_a_file(clips, run, name):
    run("graph a.bvh b.bvh --threshold 5 -o g.npz")
    before = sorted(path.name for path in clips.iterdir())
    words = [*MOCAP, "-v", "walk", "g.npz", "--random", "20h"]
    obeyed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # a shell's background ignores it
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True, preexec_fn=obeyed) as process:
        told = iter(process.stderr.readline, "")
        assert any(line.startswith("mocap: reading: 2 in ") for line in told)  # hours of work follow
        process.send_signal(getattr(signal, name))
        *stages, ending = process.stderr.read().splitlines()
        assert ending == "mocap: interrupted; no half-written file is left."
        assert all(line.startswith("mocap: reading the graph: ") for line in stages)
    assert process.returncode == 130
    assert sorted(path.name for path in clips.iterdir()) == before


@pytest.mark.parametrize("line", ["bend --help", "info a.bvh", "conver", "graph"])
def test_python_without_docstrings_says_the_same(clips, line):
    """`python -OO` drops docstrings and assertions; the help is then read in the sources."""
    usual, bare = (
        subprocess.run([sys.executable, *flags, "-m", "mocap", *line.split()], capture_output=True, text=True)
        for flags in ([], ["-OO"])
    )
    assert (usual.returncode, usual.stdout, usual.stderr) == (bare.returncode, bare.stdout, bare.stderr)


def test_flags_of_all_commands_are_those_of_verbosity():
    shared = {
        name for argument in command("info").assemble_argument_collection()[-3:] for name in argument.names
    }
    assert shared == {*SHARED_FLAGS}
