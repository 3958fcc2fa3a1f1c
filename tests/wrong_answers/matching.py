import numpy as np


def not_wrapped(a, b):
    return np.array([x - y for x, y in zip(a, b, strict=True)])


def up_to_360(a, b):
    gap = a - b
    return np.where(gap < 0, gap + 360, gap)


def unsigned(a, b):
    gap = np.abs(a - b)
    return np.minimum(gap, 360 - gap)


def in_radians(a, b):
    gap = a - b
    return gap - 2 * np.pi * np.floor((gap + np.pi) / (2 * np.pi))


def backwards(a, b):
    gap = b - a
    return gap - 360 * np.floor(gap / 360 + 0.5)


def shift_of_means(points, others, angle):
    x, _, z = points.mean(axis=0)
    other_x, _, other_z = others.mean(axis=0)
    return x - other_x, z - other_z


def shift_turned_back(points, others, angle):
    x, _, z = points.mean(axis=0)
    other_x, _, other_z = others.mean(axis=0)
    cos, sin = np.cos(angle), np.sin(angle)
    return x - other_x * cos + other_z * sin, z - other_x * sin - other_z * cos


def shift_of_sums(points, others, angle):
    x, _, z = points.sum(axis=0)
    other_x, _, other_z = others.sum(axis=0)
    cos, sin = np.cos(angle), np.sin(angle)
    return x - other_x * cos - other_z * sin, z + other_x * sin - other_z * cos


def shift_back(points, others, angle):
    return tuple(-np.array(shift_of_sums(points, others, angle)) / len(points))


def z_first(points, others, angle):
    x, z = np.array(shift_of_sums(points, others, angle)) / len(points)
    return z, x


def sums(points, others):
    x, z, other_x, other_z = points[:, 0], points[:, 2], others[:, 0], others[:, 2]
    return np.sum(x * other_z - other_x * z), np.sum(x * other_x + z * other_z)


def not_centred(points, others):
    return np.arctan2(*sums(points, others))


def half_turns_lost(points, others):
    b, a = sums(points - points.mean(axis=0), others - others.mean(axis=0))
    return np.arctan(b / a)


def wrong_way(points, others):
    return np.arctan2(*sums(others - others.mean(axis=0), points - points.mean(axis=0)))


def cosine_first(points, others):
    b, a = sums(points - points.mean(axis=0), others - others.mean(axis=0))
    return np.arctan2(a, b)


def z_up(points, others):
    return np.arctan2(*sums((points - points.mean(0))[:, [0, 2, 1]], (others - others.mean(0))[:, [0, 2, 1]]))


def unsigned_and_not_wrapped(a, b):
    return abs(a - b)


def half_turns_positive(a, b):
    gap = a - b
    return gap - 360 * np.ceil((gap - 180) / 360)


WRONG = {
    "angle_gap": [
        (not_wrapped, "not 358°"),
        (up_to_360, "counts as 359°"),
        (unsigned, "have signs"),
        (in_radians, "in degrees"),
        (backwards, "b - a"),
        (unsigned_and_not_wrapped, "do not remove them"),
        (half_turns_positive, "half a turn is -180"),
    ],
    "best_shift": [
        (shift_of_means, "turned before they are moved"),
        (shift_turned_back, "signs of the sines"),
        (shift_of_sums, "not means"),
        (shift_back, "reverse the sign"),
        (z_first, "x0 first"),
    ],
    "best_angle": [
        (not_centred, "did not centre"),
        (half_turns_lost, "below 90°"),
        (wrong_way, "the sign of θ"),
        (cosine_first, "sine's part first"),
        (z_up, "columns 0 and 2"),
    ],
}
