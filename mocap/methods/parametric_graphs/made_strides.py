"""Strides made out of mixes, frame by frame: near their strikes, or one as a whole."""

from dataclasses import dataclass

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.methods.parametric_graphs.stride_spaces import StrideSpace, measure_mixes, neighbours
from mocap.methods.parametric_graphs.strides import mixed_way


@dataclass(frozen=True, eq=False)
class MadeStride:
    """A stride of F frames, margins and all, which starts at the origin; `make_stride` shows an example.

    Parameters
    ----------
    motion : F frames, with contacts.
    phases : shape (F,).
    heading : shape (F,), how the body faces.
    values : shape (2,), the turn in radians and the speed in m/s that it comes to.
    """

    motion: Motion
    phases: Array
    heading: Array
    values: Array

    def frame(self, phase: float) -> int:
        """Give the frame nearest to a phase."""
        return int(np.abs(self.phases - phase).argmin())


def mixed_frames(space: StrideSpace, asked: Array, phases: Array) -> tuple[Array, Array, Array, Array]:
    """Make M strides at F phases each: roots (M, F, 3), rotations (M, F, J, 4), headings (M, F), and values.

    The pose is a normalised sum of quaternions of one sign; heights are sums; the root's velocities are mixed
    as the body sees them [ours], and integrated.

    Parameters
    ----------
    space : of strides.
    asked : shape (M, d), parameters.
    phases : shape (M, F).
    """
    strides, weights = space.strides, space.weights(asked)
    near, shares = neighbours(asked, space.values, space.scale)
    ground, facing = mixed_way(strides, weights)
    values = measure_mixes(strides, weights, (ground, facing))
    place = (phases - strides.grid[0]) / (strides.grid[1] - strides.grid[0])
    low = np.clip(place.astype(int), 0, len(strides.grid) - 2)
    share, row = place - low, np.arange(len(weights))[:, None]
    ground, facing, heights = (
        part[row, low] * (1 - share) + part[row, low + 1] * share
        for part in (ground, facing, weights @ strides.heights)
    )
    turns = np.zeros((*low.shape, *strides.poses.shape[2:]))
    for k in range(near.shape[1]):
        for step, amount in ((0, 1 - share), (1, share)):
            mixed = space.sampled_poses[near[:, k, None], low + step]
            turns += (shares[:, k, None] * amount)[..., None, None] * mixed
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    turns[:, :, 0] = rotations.multiply(rotations.about_y(facing), turns[:, :, 0])
    return np.stack([ground.imag, heights, ground.real], axis=-1), turns, facing, values


def make_stride(space: StrideSpace, asked: Array) -> MadeStride:
    """Make the stride that a space has for some parameters, at the rate of its clips.

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
    strides, weights = space.strides, space.weights(asked)
    seconds = (weights @ strides.seconds)[0]
    times = (
        np.arange(np.ceil(seconds[0] * strides.fps), np.floor(seconds[-1] * strides.fps) + 1) / strides.fps
    )
    phases = np.interp(times, seconds, strides.grid)
    (roots,), (turns,), (facing,), (values,) = mixed_frames(space, asked[None], phases[None])
    near = np.abs(strides.grid - phases[:, None]).argmin(axis=1)
    contacts: Mask = np.tensordot(weights[0], strides.contacts[:, near], 1) > 0.5
    marks = dict(zip(strides.contact_names, contacts.T, strict=True))
    motion = Motion(strides.skeleton, roots, turns, strides.fps, "stride", contacts=marks)
    return MadeStride(motion, phases, facing, values)
