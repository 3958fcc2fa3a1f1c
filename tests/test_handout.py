"""The course handed out, handed in, and marked."""

import csv
import io
import sys

import nbformat
import pytest

from mocap import handout
from mocap.__main__ import main
from mocap.course import read, tagged
from mocap.errors import MocapError
from mocap.handout import hand_out, mark, to_csv
from mocap.lab import stored

RIGHT = "def speed(positions, fps):\n    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps\n"


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
    with pytest.raises(MocapError, match=r"00-quickstart.ipynb is there already; name another folder"):
        hand_out(stored(), copies[0].parent)


def hand_in(copy, target, **code):
    notebook = read(copy)
    for name, cell in tagged(notebook, "exercise"):
        cell.source = code.get(name, cell.source)
    target.parent.mkdir(exist_ok=True)
    nbformat.write(notebook, target)


def test_marks(copies, tmp_path, monkeypatch, capsys):
    hand_in(
        copies[0], tmp_path / "ada" / "00.ipynb", speed=RIGHT, dead_ends="def dead_ends(edges)\n    return 1"
    )
    hand_in(
        copies[0], tmp_path / "bob" / "00.ipynb", cheapest="import time\ntime.sleep(60)", speed="print(1)"
    )
    (tmp_path / "bob" / "broken.ipynb").write_text("{")
    monkeypatch.setattr(handout, "SECONDS", 6)
    assert main(["course", "mark", str(tmp_path), "-o", str(tmp_path / "marks.csv")]) == 0
    assert "1 of 7 are right" in capsys.readouterr().out
    rows = list(csv.DictReader(io.StringIO((tmp_path / "marks.csv").read_text("utf-8"))))
    said = {(row["handed in"], row["exercise"]): (row["right"], row["said"]) for row in rows}
    assert said["ada/00.ipynb", "speed"] == ("1", "✓ speed: right on 40 random inputs.")
    assert said["ada/00.ipynb", "cheapest"][1].startswith("✗ cheapest: not there yet")
    assert said["ada/00.ipynb", "dead_ends"][1].startswith("✗ SyntaxError: ")
    assert said["bob/00.ipynb", "speed"][1].startswith("✗ speed: not there yet")
    assert said["bob/00.ipynb", "cheapest"] == ("0", "✗ stopped after 6 s")
    assert said["bob/broken.ipynb", ""][1].endswith("broken.ipynb: is not a notebook.")


@pytest.mark.parametrize("function", [lambda folder: list(mark(folder)), lambda f: hand_out(f, f / "out")])
def test_an_empty_folder_is_told(function, tmp_path):
    with pytest.raises(MocapError, match="There are no notebooks in"):
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
