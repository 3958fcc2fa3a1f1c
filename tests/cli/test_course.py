"""`mocap course run` and `mocap lab`, as a person types them; the other commands are in tests/course."""

import nbformat
import pytest

from mocap.cli.main import main
from mocap.course import opening


def test_a_cell_that_fails_is_named_in_one_sentence(tmp_path, capsys):
    path = tmp_path / "n.ipynb"
    cells = [nbformat.v4.new_markdown_cell("# Title"), nbformat.v4.new_code_cell("x = 1\nx / 0")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    before = path.read_text("utf-8")
    assert main(["course", "run", str(path)]) == 2
    assert capsys.readouterr().err == f"mocap: {path}, cell 1: ZeroDivisionError: division by zero\n"
    assert path.read_text("utf-8") == before


class Started:
    """A JupyterLab that ends when it has been asked twice."""

    def __init__(self, command):
        self.command, self.asked = command, 0

    def wait(self):
        self.asked += 1
        if self.asked == 1:
            raise KeyboardInterrupt
        return 7


@pytest.mark.parametrize(("user", "allowed"), [(0, ["--allow-root"]), (1000, [])])
def test_lab_opens_the_first_notebook_and_leaves_ctrl_c_to_jupyterlab(monkeypatch, tmp_path, user, allowed):
    started = []
    monkeypatch.setattr(
        opening.subprocess, "Popen", lambda command: started.append(Started(command)) or started[0]
    )
    monkeypatch.setattr(opening.os, "geteuid", lambda: user, raising=False)
    own = ["--no-browser", "--port", "8890"]
    assert main(["lab", str(tmp_path), "--", *own]) == 7  # JupyterLab's own status
    command = started[0].command
    assert command[1:3] == ["-m", "jupyterlab"]
    assert command[3] == str(
        tmp_path / "00-quickstart.ipynb"
    )  # also where notebooks of a checkout are at hand
    assert command[4:] == [*allowed, *own]
    assert started[0].asked == 2


def test_lab_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setattr(opening.importlib.util, "find_spec", lambda name: None)
    assert main(["lab"]) == 2
    assert "pip install '.[notebooks]'" in capsys.readouterr().err
