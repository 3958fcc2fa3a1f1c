from dataclasses import replace

import numpy as np
import pytest

from mocap.errors import FormatError, MocapError
from mocap.methods.match_webs import load_web, save_web, search


@pytest.fixture(scope="module")
def saved(bundled, tmp_path_factory):
    path = tmp_path_factory.mktemp("webs") / "web.npz"
    save_web(bundled.web, path)
    return path


def test_a_web_comes_back_bit_for_bit(bundled, saved):
    back = load_web(saved, bundled.clips)
    for key in ("starts", "cells", "costs", "offsets"):
        assert np.array_equal(getattr(back, key), getattr(bundled.web, key))
        assert getattr(back, key).dtype == getattr(bundled.web, key).dtype
    assert (back.rate, back.window, back.below) == (30, 5, 0.08)
    one, other = (search(web, 0, bundled.truth[2][1]) for web in (bundled.web, back))
    assert [m[:6] for m in one] == [m[:6] for m in other]


def test_the_file_is_small_and_holds_no_frames(bundled, saved):
    frames = sum(clip.rotations.nbytes for clip in bundled.clips)
    assert saved.stat().st_size < 0.05 * frames
    with np.load(saved, allow_pickle=False) as archive:
        assert archive["cells"].dtype == np.int32 and archive["costs"].dtype == np.float32


def test_other_clips_are_refused(bundled, saved):
    clips = bundled.clips
    with pytest.raises(MocapError, match=r"web\.npz was built of 5 clips, got 4\."):
        load_web(saved, clips[:4])
    with pytest.raises(MocapError, match="was built of 'walk_straight', not of this 'walk_circle'"):
        load_web(saved, [clips[1], clips[0], *clips[2:]])
    with pytest.raises(MocapError, match="not of this 'walk_straight': take that clip, or build anew"):
        load_web(saved, [clips[0][1:], *clips[1:]])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda a: a.update(format=np.array("another")), "an .npz of another kind"),
        (lambda a: a.update(version=np.array(9)), "version 9, which a newer mocap wrote"),
        (lambda a: a.pop("costs"), "one without costs"),
        (lambda a: a.update(costs=a["costs"][:-1]), "'costs' to fit the other arrays"),
        (lambda a: a.update(cells=a["cells"].astype(float)), "'cells' to fit the other arrays"),
        (lambda a: a.update(cells=a["cells"] + 10_000), "that cells lie in clips"),
        (lambda a: a.update(cells=a["cells"] - 10_000), "that cells lie in clips"),
        (lambda a: a.update(cells=a["cells"][::-1]), "that time never runs backwards"),
        (lambda a: a.update(lengths=a["lengths"][::-1]), "that a path stays in its two clips"),
        (lambda a: a.update(offsets=a["offsets"][1:]), "that paths begin at the first cell"),
        (lambda a: a.update(offsets=a["offsets"][:-1]), "that paths end at the last cell"),
        (lambda a: a.update(offsets=np.repeat(a["offsets"], 2)), "that no path is empty"),
        (lambda a: a.update(costs=-a["costs"]), "that costs are distances"),
        (lambda a: a.update(numbers=-a["numbers"]), "that its frames are 30 a second, its distances above 0"),
        (lambda a: a.update(window=np.array(0)), "that the window has frames"),
        (lambda a: a.update(lengths=-a["lengths"]), "that clips have lengths"),
    ],
)
def test_a_damaged_file_is_refused_with_what_is_wrong(bundled, saved, tmp_path, change, message):
    with np.load(saved) as archive:
        arrays = dict(archive)
    change(arrays)
    path = tmp_path / "bad.npz"
    np.savez(path, **arrays)
    with pytest.raises(FormatError, match=message) as caught:
        load_web(path, bundled.clips)
    assert len(str(caught.value)) - len(str(path)) <= 200


def test_names_do_not_matter_but_poses_do(bundled, saved):
    clips = [replace(clip, name="renamed") for clip in bundled.clips]
    assert len(load_web(saved, clips)) == len(bundled.web)
