"""`mocap graph`, as a person types it."""

import pytest

from mocap.cli.main import main
from mocap.files import load_save
from mocap.graphs import storage
from tests.cli.refused import check_refused


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
        (["{clips}", "--graphml", "g.xml"], "--graphml writes .graphml, got"),
        (["{clips}", "--threshold", "0.001"], "no cycle"),
        (["{clips}", "--threshold", "nan"], "--threshold: 'nan' is not a number"),
        (["{clips}", "--window", "nan"], "--window: 'nan' is not a number"),
        (["{clips}", "-o", "{clips}/nowhere/g.npz"], "No such file or directory"),
        (["{clips}", "-o", "{clips}"], "written as .npz"),
    ],
)
def test_a_graph_that_cannot_be_is_one_sentence(clips, capsys, options, message):
    options = [option.format(clips=clips) for option in options]
    check_refused(clips, capsys, ["graph", "-o", str(clips / "g.npz"), *options], message)


@pytest.mark.parametrize(
    ("file", "message"), [("a.bvh", "a.bvh: expected a motion graph"), ("none.npz", "No such file")]
)
def test_info_about_what_is_no_graph_is_one_sentence(clips, capsys, file, message):
    check_refused(clips, capsys, ["graph", "info", str(clips / file)], message)


def test_a_folder_of_clips_named_info_is_built(clips, tmp_path, monkeypatch):
    (tmp_path / "info").symlink_to(clips)
    monkeypatch.chdir(tmp_path)
    for words in (["graph", "build", "info"], ["graph", "./info"]):
        assert main([*words, "-o", "g.npz"]) == 0
    assert main(["graph", "info"]) == 2


def test_the_usage_of_its_actions_is_in_one_piece(capsys):
    for action in ("build", "info"):
        with pytest.raises(SystemExit, match="0"):
            main(["graph", action, "--help"])
        assert capsys.readouterr().out.startswith(f"usage: mocap graph {action} [-h]")
