"""Back from a wish to weights: those of the blend that does what is asked."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls

from mocap._shared.arrays import Array, Indices
from mocap.errors import MocapError, shortened
from mocap.methods.match_webs.motion_spaces import MotionSpace

CONVEX = 12  # nearest samples that are mixed
RIDGE = 5e-4  # preference for near samples


def weights_for(
    space: MotionSpace[Any], wish: ArrayLike, *, k: int | None = None, method: str = "convex"
) -> Array:
    """Find weights whose blend does what is asked [KG04, request].

    "neighbours" mixes the weights of the k nearest samples by v ∝ 1 / d - 1 / d_k, with d for their distances
    from the wish [HG07, Eqs. 1-2, after ACP02]. "convex" (ours) takes the mix v ≥ 0, Σ v = 1 of the k nearest
    samples whose values come nearest the wish, by least squares. The first does not even follow a linear
    measure; the second is exact for one, so that its error falls with the square of the samples' spacing.

    A mix of allowed weights is allowed: for no wish does a weight leave the range of the samples', and far
    outside of what can be reached the blend stays at the edge.

    Parameters
    ----------
    space : from `sample_space` or `methods.parametric_graphs.make_space`.
    wish : shape (d,), or a number; or M wishes (M, d).
    k : nearest samples that count; by default 12, and d + 2 for "neighbours".
    method : "convex" or "neighbours".

    Returns
    -------
    Shape (C,), adding up to one; or (M, C).

    Raises
    ------
    MocapError : for a wish that is not d finite numbers, and another method.

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
    asked = np.asarray(wish, float)
    nearest, shares = shares_for(space, np.atleast_2d(asked), k=k, method=method)
    weights = np.einsum("mk,mkc->mc", shares, space.weights[nearest])
    return np.asarray(weights if asked.ndim == 2 else weights[0])


def shares_for(
    space: MotionSpace[Any], asked: Array, *, k: int | None = None, method: str = "convex"
) -> tuple[Indices, Array]:
    """Find which samples are mixed for wishes (M, d), and how much of each: (M, k) each; see `weights_for`.

    Examples
    --------
    >>> space = MotionSpace(None, np.eye(2), np.array([[0.0], [1]]), np.ones(1))
    >>> shares_for(space, np.array([[0.25]]))[1].round(2)
    array([[0.75, 0.25]])

    For one number three neighbours count, of which the last has no weight:

    >>> space = MotionSpace(None, np.eye(4), np.array([[3.0], [0], [1], [4]]), np.ones(1))
    >>> nearest, shares = shares_for(space, np.array([[0.25]]), method="neighbours")
    >>> nearest.tolist(), shares.round(2).tolist()
    ([[1, 2, 0]], [[0.79, 0.21, 0.0]])
    """
    samples, numbers = space.values.shape
    if asked.ndim != 2 or asked.shape[1] != numbers or not np.isfinite(asked).all():
        got = shortened(str((asked[0] if len(asked) == 1 else asked).tolist()))
        raise MocapError(f"This space is asked for {numbers} finite numbers, got {got}.")
    if method not in ("convex", "neighbours"):
        raise MocapError(f'A method is "convex" or "neighbours", got {method!r}.')
    count = min(k or (CONVEX if method == "convex" else numbers + 2), samples)
    nearest, gaps = nearest_samples(asked, space.values, space.scale, count)
    if method == "neighbours":
        return nearest, neighbour_weights(gaps)
    offsets = (space.values[nearest] - asked[:, None]) / space.scale
    return nearest, np.array([_convex(*own) for own in zip(offsets, gaps, strict=True)])


def _convex(offsets: Array, gaps: Array) -> Array:
    """Find v ≥ 0 with the sum one that makes |Σ v · offset| least; of equals, those of the nearest samples.

    A row of ones asks for the sum: s² |Σ v · offset|² + (s - 1)² is least for the same v at its best s.

    Examples
    --------
    A sample 1 below the wish and one 2 above it are mixed, and hardly that which is 200 above:

    >>> _convex(np.array([[-1.0], [2], [200]]), np.array([1.0, 2, 200])).round(4).tolist()
    [0.7147, 0.2846, 0.0007]
    """
    count, numbers = offsets.shape
    ridge = RIDGE * np.diag(gaps / max(gaps[-1], np.finfo(float).tiny))
    rows = np.concatenate([offsets.T, np.ones((1, count)), ridge])
    shares, _ = nnls(rows, np.concatenate([np.zeros(numbers), [1], np.zeros(count)]))
    return np.asarray(shares / shares.sum())


def nearest_samples(asked: Array, among: Array, scale: Array, count: int) -> tuple[Indices, Array]:
    """Find the samples (S, d) nearest to what is asked (M, d), in units of scale: numbers and gaps, (M, k).

    Examples
    --------
    >>> nearest_samples(np.array([[0.0]]), np.array([[4.0], [1], [2]]), np.ones(1), 2)
    (array([[1, 2]]), array([[1., 2.]]))
    """
    gaps = np.linalg.norm((asked[:, None] - among) / scale, axis=-1)
    near = np.argsort(gaps, axis=1, kind="stable")[:, :count]
    return near, np.take_along_axis(gaps, near, 1)


def neighbour_weights(distances: ArrayLike) -> Array:
    """Weight the k nearest samples by 1 / d - 1 / d_k, so that the last one counts nothing.

    In the paper: [HG07, Eqs. 1-2, after ACP02].

    A sample that is hit gets all the weight; so does the first where all are equally far.

    Parameters
    ----------
    distances : shape (..., k), each row from the nearest on.

    Examples
    --------
    >>> neighbour_weights([1, 2, 4]), neighbour_weights([0, 2, 4])
    (array([0.75, 0.25, 0.  ]), array([1., 0., 0.]))

    Notebook: 16-match-webs
    """
    d = np.asarray(distances, float)
    near, far = d[..., :1], d[..., -1:]
    only = (near <= 1e-12 * far) | (near == far)
    d = np.where(only, 1.0, d)
    raw = np.where(only, np.eye(d.shape[-1])[0], near / d - near / d[..., -1:])
    return np.asarray(raw / raw.sum(axis=-1, keepdims=True))
