"""Make a stride that turns as much as asked, from the strides of all clips but the one that it is from.

Pose: the RMS distance of its points from the captured stride's, each of 25 moments aligned. End: how far from
where the captured stride ends it does, seen from its start; turn: by how much it turns otherwise.
"""

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion, heading, on_ground
from mocap.errors import MocapError
from mocap.matching import align, point_cloud
from mocap.methods.match_webs import weights_for
from mocap.methods.parametric_graphs import cut_strides, make_space
from mocap.methods.parametric_graphs.examples import Examples
from tasks import CMU_16, HOMEWORK, WALKS, Case

CLIPS = {
    "bundled clips": WALKS,
    "homework's clips": HOMEWORK,
    "CMU 16, walks": CMU_16,
    "a walker's turns": tuple(
        f"puppy0512_motion_graph/walk_normal_{turn}"
        for turn in ("left_180", "left_45", "left_90", "right_45", "right_90", "stright")
    ),
}
LEAST, EACH, WIDTH, MOMENTS = np.radians(15), 6, np.radians(14), 25  # of turns asked; strides of a clip
MEASURES = {"pose, cm": True, "end, cm": True, "turn, °": True}
BASELINES = ("mean stride", "nearest stride")


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield strides that turn, evenly spread over each clip."""
    for clip in clips:
        try:
            own = strides((clip,))
        except MocapError:  # no whole stride
            continue
        turning = np.flatnonzero(np.abs(own.values[:, 0]) > LEAST)
        others = tuple(other for other in clips if other is not clip)
        for number in turning[:: max(1, len(turning) // EACH)][:EACH]:
            truth = own.blend(np.eye(len(own))[number])
            given = {"turn": own.values[[number], :1], "clips": others}
            yield Case(collection, f"{clip.name}-{number}", given, truth)


@cache
def strides(clips: tuple[Motion, ...]) -> Examples:
    """Cut strides from left strike to left strike."""
    return cut_strides(list(clips))


def of(weights: Callable[[Examples, float], Array]) -> Callable[[Case], Motion]:
    """Blend the strides of the other clips by weights for a turn."""

    def method(case: Case) -> Motion:
        examples = strides(case.given["clips"])
        return examples.blend(weights(examples, float(case.given["turn"][0, 0])))

    return method


def in_space(examples: Examples, turn: float) -> Array:
    """Give the weights that a space of strides has for a turn."""
    values = examples.values[:, 0]
    space = make_space(examples, WIDTH, values.min(), values.max())
    return weights_for(space, [[turn]])[0]


METHODS = {
    "mean stride": of(lambda examples, _: np.full(len(examples), 1 / len(examples))),
    "nearest stride": of(
        lambda examples, turn: np.eye(len(examples))[np.abs(examples.values[:, 0] - turn).argmin()]
    ),
    "space of strides": of(in_space),
}


def score(case: Case, answer: Motion) -> tuple[float, float, float]:
    """Compare a stride with the captured one."""
    made, real = (motion.at(np.linspace(0, len(motion) - 1, MOMENTS)) for motion in (answer, case.truth))
    points, others = point_cloud(real), point_cloud(made)
    laid = align(points, others)
    turn, move = np.asarray(laid.rotation)[:, None], np.asarray(laid.translation)[:, None]
    ground = np.abs(turn * on_ground(others) + move - on_ground(points)) ** 2
    pose = np.sqrt((ground + (others - points)[..., 1] ** 2).mean(axis=1)).mean()
    ends, turns = zip(*(end(motion) for motion in (made, real)), strict=True)
    off = abs(float(np.degrees(np.angle(np.exp(1j * (turns[0] - turns[1]))))))
    return 100 * float(pose), 100 * abs(ends[0] - ends[1]), off


def end(motion: Motion) -> tuple[complex, float]:
    """Say where a motion ends and how far it has turned, seen from its start."""
    facing, track = heading(motion.rotations[[0, -1], 0]), on_ground(motion.root_positions[[0, -1]])
    return complex((track[1] - track[0]) * np.exp(-1j * facing[0])), float(facing[1] - facing[0])
