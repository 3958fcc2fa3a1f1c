"""Eleven dishonest and five unlucky students, and what the marker says of them."""

import csv
import io
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import redirect_stderr, suppress
from pathlib import Path

import pytest

from mocap.cli.course import NETWORK
from mocap.cli.main import main
from mocap.course.marking import mark, marks, sealed
from mocap.errors import MocapError
from tests.course.marking.students import (
    DISHONEST,
    HONEST,
    LINUX,
    SLEEP,
    SPEED,
    START,
    UNLUCKY,
    hand_in,
    replaced,
)

SECRET = "correct horse battery staple"
EXERCISES = ("speed", "cheapest", "dead_ends")
UNLUCKY_MARKS = {
    "prints without end": "011",
    "fills the memory": "011",
    "ends Python": "011",
    "has helpers, tests and a cell on top": "111",
    "lost cells and tags": "101",
}
pytestmark = pytest.mark.skipif(os.name != "posix", reason="marking needs Linux or macOS")


def rows(file):
    return list(csv.DictReader(file.read_text("utf-8").splitlines()))


def said(path):
    return {(row["handed in"].split("/")[0], row["exercise"]): row for row in rows(path / "marks.csv")}


def sleepers():
    found = []
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):  # it has ended
            found += [file] * (f"\0{SLEEP}\0".encode() in file.read_bytes())
    return found


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    return tmp_path_factory.mktemp("home")


@pytest.fixture(scope="module")
def marked(home, tmp_path_factory):
    """Mark all students at once."""
    path = tmp_path_factory.mktemp("marked")
    words = {"PLANTED": path / "planted", "LATER": path / "handed-in" / "zoe" / "later.ipynb"}
    for name, cells in (DISHONEST | UNLUCKY | {"zoe": HONEST}).items():
        hand_in(replaced(cells, words), path / "handed-in" / name / "later.ipynb")
    (path / "handed-in" / "yan").mkdir()
    (path / "handed-in" / "yan" / "broken.ipynb").write_text("{")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(marks, "SECONDS", 6)
        patch.setenv("HOME", str(home))
        patch.setenv("TOKEN", SECRET)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        with redirect_stderr(io.StringIO()) as said:
            assert main(["course", "mark", str(path / "handed-in"), "-o", str(path / "marks.csv")]) == 0
        assert said.getvalue().startswith(NETWORK[sealed.offline()])
        assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000  # kilobytes
    return path


def test_students_get_marks_only_for_what_is_right(marked):
    wanted = dict.fromkeys(DISHONEST, "011") | UNLUCKY_MARKS | {"patches the check": "010", "zoe": "111"}
    for student, right in wanted.items():
        name = f"'{student}" if student.startswith("=") else student
        assert "".join(said(marked)[name, exercise]["right"] for exercise in EXERCISES) == right, student


@pytest.mark.parametrize(
    ("student", "exercise", "says"),
    [
        ("answers with what equals all", "speed", "speed: your answer has the shape"),
        ("answers with a pickle that runs", "speed", "speed: your answer has the shape"),
        ("remembers the inputs of the notebook", "speed", "speed: your function returns None"),
        ("lists and plants files", "speed", "speed: your function raises ValueError: [] (in"),
        ("starts many processes", "speed", "✗ speed: starts more than 16 processes"),
        ("kills what started it", "speed", "✗ speed: ends Python itself"),
        ("prints without end", "speed", "✗ speed: stopped after 6 s"),
        ("fills the memory", "speed", "your function raises MemoryError"),
        ("ends Python", "speed", "✗ speed: ends Python itself"),
        (
            "lost cells and tags",
            "cheapest",
            "cheapest: its cell is missing. The course does not know the tag `sped`",
        ),
        ("yan", "speed", "✗ speed: not handed in."),
        ("yan", "", "broken.ipynb: is not a notebook."),
    ],
)
def test_the_reason_is_said(student, exercise, says, marked):
    if student == "starts many processes" and not LINUX:
        pytest.skip("only Linux counts a student's processes")
    assert says in said(marked)[student, exercise]["said"]


def test_no_secret_gets_into_the_marks_and_no_file_onto_the_disk(home, marked):
    assert SECRET not in (marked / "marks.csv").read_text("utf-8")
    assert str(home) not in (marked / "marks.csv").read_text("utf-8")
    assert list(home.iterdir()) == []
    assert not (marked / "planted").exists()


@pytest.mark.skipif(not LINUX, reason="needs /proc")
def test_no_process_is_left(marked):
    assert sleepers() == []


def test_no_line_is_a_formula_or_two_lines(marked):
    lines = (marked / "marks.csv").read_text("utf-8").splitlines()
    assert len(lines) == len(rows(marked / "marks.csv")) + 1
    assert not any(
        value.startswith(("=", "+", "-", "@")) for row in rows(marked / "marks.csv") for value in row.values()
    )
    assert "\x1b" not in "".join(lines)


def test_the_table_has_a_line_for_each_student_and_a_column_for_each_exercise(marked):
    table = {row["student"]: row for row in rows(marked / "marks-table.csv")}
    assert table["zoe"] == {"student": "zoe", **dict.fromkeys(EXERCISES, "1"), "right": "3"}
    assert table["yan"] == {"student": "yan", **dict.fromkeys(EXERCISES, "0"), "right": "0"}
    assert len(table) == len(DISHONEST) + len(UNLUCKY) + 2


def test_an_empty_folder_and_one_without_exercises(tmp_path):
    with pytest.raises(MocapError, match="holds no notebooks"):
        list(mark(tmp_path))
    hand_in([], tmp_path / "ada.ipynb")
    (only,) = mark(tmp_path)
    assert only == ("ada.ipynb", "", False, "holds no exercise of the course.")


def test_an_endless_first_cell_is_said_of_each_exercise(tmp_path, monkeypatch):
    monkeypatch.setattr(marks, "STARTING", 1)
    hand_in([("", "while True: pass"), *HONEST[1:]], tmp_path / "ada" / "00.ipynb")
    assert [one.said for one in mark(tmp_path)] == [f"✗ {name}: stopped after 1 s." for name in EXERCISES]


def test_no_answer_stops_the_marker(tmp_path):
    """One too large for a float, one too long, of rows of different lengths, no number, and no plain data."""
    heads = (SPEED[1], HONEST[2][1], HONEST[3][1])
    for name, answers in {
        "a": ("10**400", "'x' * 2_000_000", "[[1], [2, 3]]"),
        "b": ("float('nan')", "object()", "len"),
    }.items():
        cells = [
            (f"exercise:{exercise}", f"{head.splitlines()[0]}\n    return {answer}")
            for exercise, head, answer in zip(EXERCISES, heads, answers, strict=True)
        ]
        hand_in([START, *cells], tmp_path / f"{name}.ipynb")
    found = list(mark(tmp_path))
    assert len(found) == 6 and not any(one.right for one in found)


@pytest.mark.parametrize(
    ("times", "size", "says"),
    [
        (2100, 1, "writes 2000 files, or"),
        pytest.param(20, 45_000_000, "writes 2000 files, or", marks=pytest.mark.sweep),
        (1, 60_000_000, "✗ speed: its cells raise OSError: [Errno 27] File too large"),
    ],
)
def test_no_notebook_fills_the_disk(times, size, says, tmp_path):
    write = f"for n in range({times}): open(f'{{n}}', 'wb').write(b'x' * {size})\nimport time\ntime.sleep(60)"
    hand_in([START, ("exercise:speed", write)], tmp_path / "00.ipynb")
    assert says in next(mark(tmp_path)).said


def test_junk_on_the_channel_is_no_answer(tmp_path):
    write = "  try: os.write(fd, b'[' * 100000 + b'\\n')\n  except OSError: pass"
    junk = f"import os\nfor fd in range(3, 30):\n{write}"
    hand_in([START, ("exercise:speed", junk), HONEST[2]], tmp_path / "00.ipynb")
    found = {one.exercise: one for one in mark(tmp_path)}
    assert not found["speed"].right
    assert found["cheapest"].right


@pytest.mark.sweep
def test_folders_in_folders_leave_nothing_behind(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    deep = "import os\nfor _ in range(1500):\n    os.mkdir('d')\n    os.chdir('d')"
    hand_in([START, ("exercise:speed", deep)], tmp_path / "in" / "00.ipynb")
    assert len(list(mark(tmp_path / "in"))) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["in"]


def test_what_is_no_file_is_said_at_once(tmp_path):
    (tmp_path / "zero.ipynb").symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "fifo.ipynb")
    (tmp_path / "deep.ipynb").write_text("[" * 100_000)
    assert [one.said for one in mark(tmp_path)] == [
        "deep.ipynb: is not a notebook.",
        "fifo.ipynb: is no file, or one of more than 50 MB.",
        "zero.ipynb: is no file, or one of more than 50 MB.",
    ]


@pytest.mark.skipif(not LINUX, reason="needs /proc")
def test_a_keeper_that_was_stopped_still_leaves_no_process(tmp_path):
    stop = f"import os, signal, subprocess\nsubprocess.Popen(['sleep', '{SLEEP}'], start_new_session=True)\n"
    hand_in(
        [START, ("exercise:speed", f"{stop}os.kill(os.getppid(), signal.SIGSTOP)")], tmp_path / "00.ipynb"
    )
    assert not next(mark(tmp_path)).right
    assert sleepers() == []


def test_an_interruption_is_one_sentence_and_keeps_the_marks(tmp_path):
    begun = tmp_path / "begun"
    hand_in([START, SPEED], tmp_path / "in" / "ada" / "00.ipynb")
    slow = f"open({str(begun)!r}, 'w')\nimport subprocess\nsubprocess.run(['sleep', '{SLEEP}'])"
    hand_in([START, ("exercise:speed", slow)], tmp_path / "in" / "bob" / "00.ipynb")
    command = [sys.executable, "-m", "mocap", "course", "mark", "in", "-o", "marks.csv"]
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # tests in the background ignore it
    )
    for _ in range(1200):
        if begun.exists() or process.poll() is not None:
            break
        time.sleep(0.1)
    assert begun.exists()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    assert err.splitlines()[1:] == ["mocap: interrupted; no half-written file is left."]
    assert [row["right"] for row in rows(tmp_path / "marks.csv")] == ["1", "0", "0"]
    assert not LINUX or sleepers() == []


def test_kept_functions_beside_a_notebook_are_neither_run_nor_marked(tmp_path, monkeypatch):
    kept, planted = tmp_path / "ann" / "my_graph.py", tmp_path / "planted"
    adopts = ("exercise:speed", "from mocap.course import lab\nspeed = lab.mine('speed')")
    hand_in([START, adopts], kept.with_name("later.ipynb"))
    kept.write_text(f"open({str(planted)!r}, 'w')\n\n# ---- speed (notebook 00) ----\n\n{SPEED[1]}\n")
    monkeypatch.setenv("MOCAP_MINE", str(kept))
    monkeypatch.chdir(kept.parent)
    said = [one.said for one in mark(tmp_path) if one.exercise == "speed"]
    assert not planted.exists()
    assert said[0].startswith("✗ speed: not there yet.")  # and not what the package puts in its place
