"""Which frame of one clip belongs to which of another: the best path through a grid of their distances.

A path goes down and to the right by the steps (1, 1), (1, 0) and (0, 1), so time never runs backwards. At
most W straight steps of one direction follow each other, so neither clip plays more than W + 1 times as fast
as the other. [KG03] asks for the same three things: continuity, causality and a limit of the slope.

The best way to a cell depends on how long the last run of straight steps is: a path that has used up its run
may be cheaper and still the wrong one to go on with. So each length of the run is a *state* of its own,
2 W + 1 of them for each cell, and dynamic programming is exact. All cells of a row are worked on at once:

    A[j] = 2 c + M₋[j - 1]                           after a diagonal step; ₋ is the row above
    V₁ = c + A₋,  V_k = c + V_{k - 1}₋               after k steps down
    H₁[j] = c + A[j - 1],  H_k[j] = c + H_{k - 1}[j - 1]     after k steps to the right
    M = the least of all of them

A run to the right is a chain of W shifted sums, which is why a row needs only few calls of NumPy. A cell
counts by the frames it advances, 2 for a diagonal step and for the first cell, 1 for a straight one: so the
sum of these weights depends on a path's ends alone, and detours gain nothing. For W = 1 and 2 these are the
symmetric rules of [SC78] for P = 1 and P = 1/2. (That [KG03] weighs all steps alike is recalled, not checked.
With the weight 1 for all of them, a known timewarp comes back 16 % less exactly. The free ends are ours.)
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Indices, Mask
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least
from mocap.errors import MocapError

Floats = NDArray[np.floating[Any]]

ROUNDS = 50  # of the search for the least mean, which takes two to four
SETTLED = 1e-9  # of the mean: a round that changes it by no more is the last

# Of the largest cost: sums of costs that differ by less are equal, and the earlier kind of step is taken.
# Rounding of a sum is some 1e-13 of that cost.
EQUAL = 1e-9


class PathSums(NamedTuple):
    """The best path to each cell, by its sum and its last step.

    totals : (n, m), the least sum of a path that ends there; infinite where none does.
    steps : (n, m), how this path ends: 0 for a diagonal step, k for k steps down, W + k for k to the right.
    begins : (n, m), whether a path that is here after a diagonal step begins here.
    slope : W.
    equal : sums that differ by no more are equal, in the unit of the costs.
    """

    totals: Floats
    steps: NDArray[np.int8]
    begins: Mask
    slope: int
    equal: float


def path_sums(costs: Floats, starts: Mask, *, slope: int) -> PathSums:
    """Add up costs along the best path to each cell, row by row.

    Parameters
    ----------
    costs : shape (n, m); each counts 2 after a diagonal step and where a path begins, and 1 otherwise. They
        may be negative: a path begins afresh only where the best sum before is not below 0.
    starts : shape (n, m), booleans: where a path may begin. True everywhere makes it a local alignment.
    slope : W, at least 1 and at most 63.

    Returns
    -------
    The sums. Of equal paths to a cell the one is kept that ends with a diagonal step, else with fewer steps
    down, else with fewer to the right.

    Examples
    --------
    >>> corner = np.eye(2, dtype=bool) & [True, False]
    >>> path_sums(np.array([[1.0, 5], [5, 1]]), corner, slope=1).totals
    array([[2., 7.],
           [7., 4.]])
    """
    totals = np.empty_like(costs)
    steps = np.empty(costs.shape, np.int8)
    begins = np.zeros(costs.shape, bool)
    has_start = np.asarray(starts.any(axis=1))
    # The states of a row and of the one above, shape (2 W + 1, m): A, V₁ … V_W, H₁ … H_W.
    row, above = np.full((2, 2 * slope + 1, costs.shape[1]), np.inf, costs.dtype)
    lowest = np.full(costs.shape[1] + 1, np.inf, costs.dtype)  # M of the row above, one to the right
    equal = EQUAL * float(np.abs(costs).max(initial=0.0, where=np.isfinite(costs)))
    for i, cost in enumerate(costs):
        diagonal = lowest[:-1]  # the sums from which a diagonal step leads to this row
        if has_start[i]:
            begins[i] = starts[i] & (diagonal >= 0)
            diagonal = np.where(begins[i], 0, diagonal)
        np.add(diagonal + cost, cost, out=row[0])
        np.add(above[:slope], cost, out=row[1 : slope + 1])
        np.add(row[0, :-1], cost[1:], out=row[slope + 1, 1:])
        for k in range(slope + 2, 2 * slope + 1):
            np.add(row[k - 1, :-1], cost[1:], out=row[k, 1:])
        lowest[1:] = np.minimum.reduce(row, out=totals[i])
        steps[i] = (row <= totals[i] + equal).argmax(0)
        row, above = above, row
    return PathSums(totals, steps, begins, slope, equal)


def origins(sums: PathSums) -> Indices:
    """Find, for each cell, the number of the cell where its best path begins.

    Parameters
    ----------
    sums : of (n, m) cells.

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
    # For each cell the last one after a diagonal step on its best path: before its run of straight steps.
    corners = numbers - np.concatenate([runs_down, runs_right])[sums.steps]
    best = np.empty_like(numbers)  # the cell where the best path begins
    after_diagonal = np.empty_like(numbers)  # and where the best one that ends with a diagonal step does
    for i in range(rows):
        beside_diagonal = np.roll(best[i - 1], 1)
        after_diagonal[i] = np.where(sums.begins[i], numbers[i], beside_diagonal)
        best[i] = after_diagonal.ravel()[corners[i]]
    return best


def trace(sums: PathSums, end: tuple[int, int]) -> Indices:
    """Walk back from a cell to where its best path begins.

    Parameters
    ----------
    sums : as by `path_sums`.
    end : a cell whose total is finite.

    Returns
    -------
    The path's cells from its first to this one, shape (N, 2).

    Examples
    --------
    >>> corner = np.eye(2, dtype=bool) & [True, False]
    >>> trace(path_sums(np.zeros((2, 2)), corner, slope=1), (1, 1)).tolist()
    [[0, 0], [1, 1]]
    """
    i, j = end
    cells = [(i, j)]
    while True:
        step = int(sums.steps[i, j])
        down = step <= sums.slope
        for _ in range(step if down else step - sums.slope):
            if down:
                i -= 1
            else:
                j -= 1
            cells.append((i, j))
        if sums.begins[i, j]:
            return np.array(cells[::-1])
        i -= 1
        j -= 1
        cells.append((i, j))


def time_path(grid: ArrayLike, *, slope: int = 2, slack: int = 0) -> Indices:
    """Find the path through a grid whose mean is least, from its first corner to its last or nearly so.

    In the paper: [KG03, time path].

    It begins in the first row or column and ends in the last one, each at most `slack` from the corner. Of
    all such paths it is the one of the least mean Σ c a / Σ a, where a counts the frames that a cell advances
    (as in `path_mean`). The least *sum* would prefer short paths that cut the corners. The least mean is
    found by Dinkelbach's way [Din67]: subtract the mean of the last path from the grid, find the least sum,
    and repeat until the mean stays. (The free ends are ours.)

    Parameters
    ----------
    grid : shape (n, m), how badly each frame of one clip fits each of another: √D of `distance_grid`, say.
    slope : W, how many straight steps of one direction may follow each other.
    slack : how many frames of one clip may be left out at the start, and how many at the end.

    Returns
    -------
    The path's cells (i, j), shape (N, 2); both columns never fall.

    Raises
    ------
    MocapError : for a grid that is not of two dimensions, is empty or holds a number that is not finite; for
        a slope outside 1 … 63, a slack below 0 or as long as a clip, and lengths that no slope allows.

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
    if not (1 <= slope <= 63 and 0 <= slack < min(costs.shape)):
        short = f"slack from 0 to less than the {min(costs.shape)} frames of a clip"
        raise MocapError(f"A path needs a slope from 1 to 63 and {short}, got {slope} and {slack}.")
    starts = np.zeros(costs.shape, bool)
    starts[0, : slack + 1] = True
    starts[: slack + 1, 0] = True
    ends = np.argwhere(starts[::-1, ::-1])
    level = float(costs.min(axis=1).mean()) if slack else 0.0  # a mean that is nearly that of the path
    for _ in range(ROUNDS):
        sums = path_sums(costs - level, starts, slope=slope)
        totals = sums.totals[ends[:, 0], ends[:, 1]]
        if not np.isfinite(totals.min()):
            frames = f"{len(costs)} frames cannot be laid on {costs.shape[1]}"
            raise MocapError(f"{frames} with slope {slope}: at most {slope + 1} to 1.")
        end = ends[first_least(totals, sums.equal)]
        path = trace(sums, (int(end[0]), int(end[1])))
        previous_level = level
        level = path_mean(costs, path)
        if not slack or abs(level - previous_level) <= SETTLED * abs(level):
            break
    return path


def path_mean(grid: ArrayLike, path: ArrayLike) -> float:
    """Average a grid along a path, each cell weighted by the frames it advances.

    Parameters
    ----------
    grid : shape (n, m).
    path : cells, shape (N, 2). The first one and those after a diagonal step count 2, all others 1.

    Examples
    --------
    >>> rows, columns = np.indices((7, 4))
    >>> grid = np.abs(rows - 2 * columns)
    >>> path_mean(grid, time_path(grid)) == 3 / 11
    True

    Notebook: 15-registration
    """
    values = np.asarray(grid)
    cells = np.asarray(path)
    advanced = np.append(2, np.abs(np.diff(cells, axis=0)).sum(axis=1))
    return float(np.average(values[cells[:, 0], cells[:, 1]], weights=advanced))
