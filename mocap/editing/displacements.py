"""Displacement maps, which an edit adds to a motion, and the splines that make them smooth.

A displacement map is a translation of the root and a rotation of each joint, in every frame. The idea is
[WP95]'s, rotations in each joint's own frame are [LS99]'s: m = m₀ ⊕ d, and d = m ⊖ m₀. The fine structure of
the captured motion stays, because d is smooth: a B-spline with a knot every h seconds has no detail shorter
than about 2 h.
"""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.interpolate import BSpline

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError


class Displacement(NamedTuple):
    """The difference of two motions: `root` (F, 3), metres, and `turns` (F, J, 3), rotation vectors.

    A rotation vector is in the joint's own frame, radians.

    Examples
    --------
    >>> nothing = Displacement(np.zeros((9, 3)), np.zeros((9, 38, 3)))
    >>> nothing.turns.shape
    (9, 38, 3)
    """

    root: Array
    turns: Array


def difference(motion: Motion, base: Motion) -> Displacement:
    """Compute m ⊖ m₀: p - p₀ for the root, and log(q₀⁻¹ q) for each joint, in its own frame.

    Parameters
    ----------
    motion, base : F frames of one skeleton.

    Returns
    -------
    The displacement that `displaced` adds to `base` to give `motion`; angles are at most π.

    Raises
    ------
    SkeletonMismatch : for different skeletons.
    MocapError : for different numbers of frames.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> float(abs(difference(walk, walk).turns).max().round(9))
    0.0

    Notebook: 11-warping
    """
    motion.skeleton.require_same(base.skeleton)
    if len(motion) != len(base):
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, '{base.name}' has {len(base)}.")
    turns = rotations.difference(base.rotations, motion.rotations)
    return Displacement(motion.root_positions - base.root_positions, turns)


def displaced(base: Motion, change: Displacement) -> Motion:
    """Add a displacement, m₀ ⊕ d: p = p₀ + d_root, q = q₀ exp(d) [LS99, displacement map].

    ⊕ does not commute: (m₀ ⊕ a) ⊕ b is m₀ ⊕ (a + b) only if the axes of a and b agree. Therefore several
    displacements are added one after the other. The rotation is applied on the right, in the joint's own
    frame; exp(d) q₀ would rotate about the parent's axes.

    Parameters
    ----------
    base : F frames of J joints.
    change : F frames of J joints.

    Returns
    -------
    The same frames, labels and contacts; a joint that never rotates keeps its numbers to the last bit.

    Raises
    ------
    MocapError : for another number of frames.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> lifted = displaced(walk, Displacement(np.tile([0, 0.1, 0], (9, 1)), np.zeros((9, 38, 3))))
    >>> (lifted.root_positions - walk.root_positions)[0].round(9) + 0.0
    array([0. , 0.1, 0. ])

    Notebook: 11-warping
    """
    if len(change.root) != len(base):
        raise MocapError(f"'{base.name}' has {len(base)} frames, its displacement {len(change.root)}.")
    local = base.rotations.copy()
    joints = np.flatnonzero(np.any(change.turns, axis=(0, 2)))
    local[:, joints] = rotations.multiply(local[:, joints], rotations.from_rotvec(change.turns[:, joints]))
    return replace(base, root_positions=base.root_positions + change.root, rotations=local)


def spline_basis(frames: int, spacing: float) -> sparse.csr_array:
    """Build uniform cubic B-splines over frames 0 … F - 1, with knots about `spacing` frames apart.

    In the paper: [Gle98, smooth change].

    With n = max(1, round((F - 1) / spacing)) spans, frame f is at u = f n / (F - 1), and the knots are at
    -3 … n + 3. A curve is B c, where c holds a control point for each of the n + 3 splines.

    Parameters
    ----------
    frames : their number F, at least 1.
    spacing : between knots, in frames, above 0; `seconds * fps`, so that it does not depend on the rate.

    Returns
    -------
    B, shape (F, n + 3): four entries for each frame at most, and each row adds up to 1.

    Raises
    ------
    MocapError : for no frames, or a spacing that is not above 0.

    Examples
    --------
    >>> spline_basis(11, 5).toarray()[[0, 5]].round(3)
    array([[0.167, 0.667, 0.167, 0.   , 0.   ],
           [0.   , 0.167, 0.667, 0.167, 0.   ]])

    Notebook: 14-levels
    """
    if not (frames >= 1 and spacing > 0):
        raise MocapError(f"A basis needs a frame and knots above 0 apart, got {frames} and {spacing}.")
    spans = max(1, round((frames - 1) / spacing))
    positions = np.minimum(np.arange(frames) * (spans / max(frames - 1, 1)), spans)
    knots = np.arange(-3.0, spans + 4)
    return sparse.csr_array(BSpline.design_matrix(positions, knots, k=3))


def right_jacobian(turns: Array) -> Array:
    """Build J(v), shape (..., 3, 3), with exp(v + δ) ≈ exp(v) exp(J δ) for small δ.

    J(v) = I - (1 - cos θ)/θ² [v]× + (θ - sin θ)/θ³ [v]×² with θ = ‖v‖.

    Parameters
    ----------
    turns : rotation vectors v, shape (..., 3).

    Examples
    --------
    >>> (right_jacobian(np.array([0, 0, np.pi / 2])) * np.pi / 2).round(6) + 0.0
    array([[ 1.      ,  1.      ,  0.      ],
           [-1.      ,  1.      ,  0.      ],
           [ 0.      ,  0.      ,  1.570796]])
    >>> float(right_jacobian(np.array([0, 0, 1e-5]))[0, 1].round(9))  # half of a small turn
    5e-06
    """
    angle = np.linalg.norm(turns, axis=-1)[..., None, None]
    size = np.maximum(angle, 1e-4)  # below, both quotients are at their limits to 1e-9
    first = np.where(angle < size, 0.5, (1 - np.cos(size)) / size**2)
    second = np.where(angle < size, 1 / 6, (size - np.sin(size)) / size**3)
    cross = _cross_matrices(turns)
    return np.asarray(np.eye(3) - first * cross + second * cross @ cross)


def _cross_matrices(vectors: Array) -> Array:
    """Build [v]×, shape (..., 3, 3), with [v]× u = v × u."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    upper = np.zeros((*vectors.shape, 3))
    upper[..., 0, 1] = -z
    upper[..., 0, 2] = y
    upper[..., 1, 2] = -x
    return np.asarray(upper - np.swapaxes(upper, -1, -2))
