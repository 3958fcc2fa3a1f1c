"""Checks of notebook 00."""

import numpy as np

from mocap.checking import Check, Mistake

speed = Check(
    name="speed",
    asks="the speed over the ground between each frame and the next, in metres a second",
    start="np.diff gives the steps from frame to frame; a step lasts 1 / fps seconds.",
    draw=lambda rng: (rng.normal(size=(rng.integers(2, 30), 3)).cumsum(axis=0), float(rng.integers(24, 121))),
    truth=lambda positions, fps: np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps,
    mistakes=[
        Mistake(
            lambda positions, fps: np.linalg.norm(np.diff(positions, axis=0), axis=1) * fps,
            "the bob up and down is in it; the ground has only x and z.",
        ),
        Mistake(
            lambda positions, fps: np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T),
            "that is metres a frame; a second has `fps` frames.",
        ),
        Mistake(
            lambda positions, fps: np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) / fps,
            "divide by the time of a frame, which is 1 / fps: so multiply by fps.",
        ),
        Mistake(
            lambda positions, fps: np.hypot(*np.diff(positions[:, :2], axis=0).T) * fps,
            "columns 0 and 1 are x and y, and y is up; the ground is x and z.",
        ),
    ],
)
