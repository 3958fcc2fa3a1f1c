"""A limb of two bones meets its target, with its bones as long as they are and its knee to the front."""

import numpy as np
import pytest
from hypothesis import given
from walking.two_bone_ik import two_bone

from mocap.body import rotations
from tests.refusals import refusals
from tests.strategies import seeds


def random_limbs(seed: int, least: float, most: float):
    """Return hips, targets at `least` to `most` of the limb's reach, lengths and bend directions."""
    random = np.random.default_rng(seed)
    lengths = tuple(random.uniform(0.2, 0.6, 2))
    start, away, bend = random.normal(size=(3, 7, 3))
    away /= np.linalg.norm(away, axis=-1, keepdims=True)
    near, far = abs(lengths[0] - lengths[1]), sum(lengths)
    reach = near + (far - near) * random.uniform(least, most, (7, 1))
    return start, start + reach * away, lengths, bend


@given(seeds)
def test_within_reach_the_end_meets_its_target_and_the_knee_is_a_hinge_that_bends_to_the_front(seed):
    start, target, lengths, bend = random_limbs(seed, 0.02, 0.98)
    limb = two_bone(start, target, lengths, bend)
    assert limb.reached.all()
    assert limb.end == pytest.approx(target, abs=1e-9)
    outwards, axis = limb.middle - start, target - start
    assert np.linalg.norm(outwards, axis=-1) == pytest.approx(lengths[0])
    assert np.linalg.norm(target - limb.middle, axis=-1) == pytest.approx(lengths[1])
    along = (outwards * axis).sum(-1) * (bend * axis).sum(-1) / (axis * axis).sum(-1)
    assert ((outwards * bend).sum(-1) - along > 0).all()
    assert (outwards * np.cross(axis, bend)).sum(-1) == pytest.approx(0, abs=1e-9)
    middle = start + rotations.rotate(limb.upper, [0, -lengths[0], 0])  # as the rest pose hangs
    assert middle == pytest.approx(limb.middle, abs=1e-9)
    assert middle + rotations.rotate(limb.lower, [0, -lengths[1], 0]) == pytest.approx(target, abs=1e-9)
    knee = rotations.to_rotvec(rotations.multiply(rotations.inverse(limb.upper), limb.lower))
    assert knee[:, 1:] == pytest.approx(0, abs=1e-6)
    assert (knee[:, 0] > 0).all()


def test_a_target_out_of_reach_is_reported_and_pointed_at():
    limb = two_bone([0, 1, 0], [[0, -1, 0], [0, 0.4, 0]], (0.4, 0.4), [0, 0, 1])
    assert limb.reached.tolist() == [False, True]
    assert limb.end[0] == pytest.approx([0, 0.2, 0])
    near = two_bone([0, 1, 0], [0, 0.9, 0], (0.5, 0.3), [0, 0, 1])
    assert not near.reached and near.end == pytest.approx([0, 0.8, 0])


test_senseless_limbs_are_refused = refusals(
    ("length above 0, got 0.0 and 1.0", two_bone, [0, 1, 0], [0, 0, 0], (0.0, 1.0), [0, 0, 1]),
    ("off the start", two_bone, [0, 1, 0], [0, 1, 0], (1.0, 1.0), [0, 0, 1]),
    ("along the limb", two_bone, [0, 1, 0], [0, 0, 0], (1.0, 1.0), [0, 2, 0]),
)
