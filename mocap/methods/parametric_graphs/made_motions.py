"""Motions made by blending, and the best moments to leave one and to enter another [HG07, 3.1].

All pairs of 50 × 1000 generated clips are compared by the matrix products of `matching.distance_grids`. In
these a whole window is one frame of many points.
"""

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import dataclass
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.matching.distance_grids import Cloud, cloud, cloud_distances
from mocap.methods.match_webs.target_weights import sample_weights, weights_for
from mocap.methods.parametric_graphs.stride_spaces import Space
from mocap.methods.parametric_graphs.tuned import TUNED

HALF = 5  # frames of a window on either side of its centre
WINDOW = 2 * HALF + 1  # frames, a third of a second at 30 Hz
ROWS = 8  # number of sources compared in one product


@dataclass(frozen=True, eq=False)
class MadeMotion:
    """A motion of F frames, with its margins, that starts at the origin; `make_motion` shows an example.

    Parameters
    ----------
    motion : F frames, with contacts.
    phases : shape (F,).
    heading : shape (F,), radians.
    values : shape (d,), its parameters, interpolated between the samples of its space.
    """

    motion: Motion
    phases: Array
    heading: Array
    values: Array

    def frame(self, phase: float) -> int:
        """Return the number of the frame nearest to a phase."""
        return int(np.abs(self.phases - phase).argmin())


def make_motion(space: Space, parameters: Array) -> MadeMotion:
    """Make the motion of a space with some parameters, at the frame rate of its clips.

    Parameters
    ----------
    space : of examples on a grid.
    parameters : shape (d,).

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
    examples = space.examples
    fps = examples.fps
    (samples,), (combination,) = sample_weights(space, parameters[None])
    weights = combination @ space.weights[samples]
    values = combination @ space.values[samples]
    seconds = weights @ examples.seconds
    frames = np.arange(np.ceil(seconds[0] * fps), np.floor(seconds[-1] * fps) + 1)
    times = frames / fps
    positions = np.interp(times, seconds, np.arange(len(seconds)))
    motion, facing = examples.motion(weights, positions, fps)
    return MadeMotion(motion, np.interp(times, seconds, examples.grid), facing, values)


def near_end(space: Space, parameters: Array, phase: float) -> tuple[Array, Array]:
    """Generate clips in the F frames around the beginning or the end of their action only.

    Parameters
    ----------
    space : of examples on a grid.
    parameters : shape (M, d).
    phase : 0 or 1.

    Returns
    -------
    Points (M, F, P, 3) in metres, and their phases (M, F).

    Raises
    ------
    MocapError : for windows that exceed the margins by more than a frame; they would repeat the last frame.

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
    examples = space.examples
    fps = examples.fps
    reach = HALF + TUNED.span
    weights = weights_for(space, parameters)
    seconds = weights @ examples.seconds
    centres = np.array([round(np.interp(phase, examples.grid, clock) * fps) for clock in seconds])
    times = (centres[:, None] + np.arange(-reach, reach + 1)) / fps
    _require_margins(times, seconds, fps)
    numbers = np.arange(len(examples.grid))
    positions = np.array([np.interp(t, clock, numbers) for t, clock in zip(times, seconds, strict=True)])
    roots, poses, _ = examples.mixed(weights, positions)
    motion = Motion(examples.skeleton, roots.reshape(-1, 3), poses.reshape(-1, *poses.shape[2:]), fps)
    points = joint_positions(motion)[:, examples.joints].reshape(*positions.shape, -1, 3)
    return points, np.interp(positions, numbers, examples.grid)


def _require_margins(times: Array, seconds: Array, fps: float) -> None:
    """Raise MocapError if windows at some times (M, F) exceed motions with time warps (M, G) by a frame."""
    before_start = seconds[:, 0] - times[:, 0]
    after_end = times[:, -1] - seconds[:, -1]
    excess = np.maximum(before_start, after_end)
    largest = excess.max()
    if largest > 1 / fps:
        duration = np.ptp(seconds[excess.argmax()])
        motion = f"a motion of {duration:.2f} s, margins and all"
        raise MocapError(f"A window runs {largest:.2f} s off {motion}: cut with a larger margin.")


def optimal_transitions(
    source: Space, target: Space, sources: Array, targets: Array
) -> tuple[Array, Array, Array]:
    """Find the most similar windows of each pair of clips [HG07, 3.1].

    The windows of 11 frames are centred up to 3 frames from the source's end, such as the last strike of a
    stride, and from the target's beginning.

    Parameters
    ----------
    source, target : spaces of one skeleton and rate.
    sources, targets : parameters (M, d) of sources and (N, d') of targets.

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

    The cost from turns by -0.8, 0.6 and 0.8 to one by -0.6, and the phases to leave and to enter:

    >>> turns = np.linspace(-0.8, 0.8, 9)[:, None]
    >>> transitions = optimal_transitions(space, space, turns, turns[1:2])
    >>> [part[[0, 7, 8], 0].round(2).tolist() for part in transitions]
    [[0.02, 0.04, 0.04], [1.0, 0.96, 0.96], [0.0, -0.06, -0.06]]

    Notebook: 17-parametric-graphs
    """
    points, leaving = near_end(source, sources, 1.0)
    target_points, entering = near_end(target, targets, 0.0)
    count = 2 * TUNED.span + 1  # windows of a clip
    level = np.tile(points[..., 1].mean(axis=(0, 1)), WINDOW)
    source_windows = _windows(points, level)
    target_windows = _windows(target_points, level)
    cost = np.empty((len(sources), len(targets)))
    best = np.empty((len(sources), len(targets)), int)
    for start in range(0, len(sources), ROWS):
        rows = source_windows.part(slice(start * count, (start + ROWS) * count))
        grid = cloud_distances(rows, target_windows).reshape(-1, count, len(targets), count)
        pairs = grid.transpose(0, 2, 1, 3)
        flat = pairs.reshape(*pairs.shape[:2], -1)  # all pairs of windows of two clips
        part = slice(start, start + ROWS)
        best[part] = flat.argmin(axis=-1)
        cost[part] = np.sqrt(flat.min(axis=-1))
    leaving_window, entering_window = np.divmod(best, count)
    leave = np.take_along_axis(leaving[:, HALF : HALF + count], leaving_window, 1)
    return cost, leave, entering[np.arange(len(targets)), HALF + entering_window]


def _windows(points: Array, level: Array) -> Cloud:
    """Stack the frames of each window of clips (M, F, P, 3) to one cloud of points."""
    size = WINDOW * points.shape[2]
    frames = np.arange(2 * TUNED.span + 1)[:, None] + np.arange(WINDOW)
    windows = points[:, frames].reshape(-1, size, 3)
    return cloud(windows, level, np.full(size, 1 / size), 1, np.float32)
