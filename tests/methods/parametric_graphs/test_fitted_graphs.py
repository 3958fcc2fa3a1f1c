"""Graphs fitted to clips: ranges and T_GOOD that the examples allow, and what is missing otherwise."""

from dataclasses import replace

import numpy as np
import pytest

import mocap
from mocap import feet
from mocap.body import resample
from mocap.datasets import sample
from mocap.errors import MocapError, MocapWarning, NoWalk
from mocap.methods.match_webs.motion_spaces import MotionSpace
from mocap.methods.parametric_graphs import cut_actions, cut_strides, fit_strides, fitted_graphs, make_space
from mocap.methods.parametric_graphs.examples import LEAST_MARGIN
from mocap.methods.parametric_graphs.fitted_graphs import fit_parametric, pose_change
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from tests.bundled import clips
from tests.methods.parametric_graphs import built


def of_costs(monkeypatch, costs):
    """Fit one space of turns whose transitions cost what a function of source and target says, cm."""

    def transitions(source, target, sources, targets):
        return costs(np.degrees(sources), np.degrees(targets).T) / 100, None, None

    monkeypatch.setattr(fitted_graphs, "optimal_transitions", transitions)
    monkeypatch.setattr(fitted_graphs, "build_edge", lambda *_, **__: built.walking()["walk"]["walk"]["edge"])
    monkeypatch.setattr(fitted_graphs, "build_parametric", lambda spaces, *_, **__: spaces)
    return fit_parametric({"walk": built.space()}, [("walk", "walk")], worst=0.06)["walk"]


def ends(space):
    """Give the range of turns, degrees."""
    return np.degrees([space.low[0], space.high[0]])


def test_a_range_keeps_what_has_a_successor(monkeypatch):
    """Above 40° nothing follows, so a range of -75° to 75° ends there; its scale is half of what is kept."""
    with pytest.warns(MocapWarning, match="narrowed to turn -75° to"):
        space = of_costs(monkeypatch, lambda source, target: np.where(source > 40, 9.0, 3.0) + 0 * target)
    low, high = ends(space)
    assert low == pytest.approx(-75, abs=1)
    assert 36 <= high <= 40  # one of 50 sources is 3° from the next
    assert space.scale[0] == pytest.approx((space.high[0] - space.low[0]) / 2)


def test_a_source_whose_only_successors_are_cut_off_goes_as_well(monkeypatch):
    """Sources above 40° have none; those above 20° have only targets above 40°."""

    def costs(source, target):
        has_any = (source <= 20) | ((source <= 40) & (target > 40))
        return np.where(has_any, 3.0, 9.0)

    with pytest.warns(MocapWarning, match="narrowed"):
        assert 16 <= ends(of_costs(monkeypatch, costs))[1] <= 20


def test_a_poor_source_in_the_middle_does_not_cost_a_side(monkeypatch):
    """It costs 7 cm, a little over the 6 cm that are the largest."""
    space = of_costs(monkeypatch, lambda source, target: np.where(abs(source) < 3, 7.0, 3.0) + 0 * target)
    np.testing.assert_allclose(ends(space), [-75, 75], atol=1)


@pytest.mark.parametrize("kept", [0, 10])  # percent of the range
def test_what_has_no_successor_is_named(monkeypatch, kept):
    def costs(source, target):
        return np.where(source <= -75 + 1.5 * kept, 3.0, 9.0 + source / 100) + 0 * target

    with pytest.raises(NoWalk, match=r"follows 'walk' with turn 75° below .*add a clip that continues after"):
        of_costs(monkeypatch, costs)


def test_steps_are_fitted_and_walked():
    """Their boxes are those of the package's graph of steps."""
    graph = fit_strides([clips()[0]])
    assert set(graph.edges) == {("lr", "rl"), ("rl", "lr")}
    character = ParametricController(graph)
    poses = [character.step(0.3, 1.0) for _ in range(90)]
    assert len(character.chosen) >= 4
    assert all(np.isfinite(pose.root_position).all() for pose in poses)


def test_clips_that_go_straight_are_told_their_speed():
    walks = [resample(sample(f"walk_6m_{speed}_0"), 30) for speed in (0.7, 0.9, 1.15, 1.4)]
    graph = fit_strides(walks, feet=("lrl",), good=0.2)
    space = graph.nodes["lrl"]["space"]
    assert space.parameters == ("speed",)
    assert space.low[0] < 0.8
    assert space.high[0] > 1.3
    character = ParametricController(graph)
    for _ in range(150):
        character.step(0.0, 1.2)
    assert character.chosen[-1].reached[0] == pytest.approx(1.2, abs=0.02)


def test_clips_that_are_all_alike_are_refused_with_what_is_missing():
    walk = resample(sample("walk_straight"), 30)
    with pytest.raises(MocapError, match=r"too alike .*turns to the left and one to the right"):
        fit_strides([walk[: 5 * 30]], feet=("lrl",))


def test_shorter_margins_keep_strides_at_the_ends_of_a_clip():
    walk = clips()[3]
    strikes = 1 + np.flatnonzero(np.diff(walk.contacts["lfoot"].astype(int)) == 1)
    short = walk[strikes[1] - LEAST_MARGIN : strikes[2] + LEAST_MARGIN + 1]
    with pytest.raises(MocapError, match="No example"):
        cut_strides([short])
    kept = cut_strides([short], margin=None)
    assert len(kept) == 1
    np.testing.assert_allclose(kept.seconds[0, [0, -1]] * 30, [-9, strikes[2] - strikes[1] + 9])


def test_actions_need_as_little_room():
    walk = clips()[3]
    cut = [walk[100:161]] * 3
    with pytest.raises(MocapError, match="leave it more room"):
        cut_actions(cut, [(9, 51)] * 3)
    assert len(cut_actions(cut, [(9, 51)] * 3, margin=None)) == 3


def test_poses_change_in_proportion_to_the_time_and_the_pace():
    strides = built.strides()
    assert pose_change(strides, 0.2) == pytest.approx(3 * pose_change(strides, 0.2 / 3))
    hurried = replace(strides, seconds=strides.seconds / 2)
    assert pose_change(hurried) == pytest.approx(2 * pose_change(strides))


def test_a_space_of_several_numbers_is_fitted_too():
    space = built.of_hands()["punch"]
    graph = fit_parametric({"punch": space}, [("punch", "punch")], sampling=built.SMALL)
    assert isinstance(graph.nodes["punch"]["space"], MotionSpace)
    assert graph.nodes["punch"]["space"].parameters == space.parameters


@pytest.mark.parametrize("trials", [(5, 6, 7, 9, 10)])
def test_captured_jumps_make_a_graph(real_data, trials):
    """Their margins of 0.38 of a jump would exceed the clips."""
    folder = real_data / "cmu" / "16"
    jumps = [feet.mark_plants(mocap.resample(mocap.load(folder / f"16_{n:02}.amc"), 30)) for n in trials]
    spans = [(17, 63), (46, 91), (43, 93), (57, 105), (55, 104)]
    examples = cut_actions(jumps, spans, margin=None)
    values = examples.values.copy()
    space = make_space(replace(examples, values=values), 0.1, 0.0, 9.0, parameter="speed")
    with pytest.warns(MocapWarning):
        graph = fit_parametric({"jump": space}, [("jump", "jump")], sampling=built.SMALL)
    assert graph.has_edge("jump", "jump")
