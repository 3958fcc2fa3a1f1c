import numpy as np


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


def last_from_first(positions, planted):
    on = positions[planted][:, [0, 2]]
    return 100 * np.hypot(*(on[-1] - on[0]))


def path_walked(positions, planted):
    steps = np.diff(positions[planted], axis=0)
    return 100 * np.hypot(steps[:, 0], steps[:, 2]).sum()


def slow(speed, start, stay):
    return speed < start


def slowish(speed, start, stay):
    return speed < stay


def onwards(speed, start, stay):
    marks, stands = [], False
    for v in speed:
        stands = v < start or (stands and v < stay)
        marks.append(stands)
    return np.array(marks)


def back(speed, start, stay):
    return onwards(speed[::-1], start, stay)[::-1]


def swings(speed, start, stay):
    return ~(onwards(speed, start, stay) | back(speed, start, stay))


WRONG = {
    "slide": [
        (with_height, "only x and z"),
        (in_metres, "in metres"),
        (always, "in the air"),
        (mean_of_all, "over the planted frames only"),
        (from_the_start, "where the plant begins"),
        (last_from_first, "slide away and come back"),
        (path_walked, "the length of the joint's path"),
    ],
    "plant_marks": [
        (slow, "uses `start` alone"),
        (slowish, "uses `stay` alone"),
        (onwards, "also begins earlier"),
        (back, "also lasts longer"),
        (swings, "the wrong way round"),
    ],
    "knee_bend": [
        (between_bones, "π for a straight leg"),
        (in_degrees, "in degrees"),
        (at_the_hip, "at the hip"),
        (bent_forwards, "wrong sign"),
    ],
}
