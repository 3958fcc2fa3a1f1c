"""Dynamic time warping: the frame of one clip for each frame of another, by a path through a distance grid.

A path consists of the steps (1, 1), (1, 0) and (0, 1), therefore time is monotonic. At most W straight steps
in the same direction follow each other, therefore neither clip plays more than W + 1 times as fast as the
other. These are the constraints of [KG03]: continuity, causality and a slope limit.

The continuation of a path depends on the length of its last run of straight steps: the path of least cost to
a cell may not be extensible in the direction needed. Each length of a run is therefore a separate *state*.
With 2 W + 1 states for each cell, dynamic programming is exact. All cells of a row are computed at once:

    A[j] = 2 c + M₋[j - 1]                           after a diagonal step; ₋ is the row above
    V₁ = c + A₋,  V_k = c + V_{k - 1}₋               after k steps down
    H₁[j] = c + A[j - 1],  H_k[j] = c + H_{k - 1}[j - 1]     after k steps to the right
    M = the minimum of all of them

A run to the right is a chain of W shifted sums, and a row therefore takes only a few NumPy calls. The weight
of a cell is the number of frames by which it advances: 2 for a diagonal step and for the first cell, 1 for a
straight step. The sum of these weights depends only on the ends of a path, and detours have no advantage. For
W = 1 and 2 these are the symmetric rules of [SC78] for P = 1 and P = 1/2. (It has not been checked whether
[KG03] gives all steps the same weight. With weight 1 for all steps, the error of a recovered known timewarp
is 16 % larger. The free ends are ours.)
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Indices, Mask
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least
from mocap.errors import MocapError
from mocap.matching.time_bands import Band, whole_band

Floats = NDArray[np.floating[Any]]

ROUNDS = 50  # the largest number of iterations for the minimum mean, which takes two to four
SETTLED = 1e-9  # relative change of the mean at which the iteration has converged

# Relative to the largest cost: the tolerance for equal sums of costs, of which the first kind of step is
# chosen. The rounding error of a sum is about 1e-13 of that cost.
EQUAL = 1e-9


class PathSums(NamedTuple):
    """The best path to each cell, given by its sum and its last steps.

    totals : the minimum sum of a path that ends at a cell, infinite if there is none. The shape of this and
        the next two fields is that of the costs: (n, m), or (N,) for the N cells of a band.
    steps : the last steps of this path: 0 for a diagonal step, k for k steps down, W + k for k steps to the
        right.
    begins : whether the best path that reaches a cell by a diagonal step begins at this cell.
    slope : W.
    equal : the tolerance for equal sums, in the unit of the costs.
    band : the cells of the grid that are searched.
    """

    totals: Floats
    steps: NDArray[np.int8]
    begins: Mask
    slope: int
    equal: float
    band: Band


def path_sums(costs: Floats, starts: Mask, *, slope: int, band: Band | None = None) -> PathSums:
    """Compute the minimum sum of costs along a path to each cell, by dynamic programming over rows.

    Parameters
    ----------
    costs : shape (n, m), with weight 2 after a diagonal step and at the start of a path, and 1 otherwise.
        They may be negative: a path begins at a cell only if the sum of its diagonal predecessor is not.
    starts : the same shape, booleans: cells at which a path may begin. True everywhere is a local alignment.
    slope : W, from 1 to 63.
    band : the cells of the grid to which the paths are confined. Costs and starts then have the shape (N,),
        for each of its N cells.

    Returns
    -------
    The sums. Ties are broken in favour of a diagonal last step, then of fewer steps down, then of fewer steps
    to the right.

    Examples
    --------
    >>> corner = np.eye(2, dtype=bool) & [True, False]
    >>> path_sums(np.array([[1.0, 5], [5, 1]]), corner, slope=1).totals
    array([[2., 7.],
           [7., 4.]])
    """
    if band is None:
        band = whole_band(*costs.shape)
    cost_of_cells = costs.ravel()
    may_begin = starts.ravel()
    totals = np.empty_like(cost_of_cells)
    steps = np.empty(cost_of_cells.shape, np.int8)
    begins = np.zeros(cost_of_cells.shape, bool)
    # The states of a row and of the one above, shape (2 W + 1, m): A, V₁ … V_W, H₁ … H_W. They are infinite
    # to the right of a band, because its limits never fall.
    row_states, states_above = np.full((2, 2 * slope + 1, band.columns), np.inf, costs.dtype)
    lowest = np.full(band.columns + 1, np.inf, costs.dtype)  # M of the row above, one to the right
    equal = EQUAL * float(np.abs(cost_of_cells).max(initial=0.0, where=np.isfinite(cost_of_cells)))
    for first, stop, start in zip(band.first, band.stop, band.offsets[:-1], strict=True):
        cells = slice(start, start + stop - first)
        cost = cost_of_cells[cells]
        row = row_states[:, first:stop]
        diagonal = lowest[first:stop]  # the sums from which a diagonal step leads to this row
        if may_begin[cells].any():
            begins[cells] = may_begin[cells] & (diagonal >= 0)
            diagonal = np.where(begins[cells], 0, diagonal)
        np.add(diagonal + cost, cost, out=row[0])
        np.add(states_above[:slope, first:stop], cost, out=row[1 : slope + 1])
        row[slope + 1 :, 0] = np.inf  # nothing leads to the first cell of a row from its left
        np.add(row[0, :-1], cost[1:], out=row[slope + 1, 1:])
        for k in range(slope + 2, 2 * slope + 1):
            np.add(row[k - 1, :-1], cost[1:], out=row[k, 1:])
        lowest[first] = np.inf
        lowest[first + 1 : stop + 1] = np.minimum.reduce(row, out=totals[cells])
        steps[cells] = (row <= totals[cells] + equal).argmax(0)
        row_states, states_above = states_above, row_states
    shape = costs.shape
    return PathSums(totals.reshape(shape), steps.reshape(shape), begins.reshape(shape), slope, equal, band)


def origins(sums: PathSums) -> Indices:
    """Return, for each cell, the number of the cell at which its best path begins.

    Parameters
    ----------
    sums : of all (n, m) cells of a grid.

    Returns
    -------
    Shape (n, m): i · m + j for a path that begins at (i, j).

    Examples
    --------
    >>> sums = path_sums(np.array([[-1.0, 5], [5, -1]]), np.ones((2, 2), bool), slope=1)
    >>> origins(sums).tolist()
    [[0, 0], [0, 0]]
    """
    rows, columns = sums.steps.shape
    numbers = np.arange(rows * columns).reshape(rows, columns)
    runs_down = columns * np.arange(sums.slope + 1)
    runs_right = np.arange(1, sums.slope + 1)
    # For each cell, the cell at which the last run of straight steps on its best path starts.
    corners = numbers - np.concatenate([runs_down, runs_right])[sums.steps]
    best = np.empty_like(numbers)  # the origin of the best path
    after_diagonal = np.empty_like(numbers)  # the origin of the best path that ends with a diagonal step
    for i in range(rows):
        beside_diagonal = np.roll(best[i - 1], 1)
        after_diagonal[i] = np.where(sums.begins[i], numbers[i], beside_diagonal)
        best[i] = after_diagonal.ravel()[corners[i]]
    return best


def trace(sums: PathSums, end: tuple[int, int]) -> Indices:
    """Backtrack the best path to a cell.

    Parameters
    ----------
    sums : from `path_sums`.
    end : a cell whose total is finite.

    Returns
    -------
    The cells of the path from its first to this one, shape (N, 2).

    Examples
    --------
    >>> corner = np.eye(2, dtype=bool) & [True, False]
    >>> trace(path_sums(np.zeros((2, 2)), corner, slope=1), (1, 1)).tolist()
    [[0, 0], [1, 1]]
    """
    i, j = end
    cells = [(i, j)]
    steps = sums.steps.ravel()
    begins = sums.begins.ravel()
    first_columns = sums.band.first
    offsets = sums.band.offsets
    while True:
        cell = offsets[i] + j - first_columns[i]
        step = int(steps[cell])
        down = step <= sums.slope
        for _ in range(step if down else step - sums.slope):
            if down:
                i -= 1
            else:
                j -= 1
            cells.append((i, j))
        if begins[offsets[i] + j - first_columns[i]]:
            return np.array(cells[::-1])
        i -= 1
        j -= 1
        cells.append((i, j))


def time_path(grid: ArrayLike, *, slope: int = 2, slack: int = 0) -> Indices:
    """Find the path of minimum mean cost through a grid, from its first corner to its last.

    In the paper: [KG03, time path].

    The path begins in the first row or column and ends in the last one, each within `slack` of the corner. It
    minimises the mean Σ c a / Σ a, where a is the number of frames by which a cell advances (as in
    `path_mean`). The minimum *sum* would prefer short paths that cut off the corners. The minimum mean is
    computed by Dinkelbach's method [Din67]: subtract the mean of the last path from the grid, find the path
    of minimum sum, and repeat until the mean converges. (The free ends are ours.)

    Parameters
    ----------
    grid : shape (n, m), the cost of matching each frame of one clip with each frame of another, for example
        √D of `distance_grid`.
    slope : W, the largest number of consecutive straight steps in one direction.
    slack : the largest number of frames of one clip that are skipped at the start, and also at the end.

    Returns
    -------
    The cells (i, j) of the path, shape (N, 2), in ascending order.

    Raises
    ------
    MocapError : for a grid that is empty, does not have two dimensions, or contains a number that is not
        finite. Also for a slope outside 1 … 63, a slack below 0 or as long as a clip, and lengths that the
        slope does not allow.

    Examples
    --------
    >>> rows, columns = np.indices((7, 4))
    >>> time_path(np.abs(rows - 2 * columns)).tolist()
    [[0, 0], [1, 0], [2, 1], [3, 1], [4, 2], [5, 2], [6, 3]]

    Notebook: 15-registration
    """
    costs = np.asarray(grid, float)
    if costs.ndim != 2 or not costs.size or not np.isfinite(costs.sum()):
        raise MocapError(f"A path needs a grid of finite numbers, of two dimensions, got {costs.shape}.")
    return least_mean_path(costs.ravel(), whole_band(*costs.shape), slope, slack)


def least_mean_path(costs: Floats, band: Band, slope: int, slack: int) -> Indices:
    """Find the path of minimum mean cost through a band of a grid, as `time_path` does through a whole grid.

    Parameters
    ----------
    costs : shape (N,), of the cells of the band.
    band : the cells of the grid to which the path is confined.
    slope, slack : as for `time_path`.

    Returns
    -------
    The cells (i, j) of the path, shape (N, 2), in ascending order.

    Raises
    ------
    MocapError : for a slope outside 1 … 63, a slack below 0 or as long as a clip, and lengths that the slope
        does not allow.
    """
    shortest = min(len(band.first), band.columns)
    if not (1 <= slope <= 63 and 0 <= slack < shortest):
        limits = f"slack from 0 to less than the {shortest} frames of a clip"
        raise MocapError(f"A path needs a slope from 1 to 63 and {limits}, got {slope} and {slack}.")
    starts, ends = _corners(band, slack)
    # The initial estimate of the mean.
    level = float(np.minimum.reduceat(costs, band.offsets[:-1]).mean()) if slack else 0.0
    for _ in range(ROUNDS):
        sums = path_sums(costs - level, starts, slope=slope, band=band)
        totals = sums.totals[ends]
        if not np.isfinite(totals.min()):
            frames = f"{len(band.first)} frames cannot be laid on {band.columns}"
            raise MocapError(f"{frames} with slope {slope}: at most {slope + 1} to 1.")
        path = trace(sums, band.place(int(ends[first_least(totals, sums.equal)])))
        previous_level = level
        level = mean_of_cells(costs[band.cells(path[:, 0], path[:, 1])], path)
        if not slack or abs(level - previous_level) <= SETTLED * abs(level):
            break
    return path


def _corners(band: Band, slack: int) -> tuple[Mask, Indices]:
    """Return the cells of a band at which a path may begin, as booleans, and those at which it may end."""
    rows = np.arange(slack + 1)
    last_rows = len(band.first) - 1 - rows[::-1]
    starts = np.zeros(band.offsets[-1], bool)
    starts[: min(slack + 1, band.stop[0])] = True
    starts[band.offsets[rows[band.first[rows] == 0]]] = True
    ends = np.zeros(band.offsets[-1], bool)
    ends[max(band.offsets[-1] - slack - 1, band.offsets[-2]) :] = True
    ends[band.offsets[last_rows[band.stop[last_rows] == band.columns] + 1] - 1] = True
    return starts, np.flatnonzero(ends)


def path_mean(grid: ArrayLike, path: ArrayLike) -> float:
    """Compute the mean of a grid along a path, each cell weighted by the frames by which it advances.

    Parameters
    ----------
    grid : shape (n, m).
    path : cells, shape (N, 2). The weight of the first cell and of a diagonal step is 2, of all others 1.

    Examples
    --------
    >>> rows, columns = np.indices((7, 4))
    >>> grid = np.abs(rows - 2 * columns)
    >>> round(path_mean(grid, time_path(grid)), 4)  # 3 / 11
    0.2727

    Notebook: 15-registration
    """
    cells = np.asarray(path)
    return mean_of_cells(np.asarray(grid)[cells[:, 0], cells[:, 1]], cells)


def mean_of_cells(values: NDArray[Any], path: Indices) -> float:
    """Compute the mean of values at the cells of a path, weighted as by `path_mean`."""
    advanced = np.append(2, np.abs(np.diff(path, axis=0)).sum(axis=1))
    return float(np.average(values, weights=advanced))
