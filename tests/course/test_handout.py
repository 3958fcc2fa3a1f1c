"""The course handed out, handed in, and marked."""

import contextlib
import csv
import io
import sys

import nbformat
import pytest

from mocap.cli.main import main
from mocap.course import handout
from mocap.course.handout import hand_out, mark, to_csv
from mocap.course.lab import stored
from mocap.course.notebooks import read, tagged
from mocap.errors import MocapError

RIGHT = "def speed(positions, fps):\n    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps\n"
LOUD = """
def cheapest(grid, minima):
    print("✗ I say so")
    np.log(0.0)
    return minima[np.argmin(grid[minima[:, 0], minima[:, 1]])]
"""
DEAF = """
import time
for _ in range(99):
    try:
        time.sleep(60)
    except KeyboardInterrupt:
        pass
"""


@pytest.fixture(scope="module")
def copies(tmp_path_factory):
    return hand_out(stored(), tmp_path_factory.mktemp("handout") / "course")


def test_a_handout_has_everything_but_the_solutions(copies):
    for copy, original in zip(copies, sorted(stored().glob("*.ipynb")), strict=True):
        notebook, whole = read(copy), read(original)
        nbformat.validate(notebook)
        assert list(tagged(notebook, "solution")) == []
        solutions = len(list(tagged(whole, "solution")))
        assert len(notebook.cells) == len(whole.cells) - solutions
        assert "<summary>Solution" not in copy.read_text("utf-8")
    assert {"GLOSSARY.md", "FORMULAS.md"} <= {path.name for path in copies[0].parent.iterdir()}
    assert not (copies[0].parent / "README.md").exists()  # the instructors'


def test_a_handout_replaces_nothing(copies):
    with pytest.raises(MocapError, match=r"00-quickstart.ipynb exists already; choose another folder"):
        hand_out(stored(), copies[0].parent)


@pytest.mark.parametrize("command", ["handout", "site"])
def test_a_folder_that_cannot_be_made_is_told(command, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["course", command, "-o", str(tmp_path / "file")]) != 0
    assert f"Cannot make the folder {tmp_path / 'file'}: File exists." in capsys.readouterr().err


def hand_in(copy, target, **code):
    notebook = read(copy)
    for name, cell in tagged(notebook, "exercise"):
        cell.source = code.get(name, cell.source)
    target.parent.mkdir(exist_ok=True)
    nbformat.write(notebook, target)


def test_marks(copies, tmp_path, monkeypatch, capsys):
    broken = "def dead_ends(edges)\n    return 1"
    hand_in(copies[0], tmp_path / "ada" / "00.ipynb", speed=RIGHT, cheapest=LOUD, dead_ends=broken)
    ending = "import os\nos._exit(0)"
    hand_in(copies[0], tmp_path / "bob" / "00.ipynb", speed="print(1)", cheapest=ending, dead_ends=DEAF)
    (tmp_path / "bob" / "broken.ipynb").write_text("{")
    nbformat.write(nbformat.v4.new_notebook(), tmp_path / "bob" / "empty.ipynb")
    monkeypatch.setattr(handout, "SECONDS", 4)
    assert main(["course", "mark", str(tmp_path), "-o", str(tmp_path / "marks.csv")]) == 0
    assert "2 of 8 are right" in capsys.readouterr().out
    rows = list(csv.DictReader(io.StringIO((tmp_path / "marks.csv").read_text("utf-8"))))
    said = {(row["handed in"], row["exercise"]): (row["right"], row["said"]) for row in rows}
    assert said["ada/00.ipynb", "speed"] == ("1", "✓ speed: right on 40 random inputs.")
    assert said["ada/00.ipynb", "cheapest"] == ("1", "✓ cheapest: right on 40 random inputs.")
    assert said["ada/00.ipynb", "dead_ends"][1].startswith("✗ SyntaxError: ")
    assert said["bob/00.ipynb", "speed"][1].startswith("✗ speed: not there yet")
    assert said["bob/00.ipynb", "cheapest"] == ("0", "✗ ends Python itself")
    assert said["bob/00.ipynb", "dead_ends"] == ("0", "✗ stopped after 4 s")
    assert said["bob/broken.ipynb", ""][1].endswith("broken.ipynb: is not a notebook.")
    assert said["bob/empty.ipynb", ""][1].startswith("holds no exercises")


@pytest.mark.parametrize(
    ("first", "says"),
    [
        ("import os; os._exit(0)", "✗ ends Python itself"),
        ("get_ipython().ast_node_interactivity = 'none'", "✗ keeps"),
    ],
)
def test_a_first_cell_that_spoils_all_is_told_of_each_exercise(first, says, copies, tmp_path):
    notebook = read(copies[0])
    next(cell for cell in notebook.cells if cell.cell_type == "code").source = first
    nbformat.write(notebook, tmp_path / "00.ipynb")
    marks = list(mark(tmp_path))
    assert len(marks) == 3
    assert all(one.said.startswith(says) and not one.right for one in marks)


def test_marks_made_before_an_interruption_are_kept(tmp_path, monkeypatch):
    def marks(folder, progress):
        yield handout.Mark("ada/00.ipynb", "speed", True, "✓")
        raise KeyboardInterrupt

    monkeypatch.setattr("mocap.course.mark", marks)
    with contextlib.suppress(KeyboardInterrupt):
        main(["course", "mark", str(tmp_path), "-o", str(tmp_path / "marks.csv")])
    assert "ada/00.ipynb,speed,1" in (tmp_path / "marks.csv").read_text("utf-8")


@pytest.mark.parametrize("function", [lambda folder: list(mark(folder)), lambda f: hand_out(f, f / "out")])
def test_an_empty_folder_is_told(function, tmp_path):
    with pytest.raises(MocapError, match="holds no notebooks"):
        function(tmp_path)


@pytest.mark.parametrize(
    "command", [["handout", "-o", "out"], ["mark", "."], ["run", "n.ipynb"], ["site", "-o", "site"]]
)
def test_without_the_notebooks_libraries_one_sentence_says_what_to_install(
    command, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "nbformat", None)
    assert main(["course", *command]) != 0
    assert "pip install 'mocap[notebooks]'" in capsys.readouterr().err
    assert not list(tmp_path.glob("out/*"))


def test_the_table_keeps_commas():
    text = to_csv([handout.Mark("a", "f", False, "✗ f: one, two")])
    assert list(csv.reader(io.StringIO(text)))[1] == ["a", "f", "0", "✗ f: one, two"]
