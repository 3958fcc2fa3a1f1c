"""Make a stride with the turn of a captured one, from the strides of all clips except its own.

Pose: the RMS distance of its points from those of the captured stride, aligned at each of 25 moments. End:
the distance between the ends of both, relative to their starts. Turn: the difference between their turns.

A walker's turns differ more from one another than their turn says, such as sharp ones on the spot and long
ones around a bend: a mean of all is nearer in its pose than one of those with the turn that is asked for.
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
SMALLEST_TURN = np.radians(15)  # of a captured stride
EACH = 6  # number of strides of a clip, about
WIDTH = np.radians(14)  # of the bell of a space
MOMENTS = 25  # number of frames that are compared
MEASURES = {"pose, cm": True, "end, cm": True, "turn, °": True}
BASELINES = ("mean stride", "nearest stride")


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield strides that turn, evenly spread over each clip."""
    for clip in clips:
        try:
            captured = strides((clip,))
        except MocapError:  # no whole stride
            continue
        turning = np.flatnonzero(np.abs(captured.values[:, 0]) > SMALLEST_TURN)
        remaining = tuple(source for source in clips if source is not clip)
        for number in turning[:: max(1, len(turning) // EACH)][:EACH]:
            truth = captured.blend(np.eye(len(captured))[number])
            data = {"turn": captured.values[[number], :1], "clips": remaining}
            yield Case(collection, f"{clip.name}-{number}", data, truth)


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


def mean_weights(examples: Examples, turn: float) -> Array:
    """Weigh all strides equally, whatever the turn is."""
    return np.full(len(examples), 1 / len(examples))


def nearest_weights(examples: Examples, turn: float) -> Array:
    """Take the stride with the nearest turn."""
    nearest = np.abs(examples.values[:, 0] - turn).argmin()
    return np.asarray(np.eye(len(examples))[nearest])


def space_weights(examples: Examples, turn: float) -> Array:
    """Return the weights of a space of strides for a turn."""
    values = examples.values[:, 0]
    space = make_space(examples, WIDTH, values.min(), values.max())
    return np.asarray(weights_for(space, [[turn]])[0])


METHODS = {
    "mean stride": of(mean_weights),
    "nearest stride": of(nearest_weights),
    "space of strides": of(space_weights),
}


def score(case: Case, answer: Motion) -> tuple[float, float, float]:
    """Compare a stride with the captured one: the three `MEASURES`."""
    synthetic = answer.at(np.linspace(0, len(answer) - 1, MOMENTS))
    captured = case.truth.at(np.linspace(0, len(case.truth) - 1, MOMENTS))
    synthetic_end, synthetic_turn = end(synthetic)
    captured_end, captured_turn = end(captured)
    turn_error = abs(float(np.degrees(np.angle(np.exp(1j * (synthetic_turn - captured_turn))))))
    return 100 * pose_error(synthetic, captured), 100 * abs(synthetic_end - captured_end), turn_error


def pose_error(synthetic: Motion, captured: Motion) -> float:
    """Average the RMS distances of the points of two motions, aligned frame by frame, metres."""
    points = point_cloud(captured)
    synthetic_points = point_cloud(synthetic)
    transform = align(points, synthetic_points)
    rotation = np.asarray(transform.rotation)[:, None]
    translation = np.asarray(transform.translation)[:, None]
    ground = np.abs(rotation * on_ground(synthetic_points) + translation - on_ground(points)) ** 2
    heights = (synthetic_points - points)[..., 1] ** 2
    return float(np.sqrt((ground + heights).mean(axis=1)).mean())


def end(motion: Motion) -> tuple[complex, float]:
    """Return the ground position of a motion's end relative to its start, and its turn."""
    facing = heading(motion.rotations[[0, -1], 0])
    track = on_ground(motion.root_positions[[0, -1]])
    relative = (track[1] - track[0]) * np.exp(-1j * facing[0])
    return complex(relative), float(facing[1] - facing[0])
