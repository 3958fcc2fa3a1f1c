"""Where to leave one stride and enter another: the least distance of windows near their strikes [HG07, 3.1].

All pairs of 50 × 1000 generated clips are compared at once. With windows flattened to one vector each,
centred over the ground, D of [KGP02, Eq. 1] is S + S' - 2 Σ y y' - 2 |Σ g g'*|: two products of matrices, as
in `matching.distance_grids`.
"""

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.methods.parametric_graphs.stride_spaces import StrideSpace
from mocap.methods.parametric_graphs.strides import mixed_way

HALF = 5  # a window is 11 frames, a third of a second at 30 Hz, about its centre
WINDOW = 2 * HALF + 1
SPAN = 3  # frames around a strike at which a transition may be centred
ROWS = 8  # sources compared in one product


class NearStrike(NamedTuple):
    """Frames around a strike of M clips: points (M, F, P, 3) in metres, and their phases (M, F)."""

    points: Array
    phases: Array


class OptimalTransitions(NamedTuple):
    """For M sources and N targets, (M, N) each: the RMS distance in metres, when to leave and to enter."""

    cost: Array
    leave: Array
    enter: Array


class _Windows(NamedTuple):
    """All windows of M clips: ground (M, n, K) complex and centred, heights alike, sizes (M, n)."""

    ground: Points
    heights: Array
    sizes: Array


def near_strike(space: StrideSpace, asked: Array, phase: float) -> NearStrike:
    """Generate clips only in the frames around one of their strikes.

    Parameters
    ----------
    space : of strides.
    asked : shape (M, d), parameters.
    phase : of the strike: 0 or 1.
    """
    strides, weights = space.strides, space.weights(asked)
    ground, facing = mixed_way(strides, weights)
    seconds, heights = weights @ strides.seconds, weights @ strides.heights
    reach, rate = HALF + SPAN, strides.fps
    centre = np.array([round(np.interp(phase, strides.grid, clock) * rate) for clock in seconds])
    times = (centre[:, None] + np.arange(-reach, reach + 1)) / rate
    _check_margins(times, seconds, rate)
    phases = np.array([np.interp(t, clock, strides.grid) for t, clock in zip(times, seconds, strict=True)])
    place = (phases - strides.grid[0]) / (strides.grid[1] - strides.grid[0])
    low = np.clip(place.astype(int), 0, len(strides.grid) - 2)
    share, row = place - low, np.arange(len(weights))[:, None]
    ground, facing, heights = (
        part[row, low] * (1 - share) + part[row, low + 1] * share for part in (ground, facing, heights)
    )
    turns = _mixed_poses(space, weights, low, share)
    turns[:, :, 0] = rotations.multiply(rotations.about_y(facing), turns[:, :, 0])
    roots = np.stack([ground.imag, heights, ground.real], axis=-1).reshape(-1, 3)
    motion = Motion(strides.skeleton, roots, turns.reshape(-1, *turns.shape[2:]), rate)
    points = joint_positions(motion)[:, strides.joints]
    return NearStrike(points.reshape(*low.shape, -1, 3), phases)


def _check_margins(times: Array, seconds: Array, fps: float) -> None:
    """Refuse windows that run off the margins by more than a frame; they would hold the last frame there."""
    off = np.maximum(seconds[:, 0] - times[:, 0], times[:, -1] - seconds[:, -1])
    worst = int(off.argmax())
    if off[worst] > 1 / fps:
        whole = np.ptp(seconds[worst])
        raise MocapError(
            f"A window runs {off[worst]:.2f} s off a stride of {whole:.2f} s, margins and all: "
            "cut strides with a larger margin, or leave quick ones out."
        )


def _mixed_poses(space: StrideSpace, weights: Array, low: Array, share: Array) -> Array:
    """Mix poses (M, F, J, 4) between the phases `low` and the next: normalised sums of quaternions."""
    poses = space.strides.poses
    some = np.unique(np.concatenate([low.ravel(), low.ravel() + 1]))
    flat = poses[:, some].reshape(len(poses), -1)
    turns = np.empty((*low.shape, *poses.shape[2:]))
    for start in range(0, len(weights), 64):
        part = slice(start, start + 64)
        mixed = (weights[part] @ flat).reshape(-1, len(some), *poses.shape[2:])
        row, column = np.arange(len(mixed))[:, None], np.searchsorted(some, low[part])
        amount = share[part][..., None, None]
        turns[part] = mixed[row, column] * (1 - amount) + mixed[row, column + 1] * amount
    return np.asarray(turns / np.linalg.norm(turns, axis=-1, keepdims=True))


def _windows(points: Array) -> _Windows:
    clips, frames, joints, _ = points.shape
    count = frames - WINDOW + 1
    cloud = points[:, np.arange(count)[:, None] + np.arange(WINDOW)].reshape(clips, count, WINDOW * joints, 3)
    ground = cloud[..., 2] + 1j * cloud[..., 0]
    ground = (ground - ground.mean(axis=-1, keepdims=True)) / np.sqrt(WINDOW * joints)
    return _Windows(ground, cloud[..., 1] / np.sqrt(WINDOW * joints), (np.abs(ground) ** 2).sum(axis=-1))


def _distances(first: _Windows, second: _Windows) -> Array:
    """Compare all windows of all clips, each pair aligned: RMS distances (M, N, n, m), metres."""
    (clips, count, size), (others, others_count, _) = first.ground.shape, second.ground.shape
    level = first.heights.reshape(-1, size).mean(axis=0)
    heights = [(part.heights - level).reshape(-1, size).astype(np.float32) for part in (first, second)]
    grounds = [part.ground.reshape(-1, size).astype(np.complex64) for part in (first, second)]
    shared = np.abs(grounds[0] @ grounds[1].conj().T) + heights[0] @ heights[1].T
    sizes = [
        part.sizes.ravel() + (height**2).sum(axis=-1)
        for part, height in zip((first, second), heights, strict=True)
    ]
    square = np.maximum(sizes[0][:, None] + sizes[1] - 2 * shared, 0)
    return np.asarray(np.sqrt(square).reshape(clips, count, others, others_count).transpose(0, 2, 1, 3))


def optimal_transitions(source: StrideSpace, target: StrideSpace, at: Array, to: Array) -> OptimalTransitions:
    """Find for each pair of clips the windows that are nearest [HG07, 3.1].

    Windows of 11 frames, centred up to 3 frames from the source's last strike and the target's first.

    Parameters
    ----------
    source, target : spaces of one skeleton and rate.
    at, to : parameters (M, d) of sources and (N, d') of targets.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> found = optimal_transitions(space, space, np.array([[0.6]]), np.array([[0.6], [-0.6]]))
    >>> bool(found.cost[0, 0] < found.cost[0, 1])
    True

    Notebook: 17-parametric-graphs
    """
    leaving, entering = near_strike(source, at, 1.0), near_strike(target, to, 0.0)
    first, second = _windows(leaving.points), _windows(entering.points)
    cost, leave, enter = (np.empty((len(at), len(to))) for _ in range(3))
    for start in range(0, len(at), ROWS):
        part = slice(start, start + ROWS)
        grid = _distances(_Windows._make(values[part] for values in first), second)
        count, others = grid.shape[2:]
        flat = grid.reshape(*grid.shape[:2], -1)
        best = flat.argmin(axis=-1)
        cost[part] = np.take_along_axis(flat, best[..., None], -1)[..., 0]
        i, j = np.divmod(best, others)
        leave[part] = np.take_along_axis(leaving.phases[part, HALF : HALF + count], i, 1)
        enter[part] = entering.phases[np.arange(len(to)), HALF + j]
    return OptimalTransitions(cost, leave, enter)
