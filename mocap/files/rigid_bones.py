"""Rigid bones for a file whose joints move in their parents' frames.

Some programs write six channels for every joint, and let bones grow and shrink by a few millimetres. To
drop these moves, as some readers do, would carry each of them on to all joints behind. Here each bone gets
its mean length, and each joint turns so that its children come as close as they can to where the file has
them. The method is ours, from the polar decomposition of a sum of outer products.
"""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body import rotations

STRETCH = 0.02  # metres: a bone whose length changes by more is no bone
APART = 2.5  # times as far a joint may come to lie from its place in the file
KEPT = 1e-3  # of the bones' square lengths: how much a joint's own turn counts, so that it keeps its twist


def fit(parents: NDArray[np.intp], places: Array, local: Array) -> tuple[Array, Array, Array, Array]:
    r"""Fit rigid bones, from the root down.

    A bone gets its mean direction and mean length in its parent's frame. The global turn R of a joint with
    children at offsets o is the one that maximises Σ d · R o + λ tr(Rᵀ G), where d leads from the joint to
    the child's place in the file, and G is its turn there: R = U diag(1, 1, ±1) Vᵀ of the SVD of
    Σ d oᵀ + λ G.

    Parameters
    ----------
    parents : shape (J,), -1 for the root, each before its children.
    places : shape (F, J, 3), metres: where each joint is in its parent's frame; the root in the world.
    local : shape (F, J, 4), quaternions against the parent's frame.

    Returns
    -------
    The bones' offsets (J, 3), metres; rotations (F, J, 4); by how much each bone changes its length in the
    file, (J,), metres; and how far each joint lies from its place there at most, (J,), metres.

    Examples
    --------
    A bone that points up, then sideways: the joint below it turns, and the bone is as long as before.

    >>> moving = np.array([[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0]]], float)
    >>> offsets, _, stretch, _ = fit(np.array([-1, 0]), moving, np.tile(rotations.IDENTITY, (2, 2, 1)))
    >>> offsets[1].round(2), float(stretch.max())
    (array([0.71, 0.71, 0.  ]), 0.0)
    """
    lengths = np.linalg.norm(places, axis=-1)
    middle = places.mean(axis=0)
    short = np.linalg.norm(middle, axis=-1)
    offsets = middle * np.where(short > 1e-9, lengths.mean(axis=0) / np.maximum(short, 1e-9), 1.0)[:, None]
    offsets[0] = 0.0
    there, turned = _in_world(parents, places, local)
    here, fitted = there.copy(), turned.copy()
    for joint in range(len(parents)):
        below = np.flatnonzero(parents == joint)
        bones = offsets[below]
        if len(below) and (bones**2).sum() > 0:
            aims = there[:, below] - here[:, joint, None]
            matrix = np.einsum("fci,cj->fij", aims, bones) + KEPT * (bones**2).sum() * turned[:, joint]
            fitted[:, joint] = rotations.nearest(matrix)
        here[:, below] = here[:, joint, None] + np.einsum("fij,cj->fci", fitted[:, joint], bones)
    above = np.swapaxes(fitted[:, parents[1:]], -1, -2)
    own = np.concatenate([fitted[:, :1], above @ fitted[:, 1:]], axis=1)
    stretch = np.ptp(lengths, axis=0)
    stretch[0] = 0.0
    apart = np.linalg.norm(here - there, axis=-1).max(axis=0)
    return offsets, rotations.from_matrix(own), stretch, apart


def _in_world(parents: NDArray[np.intp], places: Array, local: Array) -> tuple[Array, Array]:
    """Place all joints, (F, J, 3), and give how they are turned, (F, J, 3, 3), with bones of any length."""
    at, turned = places.copy(), rotations.to_matrix(local)
    for joint in range(1, len(parents)):
        above = parents[joint]
        at[:, joint] = at[:, above] + np.einsum("fij,fj->fi", turned[:, above], places[:, joint])
        turned[:, joint] = turned[:, above] @ turned[:, joint]
    return at, turned
