"""Transitions against what they promise, and minima against the whole grid's, wherever the work is done."""

import os
import signal
import threading
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap import datasets, resample
from mocap._shared import tasks
from mocap.body import Motion, Skeleton
from mocap.errors import SkeletonMismatch
from mocap.graphs.motion_graph import build
from mocap.matching import distance_grids, minima, near_pairs, transitions
from mocap.matching.distance_grids import cloud_distances, distance_grid
from mocap.matching.minima import find_minima, local_minima
from mocap.matching.prepared_clouds import cloud, join
from mocap.matching.transitions import find_transitions, join_clouds
from tests.bundled import walks_of_16
from tests.refusals import refusals
from tests.strategies import random_motion, seeds, wave
from tests.tuning import tune

CLIPS = [wave(70, name="a"), wave(50, phase=1.0, name="b", seed=1)]


@pytest.mark.parametrize("window", [1, 2, 8])
def test_transitions_are_the_minima_of_every_pair_both_ways(window):
    """As in [KGP02, 3.2]."""
    found = find_transitions(CLIPS, window=window, below=0.1)
    for a, b in ((0, 0), (0, 1), (1, 1)):
        minima = local_minima(distance_grid(CLIPS[a], CLIPS[b], window=window), 0.01)
        wanted = [[i, j] for i, j in minima.tolist() if a != b or j - i >= window]
        ways = [[t.leave, t.enter] for t in found if (t.source, t.target) == (a, b)]
        assert [[i, j] for i, j in ways if a != b or j > i] == wanted != []
    there = {(t.source, t.leave, t.target, t.enter): t for t in found}
    for (a, i, b, j), t in there.items():
        assert there[b, j, a, i].cost == t.cost


WALKS = [replace(clip, labels={"walk": True}) for clip in CLIPS]
FAR = replace(CLIPS[1], root_positions=CLIPS[1].root_positions + 1e6)


def search(clips, below, **options):
    return find_transitions(clips, window=8, below=below, **options)


test_what_has_no_transitions_is_refused = refusals(
    (r"A threshold is above 0 m, got 0 m\.$", search, CLIPS, 0),
    (r"got nan m\.$", search, CLIPS, np.nan),
    ("No clip has the label 'run'; there are: walk", search, WALKS, {("walk", "run"): 0.1}),
    (r"above 0 m, got -1 m for \('walk', 'walk'\)", search, WALKS, {("walk", "walk"): -1}),
    ("no threshold", search, WALKS, {}),
    ("'wave' has 7 frames, too few for a window of 8", search, [*CLIPS, wave(7)], 0.1),
    (SkeletonMismatch, "joint", search, [CLIPS[0], random_motion(0, frames=20)], 0.1),
    ("resample one first", search, [CLIPS[0], replace(CLIPS[1], fps=60.0)], 0.1),
    (r"within 1e[+]06 m; 'b' holds", search, [CLIPS[0], FAR], 0.1),
    ("Weights must be 8 numbers", partial(search, taper=np.ones(7)), CLIPS, 0.1),
    ("jobs is a whole number of threads, at least 1, or None", partial(search, jobs=0), CLIPS, 0.1),
    ("or None for all cores, got 1.5", partial(search, jobs=1.5), CLIPS, 0.1),
    ("or None for all cores, got 0", partial(distance_grid, window=8, jobs=0), *CLIPS),
)


def test_a_clip_of_one_window_passes_into_others_only():
    found = find_transitions([wave(8, name="short"), *CLIPS], window=8, below=0.1)
    assert 0 in found.source and not np.any((found.source == 0) & (found.target == 0))
    alone = find_transitions([wave(8)], window=8, below=0.1)
    assert len(alone) == 0


def same(found, others):
    return all(np.array_equal(a, b) for a, b in zip(found.columns, others.columns, strict=True))


def test_transitions_are_a_sequence_of_records():
    found = find_transitions(CLIPS, window=8, below=0.1)
    records = list(found)
    assert len(records) == len(found) > 10
    assert [t[:4] for t in records] == sorted(t[:4] for t in records)
    assert records == [found[n] for n in range(len(found))]
    assert found[-1] == records[-1]
    assert found[np.int64(3)] == records[3]
    assert list(found[3:9]) == records[3:9]
    cheap = found[found.cost < 0.002]
    assert list(cheap) == [t for t in records if t.cost < 0.002]
    assert list(found[[4, 2]]) == [records[4], records[2]]
    assert all(type(n) is int for n in records[0][:4])
    assert all(type(n) is float for n in (records[0].cost, *records[0].transform))
    low, high = 100 * found.cost.min(), 100 * found.cost.max()
    assert repr(found) == f"Transitions({len(found)}, from {low:.1f} to {high:.1f} cm)"
    with pytest.raises(IndexError):
        found[len(found)]


def test_few_frames_are_compared_in_64_bits_and_many_in_32(monkeypatch):
    used = []
    joined = lambda *given, **options: used.append(given[-1]) or join_clouds(*given, **options)  # noqa: E731
    monkeypatch.setattr(transitions, "join_clouds", joined)
    for few in (120, 119):  # the clips have 120
        tune(monkeypatch, transitions, few_frames=few)
        find_transitions(CLIPS, window=8, below=0.1)
    assert used == [np.float64, np.float32]


def test_how_high_the_clips_are_does_not_matter():
    """Heights are measured from those of the first clip, so no digits are lost."""
    up = np.array([0, 1e4, 0])
    high = [replace(clip, root_positions=clip.root_positions + up) for clip in CLIPS]
    near, away = (find_transitions(clips, window=8, below=0.1) for clips in (CLIPS, high))
    assert np.array_equal(near.enter, away.enter) and np.array_equal(near.leave, away.leave)
    assert near.cost == pytest.approx(away.cost, abs=1e-9)


def test_a_threshold_for_every_pair_of_labels():
    """As in [KGP02, thresholds]."""
    marks = np.arange(70) < 35
    a = replace(CLIPS[0], labels={"walk": marks, "run": ~marks})
    clips = [a, replace(CLIPS[1], labels={"walk": True})]
    both = {("walk", "walk"): 0.1, ("walk", "run"): 0.001, ("run", "walk"): 0.003}
    one = {("walk", "walk"): 0.1, ("run", "walk"): 0.003}  # which then counts for both ways
    for below in (both, one):
        require_thresholds(clips, below)


def require_thresholds(clips, below):
    found = find_transitions(clips, window=8, below=below)
    loosest = find_transitions(clips, window=8, below=0.1)
    kept = []
    for t in loosest:
        here, there = (
            {label for label, mark in clips[clip].labels.items() if mark[first : first + 8].any()}
            for clip, first in ((t.source, t.leave), (t.target, t.enter))
        )
        limits = [below.get((a, b), below.get((b, a), np.inf)) for a in here for b in there]
        limits = [limit for limit in limits if limit < np.inf]
        kept += [t] if limits and t.cost < min(limits) else []
    assert list(found) == kept and 0 < len(kept) < len(loosest)


def test_a_cost_is_below_its_threshold():
    dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    heights = np.array([1.0, 2.0, 3.0, 1.5])  # the last one is 0.5 m above the first
    still = np.tile([1.0, 0, 0, 0], (4, 1, 1))
    clip = Motion(dot, heights[:, None] * [0, 1, 0], still, 30.0, "a", {"up": True})
    for below, count in ((0.5, 0), (0.5 + 1e-9, 2)):
        assert len(find_transitions([clip], window=1, below=below)) == count
        other = replace(clip, labels={"on": True}, name="b")
        pairs = {("up", "up"): below, ("on", "on"): np.inf}
        found = find_transitions([clip, other], window=1, below=pairs)
        assert np.count_nonzero((found.source == 0) & (found.target == 0)) == count


@pytest.mark.sweep
def test_a_cluster_gives_the_same_and_survives_the_loss_of_a_worker(monkeypatch, tmp_path):
    distributed = pytest.importorskip("distributed")
    tune(monkeypatch, minima, block=40)
    monkeypatch.setattr(tasks, "AHEAD", 2)
    expected = find_transitions(CLIPS, window=8, below=0.1)
    options = {"dashboard_address": None, "local_directory": str(tmp_path)}
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, **options)
    with cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        assert len(set(pids)) == 2
        there = find_transitions(CLIPS, window=8, below=0.1, executor=client.get_executor())
        assert same(there, expected)

        def killing(pairs):
            for number, pair in enumerate(pairs):
                if number == 3:  # in the middle of the work
                    os.kill(pids[0], signal.SIGKILL)
                yield pair

        executor = client.get_executor(retries=3)
        found = find_transitions(CLIPS, window=8, below=0.1, progress=killing, executor=executor)
        assert same(found, expected)
        assert pids[0] not in client.run(os.getpid).values()


def smooth_points(seed, frames):
    """Points on waves, with many minima in their grid."""
    random = np.random.default_rng(seed)
    t = np.arange(frames)[:, None, None] / random.uniform(2, 6, (1, 4, 3))
    return np.sin(t + random.uniform(0, 6, (4, 3))) + random.normal(size=(frames, 4, 3)) * 0.01


EQUAL = np.full(4, 0.25)


def clouds(lengths, window, seed):
    parts = [
        cloud(smooth_points(seed + n, length), np.zeros(4), EQUAL, window, np.float32)
        for n, length in enumerate(lengths)
    ]
    return join(parts)


def by_bound(patch, block, sparse=np.inf, leaf=5):
    """Search by the bound, in blocks of this size of which all are sparse enough, or only some."""
    tune(patch, minima, few_windows=0)
    tune(patch, minima, wide_block=block)
    tune(patch, minima, sparse=sparse)
    patch.setattr(minima, "is_sparse", lambda *_: True)
    tune(patch, near_pairs, leaf=leaf)


@given(
    st.sampled_from([0.3, 1.0, 3.0]),
    seeds,
    st.lists(st.integers(4, 30), min_size=1, max_size=4),
    st.integers(1, 4),
    st.integers(3, 40),
    st.sampled_from(["by products", "by the bound", "some blocks by the bound"]),
)
def test_blocks_and_tiles_do_not_show(below, seed, lengths, window, block, way):
    """Minima at every border are found once, whichever way the grid is cut and searched."""
    whole = clouds(lengths, window, seed)
    count = sum(lengths) - window + 1
    grid = cloud_distances(*[whole.part(slice(0, count))] * 2)
    expected = [[i, j] for i, j in local_minima(grid, below**2).tolist() if j - i >= window]
    with pytest.MonkeyPatch.context() as patch:
        tune(patch, minima, block=block if way == "by products" else 4)
        tune(patch, distance_grids, tile=(5, 7))
        if way != "by products":
            by_bound(patch, block, 0.2 if way == "some blocks by the bound" else np.inf)
        found = find_minima(whole, below)
    order = np.lexsort(found[1::-1])
    i, j = found[:2].astype(int)
    assert np.stack([i, j], 1)[order].tolist() == expected
    assert found[2] == pytest.approx(np.sqrt(grid[i, j]), abs=2e-3)
    assert found[2] ** 2 == pytest.approx(grid[i, j], abs=1e-6)


def test_clips_without_a_whole_window_have_no_minima():
    short = clouds([3], 3, 0)
    short.sizes[:] = np.inf
    assert find_minima(short, 1.0).shape == (6, 0)


class Late:
    """An executor that does nothing before its results are asked for; it counts what is out."""

    def __init__(self):
        self.out = self.most = self.done = 0

    def submit(self, work, *arguments):
        self.out += 1
        self.most = max(self.most, self.out)
        future = Future()

        def result(timeout=None):
            self.out, self.done = self.out - 1, self.done + 1
            return work(*arguments)

        future.result = result
        return future


def test_only_a_few_blocks_are_out_at_once_and_they_are_shown(monkeypatch):
    tune(monkeypatch, minima, block=10)
    monkeypatch.setattr(tasks, "AHEAD", 4)
    whole, executor, seen = clouds([30], 2, 0), Late(), []
    expected = find_minima(whole, 2.0)
    shown = {"progress": lambda pairs: seen.extend(pairs) or pairs}
    found = find_minima(whole, 2.0, executor=executor, **shown)
    assert expected.shape[1] > 3
    assert np.array_equal(found, expected)
    assert (executor.most, executor.done, executor.out) == (4, 6, 0)
    assert seen == [(0, 0), (0, 10), (0, 20), (10, 10), (10, 20), (20, 20)]


def test_weights_of_joints_are_those_of_the_grid():
    weights = {"joint_weights": [1, 0, 5, 2]}
    grid = distance_grid(*CLIPS, window=8, **weights)
    found = find_transitions(CLIPS, window=8, below=0.1, **weights)
    across = found[(found.source == 0) & (found.target == 1)]
    assert np.stack([across.leave, across.enter], 1).tolist() == local_minima(grid, 0.01).tolist()
    assert across.cost == pytest.approx(np.sqrt(grid[across.leave, across.enter]), abs=1e-7)
    assert not np.array_equal(found.leave, find_transitions(CLIPS, window=8, below=0.1).leave)
    graph = build(CLIPS, window=8, threshold=0.1, **weights)  # passes all parameters on
    assert graph.count("transition") == len(found)


def costs(found):
    rows = zip(*(column.tolist() for column in found.columns[:4]), strict=True)
    return dict(zip(rows, found.cost.tolist(), strict=True))


@pytest.mark.parametrize("block", [30, 1000])
def test_a_taper_is_that_of_the_grid_in_both_searches(block, monkeypatch):
    taper = {"taper": [1, 2, 3, 4, 4, 3, 2, 1]}
    grid = distance_grid(*CLIPS, window=8, **taper)
    expected = local_minima(grid, 0.01).tolist()
    found = find_transitions(CLIPS, window=8, below=0.1, **taper)
    by_bound(monkeypatch, block)
    again = find_transitions(CLIPS, window=8, below=0.1, **taper)
    assert costs(found).keys() == costs(again).keys()
    for each in (found, again):
        across = each[(each.source == 0) & (each.target == 1)]
        assert np.stack([across.leave, across.enter], 1).tolist() == expected
        assert across.cost == pytest.approx(np.sqrt(grid[across.leave, across.enter]), abs=1e-7)
    assert costs(found).keys() != costs(find_transitions(CLIPS, window=8, below=0.1)).keys()
    graph = build(CLIPS, window=8, threshold=0.1, **taper)
    assert graph.count("transition") == len(found)


@given(
    seeds,
    st.lists(st.integers(8, 60), min_size=1, max_size=4),
    st.sampled_from([0.05, 0.3, 1.0]),
    st.booleans(),
    st.integers(9, 80),
)
def test_the_bound_finds_the_transitions_of_all_pairs(seed, lengths, below, weighted, block):
    """Of motions that swing, and that change at random: with weights and with labels, too."""
    clips = [wave(length, phase=n, name=str(n), seed=seed + n) for n, length in enumerate(lengths)]
    clips = [replace(clip, labels={"even": np.arange(len(clip)) % 2 == 0, "all": True}) for clip in clips]
    random = np.random.default_rng(seed)
    options = {"window": 8, "below": {("all", "all"): below, ("even", "all"): below / 2}}
    if weighted:
        options |= {"joint_weights": random.random(4) + 0.1, "taper": random.random(8) + 0.1}
    expected = costs(find_transitions(clips, **options))
    with pytest.MonkeyPatch.context() as patch:
        by_bound(patch, block)
        found = costs(find_transitions(clips, **options))
    assert found.keys() == expected.keys()
    assert list(found.values()) == pytest.approx(list(expected.values()), abs=1e-12)


@pytest.mark.parametrize("below", [0.02, 0.1])
def test_the_bound_finds_the_transitions_of_the_bundled_clips(below, monkeypatch):
    clips = [resample(datasets.sample(name), 30) for name in ("walk_curve_1", "walk_circle", "sneak")]
    expected = costs(find_transitions(clips, window=10, below=below))
    by_bound(monkeypatch, 500, leaf=100)
    found = costs(find_transitions(clips, window=10, below=below))
    assert found.keys() == expected.keys() and len(found) > 10
    assert list(found.values()) == pytest.approx(list(expected.values()), abs=1e-12)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_bound_finds_the_transitions_of_captured_clips(real_data, dtype, monkeypatch):
    clips = walks_of_16(real_data)[:8]
    tune(monkeypatch, transitions, few_frames=0 if dtype == np.float32 else 10**9)
    expected = costs(find_transitions(clips, window=10, below=0.06))
    by_bound(monkeypatch, 1000, leaf=100)
    found = costs(find_transitions(clips, window=10, below=0.06))
    same_pairs = found.keys() & expected.keys()
    # In 32 bits flat valleys may have their minimum a few frames further: few of a thousand.
    allowed = 0 if dtype == np.float64 else 0.01 * len(expected)
    assert len(found.keys() ^ expected.keys()) <= allowed and len(expected) > 200
    assert max(abs(found[pair] - expected[pair]) for pair in same_pairs) < 1e-6


def test_the_bound_is_taken_for_many_windows_of_which_few_pairs_are_near(monkeypatch):
    bounds = []

    def choose(*given):
        bounds.append(choose_bound(*given) is not None)
        return

    choose_bound = minima._choose_bound
    monkeypatch.setattr(minima, "_choose_bound", choose)
    clips = [wave(300, name="a", period=90)]
    for few, below in ((5000, 0.01), (200, 0.01), (200, 1.0), (200, np.inf)):
        tune(monkeypatch, minima, few_windows=few)
        find_transitions(clips, window=8, below=below)
    assert bounds == [False, True, False, False]


def test_stopped_by_ctrl_c_no_thread_works_on(monkeypatch):
    tune(monkeypatch, minima, block=10)
    before = threading.active_count()
    seen = []

    def interrupted(pairs):
        for number, pair in enumerate(pairs):
            if number == 5:
                raise KeyboardInterrupt
            seen.append(pair)
            yield pair

    with pytest.raises(KeyboardInterrupt):
        find_transitions(CLIPS, window=8, below=0.1, jobs=3, progress=interrupted)
    assert len(seen) == 5 and threading.active_count() == before


@pytest.mark.parametrize(
    ("executor", "workers"),
    [(ThreadPoolExecutor, 3), pytest.param(ProcessPoolExecutor, 2, marks=pytest.mark.sweep)],
)
@pytest.mark.parametrize("is_bound", [False, True])
def test_any_number_of_workers_gives_the_same_bit_for_bit(executor, workers, is_bound, monkeypatch):
    tune(monkeypatch, minima, block=40)
    if is_bound:
        by_bound(monkeypatch, 40)
    here = find_transitions(CLIPS, window=8, below=0.1, jobs=1)
    for jobs in (None, 2, 5):
        assert same(here, find_transitions(CLIPS, window=8, below=0.1, jobs=jobs))
    with executor(workers) as pool:
        there = find_transitions(CLIPS, window=8, below=0.1, executor=pool)
    assert same(here, there)
