"""The search by the bound finds what the search of all pairs finds, wherever the work is done."""

import os
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap import load, resample
from mocap._shared import tasks
from mocap.graphs.motion_graph import build
from mocap.matching import bounded_search, transitions
from mocap.matching.bounded_search import find_minima_by_bound, is_quicker
from mocap.matching.distance_grids import distance_grid
from mocap.matching.minima import local_minima
from mocap.matching.tiled_search import find_minima
from mocap.matching.transitions import find_transitions
from tests.matching.test_tiled_search import Late, clouds, equal
from tests.strategies import seeds, wave

CLIPS = [wave(70, name="a"), wave(50, phase=1.0, name="b", seed=1)]


def in_order(found):
    return found[:, np.lexsort(found[1::-1])]


def same(found, others, costs=1e-9):
    places = all(np.array_equal(a, b) for a, b in zip(found.columns[:4], others.columns[:4], strict=True))
    return places and np.allclose(found.cost, others.cost, atol=costs, rtol=0)


@settings(max_examples=30)
@given(seeds, st.lists(st.integers(4, 30), min_size=1, max_size=4), st.integers(1, 4), st.integers(3, 40))
@pytest.mark.parametrize("below", [0.3, 1.0, 3.0])
def test_blocks_do_not_show_and_the_minima_are_those_of_all_pairs(below, seed, lengths, window, block):
    whole = clouds(lengths, window, seed)
    expected = in_order(find_minima(whole, equal(window), below))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bounded_search, "BLOCK", block)
        patch.setattr(bounded_search, "ROWS", 5)
        patch.setattr(bounded_search, "AT_ONCE", 20)
        found = in_order(find_minima_by_bound(whole, equal(window), below))
    assert np.array_equal(found[:2], expected[:2])
    assert found[2:] == pytest.approx(expected[2:], abs=1e-6)


def both_ways(clips, **search):
    return [find_transitions(clips, method=method, **search) for method in ("products", "bound")]


@pytest.mark.parametrize("window", [1, 2, 8])
@pytest.mark.parametrize("below", [0.01, 0.1, np.inf])
def test_both_methods_give_the_same_transitions(window, below):
    every, few = both_ways(CLIPS, window=window, below=below)
    assert same(few, every) and len(every) > 0


@pytest.mark.parametrize("window", [1, 2, 8])
def test_in_32_bits_both_methods_differ_in_flat_valleys_only(window):
    every, few = both_ways(CLIPS, window=window, below=0.1, precision="single")
    places, others = (
        set(zip(*(c.tolist() for c in found.columns[:4]), strict=True)) for found in (every, few)
    )
    assert len(places & others) > 0.95 * max(len(places), len(others))
    assert few.cost.min() == pytest.approx(every.cost.min(), abs=1e-6)


def test_identical_clips_match_at_no_cost_on_both_ways():
    clips = [CLIPS[0], replace(CLIPS[0], name="again")]
    found = find_transitions(clips, window=8, below=0.01, method="bound")
    assert found.cost.min() < 1e-9 and np.any((found.source == 0) & (found.target == 1))


@pytest.mark.parametrize("method", ["products", "bound"])
def test_weights_of_joints_and_frames_are_those_of_the_grid(method):
    weights = {"joint_weights": [1, 0, 5, 2], "taper": [1, 2, 3, 4, 4, 3, 2, 0]}
    minima = local_minima(distance_grid(*CLIPS, window=8, **weights), 0.01).tolist()
    found = find_transitions(CLIPS, window=8, below=0.1, method=method, **weights)
    across = found[(found.source == 0) & (found.target == 1)]
    assert np.stack([across.leave, across.enter], 1).tolist() == minima
    grid = distance_grid(*CLIPS, window=8, **weights)
    assert across.cost == pytest.approx(np.sqrt(grid[across.leave, across.enter]), abs=1e-7)
    plain = find_transitions(CLIPS, window=8, below=0.1, method=method)
    assert not same(found, plain)


def test_thresholds_for_pairs_of_labels():
    marks = np.arange(70) < 35
    clips = [
        replace(CLIPS[0], labels={"walk": marks, "run": ~marks}),
        replace(CLIPS[1], labels={"walk": True}),
    ]
    below = {("walk", "walk"): 0.1, ("walk", "run"): 0.001, ("run", "walk"): 0.003}
    every, few = both_ways(clips, window=8, below=below)
    assert same(few, every) and len(few)


def test_the_bound_is_taken_for_many_windows_of_which_few_are_near(monkeypatch):
    whole = clouds([200], 2, 0)
    assert not is_quicker(whole, equal(2), 0.01)
    monkeypatch.setattr(bounded_search, "MANY", 100)
    assert not is_quicker(whole, equal(2), 0.3)  # each window is near itself: 1 pair in 200
    monkeypatch.setattr(bounded_search, "LOOSE", 0.02)
    assert is_quicker(whole, equal(2), 0.01)
    assert not is_quicker(whole, equal(2), 10.0)
    assert not is_quicker(whole, equal(2), np.inf)


def test_auto_asks_which_is_quicker(monkeypatch):
    ways = []
    for name in ("find_minima", "find_minima_by_bound"):
        way = getattr(transitions, name)
        monkeypatch.setattr(
            transitions, name, lambda *a, way=way, name=name, **k: ways.append(name) or way(*a, **k)
        )
    for quicker in (True, False):
        monkeypatch.setattr(transitions, "is_quicker", lambda *_, quicker=quicker: quicker)
        find_transitions(CLIPS, window=8, below=0.1)
    assert ways == ["find_minima_by_bound", "find_minima"]


def test_only_a_few_tasks_are_out_at_once_and_the_pairs_of_blocks_are_shown(monkeypatch):
    monkeypatch.setattr(bounded_search, "BLOCK", 10)
    monkeypatch.setattr(tasks, "AHEAD", 4)
    whole, executor, seen = clouds([30], 2, 0), Late(), []
    expected = find_minima_by_bound(whole, equal(2), 2.0)
    found = find_minima_by_bound(
        whole, equal(2), 2.0, executor=executor, progress=lambda pairs: seen.extend(pairs) or pairs
    )
    assert np.array_equal(found, expected)
    assert (executor.most, executor.done, executor.out) == (4, 6, 0)
    assert seen == [(0, 0), (0, 10), (0, 20), (10, 10), (10, 20), (20, 20)]


def test_an_interrupt_stops_the_search():
    class Interrupting(Executor):
        def submit(self, *task):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        find_transitions(CLIPS, window=8, below=0.1, method="bound", executor=Interrupting())


@pytest.mark.parametrize("workers", [1, 2, 3])
@pytest.mark.parametrize("executor", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_any_number_of_workers_gives_the_same_bit_for_bit(executor, workers, monkeypatch):
    monkeypatch.setattr(bounded_search, "BLOCK", 40)
    here = find_transitions(CLIPS, window=8, below=0.1, method="bound")
    with executor(workers) as pool:
        there = find_transitions(CLIPS, window=8, below=0.1, method="bound", executor=pool)
    assert all(np.array_equal(a, b) for a, b in zip(here.columns, there.columns, strict=True))


def test_a_cluster_gives_the_same(monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(bounded_search, "BLOCK", 40)
    here = find_transitions(CLIPS, window=8, below=0.1, method="bound")
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        assert os.getpid() not in client.run(os.getpid).values()
        there = find_transitions(CLIPS, window=8, below=0.1, method="bound", executor=client.get_executor())
    assert all(np.array_equal(a, b) for a, b in zip(here.columns, there.columns, strict=True))


def real_clips(real_data, pattern):
    takes = [load(path) for path in sorted((real_data / "cmu").glob(pattern))]
    takes = [replace(take, skeleton=takes[0].skeleton) for take in takes]
    return [resample(take, 30) for take in takes if len(take) > 60]


def assert_all_found(clips):
    for below in (0.02, 0.04, 0.06, 0.1):
        every, few = both_ways(clips, window=10, below=below, precision="double")
        assert same(few, every), below


def test_every_transition_of_some_real_clips_is_found(real_data):
    assert_all_found(real_clips(real_data, "16/16_[13][5-7].amc"))


@pytest.mark.exhaustive
def test_every_transition_of_all_real_clips_is_found(real_data):
    assert_all_found(real_clips(real_data, "*/*.amc"))


def test_building_a_graph_passes_all_parameters_on():
    search = {"joint_weights": [1, 0, 5, 2], "taper": [1, 2, 3, 4, 4, 3, 2, 0], "method": "bound"}
    graph = build(CLIPS, window=8, threshold=0.1, **search)
    assert graph.count("transition") == len(find_transitions(CLIPS, window=8, below=0.1, **search))
