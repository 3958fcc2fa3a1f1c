"""A match web comes back from its file bit for bit, with its clips and no others."""

from dataclasses import replace

import numpy as np
import pytest

from mocap import datasets
from mocap.body import resample
from mocap.datasets.clip_origins import Origin
from mocap.datasets.samples import FRAMES_IN_0_1
from mocap.errors import FormatError, MocapError
from mocap.files import load_save
from mocap.methods.match_webs import build_web, load_web, save_web, search
from tests.refusals import quietly, refused
from tests.strategies import wave


@pytest.fixture(scope="module")
def saved(bundled, tmp_path_factory):
    path = tmp_path_factory.mktemp("webs") / "web.npz"
    save_web(bundled.web, path)
    return path


def changed(saved, path, **arrays):
    """Write the file again with other arrays; None takes one out."""
    with np.load(saved) as archive:
        new = {**archive, **arrays}
    np.savez(path, **{key: array for key, array in new.items() if array is not None})
    return path


def assert_same(web, other):
    for key in ("starts", "cells", "costs", "offsets"):
        ours, theirs = getattr(web, key), getattr(other, key)
        assert np.array_equal(ours, theirs) and ours.dtype == theirs.dtype and not theirs.flags.writeable
    assert web.below == other.below


def test_a_web_comes_back_bit_for_bit_and_finds_the_same(bundled, saved):
    back = load_web(saved, bundled.clips[::-1])
    assert back.clips == tuple(bundled.clips)
    assert_same(bundled.web, back)
    for clip, part in bundled.truth[::30]:
        ours, theirs = (quietly(search, web, clip, part) for web in (bundled.web, back))
        assert len(ours) > 1
        assert [match[:6] for match in ours] == [match[:6] for match in theirs]
        for one, other in zip(ours, theirs, strict=True):
            assert np.array_equal(one.rows, other.rows) and np.array_equal(one.frames, other.frames)


def test_bundled_clips_are_found_by_their_names(saved, bundled):
    assert_same(bundled.web, load_web(saved))


def test_a_web_saved_again_is_the_same_file(saved, bundled, tmp_path):
    save_web(load_web(saved, bundled.clips), tmp_path / "web.npz")
    assert (tmp_path / "web.npz").read_bytes() == saved.read_bytes()


def test_roles_are_those_with_which_the_web_was_saved(saved, bundled, tmp_path):
    bodies = [replace(clip.skeleton, roles={"left ball": "ltoes_end"}) for clip in bundled.clips]
    clips = [replace(clip, skeleton=body) for clip, body in zip(bundled.clips, bodies, strict=True)]
    save_web(replace(bundled.web, clips=tuple(clips)), tmp_path / "web.npz")
    assert load_web(tmp_path / "web.npz").clips == tuple(clips)
    older = changed(saved, tmp_path / "older.npz", version=np.array(1), roles=None)
    assert load_web(older, clips).clips == tuple(clips)


def test_the_file_is_small_and_holds_no_frames(bundled, saved):
    assert saved.stat().st_size < 0.05 * sum(clip.rotations.nbytes for clip in bundled.clips)


def test_clips_of_one_name_are_told_apart_and_short_ones_are_remembered(tmp_path):
    walk = resample(datasets.sample("walk_straight"), 60)
    parts = [walk[:20], walk[:27], walk[:200], walk[200:400]]  # 10, 14, 100 and 100 frames at 30 Hz
    web = quietly(build_web, parts, below=0.1)
    save_web(web, tmp_path / "web.npz")
    back = load_web(tmp_path / "web.npz", [datasets.sample("walk_straight"), *parts[::-1]])
    assert list(map(len, back.clips)) == [20, 27, 200, 200] and back.clips[1] is parts[1]
    assert np.diff(back.starts).tolist() == [0, 14, 100, 100]
    assert_same(web, back)


def test_webs_without_a_path_and_with_paths_of_one_cell_come_back(tmp_path):
    short = datasets.sample("walk_straight")[:56]  # 14 frames at 30 Hz
    empty = build_web([short])
    assert len(empty) == 0
    for web in (empty, replace(empty, cells=[[0, 9], [1, 13]], costs=[0.1, 0.2], offsets=[0, 1, 2])):
        save_web(web, tmp_path / "web.npz")
        assert_same(web, load_web(tmp_path / "web.npz", [short]))


def test_clips_are_found_where_they_were_and_in_their_unit(tmp_path):
    (tmp_path / "clips").mkdir()
    file = tmp_path / "clips" / "p.bvh"
    load_save.save(wave(90, name="p"), file)
    web = quietly(build_web, [load_save.load(file, scale=0.5)], below=0.1)
    save_web(web, tmp_path / "web.npz", [Origin(file, scale=0.5)])
    back = load_web(tmp_path / "web.npz")
    assert np.array_equal(back.clips[0].root_positions, web.clips[0].root_positions)
    assert_same(web, back)
    file.unlink()
    refused("The clip 'p' is no longer where", load_web, tmp_path / "web.npz")


def test_other_clips_are_refused(bundled, saved):
    clips = bundled.clips
    refused("needs the clip 'walk_straight'; given are: ", load_web, saved, clips[1:])
    shorter = replace(clips[0][1:], name=clips[0].name)
    refused(r"another 'walk_straight': 1158 frames then, 1157 now", load_web, saved, [shorter, *clips[1:]])
    higher = replace(clips[0], root_positions=clips[0].root_positions + 0.01)
    refused("another 'walk_straight': other poses", load_web, saved, [higher, *clips[1:]])


def test_a_web_of_the_clips_of_mocap_0_1_is_refused_by_that_name(bundled, saved, tmp_path):
    frames = np.array([FRAMES_IN_0_1.get(clip.name, len(clip)) for clip in bundled.clips])
    older = changed(saved, tmp_path / "older.npz", frames=frames)
    refused("built of the clips of mocap 0.1, .* Build it anew", load_web, older)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda arrays: {"version": np.array(9)}, "version 9, which a newer mocap wrote"),
        (lambda arrays: {"costs": None}, "one without costs"),
        (lambda arrays: {"costs": arrays["costs"][:-1]}, "'costs' to fit the other arrays"),
        (lambda arrays: {"cells": arrays["cells"].astype(float)}, "'cells' to fit the other arrays"),
        (lambda arrays: {"cells": arrays["cells"] + 10_000}, "that cells lie in clips"),
        (lambda arrays: {"cells": arrays["cells"] - 10_000}, "that cells lie in clips"),
        (lambda arrays: {"cells": arrays["cells"][:, ::-1]}, "that the earlier frame of a cell comes first"),
        (lambda arrays: {"cells": arrays["cells"][::-1]}, "that time never runs backwards"),
        (lambda arrays: {"lengths": arrays["lengths"][::-1]}, "that a path stays in its two clips"),
        (lambda arrays: {"offsets": arrays["offsets"][1:]}, "that paths begin with the first cell"),
        (lambda arrays: {"offsets": arrays["offsets"][:-1]}, "that paths end with the last cell"),
        (lambda arrays: {"offsets": np.repeat(arrays["offsets"], 2)}, "that no path is empty"),
        (lambda arrays: {"costs": -arrays["costs"]}, "that costs are distances"),
        (lambda arrays: {"costs": np.inf + arrays["costs"]}, "that costs are distances"),
        (lambda arrays: {"below": np.array(0.0)}, "that the limit of distances is above 0"),
        (lambda arrays: {"rate": np.array(60.0)}, "that a web compares 30 frames a second"),
        (lambda arrays: {"lengths": -arrays["lengths"]}, "that clips have lengths"),
    ],
)
def test_a_damaged_file_is_refused_with_what_is_wrong(bundled, saved, tmp_path, change, words):
    with np.load(saved) as archive:
        path = changed(saved, tmp_path / "bad.npz", **change(dict(archive)))
    refused(words, load_web, path, bundled.clips, kind=FormatError)


def test_lengths_that_are_not_those_of_the_clips_are_refused(bundled, saved, tmp_path):
    with np.load(saved) as archive:
        longer = archive["lengths"].copy()
    longer[-1] += 1
    path = changed(saved, tmp_path / "bad.npz", lengths=longer)
    refused("clips of .* frames", load_web, path, bundled.clips, kind=FormatError)


def test_a_file_that_is_cut_short_is_refused(saved, tmp_path):
    data = saved.read_bytes()
    for share in (0.0, 0.3, 0.999):
        (tmp_path / "cut.npz").write_bytes(data[: int(share * len(data))])
        refused("a damaged one", load_web, tmp_path / "cut.npz", kind=MocapError)
