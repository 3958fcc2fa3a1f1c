"""The main job, from files to files, and `mocap demo` as a person types it."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.cli import demo
from mocap.cli.main import main
from mocap.cli.options import Building
from mocap.datasets import samples
from mocap.errors import NoWalk
from mocap.files import folders, load_save
from tests.cli.refused import check_refused
from tests.strategies import wave

CLIPS = [wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)]


@pytest.fixture(scope="module")
def bundled():
    return demo.run([samples.sample(name) for name in samples.SAMPLES], Building(), 20, 0)


def test_it_makes_a_walk_and_says_what_it_did():
    result = demo.run(CLIPS, Building(threshold=5), 5, 0)
    assert result.walk.duration >= 5 - 1 / 30
    table = dict(line.split(maxsplit=1) for line in result.table().splitlines() if line[0] != " ")
    assert table["clips"] == "2: a, b"
    assert table["frames"] == "210 at 30 Hz, 7.0 s"
    whole, pruned = map(int, table["nodes"].split())
    assert whole == result.whole.graph.number_of_nodes() > pruned > 0
    worst = max(seam.cost for seam in result.seams)
    assert table["seams"] == f"{len(result.seams)}, the worst {100 * worst:.1f} cm RMS"


def test_many_clips_are_named_in_short():
    clips = [replace(wave(60, phase=k, seed=k), name=f"clip{k}") for k in range(9)]
    assert (
        "9: clip0, clip1, clip2, clip3, clip4, clip5, clip6, … clip8"
        in demo.run(clips, Building(threshold=5), 12, 0).table()
    )


def test_a_threshold_that_leaves_no_cycle_is_told_with_one_that_does():
    with pytest.raises(NoWalk, match=r"at a threshold of 0\.01 cm; these clips need at least") as caught:
        demo.run(CLIPS, Building(threshold=0.01), 12, 0)
    enough = float(str(caught.value).split()[-2])
    assert len(demo.run(CLIPS, Building(threshold=enough + 1e-7), 12, 0).walk) > 0


def test_clips_of_other_rates_are_resampled():
    result = demo.run(CLIPS, Building(fps=20, threshold=6), 2, 0)
    assert result.walk.fps == 20


def test_the_bundled_clips_make_a_long_walk(bundled):
    assert bundled.walk.duration > 19.9
    assert bundled.pruned.count("transition") > 50
    assert all(seam.cost < 0.04 for seam in bundled.seams)
    steps = np.linalg.norm(np.diff(bundled.walk.root_positions[:, [0, 2]], axis=0), axis=1) * 30
    assert steps.max() < 4.5  # m/s: nobody is teleported


@pytest.mark.parametrize("folder", ["hw3", "cmu/16"])
def test_real_clips_make_a_walk(real_data, folder):
    names = (
        ["16_15", "16_17", "16_19", "16_31"] if folder == "cmu/16" else ["walk_fwd_circle", "walk_fwd_curve1"]
    )
    paths = [
        p for p in sorted((real_data / folder).iterdir()) if p.stem in names and p.suffix.lower() == ".amc"
    ]
    assert len(paths) == len(names)
    clips = folders.load_all(paths, skeleton=None, scale=None, progress=iter)
    result = demo.run([clip[:1600] for clip in clips], Building(), 10, 0)
    assert result.walk.duration >= 9.9
    assert 0 < max(seam.cost for seam in result.seams) < 0.04


# The command


def test_the_demo_writes_a_walk_and_tells(clips, capsys):
    out = clips / "new" / "walk"
    assert main(["demo", str(clips), "-o", str(out), "--threshold", "5", "--seconds", "2"]) == 0
    assert sorted(path.name for path in out.iterdir()) == ["walk.bvh", "walk.gif"]
    assert len(load_save.load(out / "walk.bvh")) >= 60
    told = capsys.readouterr()
    assert "new walk" in told.out
    assert str(out / "walk.gif") in told.out
    assert told.err == ""


def test_without_clips_it_takes_the_bundled_ones(bundled, tmp_path, capsys, monkeypatch):
    taken = []

    def run(clips, *_):
        taken.extend(clip.name for clip in clips)
        return replace(bundled, walk=bundled.walk[:30])

    monkeypatch.setattr(demo, "run", run)
    assert main(["demo", "-o", str(tmp_path)]) == 0
    assert taken == list(samples.SAMPLES)
    assert "walk_circle" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["nowhere.bvh"], "nowhere.bvh"),
        (["{clips}", "--threshold", "0.001"], "need at least"),
        (["{clips}", "--threshold", "-1"], "--threshold: '-1' is not a number from"),
        (["{clips}", "--window", "60"], "too few for a window of 1800"),
        (["{clips}", "--seconds", "0"], "--seconds: '0' is not"),
        (["{clips}", "--fps", "1e9"], "--fps: '1e9' is not a number from 1 to 1000"),
        (["{clips}", "--window", "0.001"], "two frames or more, got 0.001 s at 30 Hz"),
        (["{clips}", "--seed", "-1"], "--seed: '-1' is not a whole number from 0"),
        (["{clips}/a.bvh", "{clips}/a.bvh"], "given twice: a"),
        (["{clips}", "--threshold", "5", "-o", "{clips}/a.bvh/below"], "Cannot make the folder"),
    ],
)
def test_bad_input_is_one_sentence_and_status_2(clips, capsys, options, message):
    options = [option.format(clips=clips) for option in options]
    check_refused(clips, capsys, ["demo", "-o", str(clips / "out"), *options], message)


def test_an_interruption_leaves_nothing(clips, capsys, monkeypatch):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(demo, "run", interrupt)
    assert main(["demo", str(clips), "-o", str(clips / "out")]) == 130
    assert "interrupted" in capsys.readouterr().err
    assert not (clips / "out").exists()
