"""Spaces and graphs that several tests walk with."""

from dataclasses import replace
from functools import cache, partial
from itertools import permutations
from typing import NamedTuple

import numpy as np

from mocap.body import Motion, concatenate, joint_positions, resample, rotations
from mocap.datasets import samples
from mocap.methods.match_webs import hand_target, heading_change, mean_speed, sample_space, weights_for
from mocap.methods.match_webs.motion_spaces import random_weights
from mocap.methods.parametric_graphs import build_parametric, cut_actions, cut_strides, make_space
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.parametric_control import TARGET, ParametricController
from mocap.methods.parametric_graphs.parametric_edges import build_edge
from mocap.methods.parametric_graphs.stride_changes import changing_strides
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters, measure_mixes
from mocap.quality import foot_sliding
from tests.bundled import clips

SMALL = (12, 120)  # sources, targets
SHARE = {"lrl": 1.0, "lr": 0.55, "rl": 0.55}  # a step turns by half of what a stride does, or little more


@cache
def strides(feet="lrl", by="strikes"):
    return cut_strides(clips(), feet=feet, by=by)


@cache
def jogs():
    return cut_strides(clips("jog"), label="jog")


@cache
def walk_and_jog():
    """Two kinds and both changes, as spaces by turn."""
    kinds = {"walk": strides(), "jog": jogs()}
    edges = [(kind, kind) for kind in kinds]
    for one, other in permutations(("walk", "jog")):
        kinds[name := f"{one} to {other}"] = changing_strides(kinds[one], kinds[other])
        edges += [(one, name), (name, other)]
    ends = {name: np.percentile(some.values[:, 0], [4, 96]) for name, some in kinds.items()}
    spaces = {name: make_space(some, np.radians(14), *ends[name]) for name, some in kinds.items()}
    least = max(build_edge(spaces[a], spaces[b], good=np.inf, sampling=SMALL).smallest_good for a, b in edges)
    return build_parametric(spaces, edges, good=max(0.04, 1.05 * least), sampling=SMALL)


@cache
def space(feet="lrl", degrees=12):
    width, high = np.radians([degrees, 75]) * SHARE[feet]
    return make_space(strides(feet), width, -high, high)


@cache
def by_turn_and_speed():
    """Strides asked by two numbers, blended three at a time."""
    return sample_space(
        strides(), lambda blend: [heading_change(blend), mean_speed(blend)], parameters=("turn", "speed")
    )


@cache
def walking(good=0.03):
    return build_parametric({"walk": space()}, good=good)


@cache
def stepping(good=0.03):
    spaces = {"left": space("lr"), "right": space("rl")}
    return build_parametric(spaces, [("left", "right"), ("right", "left")], good=good, sampling=(30, 300))


def missed(tested, goals):
    """How far strides are from what they were asked for, in degrees and m/s."""
    got = measure_mixes(tested.examples, weights_for(tested, goals))[:, : len(tested.parameters)]
    return np.abs(got - goals) * [np.degrees(1), 1][: len(tested.parameters)]


def bad_ones(source, target, edge, bad, seed=99):
    """Test boxes on fresh samples: the shares of boxes with a bad target, and of bad ones inside."""
    random = np.random.default_rng(seed)
    at, to = draw_parameters(source, 100, random), draw_parameters(target, 300, random)
    ways = [edge.look_up(asked) for asked in at]
    cost, _, _ = optimal_transitions(source, target, at, to)
    inside = np.array([((to >= way.low) & (to <= way.high)).all(axis=1) for way in ways])
    worst = (cost > bad) & inside
    return worst.any(axis=1).mean(), worst.sum() / inside.sum()


def walk_anywhere(character, count, speed=0.8):
    """Ask for targets drawn anywhere in the boxes; give the nodes and the parameters that it left."""
    random, left = np.random.default_rng(4), []

    def anywhere(space, start, heading, speed):
        way = next(iter(character.boxes.values()))
        left.append((character.node, character.parameters))
        return random.uniform(np.minimum(way.low, way.high), np.maximum(way.low, way.high))

    character._requested = anywhere
    while len(character.chosen) < count:
        character.step(0.0, speed)
    return left


def slides(motion):
    """How far planted joints stray from their mean place, cm."""
    return [plant.distance for plant in foot_sliding(motion) if plant.stop - plant.start > 2]


def arm_moved(clip, middle, shoulder, elbow):
    """Turn the right arm of a clip about a moment, and back again."""
    share = np.exp(-((np.arange(len(clip)) - middle)[:, None] ** 2) / 50)
    turns = clip.rotations.copy()
    for joint, bent in (("rhumerus", shoulder), ("rradius", elbow)):
        one = clip.skeleton.index(joint)
        turns[:, one] = rotations.multiply(turns[:, one], rotations.from_rotvec(share * bent))
    return replace(clip, rotations=turns)


def arms(count, seed=0):
    """Draw how shoulder and elbow turn, rotation vectors."""
    random = np.random.default_rng(seed)
    shoulders = random.uniform([-1.6, -0.5, -0.4], [-0.6, 0.5, 0.4], (count, 3))
    return zip(shoulders, random.uniform([-1.0, 0, 0], [-0.2, 0, 0], (count, 3)), strict=True)


@cache
def reaches():
    """Strides of a straight walk whose right hand goes to some place in the middle."""
    walk, found = clips()[3], []
    strikes = 1 + np.flatnonzero(np.diff(walk.contacts["lfoot"].astype(int)) == 1)
    for number, arm in enumerate(arms(14)):
        first, last = strikes[2 + number % 2 : 4 + number % 2]
        marks = np.zeros(len(walk), bool)
        marks[first : last + 1] = True
        moved = arm_moved(walk, (first + last) / 2, *arm)
        found.append(replace(moved, labels={"reach": marks})[first - 20 : last + 21])
    return cut_strides(found, label="reach")


@cache
def punches():
    """One that stands, and whose right hand goes to some place."""
    still = resample(samples.sample("stop_and_go"), 30)
    speed = np.abs(np.diff(still.root_positions[:, [0, 2]] @ [1j, 1]))
    at = int(np.convolve(speed, np.ones(15), "valid").argmin()) + 7
    still = replace(still[at : at + 1], contacts=dict.fromkeys(still.contacts, True), labels={})
    still = concatenate([still] * 80)
    return cut_actions([arm_moved(still, 40, *arm) for arm in arms(14, seed=1)], [(22, 58)] * 14)


HAND = partial(hand_target, at=0.5)
EDGES = ["walk walk", "walk reach", "reach walk", "walk to_guard", "to_guard punch"]
EDGES += ["punch punch", "punch from_guard", "from_guard walk"]


@cache
def of_hands():
    """Spaces of reaches and punches, by the place of the hand."""
    own = {"reach": reaches(), "punch": punches()}
    return {name: sample_space(own[name], HAND, parameters=TARGET) for name in own}


@cache
def acting():
    """Walk, reach and punch in one graph, with the ways between."""
    straightest = strides().take(np.abs(strides().values[:, 0]) < np.radians(1))
    to = changing_strides(strides(), punches(), stands="second")
    back = changing_strides(punches(), straightest, stands="first")
    spaces = {"walk": space(), **of_hands(), "to_guard": make_space(to, np.radians(14), -1.0, 1.0)}
    spaces["from_guard"] = sample_space(back, HAND, parameters=TARGET)
    return build_parametric(spaces, [tuple(edge.split()) for edge in EDGES], good=0.08, sampling=SMALL)


class Acted(NamedTuple):
    """What a character did, its decisions, and when the hand was to be where: frames (n,), places (n, 3)."""

    motion: Motion
    chosen: list
    frames: np.ndarray
    places: np.ndarray

    def missed(self, motion):
        """Measure how far the hand is from its places, metres, (n,)."""
        hands = joint_positions(motion.at(self.frames))[:, motion.skeleton.index("rhand")]
        return np.linalg.norm(hands - self.places, axis=1)


def act(graph, node, count, seed=1):
    """Walk three strides, then bring the hand to a place of the world that blends of examples reach; again.

    Places lie in the box, seen from where the body stands when what plays is over.
    """
    random, space = np.random.default_rng(seed), graph.nodes[node]["space"]
    character = ParametricController(graph, start="walk")
    rows = random_weights(space.values[: len(space.examples)], 200, spread=0, seed=seed)
    reached = np.array([HAND(space.examples.blend(row)) for row in rows])
    poses, found, heading = [], [], 0.0
    while len(found) < count or character.frames_left:
        walked = len(character.chosen) - max((n for n, *_ in found), default=0)
        wants = walked >= 5 and len(found) < count
        decides = not character.frames_left
        if decides and wants and node in character.boxes:
            way = character.boxes[node]
            inside = reached[((reached >= way.low) & (reached <= way.high)).all(axis=1)]
            character.aim(character.end.apply_points(inside[random.integers(len(inside))]))
        first = len(poses)
        poses.append(character.step(heading, 0.8, node if wants else "walk"))
        if decides and character.node == node:
            made = character.current
            frame = np.interp(0.5, made.phases, np.arange(len(made.phases)))
            ahead = first + len(character._frames) - (character._decision - frame)
            found.append((len(character.chosen), ahead, character.target))
            heading += random.uniform(-1, 1)
    marks = {name: np.array([pose.contacts[name] for pose in poses]) for name in poses[0].contacts}
    roots, turns = (np.array([getattr(p, part) for p in poses]) for part in ("root_position", "rotations"))
    motion = Motion(character.skeleton, roots, turns, character.fps, node, contacts=marks)
    _, frames, places = zip(*found, strict=True)
    return Acted(motion, character.chosen, np.array(frames), np.array(places))
