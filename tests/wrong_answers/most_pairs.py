import numpy as np


def joined(points, middles, scale):
    rows = [[points[f, p, 1] for f in range(len(points)) for p in range(points.shape[1])], []]
    for f in range(len(points)):
        for p in range(points.shape[1]):
            rows[1].append(np.hypot(points[f, p, 0] - middles[f][0], points[f, p, 2] - middles[f][2]))
    return np.concatenate(rows) / scale


def root(points):
    return np.sqrt(points.shape[0] * points.shape[1])


def middle(points):
    return [points.mean((0, 1))] * len(points)


def from_the_origin(points):
    return joined(points, np.zeros((len(points), 3)), root(points))


def frame_by_frame(points):
    return joined(points, points.mean(1), root(points))


def without_weights(points):
    return joined(points, middle(points), 1)


def weights_without_root(points):
    return joined(points, middle(points), root(points) ** 2)


def squared_radii(points):
    numbers = joined(points, middle(points), 1)
    half = len(numbers) // 2
    numbers[half:] **= 2
    return numbers / root(points)


def coordinates(points):
    centred = (points - points.mean((0, 1)))[..., [0, 2]]
    return np.concatenate([points[..., 1].ravel(), centred.ravel()]) / root(points)


def radii_in_space(points):
    left = points - points.mean((0, 1))
    return np.concatenate([points[..., 1].ravel(), np.sqrt((left**2).sum(-1)).ravel()]) / root(points)


def pairs(rows, near, later=lambda i, j: i < j):
    count = range(len(rows))
    return [(i, j) for i in count for j in count if later(i, j) and near(rows[i] - rows[j])]


def both_ways(rows, reach):
    return pairs(rows, lambda gap: np.linalg.norm(gap) <= reach, lambda i, j: i != j)


def with_itself(rows, reach):
    return pairs(rows, lambda gap: np.linalg.norm(gap) <= reach, lambda i, j: i <= j)


def too_far(rows, reach):
    return pairs(rows, lambda gap: np.linalg.norm(gap) > reach)


def square_of_length(rows, reach):
    return pairs(rows, lambda gap: (gap**2).sum() <= reach)


def sum_of_sizes(rows, reach):
    return pairs(rows, lambda gap: np.abs(gap).sum() <= reach)


def added_sizes(difference, axes):
    return [sum(abs(difference @ axes[:, c]) for c in range(n + 1)) for n in range(axes.shape[1])]


def squares(difference, axes):
    return [sum((difference @ axes[:, c]) ** 2 for c in range(n + 1)) for n in range(axes.shape[1])]


def one_by_one(difference, axes):
    return [abs(difference @ axes[:, n]) for n in range(axes.shape[1])]


def last_first(difference, axes):
    return np.sqrt(squares(difference, axes[:, ::-1]))


def not_projected(difference, axes):
    return [np.linalg.norm(difference[: n + 1]) for n in range(axes.shape[1])]


def all_at_once(difference, axes):
    return np.sqrt(((difference @ axes) ** 2).sum())


WRONG = {
    "turn_free": [
        (from_the_origin, "from the origin"),
        (frame_by_frame, "a middle of its own"),
        (without_weights, "divide by the root"),
        (weights_without_root, "holds its root"),
        (squared_radii, "these are squares"),
        (coordinates, "change when the window turns"),
        (radii_in_space, "over the ground"),
    ],
    "worth_a_look": [
        (both_ways, "there twice"),
        (with_itself, "are no pair"),
        (too_far, "need no look"),
        (square_of_length, "square of a length"),
        (sum_of_sizes, "root of the sum of squares, which"),
    ],
    "bounds_by_direction": [
        (added_sizes, "do not add up"),
        (squares, "take the root at the end"),
        (one_by_one, "one by one"),
        (last_first, "begin with the last"),
        (not_projected, "project it"),
        (all_at_once, "with all directions"),
    ],
}
