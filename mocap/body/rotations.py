"""Unit quaternions as arrays `(..., 4)`, scalar first (w, x, y, z).

All functions broadcast over the leading axes, and take a single quaternion as well. Rotations turn column
vectors: `rotate(multiply(a, b), v)` turns v by b first, then by a.

Products, rotation vectors and slerp are written out as their formulas. On arrays, products and slerp are also
several times quicker than those of SciPy's `Rotation`, against which the tests check them. Lengths are not
corrected: results have length 1, up to rounding, if the arguments have. Matrices come from SciPy.

Notebooks: 01-skeletons-and-clips, 04-blending (slerp).
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array, frozen

IDENTITY: Array = frozen([1.0, 0.0, 0.0, 0.0], np.float64)
Z_UP: Array = frozen([0.5**0.5, -(0.5**0.5), 0.0, 0.0], np.float64)  # turns what points along z upwards


def from_matrix(matrices: ArrayLike) -> Array:
    """Convert rotation matrices, shape (..., 3, 3), to quaternions, shape (..., 4).

    Examples
    --------
    >>> from_matrix(np.eye(3))
    array([1., 0., 0., 0.])
    """
    matrices = np.asarray(matrices, float)
    quaternions = Rotation.from_matrix(matrices.reshape(-1, 3, 3)).as_quat(scalar_first=True)
    return np.asarray(quaternions.reshape(*matrices.shape[:-2], 4))


def to_matrix(quaternions: ArrayLike) -> Array:
    """Convert quaternions, shape (..., 4), to rotation matrices, shape (..., 3, 3).

    With q = (w, v) of length 1 the matrix is (w² - v·v) I + 2 v vᵀ + 2 w [v]×, where [v]× u = v × u;
    quaternions of another length than 1 are scaled to it.

    Examples
    --------
    >>> to_matrix(about_y(np.pi / 2)).round(6) + 0.0
    array([[ 0.,  0.,  1.],
           [ 0.,  1.,  0.],
           [-1.,  0.,  0.]])

    Notebook: 03b-angles
    """
    quaternions = np.asarray(quaternions, float)
    if not quaternions.size:  # SciPy before 1.15 refuses these
        return np.empty((*quaternions.shape[:-1], 3, 3))
    matrices = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True).as_matrix()
    return np.asarray(matrices.reshape(*quaternions.shape[:-1], 3, 3))


def from_rotvec(vectors: ArrayLike) -> Array:
    """Convert rotation vectors (axis times angle in radians), shape (..., 3), to quaternions, shape (..., 4).

    The exponential: a turn by θ about the unit axis n is q = (cos θ/2, n sin θ/2).

    Examples
    --------
    >>> from_rotvec([0, 0, np.pi]).round(6) + 0.0
    array([0., 0., 0., 1.])

    Notebook: 03b-angles
    """
    vectors = np.asarray(vectors, float)
    half = np.linalg.norm(vectors, axis=-1, keepdims=True) / 2
    # n sin θ/2 = vector / 2 · sinc(θ/2), where NumPy's sinc has a factor π and is 1 at 0
    return np.concatenate([np.cos(half), vectors / 2 * np.sinc(half / np.pi)], axis=-1)


def to_rotvec(quaternions: ArrayLike) -> Array:
    """Convert quaternions to rotation vectors, shape (..., 3), of at most π radians.

    The logarithm: (w, v) with w ≥ 0 is a turn by θ = 2 atan2(|v|, w) about v. Where w < 0, -q is used, which
    is the same rotation.

    Examples
    --------
    >>> to_rotvec(about_y(-0.5)).round(6) + 0.0
    array([ 0. , -0.5,  0. ])

    Notebook: 15-registration
    """
    quaternions = np.asarray(quaternions, float)
    w, v = quaternions[..., :1], quaternions[..., 1:]
    sine = np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300)  # never 0 / 0
    return np.asarray(2 * np.arctan2(sine, np.abs(w)) / sine * np.where(w < 0, -v, v))


def about_y(angles: ArrayLike) -> Array:
    """Build the turns by `angles` (radians, shape (...)) about the vertical, shape (..., 4).

    Examples
    --------
    >>> rotate(about_y(np.pi / 2), [0, 0, 1]).round(6) + 0.0
    array([1., 0., 0.])
    """
    half = np.asarray(angles, float) / 2
    turns = np.zeros((*half.shape, 4))
    turns[..., 0], turns[..., 2] = np.cos(half), np.sin(half)
    return turns


def multiply(first: ArrayLike, second: ArrayLike) -> Array:
    """Compose rotations by Hamilton's product: the result turns by `second`, then by `first`.

    (w₁, v₁)(w₂, v₂) = (w₁w₂ - v₁·v₂, w₁v₂ + w₂v₁ + v₁ × v₂); shapes (..., 4) broadcast.

    Examples
    --------
    >>> multiply(about_y(0.1), about_y(0.2)).round(6) == about_y(0.3).round(6)
    array([ True,  True,  True,  True])

    Notebook: 01-skeletons-and-clips
    """
    first, second = np.asarray(first, float), np.asarray(second, float)
    (w1, x1, y1, z1), (w2, x2, y2, z2) = ([q[..., k] for k in range(4)] for q in (first, second))
    # It is filled in place: a stack takes longer.
    product = np.empty(np.broadcast_shapes(first.shape, second.shape))
    product[..., 0] = w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2
    product[..., 1] = w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2
    product[..., 2] = w1 * y2 + y1 * w2 + z1 * x2 - x1 * z2
    product[..., 3] = w1 * z2 + z1 * w2 + x1 * y2 - y1 * x2
    return product


def inverse(quaternions: ArrayLike) -> Array:
    """Invert rotations: the conjugates (w, -v) of unit quaternions, shape (..., 4).

    Examples
    --------
    >>> inverse([1.0, 0.0, 0.0, 0.0]) + 0.0
    array([1., 0., 0., 0.])
    """
    return np.asarray(quaternions, float) * [1.0, -1.0, -1.0, -1.0]


def rotate(quaternions: ArrayLike, vectors: ArrayLike) -> Array:
    """Turn vectors, shape (..., 3), by quaternions, shape (..., 4); leading axes broadcast.

    Examples
    --------
    >>> rotate([1, 0, 0, 0], [1, 2, 3])
    array([1., 2., 3.])

    Notebook: 01-skeletons-and-clips
    """
    return np.asarray((to_matrix(quaternions) @ np.asarray(vectors, float)[..., None])[..., 0])


def between(start: ArrayLike, end: ArrayLike) -> Array:
    """Build the shortest turn that brings one direction onto another: q ~ (|a| |b| + a·b, a × b).

    Parameters
    ----------
    start, end : shape (..., 3), of any length but 0. Between opposite directions no turn is the shortest,
        and the result is not a rotation.

    Examples
    --------
    >>> between([0, 0, 1], [2, 0, 0]).round(6) == about_y(np.pi / 2).round(6)
    array([ True,  True,  True,  True])
    """
    a, b = (np.asarray(v, float) / np.linalg.norm(v, axis=-1, keepdims=True) for v in (start, end))
    turn = np.concatenate([1 + (a * b).sum(-1, keepdims=True), np.cross(a, b)], axis=-1)
    return np.asarray(turn / np.linalg.norm(turn, axis=-1, keepdims=True))


def difference(start: ArrayLike, end: ArrayLike) -> Array:
    """Give the turn from one rotation to another as a rotation vector in the first one's frame: log(a⁻¹ b).

    Parameters
    ----------
    start, end : a and b, shape (..., 4).

    Returns
    -------
    Shape (..., 3), of at most π radians.

    Examples
    --------
    >>> difference(about_y(0.2), about_y(0.5)).round(6)
    array([0. , 0.3, 0. ])
    """
    return to_rotvec(multiply(inverse(start), end))


def slerp(start: ArrayLike, end: ArrayLike, amount: ArrayLike) -> Array:
    """Interpolate the short way round: start · exp(amount · log(start⁻¹ · end)).

    exp is `from_rotvec`, and the logarithm is `difference`: as that turns by at most π, the way is the short
    one.

    Parameters
    ----------
    start, end : shape (..., 4).
    amount : shape (...), 0 at `start`, 1 at `end`.

    Returns
    -------
    Quaternions, shape (..., 4).

    Examples
    --------
    >>> slerp(about_y(0.2), about_y(0.4), 0.5).round(6) == about_y(0.3).round(6)
    array([ True,  True,  True,  True])

    Notebook: 04-blending
    """
    return multiply(start, from_rotvec(np.asarray(amount, float)[..., None] * difference(start, end)))


def continuous(quaternions: ArrayLike) -> Array:
    """Choose between q and -q, the same rotation, the one nearer to the frame before, shape (F, ..., 4).

    Examples
    --------
    >>> continuous([[1, 0, 0, 0], [-1, 0, 0, 0], [-0.6, 0.8, 0, 0]])[:, 0].tolist()
    [1.0, 1.0, 0.6]
    """
    q = np.asarray(quaternions, float)
    signs = np.cumprod(np.where((q[1:] * q[:-1]).sum(-1, keepdims=True) < 0, -1.0, 1.0), axis=0)
    return np.concatenate([q[:1], q[1:] * signs])


def nearest(matrices: Array) -> Array:
    """Find the rotations R that maximise tr(Rᵀ M), (..., 3, 3): R = U diag(1, 1, ±1) Vᵀ of the SVD of M.

    Examples
    --------
    >>> nearest(np.diag([2.0, 1.0, 0.5])).diagonal()
    array([1., 1., 1.])
    """
    left, _, right = np.linalg.svd(matrices)
    left[..., 2] *= np.linalg.det(left @ right)[..., None]
    return np.asarray(left @ right)


def mean(quaternions: ArrayLike, weights: ArrayLike | None = None, *, rounds: int = 1) -> Array:
    """Average rotations, each with its weight.

    All are first flipped to the side of the heaviest one, for q and -q are the same rotation. Their weighted
    sum, scaled to length 1, is near the mean m for which Σ w log(m⁻¹ q) = 0; each round brings it nearer, by
    m ← m exp(Σ w log(m⁻¹ q)), Karcher's way. Of two rotations, one round gives `slerp`. Without weights all
    count the same, and the mean is the q that has the largest Σ (q · qᵢ)², an eigenvector of Σ qᵢ qᵢᵀ.

    Parameters
    ----------
    quaternions : shape (..., C, 4).
    weights : shape (..., C), leading axes broadcast; they add up to one, and some may be negative.
    rounds : 0 for the bare sum, which takes a third of the time; it is off by up to 8° for random rotations,
        and by less than 1 mm at the hands of similar poses.

    Returns
    -------
    Shape (..., 4).

    Examples
    --------
    >>> mean([about_y(0.2), about_y(0.6)], [0.25, 0.75]).round(6) == about_y(0.5).round(6)
    array([ True,  True,  True,  True])
    """
    q = np.asarray(quaternions, float)
    if weights is None:
        average = np.linalg.eigh(np.swapaxes(q, -1, -2) @ q)[1][..., -1]
        return np.where(average[..., :1] < 0, -average, average)
    w = np.asarray(weights, float)[..., None]
    w = np.broadcast_to(w, (*np.broadcast_shapes(q.shape[:-1], w.shape[:-1]), 1))
    heaviest = np.take_along_axis(np.broadcast_to(q, (*w.shape[:-1], 4)), w.argmax(-2)[..., None], -2)
    q = np.where((q * heaviest).sum(-1, keepdims=True) < 0, -q, q)
    average = (w * q).sum(-2)
    average /= np.linalg.norm(average, axis=-1, keepdims=True)
    for _ in range(rounds):
        away = difference(average[..., None, :], q)
        average = multiply(average, from_rotvec((w * away).sum(-2)))
    return np.asarray(average)


def angle_between(first: ArrayLike, second: ArrayLike) -> Array:
    """Measure the angle, in [0, π] radians and shape (...), of the turn from one rotation to another.

    It is the length of their `difference`, exact for small angles, too.

    Examples
    --------
    >>> float(angle_between(about_y(0.1), about_y(-0.3)).round(6))
    0.4

    Notebook: 04-blending
    """
    return np.asarray(np.linalg.norm(difference(first, second), axis=-1))
