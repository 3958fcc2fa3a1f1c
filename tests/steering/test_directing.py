"""Directed walks stand, wait, turn and arrive as they are told, or say why not; discs are not entered."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap import graphs
from mocap.body import resample
from mocap.datasets import sample
from mocap.errors import MocapWarning
from mocap.files import DirectedPoint, Direction
from mocap.steering import direct, with_standing
from mocap.steering.anchoring import Anchor, fit_to_anchors, headings_in, rotate_at_ends
from mocap.steering.detours import along_line, around_discs
from mocap.steering.direction_legs import line_with_headings
from mocap.steering.direction_search import least_sums
from mocap.steering.waiting import Hold, Standing, held_frames, shortest_waits
from mocap.synthesis.walk_to_motion import require_walk
from tests.refusals import refused

NAMES = ("stop_and_go", "walk_straight", "walk_curve_1")
P = DirectedPoint


@pytest.fixture(scope="module")
def standing():
    clips = [resample(sample(name), 30) for name in NAMES]
    return with_standing(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))


def speed(motion, frame):
    steps = np.diff(motion.root_positions[:, [0, 2]], axis=0)
    return float(np.hypot(*steps[frame])) * motion.fps


def standing_around(motion, frame):
    steps = np.hypot(*np.diff(motion.root_positions[:, [0, 2]], axis=0).T) * motion.fps
    moving = np.flatnonzero(steps > 0.2)
    after = moving.searchsorted(frame)
    return moving[after - 1] + 1, moving[after]


@pytest.mark.parametrize("facing", [0.0, math.pi / 2, -2.5])
def test_a_walk_starts_and_ends_standing_where_and_as_it_is_told(standing, facing):
    asked = Direction([P(1, 0), P(1, 5)], start="stand", end="stand", facing=facing)
    walked = direct(standing, asked)
    require_walk(walked.graph, walked.walk)
    motion = walked.motion()
    assert np.hypot(*(motion.root_positions[-1, [0, 2]] - (1, 5))) < 0.1
    assert abs(math.remainder(headings_in(motion)[-1] - facing, math.tau)) < math.radians(10)
    assert speed(motion, 0) < 0.2 and speed(motion, -1) < 0.2


def test_a_wait_lasts_as_long_as_asked_and_the_body_turns_before_it(standing):
    walked = direct(standing, Direction([P(0, 0), P(0, 4, heading=1.0, wait=2.0), P(3, 4)], end="stand"))
    motion = walked.motion()
    start, stop = standing_around(motion, walked.passes[1])
    assert abs((stop - start) / motion.fps - 2.0) < 0.3
    still = motion.root_positions[start:stop, [0, 2]]
    assert np.hypot(*(still - (0, 4)).T).max() < 0.15
    assert np.abs(headings_in(motion)[start + 6 : stop - 6] - 1.0).max() < 0.2
    assert np.hypot(*(motion.root_positions[-1, [0, 2]] - (3, 4))) < 0.1


def test_a_walk_arrives_in_time_by_standing_longer_and_says_so_if_it_cannot(standing):
    later = Direction([P(0, 0), P(0, 5, t=11.0)], start="stand", end="stand")
    assert abs(direct(standing, later).arrivals[-1].late) < 0.3
    with pytest.warns(MocapWarning, match="later than asked at point 2 .* no clips walk so fast"):
        direct(standing, Direction([P(0, 0), P(0, 5, t=2.0)], start="stand", end="stand"))


def test_several_times_are_kept_by_waiting_first_and_each_wait_is_a_walk(standing):
    asked = [P(0, 0, t=0), P(0, 4, t=6), P(4, 5, t=11)]
    walked = direct(standing, Direction(asked, start="stand", end="stand"))
    require_walk(walked.graph, walked.walk)
    assert [abs(arrival.late) < 0.3 for arrival in walked.arrivals[1:]] == [True, True]
    assert speed(walked.motion(), 30) < 0.2  # the four metres take 4 s


def test_times_that_no_pace_keeps_leave_the_walk_as_it_is_without_times(standing):
    ends = {"start": "stand", "end": "stand"}
    with pytest.warns(MocapWarning, match="no clips walk so fast"):
        hurried = direct(standing, Direction([P(0, 0), P(3, 6, t=2)], **ends))
    assert len(hurried.raw) < 1.1 * len(direct(standing, Direction([P(0, 0), P(3, 6)], **ends)).raw)
    assert max(part.metres for part in hurried.corrections) < 0.5


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3), st.integers(1, 9), st.integers(0, 5))))
def test_shortest_waits_are_walks_and_no_edge_shortens_or_smooths_them(listed):
    edges = {}
    for key, (start, end, frames, price) in enumerate(listed):
        edge = ((0, start), (0, end), key)
        edges.setdefault((0, start), []).append(Standing(edge, (0, end), frames, float(price)))
    steps = {step.edge: step for leaving in edges.values() for step in leaving}
    shortest = shortest_waits(edges, (0, 0))
    smoothest = shortest_waits(edges, (0, 0), smoothest=True)
    prices = {node: sum(steps[edge].price for edge in wait.edges) for node, wait in smoothest.items()}
    for node, wait in shortest.items():
        assert [(0, 0), *(end for _, end, _ in wait.edges)][-1] == node
        assert sum(steps[edge].frames for edge in wait.edges) == wait.frames
        for step in edges.get(node, ()):
            assert shortest[step.node].frames <= wait.frames + step.frames
            assert prices[step.node] <= prices[node] + step.price


@given(st.integers(1, 30), st.integers(0, 20), st.integers(0, 20), st.integers(1, 200))
def test_held_frames_stay_where_the_body_stands_and_go_no_faster_than_the_motion(frame, back, ahead, added):
    back = min(back, frame)
    held = held_frames(60, [Hold(frame, back, ahead, added)])
    assert len(held) == 60 + added
    part = held[frame : frame + added + 1]
    assert part[0] == part[-1] == frame
    assert part.min() >= frame - back - 1e-9 and part.max() <= frame + ahead + 1e-9
    assert np.abs(np.diff(part)).max() < 1 + 1e-9


def test_a_wait_is_held_where_clips_stand_for_a_shorter_time(standing):
    walked = direct(standing, Direction([P(0, 0), P(0, 4, wait=9.0), P(3, 4)], end="stand"))
    require_walk(walked.graph, walked.walk)
    assert walked.held_seconds > 5 and "held" in walked.report()
    motion = walked.motion()
    start, stop = standing_around(motion, walked.passes[1])
    assert abs((stop - start) / motion.fps - 9.0) < 0.3
    assert abs(walked.arrivals[1].waited - 9.0) < 0.3


def test_a_wait_that_is_shorter_than_clips_stand_is_said(standing):
    with pytest.warns(MocapWarning, match=r"A wait of 0.2 s lasts .* the clips there stand so long"):
        direct(standing, Direction([P(0, 0), P(0, 4, wait=0.2), P(3, 4)], end="stand"))


def test_points_and_headings_in_stride_are_met_by_all_of_the_walk(standing):
    asked = [P(0, 0), P(0, 3, heading=0.4), P(1.5, 5, heading=math.pi / 2), P(4.5, 5)]
    walked = direct(standing, Direction(asked, start="stand", end="stand"))
    for arrival in walked.arrivals[1:3]:
        assert arrival.off < 0.02 and abs(arrival.turned) < math.radians(2)
    motion = walked.motion()
    assert abs(headings_in(motion)[walked.passes[2]] - math.pi / 2) < math.radians(3)


def test_a_later_time_is_kept_by_starting_later_and_the_wait_stays_as_asked(standing):
    asked = [P(0, 0), P(0, 5, wait=2.0), P(3.5, 5, t=16.0)]
    walked = direct(standing, Direction(asked, start="stand", end="stand"))
    assert abs(walked.arrivals[-1].late) < 0.1
    assert abs(walked.arrivals[1].waited - 2.0) < 0.3
    assert speed(walked.motion(), 30) < 0.2  # it does not start at once


def test_a_walk_goes_around_discs_which_its_root_does_not_enter(standing):
    discs = [(0.1, 3, 0.6), (1.0, 6, 0.5)]
    walked = direct(standing, Direction([P(0, 0), P(0, 9)], end="stand", around=discs))
    ground = walked.motion().root_positions[:, [0, 2]]
    for x, z, radius in discs:
        assert np.hypot(*(ground - (x, z)).T).min() > radius
    assert walked.arrivals[-1].off < 0.1


def test_clips_that_never_stand_and_places_inside_discs_are_refused():
    clips = [resample(sample("walk_straight"), 30)]
    walking = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    line = [P(0, 0), P(0, 3)]
    refused(
        "no clip of the graph stands still for 0.4 s: add a clip that stops",
        direct,
        walking,
        Direction(line, end="stand"),
    )
    discs = Direction(line, around=[(0, 3, 0.5)])
    refused("ends at x = 0.00, z = 3.00, which is inside a disc", direct, walking, discs)
    one_place = Direction([P(0, 0, t=0), P(0, 0, t=3)])
    refused("All points of the direction are in one place", direct, walking, one_place)


def test_a_line_without_wishes_is_followed_as_before(standing):
    walked = direct(standing, [P(0, 0), P(0, 6)])
    ground = walked.fitted.root_positions[:, [0, 2]]
    assert np.abs(ground[:, 0]).max() < 0.15 and walked.arrivals[-1].off < 0.3


def test_the_label_stand_overrules_the_pace():
    clip = resample(sample("walk_straight"), 30)
    mark = np.arange(len(clip)) < 30
    graph = graphs.from_transitions([replace(clip, labels={"stand": mark})], [], window=10)
    assert {frame for _, frame in with_standing(graph).nodes} == {*range(0, 31, 3)}


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.2, 1.0), st.floats(0.05, 0.7))
def test_lines_stay_out_of_a_disc_and_keep_their_ends(x, z, radius, clearance):
    ends = np.array([-5 + 0j, 5 + 0j])
    line = around_discs(ends, [(complex(z, x), radius)], clearance)
    assert (line[[0, -1]] == ends).all()
    fine = np.interp(
        np.linspace(0, 1, 999) * along_line(line)[-1], along_line(line), line.real
    ) + 1j * np.interp(np.linspace(0, 1, 999) * along_line(line)[-1], along_line(line), line.imag)
    assert np.abs(fine - complex(z, x)).min() > radius


def test_discs_that_leave_no_room_are_passed_together_and_a_closed_bay_is_refused():
    row = [(complex(0, x), 0.5) for x in (-0.6, 0.6)]
    line = around_discs(np.array([-4 + 0j, 4 + 0j]), row, 0.4)
    assert np.abs(line.imag).max() > 1.3
    ring = [(1.2 * np.exp(1j * angle), 0.5) for angle in np.arange(0, 6, 0.7)]
    refused("No way leads to", around_discs, np.array([-4 + 0j, 0j]), ring, 0.4)


def test_anchors_are_met_and_a_body_that_stands_stays():
    clip = resample(sample("stop_and_go"), 30)
    start = complex(clip.root_positions[0, 2], clip.root_positions[0, 0])
    anchors = [Anchor(0, start, 0.0), Anchor(250, start + 5 + 1j, 0.3)]
    fitted = fit_to_anchors(clip[:251], anchors)
    place = fitted.root_positions[-1]
    assert abs(complex(place[2], place[0]) - anchors[1].position) < 1e-9
    assert abs(headings_in(fitted)[-1] - 0.3) < 1e-9
    assert np.abs(np.diff(fitted.root_positions[:50], axis=0)).max() < 0.003


def test_turns_at_ends_are_no_faster_than_people_turn_if_there_is_time():
    clip = resample(sample("walk_straight"), 30)
    turn = headings_in(rotate_at_ends(clip, -1.5, 2.0)) - headings_in(clip)
    assert np.abs(np.diff(np.unwrap(turn))).max() * clip.fps < math.radians(101)
    assert abs(turn[0] + 1.5) < 1e-9 and abs(turn[-1] - 2.0) < 1e-9


def test_the_shortest_sums_are_those_of_trying_all_ways(standing):
    graph = standing.compiled
    ends = np.array([node in standing.arriving for node in graph.nodes])
    sums = least_sums(graph, graph.macro_edges.frames.astype(float), ends)
    source = np.repeat(np.arange(len(graph.nodes)), np.diff(graph.macro_edges.first))
    target = graph.target[graph.macro_edges.last]
    assert (sums[source] <= graph.macro_edges.frames + sums[target]).all() and (sums[ends] == 0).all()


def test_waits_backwards_are_walks_that_lead_to_the_node():
    backwards = {(0, 9): [Standing(((0, 0), (0, 9), 0), (0, 0), 9, 0.0)]}
    wait = shortest_waits(backwards, (0, 9))[0, 0]
    assert (wait.edges, wait.frames) == ([((0, 0), (0, 9), 0)], 9)


def test_a_body_that_hardly_moves_is_turned_without_a_division_by_zero():
    clip = resample(sample("stop_and_go"), 30)[:40]
    roots = clip.root_positions.copy()
    roots[-1] += (0, 0, 0.05)  # only the last frame moves
    assert np.isfinite(rotate_at_ends(replace(clip, root_positions=roots), 0.0, 1.0).rotations).all()


def test_lines_pass_points_in_the_direction_of_their_headings():
    points = [P(0, 0), P(0, 2, heading=0.5), P(2, 4)]
    line = line_with_headings(points)
    place = line.index(P(0.0, 2.0))
    before, after = line[place - 1], line[place + 1]
    for step in ((0 - before.x, 2 - before.z), (after.x, after.z - 2)):
        assert abs(math.atan2(*step) - 0.5) < 0.15
    sideways = [P(0, 0), P(0, 2, heading=1.6), P(0, 4)]
    assert line_with_headings(sideways) == sideways
