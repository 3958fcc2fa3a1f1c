"""One stride made out of a space, frame by frame, ready to be played and joined."""

from dataclasses import dataclass

import numpy as np

from mocap._shared.arrays import Array, Mask, Points
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion, concatenate
from mocap.methods.parametric_graphs.nearest_windows import HALF
from mocap.methods.parametric_graphs.stride_spaces import StrideSpace, neighbours
from mocap.methods.parametric_graphs.strides import mixed_way


@dataclass(frozen=True, eq=False)
class MadeStride:
    """A stride of F frames, margins and all, which starts at the origin; `make_stride` shows an example.

    Parameters
    ----------
    motion : F frames, with contacts.
    phases : shape (F,).
    ground, heading : shape (F,), where the root is and how the body faces.
    joints : those that windows are compared by.
    values : shape (2,), the turn in radians and the speed in m/s that it comes to.
    """

    motion: Motion
    phases: Array
    ground: Points
    heading: Array
    joints: list[int]
    values: Array

    def frame(self, phase: float) -> int:
        """Give the frame nearest to a phase."""
        return int(np.abs(self.phases - phase).argmin())


def facing_windows(one: MadeStride, centre: int, other: MadeStride, into: int) -> tuple[Array, Array]:
    """Give the points (K, 3) of two strides' frames about their centres, to align one with the other."""
    both = [stride.motion[at - HALF : at + HALF + 1] for stride, at in ((one, centre), (other, into))]
    points = joint_positions(concatenate(both))[:, one.joints].reshape(2, -1, 3)
    return points[0], points[1]


def make_stride(space: StrideSpace, asked: Array) -> MadeStride:
    """Make the stride that a space has for some parameters, at the rate of its clips.

    The pose is a normalised sum of quaternions of one sign; heights and times are sums; the root's velocities
    are mixed as the body sees them [ours], and integrated.

    Parameters
    ----------
    space : of strides.
    asked : shape (d,), parameters.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> made = make_stride(make_space(strides, 0.4, -0.8, 0.8), np.array([0.5]))
    >>> float((made.heading[made.frame(1.0)] - made.heading[made.frame(0.0)]).round(1))
    0.5
    """
    strides, grid = space.strides, space.strides.grid
    near, parts = neighbours(np.atleast_2d(asked), space.values, space.scale)
    weights = parts @ space.mixes[near[0]]
    (ground,), (facing,) = mixed_way(strides, weights)
    weights, (zero, one) = weights[0], strides.ends
    seconds, heights = weights @ strides.seconds, weights @ strides.heights
    speed = np.abs(np.diff(ground[zero : one + 1])).sum() / seconds[one]
    values = np.array([facing[one] - facing[zero] - strides.sway, speed])
    frames = np.arange(np.ceil(seconds[0] * strides.fps), np.floor(seconds[-1] * strides.fps) + 1)
    phases = np.interp(frames / strides.fps, seconds, grid)
    place = (phases - grid[0]) / (grid[1] - grid[0])
    low = np.clip(place.astype(int), 0, len(grid) - 2)
    share, used = place - low, np.flatnonzero(weights)
    poses = np.tensordot(parts[0], space.sampled_poses[near[0]], 1)
    turns = poses[low] * (1 - share)[:, None, None] + poses[low + 1] * share[:, None, None]
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    ground, facing, heights = (
        part[low] * (1 - share) + part[low + 1] * share for part in (ground, facing, heights)
    )
    turns[:, 0] = rotations.multiply(rotations.about_y(facing), turns[:, 0])
    contacts: Mask = np.tensordot(weights[used], strides.contacts[used], 1)[np.round(place).astype(int)] > 0.5
    roots = np.stack([ground.imag, heights, ground.real], axis=-1)
    marks = dict(zip(strides.contact_names, contacts.T, strict=True))
    motion = Motion(strides.skeleton, roots, turns, strides.fps, "stride", contacts=marks)
    return MadeStride(motion, phases, ground, facing, strides.joints, values)
