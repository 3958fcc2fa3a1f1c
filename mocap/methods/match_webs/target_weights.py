"""Blend weights for a target: the inverse of the measure of a space of motions."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls

from mocap._shared.arrays import Array, Indices
from mocap.errors import MocapError, shortened
from mocap.methods.match_webs.motion_spaces import MotionSpace
from mocap.methods.match_webs.tuned import TUNED

HIT = 1e-12  # a sample is hit if its distance is below this fraction of the farthest one


def weights_for(
    space: MotionSpace[Any], target: ArrayLike, *, k: int | None = None, method: str = "convex"
) -> Array:
    """Compute blend weights for a target [KG04, request].

    "neighbours" mixes the weights of the k nearest samples by v ∝ 1 / d - 1 / d_k, where d are their
    distances from the target [HG07, Eqs. 1-2, after ACP02]. "convex" [ours] solves a least-squares problem
    for the convex combination v ≥ 0, Σ v = 1 of the k nearest samples whose value is nearest to the target.
    The first is not exact even for a linear measure. The second is, and its error decreases with the square
    of the samples' spacing.

    The result is a convex combination of the samples' weights and stays within their range. For a target far
    outside the accessible region, the blend stays at its boundary.

    Parameters
    ----------
    space : from `sample_space` or `methods.parametric_graphs.make_space`.
    target : a number or shape (d,), or M targets of shape (M, d).
    k : number of nearest samples, by default 12, or d + 2 for "neighbours".
    method : "convex" or "neighbours".

    Returns
    -------
    Weights that add up to one, of shape (C,), or (M, C) for M targets.

    Raises
    ------
    MocapError : for a target that is not d finite numbers, and another method.

    Examples
    --------
    >>> from mocap.blending.registering import register
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.motion_spaces import blend_of, mean_speed, sample_space
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> space = sample_space(register(walks), mean_speed, count=10)
    >>> weights = weights_for(space, 1.0)
    >>> round(mean_speed(blend_of(space.examples, weights)), 2)
    1.0

    Notebook: 16-match-webs
    """
    targets = np.asarray(target, float)
    nearest, mix = sample_weights(space, np.atleast_2d(targets), k=k, method=method)
    weights = np.einsum("mk,mkc->mc", mix, space.weights[nearest])
    return np.asarray(weights if targets.ndim == 2 else weights[0])


def sample_weights(
    space: MotionSpace[Any], targets: Array, *, k: int | None = None, method: str = "convex"
) -> tuple[Indices, Array]:
    """Find the samples to be mixed for targets (M, d), and compute their weights, (M, k) each.

    The parameters are those of `weights_for`.

    Examples
    --------
    >>> space = MotionSpace(None, np.eye(2), np.array([[0.0], [1]]), np.ones(1))
    >>> sample_weights(space, np.array([[0.25]]))[1].round(2)
    array([[0.75, 0.25]])
    """
    samples, numbers = space.values.shape
    if targets.ndim != 2 or targets.shape[1] != numbers or not np.isfinite(targets).all():
        got = shortened(str((targets[0] if len(targets) == 1 else targets).tolist()))
        raise MocapError(f"A target in this space has {numbers} finite numbers, got {got}.")
    if method not in ("convex", "neighbours"):
        raise MocapError(f'A method is "convex" or "neighbours", got {method!r}.')
    count = min(k or (TUNED.convex if method == "convex" else numbers + 2), samples)
    nearest, distances = nearest_samples(targets, space.values, space.scale, count)
    if method == "neighbours":
        return nearest, neighbour_weights(distances)
    offsets = (space.values[nearest] - targets[:, None]) / space.scale
    return nearest, np.array([convex_weights(*row) for row in zip(offsets, distances, strict=True)])


def convex_weights(offsets: Array, distances: Array) -> Array:
    """Compute non-negative weights that sum to one and minimise |Σ vᵢ oᵢ|.

    Ties are broken in favour of the nearest samples. A row of ones constrains the sum:
    s² |Σ v o|² + (s - 1)² is minimal for the same v at its best s.

    Parameters
    ----------
    offsets : shape (k, d), of the samples from the target, nearest first.
    distances : shape (k,), their lengths.

    Examples
    --------
    Samples 1 below and 2 above the target. One 200 above it has hardly any weight:

    >>> convex_weights(np.array([[-1.0], [2], [200]]), np.array([1.0, 2, 200])).round(4).tolist()
    [0.7147, 0.2846, 0.0007]
    """
    count, numbers = offsets.shape
    ridge = TUNED.ridge * np.diag(distances / max(distances[-1], np.finfo(float).tiny))
    rows = np.concatenate([offsets.T, np.ones((1, count)), ridge])
    right_side = np.concatenate([np.zeros(numbers), [1], np.zeros(count)])
    weights, _ = nnls(rows, right_side)
    return np.asarray(weights / weights.sum())


def nearest_samples(targets: Array, values: Array, scale: Array, count: int) -> tuple[Indices, Array]:
    """Find the k nearest samples of values (S, d) to targets (M, d), with their scaled distances, (M, k).

    Examples
    --------
    >>> nearest_samples(np.array([[0.0]]), np.array([[4.0], [1], [2]]), np.ones(1), 2)
    (array([[1, 2]]), array([[1., 2.]]))
    """
    distances = np.linalg.norm((targets[:, None] - values) / scale, axis=-1)
    nearest = np.argsort(distances, axis=1, kind="stable")[:, :count]
    return nearest, np.take_along_axis(distances, nearest, 1)


def neighbour_weights(distances: ArrayLike) -> Array:
    """Weight the k nearest samples by 1 / d - 1 / d_k, which is 0 for the last one.

    In the paper: [HG07, Eqs. 1-2, after ACP02].

    A sample at distance 0 gets all the weight. If all distances are equal, the first sample gets it.

    Parameters
    ----------
    distances : shape (..., k), each row in ascending order.

    Examples
    --------
    >>> neighbour_weights([1, 2, 4]), neighbour_weights([0, 2, 4])
    (array([0.75, 0.25, 0.  ]), array([1., 0., 0.]))

    Notebook: 16-match-webs
    """
    d = np.asarray(distances, float)
    nearest = d[..., :1]
    farthest = d[..., -1:]
    takes_all = (nearest <= HIT * farthest) | (nearest == farthest)
    d = np.where(takes_all, 1.0, d)
    first_only = np.eye(d.shape[-1])[0]
    raw = np.where(takes_all, first_only, nearest / d - nearest / d[..., -1:])
    return np.asarray(raw / raw.sum(axis=-1, keepdims=True))
