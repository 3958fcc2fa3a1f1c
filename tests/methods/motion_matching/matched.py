"""Databases that several tests search."""

from functools import cache

from mocap.methods.motion_matching.pose_database import PoseDatabase, tabulate
from tests.bundled import clips


@cache
def walks() -> PoseDatabase:
    return tabulate(clips())
