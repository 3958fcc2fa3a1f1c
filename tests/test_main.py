"""The command, as a person types it."""

import subprocess
import sys

import pytest

from mocap import files, lab
from mocap.__main__ import main
from tests.strategies import wave


@pytest.fixture
def clips(tmp_path):
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        files.save(clip, tmp_path / f"{clip.name}.bvh")
    return tmp_path


def test_the_demo_writes_a_walk_and_tells(clips, capsys):
    out = clips / "new" / "walk"
    assert main(["demo", str(clips), "-o", str(out), "--threshold", "5", "--seconds", "2"]) == 0
    assert sorted(path.name for path in out.iterdir()) == ["walk.bvh", "walk.gif"]
    assert len(files.load(out / "walk.bvh")) >= 60
    told = capsys.readouterr()
    assert "new walk" in told.out
    assert str(out / "walk.gif") in told.out
    assert told.err == ""


def test_without_clips_it_takes_the_bundled_ones(tmp_path, capsys):
    assert main(["demo", "-o", str(tmp_path), "--seconds", "1"]) == 0
    assert "walk_circle" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["nowhere.bvh"], "nowhere.bvh"),
        (["{clips}", "--threshold", "0.001"], "need at least"),
        (["{clips}", "--threshold", "-1"], "above 0"),
        (["{clips}", "--window", "60"], "too few for a window of 1800"),
        (["{clips}", "--seconds", "0"], "longer than 0 s"),
        (["{clips}", "--fps", "0"], "above 0"),
        (["{clips}/a.bvh", "{clips}/a.bvh"], "given twice: a"),
        (["{clips}", "--threshold", "5", "-o", "{clips}/a.bvh/below"], "Cannot make the folder"),
    ],
)
def test_bad_input_is_one_sentence_and_status_2(clips, capsys, options, message):
    options = [option.format(clips=clips) for option in options]
    before = sorted(clips.iterdir())
    assert main(["demo", "-o", str(clips / "out"), *options]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.startswith("mocap: ")
    assert told.count("\n") == 1
    assert sorted(clips.iterdir()) == before


def test_an_interruption_leaves_nothing(clips, capsys, monkeypatch):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("mocap.demo.run", interrupt)
    assert main(["demo", str(clips), "-o", str(clips / "out")]) == 130
    assert "interrupted" in capsys.readouterr().err
    assert not (clips / "out").exists()


def test_it_runs_as_a_module_and_helps():
    run = subprocess.run(
        [sys.executable, "-m", "mocap", "demo", "--help"], capture_output=True, text=True, check=True
    )
    assert "walk.bvh" in run.stdout
    assert "--threshold" in run.stdout


def test_without_a_command_it_shows_the_usage(capsys):
    with pytest.raises(SystemExit, match="2"):
        main([])
    assert "COMMAND" in capsys.readouterr().err


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


def test_an_installed_package_copies_its_notebooks_and_keeps_edited_ones(monkeypatch, tmp_path):
    package = tmp_path / "site" / "mocap"
    (package / "notebooks").mkdir(parents=True)
    for name in ("00-quickstart.ipynb", "01-next.ipynb"):
        (package / "notebooks" / name).write_text("{}")
    monkeypatch.setattr(lab, "PACKAGE", package)
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "01-next.ipynb").write_text("edited")
    assert lab.course_folder(mine) == mine
    assert (mine / "00-quickstart.ipynb").read_text() == "{}"
    assert (mine / "01-next.ipynb").read_text() == "edited"
