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


WRONG = {
    "speed": [
        (with_height, "only x and z"),
        (a_frame, "metres a frame"),
        (divided, "multiply by fps"),
        (of_xy, "y is up"),
    ],
}
