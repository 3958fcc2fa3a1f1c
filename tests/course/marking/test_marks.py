"""Dishonest and unlucky students behind several walls, and what the marker says of them."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import pytest

import mocap
from mocap.course.checks import all_checks
from mocap.course.marking import mark, marks, walls
from tests.course.marking.students import (
    HONEST,
    LOOKING,
    SLEEP,
    SPEED,
    START,
    STUDENTS,
    hand_in,
    handed,
    speed,
)
from tests.refusals import refused

SECRET = "correct horse battery staple"
EXERCISES = ("speed", "cheapest")
COMMAND = """
import sys
from mocap.cli.main import main
from mocap.course.marking import marks, sealed
marks.SECONDS, sealed.WANTED = 4, sys.argv[1].split()
sys.exit(main(["course", "mark", *sys.argv[2:]]))
"""
LINUX = sys.platform == "linux"


def with_cells(change):
    """Change the cells of a notebook's text."""

    def spoil(text):
        notebook = json.loads(text)
        for cell in notebook["cells"]:
            change(cell)
        return json.dumps(notebook)

    return spoil


SPOILED = {  # what happened to an honest notebook, and the marks that it earns
    "is cut": ("00", lambda text: text[: len(text) // 2]),
    "is empty": ("00", lambda _: ""),
    "has no cells": ("00", with_cells(dict.clear)),
    "is JSON of another kind": ("00", lambda text: f"[{text}]"),
    "is nested": ("00", lambda _: "[" * 100_000),
    "is Latin 1": (
        "11",
        lambda text: text.replace("import numpy", "# größe\\nimport numpy").encode("latin-1"),
    ),
    "begins as Windows likes it": ("11", lambda text: f"\ufeff{text}"),
    "has huge outputs": (
        "11",
        with_cells(
            lambda c: c["outputs"].append({"output_type": "stream", "name": "stdout", "text": "x" * 9**7})
        ),
    ),
    "has one id": ("11", with_cells(lambda cell: cell.update(id="a b ü"))),
    "has no ids": ("11", with_cells(lambda cell: cell.pop("id"))),
}
pytestmark = pytest.mark.skipif(os.name != "posix", reason="marking needs Linux or macOS")


@pytest.fixture(scope="session")
def copy(tmp_path_factory):
    """Copy the package, which a notebook might change, and its notebooks; give the environment to use it."""
    place = tmp_path_factory.mktemp("copy")
    shutil.copytree(Path(mocap.__file__).parent, place / "mocap", symlinks=True)
    (place / "notebooks").symlink_to(Path(mocap.__file__).parents[1] / "notebooks")
    return os.environ | {"PYTHONPATH": str(place), "TOKEN": SECRET}


def start(copy, behind, folder, jobs=1):
    command = [sys.executable, "-c", COMMAND, behind, str(folder), "-o", str(folder.parent / "marks.csv")]
    command += ["--jobs", str(jobs)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    unignored = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    return subprocess.Popen(command, env=copy, cwd=folder.parent, **pipes, **unignored)


def rows(file):
    if not file.exists():
        return []
    return list(csv.DictReader(file.read_text("utf-8").splitlines()))


def sleepers():
    found = []
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):  # it has ended
            found += [file] * (f"\0{SLEEP}\0".encode() in file.read_bytes())
    return found


@pytest.fixture(scope="module")
def marked(copy, tmp_path_factory):
    """Mark all students behind walls; the last knows nothing."""
    path = tmp_path_factory.mktemp("marked")
    folder = path / "handed-in"
    words = {"PLANTED": path / "planted", "LATER": folder / "zoe" / "x.ipynb", "FOLDER": folder}
    words |= {"HOME": Path.home(), "PLANT": f"planted-{path.name}-{os.getpid()}"}
    cells = {name: handed(name, words) for name in STUDENTS} | {"zoe": HONEST}
    cells["zz"] = speed("def speed(positions, fps): return 0")
    for name, made in cells.items():
        hand_in(made, folder / name / "x.ipynb")
    for name, (_, spoil) in SPOILED.items():
        hand_in(HONEST, folder / name / "x.ipynb", spoil)
    before = {file: file.read_bytes() for file in folder.rglob("*.ipynb")}
    running = start(copy, " ".join(walls.ALL), folder, jobs=2)
    _, err = running.communicate(timeout=600)
    if f"behind {', '.join(walls.ALL)}:" not in err:
        pytest.skip(f"this system raises fewer walls: {err.splitlines()[0]}")
    assert running.returncode == 2, err  # some are no notebooks, and one has an unknown tag
    assert (
        "not a notebook: has no cells, is JSON of another kind, is cut, is empty, is nested"
        in err.splitlines()[-1]
    )
    assert "exercises that this version does not know: lost cells and tags (sped)" in err.splitlines()[-1]
    assert {file: file.read_bytes() for file in folder.rglob("*.ipynb")} == before
    for place in ("/tmp", "/dev/shm", "/var/tmp", Path.home(), folder, Path(sys.prefix)):
        assert not (Path(place) / words["PLANT"]).exists()
    assert not words["PLANTED"].exists()
    return path


def test_students_get_marks_only_for_what_is_right(marked):
    wanted = {name: one.get("earns", "01") for name, one in STUDENTS.items()} | {"zoe": "11", "zz": "01"}
    wanted |= {name: right for name, (right, _) in SPOILED.items()}
    said = {(r["handed in"].lstrip("'").split("/")[0], r["exercise"]): r for r in rows(marked / "marks.csv")}
    got = {name: "".join(said[name, exercise]["right"] for exercise in EXERCISES) for name in wanted}
    assert got == wanted


def test_the_reason_is_said_and_no_secret(marked):
    lines = rows(marked / "marks.csv")
    said = {line["handed in"].split("/")[0]: line["said"] for line in lines if line["exercise"] == "speed"}
    said["lost cells and tags"] = next(line["said"] for line in lines if "sped" in line["said"])
    wanted = {name: one["said"] for name, one in STUDENTS.items() if "said" in one}
    assert {name: said[name] for name, words in wanted.items() if words not in said[name]} == {}
    assert SECRET not in (marked / "marks.csv").read_text("utf-8")


def test_the_tables_are_whole_and_no_formulas_and_no_process_is_left(marked):
    assert not LINUX or sleepers() == []
    lines, found = (marked / "marks.csv").read_text("utf-8").splitlines(), rows(marked / "marks.csv")
    values = [value for row in found for value in row.values()]
    assert len(lines) == len(found) + 1
    assert not any(v.startswith(("=", "+", "-", "@")) for v in values) and "\x1b" not in "".join(lines)
    table = {row["student"].lstrip("'"): row for row in rows(marked / "marks-table.csv")}
    assert {*table} == {folder.name for folder in (marked / "handed-in").iterdir()}
    for name, right in {"zoe": 1, "is cut": 0}.items():
        wanted = {
            "student": name,
            **dict.fromkeys(EXERCISES, f"{right}"),
            "points": f"{2 * right}",
            "late": "",
        }
        assert table[name] == wanted


def test_without_walls_the_keeper_is_replaced_and_a_changed_package_ends_the_marking(copy, tmp_path):
    students = {
        "ada": HONEST,
        "bob": handed("kills what started it"),
        "cid": handed("leaves a grandchild behind"),
        "dan": handed("stops what started it"),
        "eve": handed("rewrites the package"),
        "zz": speed("def speed(positions, fps): return 0"),
    }
    for name, cells in students.items():
        hand_in(cells, tmp_path / "in" / name / "x.ipynb")
    place = tmp_path / "copy"
    shutil.copytree(Path(copy["PYTHONPATH"]), place, symlinks=True)
    running = start(copy | {"PYTHONPATH": str(place)}, "", tmp_path / "in")
    _, err = running.communicate(timeout=300)
    first, *_, last = err.splitlines()
    assert first.startswith("marking behind no walls: notebooks READ AND WRITE WHAT YOU CAN")
    assert last.startswith("mocap: eve/x.ipynb has changed the package: install it anew")
    found = rows(tmp_path / "marks.csv")
    right = ["".join(r["right"] for r in found if r["handed in"].startswith(name)) for name in students]
    assert right == ["11", "01", "01", "01", "00", ""]
    assert not LINUX or sleepers() == []


def test_where_the_checks_run_the_same_search_finds_the_right_answer_everywhere(tmp_path):
    """This is the control of the student who looks for right answers, and finds none."""
    code = f"{LOOKING}\nprint(found)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert done.stdout == "['a file', 'an import', 'its check', 'memory']\n"


def test_an_empty_folder_and_one_without_exercises(tmp_path):
    refused("holds no notebooks", list, mark(tmp_path))
    hand_in([], tmp_path / "ada.ipynb")
    [[found]] = mark(tmp_path)
    assert (found.handed_in, found.exercise, found.right) == ("ada.ipynb", "", False)
    assert (found.said, found.problem) == ("holds no exercise of the course.", "no exercise of the course")


def test_an_endless_first_cell_is_said_of_each_exercise(tmp_path, monkeypatch):
    monkeypatch.setattr(marks, "STARTING", 2)
    hand_in([("", "while True: pass"), *HONEST[1:]], tmp_path / "ada" / "00.ipynb")
    (found, _) = mark(tmp_path)
    assert [one.said for one in found] == [f"✗ {name}: stopped after 2 s." for name in EXERCISES]


def test_a_notebook_has_a_budget_of_time_for_all_that_it_holds_up(tmp_path, monkeypatch):
    """Each of eight exercises ends Python; at each look the clock has gone on by 100 s."""
    looks = count(step=100)
    monkeypatch.setattr(marks, "time", SimpleNamespace(monotonic=lambda: next(looks)))
    names = [name for name in all_checks() if name not in EXERCISES][:8]
    ends = [(f"exercise:{name}", f"import os\n{name} = 1\nos._exit(0)") for name in names]
    hand_in([START, *ends], tmp_path / "ada" / "x.ipynb")
    hand_in(HONEST, tmp_path / "zoe" / "x.ipynb")
    said, zoe = ([one.said for one in some if one.exercise] for some in list(mark(tmp_path))[:2])
    late = [one for one in said if one.endswith("not tried, as the notebook has used up its 360 s.")]
    assert len(said) == 8 and len(late) == 7
    assert said[0].endswith("ends Python itself.") and zoe[0].startswith("✓")


def test_no_answer_stops_the_marker(tmp_path):
    """One too large for a float, one too long, of rows of different lengths, no number, and no plain data."""
    heads = (SPEED[1], HONEST[2][1])
    for name, answers in {
        "a": ("10**400", "'x' * 2_000_000"),
        "b": ("float('nan')", "object()"),
        "c": ("[[1], [2, 3]]", "len"),
    }.items():
        cells = [
            (f"exercise:{exercise}", f"{head.splitlines()[0]}\n    return {answer}")
            for exercise, head, answer in zip(EXERCISES, heads, answers, strict=True)
        ]
        hand_in([START, *cells], tmp_path / f"{name}.ipynb")
    found = [one for some in mark(tmp_path) for one in some]
    assert len(found) == 6 and not any(one.right for one in found)


def test_an_exercise_that_uses_another_one_says_if_that_is_wrong(tmp_path):
    wrong = ("exercise:speed", SPEED[1].replace("* fps", "/ fps"))
    uses = ("exercise:cheapest", "def cheapest(grid, minima):\n    return speed(grid, 1.0)")
    hand_in([START, wrong, uses], tmp_path / "ada" / "00.ipynb")
    speed_mark, cheapest_mark = next(mark(tmp_path))
    assert cheapest_mark.said.endswith(" It uses `speed`, which is not right either.")
    assert cheapest_mark.note == "uses `speed`, which is not right either" and speed_mark.note == ""


def test_folders_in_folders_leave_nothing_behind(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    deep = "import os, time\nfor _ in range(1500):\n    os.mkdir('d')\n    os.chdir('d')\ntime.sleep(0.5)"
    hand_in(speed(deep), tmp_path / "in" / "00.ipynb")
    wrong, right = next(mark(tmp_path / "in"))  # the keeper counts them while they are there
    assert "no cell defines `speed`" in wrong.said and right.right
    assert [path.name for path in tmp_path.iterdir()] == ["in"]


def test_what_is_no_file_is_said_at_once(tmp_path):
    """A link is none: it may lead to another's notebook."""
    (tmp_path / "zero.ipynb").symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "fifo.ipynb")
    assert [one.said for some in mark(tmp_path) for one in some] == [
        f"{name}.ipynb: is no plain file, or one of more than 100 MB." for name in ("fifo", "zero")
    ]


@pytest.mark.parametrize("ending", ["SIGTERM", "SIGKILL"])
def test_an_end_keeps_the_marks_and_leaves_no_process(ending, copy, tmp_path):
    hand_in([START, SPEED], tmp_path / "in" / "ada" / "00.ipynb")
    slow = f"import subprocess\nsubprocess.run(['sleep', '{SLEEP}'])"
    hand_in([START, ("exercise:speed", slow)], tmp_path / "in" / "bob" / "00.ipynb")
    process = start(copy, " ".join(walls.ALL), tmp_path / "in", jobs=2)
    until = time.monotonic() + 100
    while not sleepers() and process.poll() is None and time.monotonic() < until:
        time.sleep(0.05)
    while not rows(tmp_path / "marks.csv") and time.monotonic() < until:
        time.sleep(0.05)
    assert [row["right"] for row in rows(tmp_path / "marks.csv")] == ["1", "0"]  # while bob's runs
    process.send_signal(getattr(signal, ending))
    _, err = process.communicate(timeout=60)
    if ending != "SIGKILL":
        assert (process.returncode, err.splitlines()[1:]) == (
            130,
            ["mocap: interrupted; no half-written file is left."],
        )
    while sleepers() and time.monotonic() < until:  # the keeper sees that the marker is dead
        time.sleep(0.05)
    assert sleepers() == []
    assert [row["right"] for row in rows(tmp_path / "marks.csv")] == ["1", "0"]


def test_kept_functions_beside_a_notebook_are_neither_run_nor_marked(tmp_path, monkeypatch):
    kept, planted = tmp_path / "ann" / "my_graph.py", tmp_path / "planted"
    adopts = ("exercise:speed", "from mocap.course import lab\nspeed = lab.mine('speed')")
    hand_in([START, adopts], kept.with_name("later.ipynb"))
    kept.write_text(f"open({str(planted)!r}, 'w')\n\n# ---- speed (notebook 00) ----\n\n{SPEED[1]}\n")
    monkeypatch.setenv("MOCAP_MINE", str(kept))
    monkeypatch.chdir(kept.parent)
    said = [one.said for some in mark(tmp_path) for one in some if one.exercise == "speed"]
    assert not planted.exists()
    assert said[0].startswith("✗ speed: not there yet.")  # and not what the package puts in its place
