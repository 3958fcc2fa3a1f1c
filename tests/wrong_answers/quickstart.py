import numpy as np


def with_height(positions, fps):
    return np.sqrt((np.diff(positions, axis=0) ** 2).sum(1)) * fps


def a_frame(positions, fps):
    step = positions[1:] - positions[:-1]
    return np.sqrt(step[:, 0] ** 2 + step[:, 2] ** 2)


def divided(positions, fps):
    return a_frame(positions, fps) / fps


def of_xy(positions, fps):
    step = positions[1:] - positions[:-1]
    return np.sqrt(step[:, 0] ** 2 + step[:, 1] ** 2) * fps


def least_of_all(grid, minima):
    return np.unravel_index(grid.argmin(), grid.shape)


def its_number(grid, minima):
    return int(np.argmin([grid[i, j] for i, j in minima]))


def worst(grid, minima):
    return max(minima.tolist(), key=lambda ij: grid[ij[0], ij[1]])


def its_cost(grid, minima):
    return min(grid[i, j] for i, j in minima)


def no_way_in(edges):
    ends = [end for _, end in edges]
    return {start for start, _ in edges if start not in ends}


def among_starts(edges):
    starts = [start for start, _ in edges]
    return {start for start in starts if start not in starts}


def again_and_again(edges):
    found = set()
    while True:
        left = [(a, b) for a, b in edges if b not in found]
        new = {b for _, b in left} - {a for a, _ in left}
        if not new:
            return found
        found |= new


def a_list(edges):
    return sorted({b for _, b in edges} - {a for a, _ in edges})


WRONG = {
    "speed": [
        (with_height, "only x and z"),
        (a_frame, "metres per frame"),
        (divided, "multiply by fps"),
        (of_xy, "y is up"),
    ],
    "cheapest": [
        (least_of_all, "of the whole grid"),
        (its_number, "index in the list"),
        (worst, "worst of the minima"),
        (its_cost, "its row and column"),
    ],
    "dead_ends": [
        (no_way_in, "no edge enters"),
        (among_starts, "always empty"),
        (again_and_again, "look once"),
        (a_list, "return a set"),
    ],
}
