"""A web holds sound paths, whatever its clips are."""

from dataclasses import replace

import numpy as np
import pytest

from mocap import datasets, resample
from mocap.body import Motion, PlanarTransform, Skeleton
from mocap.errors import SkeletonMismatch
from mocap.matching import distance_grid
from mocap.methods.match_webs import build_web, search
from mocap.methods.match_webs.webs import WINDOW
from tests.oracles import longest_run
from tests.refusals import refusals, told

SLOPE, NEAR = 2, 3


def cells_of_grid(web):
    """Count the pairs of windows that a web compares: those above the diagonal of all against all."""
    windows = (np.diff(web.starts) - WINDOW + 1).sum()
    return windows * (windows - 1) / 2


def check_paths(web):
    """Hold what each path of a web must be."""
    seen = set()
    for number in range(len(web)):  # of two clips, the best path comes first
        cells, costs = web.path(number)
        steps = np.diff(cells, axis=0)
        assert costs.mean() < web.below
        assert np.isin(steps, (0, 1)).all() and steps.any(axis=1).all()
        assert longest_run(cells) <= SLOPE
        clips = {tuple(web.clip_at(frame) for frame in cell) for cell in cells[[0, -1]]}
        assert len(clips) == 1 and next(iter(clips)) == tuple(sorted(next(iter(clips))))
        assert (cells[-1] - cells[0]).min() >= 9
        assert (cells[:, 0] < cells[:, 1]).all()
        assert sum(tuple(cell) in seen for cell in cells.tolist()) <= 0.5 * len(cells)
        seen.update((i, j + away) for i, j in cells.tolist() for away in range(-NEAR, NEAR + 1))


def test_the_web_of_the_bundled_clips_is_small_and_its_paths_are_sound(bundled):
    """As in [KG04, match web]."""
    web = bundled.web
    assert web.starts[-1] == 4182
    assert len(web.cells) <= 0.02 * cells_of_grid(web)
    assert web.cells.nbytes + web.costs.nbytes <= 0.05 * 4 * 2 * cells_of_grid(web)
    check_paths(web)


def test_the_costs_are_those_of_the_distance_grid(bundled, low):
    web = bundled.web
    number = next(n for n in range(len(web)) if web.clip_at(web.path(n)[0][0, 1]) == 2)
    cells, costs = web.path(number)
    first, second = (web.clip_at(frame) for frame in cells[0])
    grid = np.sqrt(distance_grid(low[first], low[second], window=5))
    rows, columns = (cells - web.starts[[first, second]] - 2).T  # a cell is the middle of two windows of 5
    assert np.allclose(grid[rows, columns], costs, atol=1e-4)


def test_a_moved_and_turned_clip_makes_the_same_web(bundled):
    walk = bundled.clips[0]
    far = PlanarTransform(2.5, 112.0, -40.0).apply_motion(walk)
    one, other = build_web([walk], below=0.05), build_web([far], below=0.05)
    assert len(one) == len(other)
    assert np.abs(one.costs.sum() - other.costs.sum()) < 1e-2


def test_a_bar_sees_all_pairs_and_changes_nothing(bundled):
    clips, seen = bundled.clips[:3], []

    def bar(pairs):
        seen.extend(pairs)
        return iter(pairs)

    theirs, ours = build_web(clips, below=0.06, progress=bar), build_web(clips, below=0.06)
    assert np.array_equal(ours.cells, theirs.cells) and len(seen) > 1


def test_a_planted_copy_is_found_at_its_own_pace():
    """A second of sneaking is played 1.25 times as fast inside a walk."""
    sneak, walk = datasets.sample("sneak"), datasets.sample("walk_straight")
    plant = resample(replace(sneak[1000:1240], fps=120 * 1.25), 120)
    roots = np.concatenate([walk.root_positions[:300], plant.root_positions, walk.root_positions[300:600]])
    turns = np.concatenate([walk.rotations[:300], plant.rotations, walk.rotations[300:600]])
    host = Motion(walk.skeleton, roots, turns, 120.0, "host")
    web = build_web([sneak[900:1400], host], below=0.03)
    found = search(web, 0, slice(100, 340), lengths=(0.5, 2))
    [match] = [match for match in found if match.clip == 1]
    assert abs(match.start - 300) <= 8 and abs(match.stop - (300 + len(plant))) <= 8
    assert np.polyfit(match.rows, match.frames, 1)[0] == pytest.approx(1 / 1.25, abs=0.05)


def test_no_path_runs_from_one_clip_into_the_next(bundled):
    parts = [bundled.clips[0][a : a + 120] for a in range(0, 600, 120)]
    web = build_web(parts, below=0.1)
    assert len(web) > 5
    for number in range(len(web)):
        cells, _ = web.path(number)
        assert all(len({web.clip_at(frame) for frame in side}) == 1 for side in cells.T)
        assert cells.max() < web.starts[-1]


def test_clips_too_short_for_a_path_are_left_out_with_a_warning(bundled):
    walk = bundled.clips[0]
    short = replace(walk[:40], name="blink")
    left_out = r"^Too short to hold a path of 0.47 s, and left out: 'blink', 'blink'\.$"
    web = told(left_out, build_web, [short, walk, short], below=0.05)
    alone = build_web([walk], below=0.05)
    assert np.array_equal(web.cells, alone.cells)
    assert {web.clip_at(frame) for frame in web.cells.ravel()} == {1}


def still(joints=1, frames=100, fps=30.0):
    names = [f"j{n}" for n in range(joints)]
    skeleton = Skeleton(names, [-1, *range(joints - 1)], np.tile([0, 0.1, 0], (joints, 1)))
    return Motion(skeleton, np.zeros((frames, 3)), np.tile([1.0, 0, 0, 0], (frames, joints, 1)), fps, "still")


test_hostile_input_is_one_sentence = refusals(
    ("one clip or more, got none", build_web, []),
    (SkeletonMismatch, "joints", build_web, [still(), still(2)]),
    ("resample one first", build_web, [still(), still(fps=60.0)]),
    ("No clip is long enough for a path: that takes 0.47 s", build_web, [still(frames=5)]),
)


def test_a_web_says_what_it_holds_and_is_not_to_be_changed(bundled):
    assert repr(bundled.web) == f"MatchWeb(5 clips, {len(bundled.web)} paths, below 8 cm)"
    with pytest.raises(ValueError, match="read-only"):
        bundled.web.cells[0] = 0
