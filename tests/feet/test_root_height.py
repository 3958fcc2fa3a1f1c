"""The root moves only as far as both legs need to reach, and not at all where they reach already."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.leg_track import UP, track_leg
from mocap.feet.root_height import HEAVY, STRAIGHT, root_rise

WALK = sample("walk_straight")[200:500]
POSES = forward_kinematics(WALK)
TRACKS = [track_leg(WALK, leg, POSES) for leg in find_legs(WALK.skeleton)]
NOTHING = np.zeros((len(WALK), 3))


def targets(*shifts):
    """Return both feet's targets, where they are but for the shifts."""
    return [
        FootTarget(track.ankle + shift, NOTHING, np.ones(len(WALK), bool))
        for track, shift in zip(TRACKS, shifts, strict=True)
    ]


@pytest.mark.parametrize("height", [-0.01, 0.01])
def test_the_root_follows_two_feet_up_and_down_but_not_all_the_way(height):
    rise = root_rise(TRACKS, targets([0, height, 0], [0, height, 0])) / height
    assert rise.min() > 0.2
    assert rise.max() <= (1.1 if height > 0 else 1.5)


@pytest.mark.parametrize("way", [[0, -0.03, 0], [0, 0, 0.06], [0, 0, -0.06]])
def test_no_knee_becomes_straighter_than_it_was_or_than_eight_degrees(way):
    wanted = targets(way, 0.0)
    rise = root_rise(TRACKS, wanted)
    for track, target in zip(TRACKS, wanted, strict=True):
        after = np.linalg.norm(target.ankle - track.hip - rise[:, None] * UP, axis=-1)
        assert np.all(after <= track.limit + 1e-9)


def test_the_rise_is_the_least_squares_solution():
    """Against what a minimiser finds, frame by frame, where no leg is at its limit."""
    wanted = targets([0, 0.004, 0.002], [0, 0.006, 0])
    rise = root_rise(TRACKS, wanted)

    def cost(h, frame):
        total = HEAVY * h**2
        for track, target in zip(TRACKS, wanted, strict=True):
            apart = (track.hip - target.ankle)[frame]
            length = np.linalg.norm(apart)
            longer = length + apart[1] / length * h - track.distance[frame]
            total += longer**2 / (np.sin(track.straight[frame]) ** 2 + np.sin(STRAIGHT) ** 2)
        return total

    found = [minimize_scalar(cost, args=(frame,), tol=1e-12).x for frame in range(0, len(WALK), 20)]
    assert rise[::20] == pytest.approx(found, abs=1e-7)
