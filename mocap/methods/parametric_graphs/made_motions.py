"""Motions made out of mixes, frame by frame, and where to leave one and enter another [HG07, 3.1].

All pairs of 50 × 1000 generated clips are compared at once, by the products of `matching.distance_grids`: a
whole window is there one frame of many points.
"""

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import dataclass
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.matching.distance_grids import cloud, cloud_distances
from mocap.methods.match_webs.target_weights import sample_weights as shares_for
from mocap.methods.match_webs.target_weights import weights_for
from mocap.methods.parametric_graphs.stride_spaces import Space

HALF = 5  # a window is 11 frames, a third of a second at 30 Hz, about its centre
WINDOW = 2 * HALF + 1
SPAN = 3  # frames around an end at which a transition may be centred
ROWS = 8  # sources compared in one product


@dataclass(frozen=True, eq=False)
class MadeMotion:
    """A motion of F frames, margins and all, which starts at the origin; `make_motion` shows an example.

    Parameters
    ----------
    motion : F frames, with contacts.
    phases : shape (F,).
    heading : shape (F,), how the body faces.
    values : shape (d,), what the samples of its space say that it comes to.
    """

    motion: Motion
    phases: Array
    heading: Array
    values: Array

    def frame(self, phase: float) -> int:
        """Give the frame nearest to a phase."""
        return int(np.abs(self.phases - phase).argmin())


def make_motion(space: Space, asked: Array) -> MadeMotion:
    """Make the motion that a space has for some parameters, at the rate of its clips.

    Parameters
    ----------
    space : of examples on a grid.
    asked : shape (d,), parameters.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> made = make_motion(make_space(strides, 0.4, -0.8, 0.8), np.array([0.5]))
    >>> float((made.heading[made.frame(1.0)] - made.heading[made.frame(0.0)]).round(1))
    0.5
    >>> len(made.motion), made.frame(0.0), made.frame(1.0), made.phases[[0, -1]].round(3).tolist()
    (57, 12, 44, [-0.377, 1.36])
    """
    examples, (near,), (shares,) = space.examples, *shares_for(space, asked[None])
    weights, values = (shares @ part[near] for part in (space.weights, space.values))
    seconds, rate = weights @ examples.seconds, examples.fps
    times = np.arange(np.ceil(seconds[0] * rate), np.floor(seconds[-1] * rate) + 1) / rate
    places = np.interp(times, seconds, np.arange(len(seconds)))
    motion, facing = examples.motion(weights, places, rate)
    return MadeMotion(motion, np.interp(times, seconds, examples.grid), facing, values)


def near_end(space: Space, asked: Array, phase: float) -> tuple[Array, Array]:
    """Generate clips only in the F frames around where their action begins or ends.

    Parameters
    ----------
    space : of examples on a grid.
    asked : shape (M, d), parameters.
    phase : 0 or 1.

    Returns
    -------
    Points (M, F, P, 3) in metres, and their phases (M, F).

    Raises
    ------
    MocapError : for windows that run off the margins by more than a frame; they would hold the last frame.

    Examples
    --------
    Windows of 11 frames about the 7 nearest to a strike take 17:

    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> points, phases = near_end(make_space(strides, 0.4, -0.8, 0.8), np.array([[0.5]]), 1.0)
    >>> points.shape, phases[0, [0, 8, -1]].round(2).tolist()
    ((1, 17, 31, 3), [0.74, 0.99, 1.24])
    """
    examples, rate, reach = space.examples, space.examples.fps, HALF + SPAN
    weights = weights_for(space, asked)
    seconds = weights @ examples.seconds
    centre = np.array([round(np.interp(phase, examples.grid, clock) * rate) for clock in seconds])
    times = (centre[:, None] + np.arange(-reach, reach + 1)) / rate
    off = np.maximum(seconds[:, 0] - times[:, 0], times[:, -1] - seconds[:, -1])
    if off.max() > 1 / rate:
        lasts = f"a motion of {np.ptp(seconds[off.argmax()]):.2f} s, margins and all"
        raise MocapError(f"A window runs {off.max():.2f} s off {lasts}: cut with a larger margin.")
    every = np.arange(len(examples.grid))
    places = np.array([np.interp(t, clock, every) for t, clock in zip(times, seconds, strict=True)])
    roots, turns, _ = examples.mixed(weights, places)
    motion = Motion(examples.skeleton, roots.reshape(-1, 3), turns.reshape(-1, *turns.shape[2:]), rate)
    points = joint_positions(motion)[:, examples.joints].reshape(*places.shape, -1, 3)
    return points, np.interp(places, every, examples.grid)


def optimal_transitions(source: Space, target: Space, at: Array, to: Array) -> tuple[Array, Array, Array]:
    """Find for each pair of clips the windows that are nearest [HG07, 3.1].

    Windows of 11 frames, centred up to 3 frames from the source's end (the last strike of a stride) and the
    target's beginning.

    Parameters
    ----------
    source, target : spaces of one skeleton and rate.
    at, to : parameters (M, d) of sources and (N, d') of targets.

    Returns
    -------
    The RMS distance in metres, and the phases to leave and to enter, (M, N) each.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> optimal_transitions(space, space, np.array([[0.6]]), np.array([[0.6], [-0.6]]))[0].round(3)
    array([[0.031, 0.039]])

    What it costs to go on from turns by -0.8, 0.6 and 0.8 to one by -0.6, and when to leave and to enter:

    >>> turns = np.linspace(-0.8, 0.8, 9)[:, None]
    >>> found = optimal_transitions(space, space, turns, turns[1:2])
    >>> [part[[0, 7, 8], 0].round(2).tolist() for part in found]
    [[0.02, 0.04, 0.04], [1.0, 0.96, 0.96], [0.0, -0.06, -0.06]]

    Notebook: 17-parametric-graphs
    """
    (points, leaving), (others, entering) = near_end(source, at, 1.0), near_end(target, to, 0.0)
    size, count = WINDOW * points.shape[2], 2 * SPAN + 1
    frames = np.arange(count)[:, None] + np.arange(WINDOW)
    level, weights = np.tile(points[..., 1].mean(axis=(0, 1)), WINDOW), np.full(size, 1 / size)
    windows = (some[:, frames].reshape(-1, size, 3) for some in (points, others))
    a, b = (cloud(every, level, weights, 1, np.float32) for every in windows)
    cost, best = np.empty((len(at), len(to))), np.empty((len(at), len(to)), int)
    for start in range(0, len(at), ROWS):
        rows, part = slice(start * count, (start + ROWS) * count), slice(start, start + ROWS)
        grid = cloud_distances(a.part(rows), b).reshape(-1, count, len(to), count).transpose(0, 2, 1, 3)
        flat = grid.reshape(*grid.shape[:2], -1)  # all pairs of windows of two clips
        best[part], cost[part] = flat.argmin(axis=-1), np.sqrt(flat.min(axis=-1))
    i, j = np.divmod(best, count)
    leave = np.take_along_axis(leaving[:, HALF : HALF + count], i, 1)
    return cost, leave, entering[np.arange(len(to)), HALF + j]
