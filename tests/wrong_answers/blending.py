import numpy as np


def by_sines(start, end, amount):
    angle = np.arccos(np.dot(start, end))
    return np.sin((1 - amount) * angle) / np.sin(angle) * start + np.sin(amount * angle) / np.sin(angle) * end


def backwards(start, end, amount):
    return by_sines(end, start if start @ end >= 0 else -start, amount)


def normalised_line(start, end, amount):
    if start @ end < 0:
        end = -end
    q = start + amount * (end - start)
    return q / np.sqrt((q**2).sum())


def bare_line(start, end, amount):
    if start @ end < 0:
        end = -end
    return start + amount * (end - start)


def line_the_long_way(start, end, amount):
    q = start + amount * (end - start)
    return q / np.sqrt((q**2).sum())


def rising(window):
    t = np.arange(1, window + 1) / window
    return t**3 * (10 - 15 * t + 6 * t**2)


def a_frame_late(window):
    t = np.arange(window) / window
    return 1 - t**3 * (10 - 15 * t + 6 * t**2)


def end_to_end(window):
    t = np.arange(window) / (window - 1)
    return 1 - t**3 * (10 - 15 * t + 6 * t**2)


def cubic(window):
    t = np.arange(1, window + 1) / window
    return 1 + t**2 * (2 * t - 3)


def with_height(positions, planted):
    on = positions[planted]
    return 100 * np.sqrt(((on - on.mean(0)) ** 2).sum(1)).max()


def over_ground(places, centre):
    return np.hypot(places[:, 0] - centre[0], places[:, 2] - centre[2]).max()


def in_metres(positions, planted):
    return over_ground(positions[planted], positions[planted].mean(0))


def always(positions, planted):
    return 100 * over_ground(positions, positions.mean(0))


def mean_of_all(positions, planted):
    return 100 * over_ground(positions[planted], positions.mean(0))


def from_the_start(positions, planted):
    return 100 * over_ground(positions[planted], positions[planted][0])


def between_bones(thigh, shank, distance):
    return np.arccos((thigh**2 + shank**2 - distance**2) / (2 * thigh * shank))


def in_degrees(thigh, shank, distance):
    return np.degrees(np.pi - between_bones(thigh, shank, distance))


def at_the_hip(thigh, shank, distance):
    return np.arccos((thigh**2 + distance**2 - shank**2) / (2 * thigh * distance))


def bent_forwards(thigh, shank, distance):
    return -np.arccos((distance**2 - thigh**2 - shank**2) / (2 * thigh * shank))


WRONG = {
    "short_way": [
        (by_sines, "the long way round: if"),
        (backwards, "runs backwards"),
        (normalised_line, "not at constant speed"),
        (bare_line, "cuts through the sphere"),
        (line_the_long_way, "on a straight line, and"),
    ],
    "quintic": [
        (rising, "these rise"),
        (a_frame_late, "one frame late"),
        (end_to_end, "would be wasted"),
        (cubic, "the cubic"),
    ],
    "slide": [
        (with_height, "only x and z"),
        (in_metres, "in metres"),
        (always, "in the air"),
        (mean_of_all, "over the planted frames only"),
        (from_the_start, "where the plant begins"),
    ],
    "knee_bend": [
        (between_bones, "π for a straight leg"),
        (in_degrees, "in degrees"),
        (at_the_hip, "at the hip"),
        (bent_forwards, "wrong sign"),
    ],
}
