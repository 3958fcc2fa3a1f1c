"""Characters that need no clips: a body that stands stiff and glides, turning at a rate."""

import numpy as np

from mocap.datasets.samples import SKELETON
from mocap.steering.characters import Pose

TURNS = np.tile([1.0, 0, 0, 0], (len(SKELETON), 1))


class Dot:
    """It turns by at most so many radians per second towards the command."""

    skeleton, frames_left = SKELETON, 0

    def __init__(self, rate=2.0, fps=30.0):
        self.rate, self.fps = rate, fps
        self.heading, self.place, self.labels = 0.0, 0j, []

    def step(self, heading, speed, label=""):
        missing = float(np.angle(np.exp(1j * (heading - self.heading))))
        self.heading += float(np.clip(missing, -self.rate / self.fps, self.rate / self.fps))
        self.place += speed / self.fps * np.exp(1j * self.heading)
        self.labels.append(label)
        return Pose(np.array([self.place.imag, 1.0, self.place.real]), TURNS, blending=bool(missing))
