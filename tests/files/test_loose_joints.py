"""What moves apart from a body is left out, and the body stays where it is."""

import numpy as np
import pytest

from mocap.body import joint_positions
from mocap.datasets import sample
from mocap.errors import MocapWarning
from mocap.files.load_save import load, save
from tests.refusals import refused

WALK = sample("walk_straight")[:120:4]
CHANNELS = "CHANNELS 3 Xposition Yposition Zposition"


def with_joints(path, *, root=False, prop=None):
    """Write the walk with a still root above the hips and a target beside them, or with a prop in a hand.

    `prop` (F, 3), centimetres, is the way of a prop in the frame of the left hand.
    """
    save(WALK, path)
    head, motion = path.read_text().split("MOTION")
    rows = motion.splitlines()[3:]
    if root:
        body = head.split("\n", 1)[1].replace("ROOT", "JOINT", 1)
        target = f"JOINT target\n{{\nOFFSET 0 0 0\n{CHANNELS}\nEnd Site\n{{\nOFFSET 0 0 0\n}}\n}}\n"
        head = f"HIERARCHY\nROOT ground\n{{\nOFFSET 0 0 0\n{CHANNELS}\n{target}{body}}}\n"
        ankle = 100 * joint_positions(WALK)[:, WALK.skeleton.index("lfoot")]
        rows = [f"0 0 0 {' '.join(map(str, place))} {row}" for place, row in zip(ankle, rows, strict=True)]
    if prop is not None:
        joint = f"JOINT sword\n{{\nOFFSET 0 0 0\n{CHANNELS}\nEnd Site\n{{\nOFFSET 0 90 0\n}}\n}}\n"
        before, after = head.split("JOINT lhand\n")
        first_brace = after.index("JOINT lfingers")
        head = f"{before}JOINT lhand\n{after[:first_brace]}{joint}{after[first_brace:]}"
        channels = head[: head.index("JOINT sword")].split()
        column = sum(int(channels[i + 1]) for i, word in enumerate(channels) if word == "CHANNELS")
        cells = [row.split() for row in rows]
        rows = [
            " ".join([*row[:column], *map(str, place), *row[column:]])
            for row, place in zip(cells, prop, strict=True)
        ]
    path.write_text("MOTION\n".join([head, "\n".join([*motion.splitlines()[1:3], *rows]) + "\n"]))


def same_walk(path):
    return np.abs(joint_positions(load(path)) - joint_positions(WALK)).max() < 1e-6


def test_a_still_root_and_a_target_are_left_out(tmp_path):
    with_joints(tmp_path / "game.bvh", root=True)
    with pytest.warns(MocapWarning, match=r"left out what moves apart from the body: ground, target"):
        assert same_walk(tmp_path / "game.bvh")


def test_a_prop_that_moves_is_left_out(tmp_path):
    way = np.linspace(0, 60, len(WALK))[:, None] * [1, 0, 0]
    with_joints(tmp_path / "sword.bvh", prop=way)
    with pytest.warns(MocapWarning, match=r"left out what moves apart from the body: sword, sword_end\."):
        assert same_walk(tmp_path / "sword.bvh")


def test_a_bone_that_stretches_is_not_left_out(tmp_path):
    way = np.linspace(0, 12, len(WALK))[:, None] * [1, 0, 0] + [40, 0, 0]
    with_joints(tmp_path / "long.bvh", prop=way)
    refused("'sword' in one place below its parent", load, tmp_path / "long.bvh")
