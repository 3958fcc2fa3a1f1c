"""Write the files that other programs read, and beside each the positions of joints that they should find.

    python -m tests.elsewhere.write_files FOLDER

For each motion there are NAME.bvh and NAME.glb, written by `mocap.save` with its defaults as users call it,
and NAME@NAME.npz with the names and parents of the joints, their positions in metres, and the frame rate. The
positions come from `mocap.body.joint_positions` and not from the files, so a writer's error shows as a
distance. The motions differ in length, frame rate, number of joints, size, side and rest pose.

For the motions in a file of several, NAME.glb, there are NAME@MOTION.npz. Some have a joint on the floor.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

import mocap
from mocap.body import Motion, Skeleton, joint_positions, rotations
from mocap.datasets import sample
from mocap.editing import mirror, retarget
from mocap.files import save_clips
from mocap.graphs import compile_graph
from mocap.methods.groups import Configuration, walk_group
from tests.bundled import WALKS, bundled
from tests.editing.bodies import LONG, adult, along_x, child, renamed, rested
from tests.strategies import random_quaternions

PLAN_SECONDS = 4
MEMBERS = 3
SPACING = 1.5  # metres between two members of a group
PLAN_STEP = 0.09  # metres in 0.1 s: a walking pace of 0.9 m/s
PENDULUM_FRAMES = 121


def named(motion: Motion, name: str) -> Motion:
    """Return a motion under another name, which becomes that of its file."""
    return replace(motion, name=name)


def single_motions() -> list[Motion]:
    """Return motions of one person, and of a pendulum 2 cm long."""
    walk = sample("walk_straight")
    two_seconds = walk[:240]
    return [
        walk,
        sample("jog"),
        sample("sneak"),
        named(mocap.resample(walk, 30), "walk_at_30"),
        named(mirror(two_seconds), "mirrored"),
        named(retarget(two_seconds, child(), adult()), "retargeted"),
        named(walk[:3], "three_frames"),
        named(walk[:1], "one_frame"),
        pendulum(),
        *odd_rests(two_seconds),
    ]


def odd_rests(motion: Motion) -> list[Motion]:
    """Return a motion on bodies whose rest pose does not stand, or faces elsewhere."""
    joints = len(motion.skeleton)
    lying = np.tile(rotations.from_rotvec([np.pi / 2, 0, 0]), (joints, 1))
    facing_x = np.tile(rotations.about_y(-np.pi / 2), (joints, 1))
    odd = random_quaternions(np.random.default_rng(0), joints)
    return [
        named(rested(motion, lying), "rest_lying"),
        named(rested(motion, facing_x), "rest_facing_x"),
        named(rested(renamed(motion, LONG), along_x(motion.skeleton)), "rest_along_x"),
        named(rested(motion, odd), "rest_odd"),
    ]


def files_of_several() -> dict[str, list[Motion]]:
    """Return the motions of each file of several."""
    walks = [sample("walk_straight")[:240], mocap.resample(sample("jog"), 30)]
    along = [rested(renamed(walk, LONG), along_x(walk.skeleton)) for walk in walks]
    return {"several": walks, "several_along_x": along, "floor": walks, "floor_along_x": along}


def pendulum() -> Motion:
    """Return a swing of three joints with a bone of 1 cm between two of them."""
    skeleton = Skeleton(["hook", "middle", "weight"], [-1, 0, 1], [[0, 0, 0], [0, -0.01, 0], [0, -0.01, 0]])
    angles = 0.6 * np.sin(np.linspace(0, 4 * np.pi, PENDULUM_FRAMES))  # radians about z
    local = np.tile(rotations.IDENTITY, (PENDULUM_FRAMES, len(skeleton), 1))
    local[:, 0] = rotations.from_rotvec(np.outer(angles, [0, 0, 1]))
    hook = np.tile([0.0, 0.02, 0.0], (PENDULUM_FRAMES, 1))
    return Motion(skeleton, hook, local, 60.0, name="pendulum")


def group_motions() -> list[Motion]:
    """Return the walks of three members of a group, side by side."""
    times = np.arange(10 * PLAN_SECONDS + 1)[:, None]
    positions = PLAN_STEP * times + 1j * SPACING * np.arange(MEMBERS)
    plan = Configuration(positions, np.full(positions.shape, 10 * PLAN_STEP + 0j))
    members = walk_group(compile_graph(bundled(*WALKS)), plan).motions
    return [named(motion, f"member_{number}") for number, motion in enumerate(members, 1)]


def write(motion: Motion, folder: Path) -> None:
    """Write a motion as .bvh and as .glb, and its positions as .npz."""
    mocap.save(motion, folder / f"{motion.name}.bvh")
    mocap.save(motion, folder / f"{motion.name}.glb")
    write_positions(motion, folder, motion.name)


def write_several(name: str, motions: list[Motion], folder: Path) -> None:
    """Write motions as one .glb, and their positions as .npz."""
    save_clips(motions, folder / f"{name}.glb", root=name.startswith("floor"))
    for motion in motions:
        write_positions(motion, folder, name)


def write_positions(motion: Motion, folder: Path, file: str) -> None:
    """Write the positions of joints that other programs should find in a file."""
    np.savez(
        folder / f"{file}@{motion.name}.npz",
        names=motion.skeleton.names,
        parents=motion.skeleton.parents,
        positions=joint_positions(motion),
        fps=motion.fps,
    )


def main() -> None:
    """Write all files into the folder that the command names."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="a folder, which is made where it is missing")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    for motion in [*single_motions(), *group_motions()]:
        write(motion, folder)
    for name, motions in files_of_several().items():
        write_several(name, motions, folder)


if __name__ == "__main__":
    main()
