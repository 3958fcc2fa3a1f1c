"""What holds for every generated clip: heels above the floor, and joints within their limits."""

import numpy as np
from walking.walking_body import FOOT, SKELETON

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics


def check_floor(motion, heel):
    """No joint goes through the floor, and no heel further than so many metres."""
    poses = forward_kinematics(motion)
    assert poses.positions[..., 1].min() > 0
    for ankle in (SKELETON.index("lfoot"), SKELETON.index("rfoot")):
        heels = poses.positions[:, ankle] + poses.matrices[:, ankle] @ [0, -FOOT.ankle, -FOOT.heel]
        assert heels[:, 1].min() > -heel


def check_limits(motion, hip, ankle):
    """Knees and elbows are hinges; hips and ankles turn within the limits given, degrees."""
    for side in "lr":
        turn = {
            bone: np.degrees(rotations.to_rotvec(motion.rotations[:, SKELETON.index(side + bone)]))
            for bone in ("femur", "tibia", "foot", "toes", "radius")
        }
        for bone, (least, most) in {
            "tibia": (4, 125),
            "femur": hip,
            "foot": ankle,
            "toes": (-65, 1e-6),
        }.items():
            assert least < turn[bone][:, 0].min() < turn[bone][:, 0].max() < most, bone
        assert np.abs(turn["tibia"][:, 1:]).max() < 1e-6
        elbow = np.linalg.norm(turn["radius"], axis=-1)
        assert 10 < elbow.min() < elbow.max() < 140
        assert np.ptp(turn["radius"] / elbow[:, None], axis=0).max() < 0.05  # a hinge


def check_stored(stored, made):
    """A clip is stored to the nanometre, with the marks and the name of what was made."""
    np.testing.assert_allclose(stored.root_positions, made.root_positions, rtol=0, atol=1e-9)
    np.testing.assert_allclose(stored.rotations, made.rotations, rtol=0, atol=1e-9)
    assert (stored.name, stored.fps) == (made.name, made.fps)
    for mine, theirs in ((stored.labels, made.labels), (stored.contacts, made.contacts)):
        assert list(mine) == list(theirs)
        assert all(np.array_equal(mark, theirs[key]) for key, mark in mine.items())
