"""The course handed out."""

import sys

import nbformat
import pytest

from mocap.cli.main import main
from mocap.course.handout import hand_out
from mocap.course.notebooks import read, tagged
from mocap.course.opening import stored
from mocap.errors import MocapError


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


@pytest.mark.parametrize(
    "command", [["handout", "-o", "out"], ["mark", "."], ["run", "n.ipynb"], ["site", "-o", "site"]]
)
def test_without_the_notebooks_libraries_one_sentence_says_what_to_install(
    command, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "nbformat", None)
    assert main(["course", *command]) != 0
    assert "pip install '.[notebooks]'" in capsys.readouterr().err
    assert not list(tmp_path.glob("out/*"))
