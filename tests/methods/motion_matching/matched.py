"""Databases that several tests search."""

from functools import cache

from mocap.body.motion import Motion, resample
from mocap.datasets import samples
from mocap.methods.motion_matching.pose_database import PoseDatabase, tabulate

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")


@cache
def clips(*names: str) -> tuple[Motion, ...]:
    return tuple(resample(samples.sample(name), 30) for name in names)


@cache
def walks() -> PoseDatabase:
    return tabulate(clips(*WALKS))
