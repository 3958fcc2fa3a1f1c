"""Back from a wish to weights: those of the blend that does what is asked."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls

from mocap._shared.arrays import Array, Indices
from mocap.errors import MocapError, shortened
from mocap.methods.match_webs.motion_spaces import MotionSpace

CONVEX = 12  # nearest samples that are mixed
SUM, RIDGE = 100.0, 5e-4  # weight of the row that asks for a sum of one; preference for near samples


def weights_for(
    space: MotionSpace, wish: ArrayLike, *, k: int | None = None, method: str = "convex"
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
    space : from `sample_space`.
    wish : shape (d,), or a number.
    k : nearest samples that count; by default 12, and d + 2 for "neighbours".
    method : "convex" or "neighbours".

    Returns
    -------
    Shape (C,), adding up to one.

    Raises
    ------
    MocapError : for a wish that is not d finite numbers, a k below 1 and another method.

    Examples
    --------
    >>> from mocap.blending.registering import register
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.motion_spaces import mean_speed
    >>> from mocap.methods.match_webs.motion_spaces import blend_of, sample_space
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> space = sample_space(register(walks), mean_speed, count=10)
    >>> weights = weights_for(space, 1.0)
    >>> round(mean_speed(blend_of(space.registration, weights)), 2)
    1.0

    Notebook: 16-match-webs
    """
    asked = np.atleast_1d(np.asarray(wish, float))
    samples, numbers = space.values.shape
    if asked.shape != (numbers,) or not np.isfinite(asked).all():
        got = shortened(str(asked.tolist()))
        raise MocapError(f"This space is asked for {numbers} finite numbers, got {got}.")
    if k is not None and k < 1:
        raise MocapError(f"Take 1 nearest sample or more, got {k}.")
    if method not in ("convex", "neighbours"):
        raise MocapError(f'A method is "convex" or "neighbours", got {method!r}.')
    count = min(k or (CONVEX if method == "convex" else numbers + 2), samples)
    nearest, gaps = (row[0] for row in nearest_samples(asked[None], space.values, space.scale, count))
    if method == "neighbours":
        shares = neighbour_weights(gaps)
    else:  # v ≥ 0 with the sum one that makes Σ v · offset least; of equals, those of the nearest samples
        offsets = (space.values[nearest] - asked) / space.scale
        ridge = RIDGE * np.diag(gaps / max(gaps[-1], 1e-300))
        rows = np.concatenate([offsets.T, np.full((1, count), SUM), ridge])
        shares, _ = nnls(rows, np.concatenate([np.zeros(numbers), [SUM], np.zeros(count)]))
        shares /= shares.sum()
    return np.asarray(shares @ space.weights[nearest])


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
    """Weight the k nearest samples by 1 / d - 1 / d_k, so that the last one counts nothing [ACP02].

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
