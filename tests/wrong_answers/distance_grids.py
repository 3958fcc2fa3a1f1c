import numpy as np


def add_up(products, window, step, rows, columns):
    total = np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            total[i, j] = sum(products[i + f, j + step(f)] for f in range(window))
    return total


def a_frame_short(products, window):
    n, m = products.shape
    return add_up(products, window - 1, lambda f: f, n - window + 2, m - window + 2)


def last_left_out(products, window):
    n, m = products.shape
    return add_up(products, window, lambda f: f, n - window, m - window)


def down_only(products, window):
    n, m = products.shape
    return add_up(products, window, lambda f: 0, n - window + 1, m - window + 1)


def other_diagonal(products, window):
    n, m = products.shape
    return add_up(products, window, lambda f: window - 1 - f, n - window + 1, m - window + 1)


def averaged(products, window):
    n, m = products.shape
    return add_up(products, window, lambda f: f, n - window + 1, m - window + 1) / window


def diagonals(grid):
    return [[grid[i, i + n] for i in range(len(grid) - n)] for n in range(len(grid))]


def summed(grid):
    return [sum(diagonal) for diagonal in diagonals(grid)]


def divided_by_all(grid):
    return [sum(diagonal) / len(grid) for diagonal in diagonals(grid)]


def roots_averaged(grid):
    return [np.mean(np.sqrt(diagonal)) for diagonal in diagonals(grid)]


def around_the_end(grid):
    count = len(grid)
    return [np.mean([grid[i, (i + n) % count] for i in range(count)]) for n in range(count)]


def rows_averaged(grid):
    return [row.mean() for row in grid]


def first_window(grid):
    return list(grid[0])


def without_itself(grid):
    return [np.mean(diagonal) for diagonal in diagonals(grid)][1:]


CROSS = ((-1, 0), (1, 0), (0, -1), (0, 1))
ALL = tuple((r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0))


def lower(grid, i, j, around):
    near = [(i + r, j + c) for r, c in around if 0 <= i + r < len(grid) and 0 <= j + c < len(grid[0])]
    return all(grid[i, j] < grid[place] for place in near)


def minima(grid, below, around=ALL, border=1):
    rows, columns = (range(border, count - border) for count in grid.shape)
    return [(i, j) for i in rows for j in columns if grid[i, j] < below and lower(grid, i, j, around)]


def with_border(grid, below):
    return minima(grid, below, border=0)


def four_neighbours(grid, below):
    return np.array(minima(grid, below, CROSS))


def without_threshold(grid, below):
    return minima(grid, np.inf)


def under_the_threshold(grid, below):
    return minima(grid, below, ())


def squared_threshold(grid, below):
    return minima(grid, below**2)


def columns_first(grid, below):
    return [(j, i) for i, j in minima(grid, below)]


def maxima(grid, below):
    return minima(-grid, np.inf)


WRONG = {
    "window_sums": [
        (a_frame_short, "off by one"),
        (last_left_out, "last window is missing"),
        (down_only, "along the diagonal"),
        (other_diagonal, "run backwards"),
        (averaged, "the mean"),
    ],
    "later_by": [
        (summed, "these are sums"),
        (divided_by_all, "become shorter"),
        (roots_averaged, "the costs themselves"),
        (around_the_end, "stop at the border"),
        (rows_averaged, "lie on a diagonal"),
        (first_window, "first window only"),
        (without_itself, "n = 0"),
    ],
    "inner_minima": [
        (with_border, "border do not count"),
        (four_neighbours, "across a corner"),
        (without_threshold, "above the threshold"),
        (under_the_threshold, "all entries under"),
        (squared_threshold, "do not square"),
        (columns_first, "the row first"),
        (maxima, "these are maxima"),
    ],
}
