"""`mocap course run` and `mocap lab`, as a person types them; the other commands are in tests/course."""

import subprocess

import nbformat

from mocap.cli.main import main
from mocap.course import lab


def test_a_cell_that_fails_is_named_in_one_sentence(tmp_path, capsys):
    path = tmp_path / "n.ipynb"
    cells = [nbformat.v4.new_markdown_cell("# Title"), nbformat.v4.new_code_cell("x = 1\nx / 0")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    before = path.read_text("utf-8")
    assert main(["course", "run", str(path)]) == 2
    assert capsys.readouterr().err == f"mocap: {path}, cell 1: ZeroDivisionError: division by zero\n"
    assert path.read_text("utf-8") == before


def test_lab_opens_the_first_notebook(monkeypatch, tmp_path):
    started = []

    def run(command, check):
        started.append(command)
        return subprocess.CompletedProcess(command, 7)

    monkeypatch.setattr(lab.subprocess, "run", run)
    assert main(["lab", str(tmp_path)]) == 7  # what JupyterLab itself ends with
    assert started[0][1:3] == ["-m", "jupyterlab"]
    assert started[0][3].endswith("00-quickstart.ipynb")


def test_lab_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setattr(lab.importlib.util, "find_spec", lambda name: None)
    assert main(["lab"]) == 2
    assert "pip install 'mocap[notebooks]'" in capsys.readouterr().err
