"""The command, as a person types it."""

import subprocess
import sys
import warnings
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

from mocap.cli.main import main
from mocap.course import lab
from mocap.errors import MocapWarning
from mocap.files import load_save
from mocap.graphs import storage
from tests.strategies import wave


@pytest.fixture
def clips(tmp_path):
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        load_save.save(clip, tmp_path / f"{clip.name}.bvh")
    return tmp_path


def test_the_demo_writes_a_walk_and_tells(clips, capsys):
    out = clips / "new" / "walk"
    assert main(["demo", str(clips), "-o", str(out), "--threshold", "5", "--seconds", "2"]) == 0
    assert sorted(path.name for path in out.iterdir()) == ["walk.bvh", "walk.gif"]
    assert len(load_save.load(out / "walk.bvh")) >= 60
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
        (["{clips}", "--fps", "0"], "two frames or more, got 0.333333 s at 0 Hz"),
        (["{clips}", "--fps", "inf"], "two frames or more"),
        (["{clips}", "--window", "nan"], "two frames or more"),
        (["{clips}", "--window", "-1"], "two frames or more"),
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

    monkeypatch.setattr("mocap.cli.demo.run", interrupt)
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


def test_view_opens_a_page_of_the_clip(clips, capsys, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or True)
    assert main(["view", str(clips / "a.bvh")]) == 0
    (address,) = opened
    page = Path(url2pathname(urlsplit(address).path))
    assert "A stick figure plays a" in page.read_text("utf-8")
    assert str(page) in capsys.readouterr().out


def test_view_says_where_the_page_is_when_no_browser_opens(clips, capsys, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda address: False)
    assert main(["view", str(clips / "a.bvh")]) == 0
    assert "open that page yourself" in capsys.readouterr().err


def test_view_keeps_a_file_and_opens_nothing(clips, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda address: pytest.fail("opened"))
    assert main(["view", str(clips / "a.bvh"), "-o", str(clips / "a.png")]) == 0
    assert (clips / "a.png").read_bytes().startswith(b"\x89PNG")


def test_view_of_no_clip_is_one_sentence(clips, capsys):
    assert main(["view", str(clips / "missing.bvh")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_graph_is_built_saved_and_told_about(clips, capsys):
    out, xml = clips / "g.npz", clips / "g.graphml"
    assert main(["graph", str(clips), "-o", str(out), "--threshold", "5", "--graphml", str(xml)]) == 0
    built = capsys.readouterr()
    assert built.out.splitlines()[-2:] == [f"wrote        {out}", f"wrote        {xml}"]
    assert built.err == ""
    assert main(["graph", "info", str(out)]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[:3] == [
        "clip         a: 120 frames at 30 Hz, 4.0 s",
        "clip         b: 90 frames at 30 Hz, 3.0 s",
        "window       10 frames, 0.33 s",
    ]
    assert told[3:] == built.out.splitlines()[:-2]
    loaded = storage.load(out, [load_save.load(clips / f"{name}.bvh") for name in "ab"])
    assert loaded.graph.number_of_nodes() == int(told[4].split()[1].rstrip(","))


def test_a_whole_graph_ends_somewhere(clips, capsys):
    assert main(["graph", str(clips), "-o", str(clips / "g.npz"), "--whole"]) == 0
    assert "none before the end of some clip" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["{clips}", "-o", "{clips}/g.json"], "written as .npz, got"),
        (["{clips}", "--graphml", "g.xml"], "written as .graphml, got"),
        (["{clips}", "--threshold", "0.001"], "no cycle"),
        (["{clips}", "--threshold", "nan"], "above 0"),
        (["{clips}", "--fps", "inf"], "two frames or more"),
        (["{clips}", "--window", "nan"], "two frames or more, got nan s"),
        (["{clips}", "--fps", "0"], "two frames or more, got 0.333333 s at 0 Hz"),
        (["{clips}", "--fps", "inf"], "two frames or more"),
        (["{clips}", "--window", "nan"], "two frames or more"),
        (["{clips}", "--window", "-1"], "two frames or more"),
    ],
)
def test_a_graph_that_cannot_be_is_one_sentence(clips, capsys, options, message):
    before = sorted(clips.iterdir())
    options = [option.format(clips=clips) for option in options]
    assert main(["graph", "-o", str(clips / "g.npz"), *options]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert (told.startswith("mocap: "), told.count("\n")) == (True, 1)
    assert sorted(clips.iterdir()) == before


@pytest.mark.parametrize(
    ("file", "message"), [("a.bvh", "a.bvh: expected a motion graph"), ("none.npz", "No such file")]
)
def test_info_about_what_is_no_graph_is_one_sentence(clips, capsys, file, message):
    assert main(["graph", "info", str(clips / file)]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1


def test_a_folder_of_clips_named_info_is_built(clips, tmp_path, monkeypatch):
    (tmp_path / "info").symlink_to(clips)
    monkeypatch.chdir(tmp_path)
    for words in (["graph", "build", "info"], ["graph", "./info"]):
        assert main([*words, "-o", "g.npz"]) == 0
    with pytest.raises(SystemExit):
        main(["graph", "info"])


def test_a_warning_is_a_line_too(clips, capsys, monkeypatch):
    def warn(*_arguments, **_settings):
        warnings.warn("7 frames stay.", MocapWarning, stacklevel=1)
        return "x"

    monkeypatch.setattr("mocap.graphs.read", warn)
    with pytest.raises(AttributeError):
        main(["graph", "info", "x.npz"])
    assert capsys.readouterr().err == "mocap: 7 frames stay.\n"
