"""Unit quaternions as arrays `(..., 4)`, scalar first (w, x, y, z).

All functions broadcast over the leading axes, and also take a single quaternion. Rotations apply to column
vectors: `rotate(multiply(a, b), v)` rotates v by b first, then by a.

Products, rotation vectors and slerp follow their formulas. On arrays, products and slerp are several times
faster than those of SciPy's `Rotation`, against which the tests check them. Matrices are computed by SciPy.
Quaternions are not normalised: results have length 1, up to rounding, if the arguments have.

Notebooks: 01-skeletons-and-clips, 04-blending (slerp).
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array, frozen

IDENTITY: Array = frozen([1.0, 0.0, 0.0, 0.0], np.float64)
Z_UP: Array = frozen([0.5**0.5, -(0.5**0.5), 0.0, 0.0], np.float64)  # rotates +z to +y

TINY_ANGLE = 1e-9  # radians, in place of 0, by which nothing can be divided

# Entries of a quaternion.
W = 0
X = 1
Y = 2
Z = 3
VECTOR = slice(1, None)


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

    For q = (w, v) of length 1 the matrix is (w² - v·v) I + 2 v vᵀ + 2 w [v]×, where [v]× u = v × u.
    Other quaternions are normalised first.

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

    This is the exponential map: the rotation by θ about the unit axis n is q = (cos θ/2, n sin θ/2).

    Examples
    --------
    >>> from_rotvec([0, 0, np.pi]).round(6) + 0.0
    array([0., 0., 0., 1.])

    Notebook: 03b-angles
    """
    vectors = np.asarray(vectors, float)
    half = np.linalg.norm(vectors, axis=-1, keepdims=True) / 2
    # n sin θ/2 = vector / 2 · sinc(θ/2), where NumPy's sinc(x) is sin(πx) / (πx)
    return np.concatenate([np.cos(half), vectors / 2 * np.sinc(half / np.pi)], axis=-1)


def to_rotvec(quaternions: ArrayLike) -> Array:
    """Convert quaternions to rotation vectors, shape (..., 3), of at most π radians.

    This is the logarithm: (w, v) with w ≥ 0 is the rotation by θ = 2 atan2(|v|, w) about v. If w < 0, the
    same rotation -q is used.

    Examples
    --------
    >>> to_rotvec(about_y(-0.5)).round(6) + 0.0
    array([ 0. , -0.5,  0. ])

    Notebook: 15-registration
    """
    quaternions = np.asarray(quaternions, float)
    scalar = quaternions[..., :1]
    vector = quaternions[..., VECTOR]
    sine = np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-300)  # never 0 / 0
    angle = 2 * np.arctan2(sine, np.abs(scalar))
    return np.asarray(angle / sine * np.where(scalar < 0, -vector, vector))


def about_y(angles: ArrayLike) -> Array:
    """Build rotations by `angles` (radians, shape (...)) about the vertical axis +y, shape (..., 4).

    Examples
    --------
    >>> rotate(about_y(np.pi / 2), [0, 0, 1]).round(6) + 0.0
    array([1., 0., 0.])
    """
    half = np.asarray(angles, float) / 2
    quaternions = np.zeros((*half.shape, 4))
    quaternions[..., W] = np.cos(half)
    quaternions[..., Y] = np.sin(half)
    return quaternions


def multiply(first: ArrayLike, second: ArrayLike) -> Array:
    """Compose rotations by Hamilton's product: the result rotates by `second`, then by `first`.

    (w₁, v₁)(w₂, v₂) = (w₁w₂ - v₁·v₂, w₁v₂ + w₂v₁ + v₁ × v₂); shapes (..., 4) broadcast.

    Examples
    --------
    >>> to_rotvec(multiply(about_y(0.1), about_y(0.2))).round(6)
    array([0. , 0.3, 0. ])

    Notebook: 01-skeletons-and-clips
    """
    first = np.asarray(first, float)
    second = np.asarray(second, float)
    w1, x1, y1, z1 = (first[..., k] for k in range(4))
    w2, x2, y2, z2 = (second[..., k] for k in range(4))
    product = np.empty(np.broadcast_shapes(first.shape, second.shape))  # faster than np.stack
    product[..., W] = w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2
    product[..., X] = w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2
    product[..., Y] = w1 * y2 + y1 * w2 + z1 * x2 - x1 * z2
    product[..., Z] = w1 * z2 + z1 * w2 + x1 * y2 - y1 * x2
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
    """Rotate vectors, shape (..., 3), by quaternions, shape (..., 4); leading axes broadcast.

    Examples
    --------
    >>> rotate([1, 0, 0, 0], [1, 2, 3])
    array([1., 2., 3.])

    Notebook: 01-skeletons-and-clips
    """
    return np.asarray((to_matrix(quaternions) @ np.asarray(vectors, float)[..., None])[..., 0])


def between(start: ArrayLike, end: ArrayLike) -> Array:
    """Build the shortest rotation from one direction to another: q ~ (|a| |b| + a·b, a × b).

    Parameters
    ----------
    start, end : a and b, shape (..., 3), of any length except 0. Between opposite directions the shortest
        rotation is not unique, and the result is not a rotation.

    Examples
    --------
    >>> to_rotvec(between([0, 0, 1], [2, 0, 0])).round(4) + 0.0
    array([0.    , 1.5708, 0.    ])
    """
    a = _normalised(start)
    b = _normalised(end)
    cosine = (a * b).sum(-1, keepdims=True)
    return _normalised(np.concatenate([1 + cosine, np.cross(a, b)], axis=-1))


def _normalised(vectors: ArrayLike) -> Array:
    """Scale vectors, along the last axis, to length 1."""
    return np.asarray(np.asarray(vectors, float) / np.linalg.norm(vectors, axis=-1, keepdims=True))


def difference(start: ArrayLike, end: ArrayLike) -> Array:
    """Return the rotation vector from one rotation to another, in the frame of the first: log(a⁻¹ b).

    Parameters
    ----------
    start, end : a and b, shape (..., 4).

    Returns
    -------
    Shape (..., 3), of length at most π radians.

    Examples
    --------
    >>> difference(about_y(0.2), about_y(0.5)).round(6)
    array([0. , 0.3, 0. ])
    """
    return to_rotvec(multiply(inverse(start), end))


def slerp(start: ArrayLike, end: ArrayLike, amount: ArrayLike) -> Array:
    """Spherical linear interpolation (slerp) along the shorter arc: start · exp(amount · log(start⁻¹ · end)).

    With the angle φ between the two quaternions as vectors, cos φ = |start · end|, this is
    (sin((1 - amount) φ) start ± sin(amount φ) end) / sin φ. The sign is that of start · end: of q and -q, the
    same rotation, the one nearer to `start` is taken.

    Parameters
    ----------
    start, end : shape (..., 4).
    amount : shape (...), 0 at `start`, 1 at `end`.

    Returns
    -------
    Quaternions, shape (..., 4).

    Examples
    --------
    >>> to_rotvec(slerp(about_y(0.2), about_y(0.4), 0.5)).round(6)
    array([0. , 0.3, 0. ])

    Notebook: 04-blending
    """
    start = np.asarray(start, float)
    end = np.asarray(end, float)
    amount = np.asarray(amount, float)
    cosine = np.einsum("...i,...i->...", start, end)
    angle = np.arccos(np.minimum(np.abs(cosine), 1))
    # Of equal rotations any weights will do whose sum is one: a tiny angle gives 1 - amount and amount.
    angle = np.maximum(angle, TINY_ANGLE)
    sine = np.sin(angle)
    start_weight = np.sin((1 - amount) * angle) / sine
    end_weight = np.sin(amount * angle) * np.copysign(1 / sine, cosine)
    result = start * start_weight[..., None]
    result += end * end_weight[..., None]
    return np.asarray(result)


def continuous(quaternions: ArrayLike) -> Array:
    """Make quaternions (F, ..., 4) continuous: of q and -q, choose the one nearer to the previous frame.

    Examples
    --------
    >>> continuous([[1, 0, 0, 0], [-1, 0, 0, 0], [-0.6, 0.8, 0, 0]])[:, 0].tolist()
    [1.0, 1.0, 0.6]
    """
    q = np.asarray(quaternions, float)
    cosines = (q[1:] * q[:-1]).sum(-1, keepdims=True)
    signs = np.cumprod(np.where(cosines < 0, -1.0, 1.0), axis=0)
    return np.concatenate([q[:1], q[1:] * signs])


def nearest(matrices: Array) -> Array:
    """Project matrices (..., 3, 3) to the nearest rotations: R = U diag(1, 1, ±1) Vᵀ from the SVD of M.

    They maximise tr(Rᵀ M), and therefore minimise the Frobenius norm of R - M.

    Examples
    --------
    >>> nearest(np.diag([2.0, 1.0, 0.5])).diagonal()
    array([1., 1., 1.])
    """
    left, _, right = np.linalg.svd(matrices)
    left[..., 2] *= np.linalg.det(left @ right)[..., None]
    return np.asarray(left @ right)


def mean(quaternions: ArrayLike, weights: ArrayLike | None = None, *, rounds: int = 1) -> Array:
    """Weighted mean of rotations.

    The signs of the quaternions are chosen for the hemisphere of the rotation with the largest weight. The
    normalised weighted sum approximates the Karcher mean m, for which Σ w log(m⁻¹ q) = 0. Each iteration,
    m ← m exp(Σ w log(m⁻¹ q)), reduces the residual. For two rotations, one iteration is `slerp`. Without
    weights, the mean is the q that maximises Σ (q · qᵢ)², an eigenvector of Σ qᵢ qᵢᵀ.

    Parameters
    ----------
    quaternions : shape (..., C, 4).
    weights : shape (..., C), leading axes broadcast. Their sum is one, and some may be negative.
    rounds : the number of iterations; 0 for the weighted sum, which takes a third of the time. Its error is
        up to 8° for random rotations, and less than 1 mm at the hands of similar poses.

    Returns
    -------
    Shape (..., 4).

    Examples
    --------
    >>> to_rotvec(mean([about_y(0.2), about_y(0.6)], [0.25, 0.75])).round(6)
    array([0. , 0.5, 0. ])
    """
    q = np.asarray(quaternions, float)
    if weights is None:
        return _unweighted_mean(q)
    shape = np.broadcast_shapes(q.shape[:-1], np.shape(weights))
    w = np.broadcast_to(np.asarray(weights, float), shape)[..., None]
    heaviest = np.take_along_axis(np.broadcast_to(q, (*shape, 4)), w.argmax(-2)[..., None], -2)
    q = np.where((q * heaviest).sum(-1, keepdims=True) < 0, -q, q)
    average = _normalised((w * q).sum(-2))
    for _ in range(rounds):
        residuals = difference(average[..., None, :], q)
        average = multiply(average, from_rotvec((w * residuals).sum(-2)))
    return average


def _unweighted_mean(q: Array) -> Array:
    """Mean of rotations (..., C, 4): the eigenvector of Σ qᵢ qᵢᵀ with the largest eigenvalue, and w ≥ 0."""
    _, eigenvectors = np.linalg.eigh(np.swapaxes(q, -1, -2) @ q)
    average = eigenvectors[..., -1]
    return np.where(average[..., :1] < 0, -average, average)


def angle_between(first: ArrayLike, second: ArrayLike) -> Array:
    """Return the angle of the rotation from one orientation to another, shape (...), radians in [0, π].

    It is the length of their `difference`, and therefore accurate for small angles.

    Examples
    --------
    >>> float(angle_between(about_y(0.1), about_y(-0.3)).round(6))
    0.4

    Notebook: 04-blending
    """
    return np.asarray(np.linalg.norm(difference(first, second), axis=-1))
