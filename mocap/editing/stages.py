"""The stages of the solver: the curves that a change may follow, and their banded least squares."""

import numpy as np
from scipy import sparse
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array, Mask
from mocap._shared.records import dataclass
from mocap.editing.displacements import spline_basis
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError

RIDGE = 1e-13  # of the largest entry: a clip of fewer frames than splines leaves some of them unseen


@dataclass(frozen=True)
class Stage:
    """A stage of the solver: how a change may vary over time, and how it is solved for.

    Parameters
    ----------
    knots : seconds between the knots of its splines: 0.5 leaves centimetres, 0.125 millimetres, and below
        accelerations grow. With 0 each frame has its own numbers.
    decay : τ, seconds: a change decays within about τ of a constraint. With 0 bends cost nothing.
    weight : w, per metre. On splines 100 leaves 10 mm on a stone of 20 cm, 300 leaves 3 mm, 1000 no less.
    damping : λ at first, as a fraction of the prices: a step is one of the weight w / √(1 + λ).
    passes : iterations at most.
    lead : seconds: above 0 joints are led from constraint to constraint, and to the first and from the last
        in this time.

    Raises
    ------
    MocapError : for a number below 0, and a weight or passes that are not above 0.

    Examples
    --------
    >>> Stage()
    Stage(knots=0.0, decay=0.0, weight=300.0, damping=1.0, passes=30, lead=0.0)
    >>> [stage.is_framewise for stage in (Stage(), Stage(knots=0.125), Stage(decay=0.1))]
    [True, False, False]

    Notebook: 14-levels
    """

    knots: float = 0.0
    decay: float = 0.0
    weight: float = 300.0
    damping: float = 1.0
    passes: int = 30
    lead: float = 0.0

    def __post_init__(self) -> None:
        for name in ("weight", "passes"):
            if not getattr(self, name) > 0:
                raise MocapError(f"A stage needs a number above 0, got {name}={getattr(self, name)}.")
        for name in ("knots", "decay", "damping", "lead"):
            if not getattr(self, name) >= 0:
                raise MocapError(f"A stage needs numbers of 0 or more, got {name}={getattr(self, name)}.")

    @property
    def is_framewise(self) -> bool:
        """Whether each frame is solved by itself."""
        return self.knots == self.decay == 0


REACH = Stage(weight=TUNED.reach_weight, damping=TUNED.reach_damping, passes=TUNED.reach_passes)
"""Each frame by itself: inverse kinematics, as [LS99] need it."""


def closing_stages() -> tuple[Stage, Stage]:
    """Return the stages that meet constraints exactly, after a stage of splines.

    Examples
    --------
    >>> [stage.is_framewise for stage in closing_stages()]
    [False, False]
    """
    stage = Stage(
        decay=TUNED.close_decay,
        weight=TUNED.close_weight,
        damping=TUNED.close_damping,
    )
    return stage, stage


class Curve:
    """The curves x = B c over F frames that a stage allows, and the least squares of control points c (K, n).

    `basis` is B (F, K), `bends` are τ² times its second differences (F - 2, K). Splines that are far apart
    share no frame and no bend. Therefore the equations are banded, and the time is linear in F. Splines that
    would change a frame that stays are left out.

    Parameters
    ----------
    stage : of the solver.
    frames : their number F.
    fps : frames per second.
    price : shape (n,).
    stays : shape (F,), frames at the beginning and the end that do not change; by default none.
    """

    def __init__(
        self, stage: Stage, frames: int, fps: float, price: Array, stays: Mask | None = None
    ) -> None:
        self.weight = stage.weight
        self.price = price
        self.is_framewise = stage.is_framewise
        if stage.knots and frames:
            self.basis = spline_basis(frames, stage.knots * fps)
        else:
            self.basis = sparse.eye_array(frames, format="csr")
        if stays is not None and stays.any():
            is_still = self.basis[stays].sum(axis=0) == 0
            self.basis = self.basis[:, np.flatnonzero(is_still)]
        inner = max(frames - 2, 0)
        following = self.basis[1 : inner + 1]
        second = self.basis[:inner] - 2 * following + self.basis[2 : inner + 2]
        self.bends = (stage.decay * fps) ** 2 * second
        width = 1 + self._largest_distance()
        self.products = _products(self.basis, width)
        self.bend_products = [product.sum(axis=1) for product in _products(self.bends, width)]

    def _largest_distance(self) -> int:
        """Return the largest k - l for splines k and l that share a frame or a bend."""
        overlap = self.basis.T @ self.basis + abs(self.bends.T) @ abs(self.bends)
        pairs = overlap.tocoo()
        return int((pairs.col - pairs.row).max(initial=0))

    def step(self, c: Array, residual: Array, jacobian: Array, damping: Array) -> Array:
        """Compute one step of Levenberg and Marquardt: the next control points c (K, n).

        With the residual r, the Jacobian J that `Pins.linearised` returns, and the price P of c,
        ‖c'‖²_P + w² ‖r - J (c' - c)‖² + λ ‖c' - c‖²_P is least if

            (w² JᵀJ + (1 + λ) P) c' = w² Jᵀ (r + J c) + λ P c;

        λ is (1, 1), or (F, 1) by frame. These large matrices are banded.
        """
        spans, n = c.shape
        x = self.basis @ c
        weighted = self.weight**2 * np.swapaxes(jacobian, 1, 2)
        matrix = weighted @ jacobian
        diagonal = np.arange(n)
        matrix[:, diagonal, diagonal] += (1 + damping) * self.price
        target = residual + np.einsum("fmn,fn->fm", jacobian, x)
        pull = np.einsum("fnm,fm->fn", weighted, target) + damping * self.price * x
        bend_pull = damping * self.price * (self.bends.T @ (self.bends @ c))
        right_side = self.basis.T @ pull + bend_pull
        band = self._band(matrix, damping)
        band[0] += RIDGE * band[0].max()
        solution = solveh_banded(band, right_side.ravel(), lower=True, check_finite=False)
        return np.asarray(solution.reshape(spans, n))

    def _band(self, matrix: Array, damping: Array) -> Array:
        """Build the banded matrix Bᵀ G B + (1 + λ) P of bends, of matrices G (F, n, n) in single frames.

        In the lower form of `solveh_banded`, the entry (i, j) is at (i - j, j).
        """
        spans = self.basis.shape[1]
        n = matrix.shape[-1]
        diagonal = np.arange(n)
        band = np.zeros((len(self.products) * n, spans * n))
        flat = matrix.reshape(len(matrix), -1)
        for distance, (product, bent) in enumerate(zip(self.products, self.bend_products, strict=True)):
            blocks = (product @ flat).reshape(-1, n, n)  # (K - d, n, n), of splines k and k + d
            blocks[:, diagonal, diagonal] += (1 + damping) * bent[:, None] * self.price
            stop = (spans - distance) * n
            for column in range(n):
                top = max(distance * n - column, 0)
                bottom = (distance + 1) * n - column
                first = top - distance * n + column  # of the block's column: the part below the diagonal
                band[top:bottom, column:stop:n] = blocks[:, column, first:].T
        return band

    def cost(self, c: Array, residual: Array) -> Array:
        """Compute the cost to be minimised, of each frame by itself (F, 1), or of all together (1, 1)."""
        of_change = ((self.basis @ c) ** 2) @ self.price
        of_frames = of_change + self.weight**2 * (residual**2).sum(axis=1)
        if self.is_framewise:
            return np.asarray(of_frames[:, None])
        of_bends = ((self.bends @ c) ** 2) @ self.price
        return np.array([[of_frames.sum() + of_bends.sum()]])


def _products(splines: sparse.csr_array, width: int) -> list[sparse.csr_array]:
    """Compute b_k b_{k+d} in each frame, (K - d, F), of the columns of splines, for d from 0 to width - 1."""
    columns = splines.tocsc()
    count = columns.shape[1]
    products = []
    for distance in range(width):
        product = columns[:, : count - distance] * columns[:, distance:]
        products.append(product.T.tocsr())
    return products
