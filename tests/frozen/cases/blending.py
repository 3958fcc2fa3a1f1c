"""Mixed and averaged motions, and point clouds."""

import numpy as np

from mocap import blending, body
from mocap.body.kinematics import hinge_of
from mocap.matching.transitions import join_clouds
from tests.bundled import clips
from tests.frozen.cases.feet import WALK
from tests.frozen.quantities import DIRECTIONS, QUATERNION, Axis, case, numbers, positions

WALKS_APART = (WALK[100:500], WALK[233:640])


@case("mixed")
def mixed():
    motion = blending.mix(blending.register(list(WALKS_APART)), [0.3, 0.7])
    return {"positions": positions(body.joint_positions(motion), motion.skeleton)}


@case("mean turns")
def mean_rotations():
    means = body.rotations.mean(WALK.rotations[:60].reshape(-1, 4, 4))
    return {"means of four": numbers(means, "mean", Axis("", QUATERNION))}


@case("no turns")
def no_rotations():
    return {"shape": numbers(np.shape(body.rotations.to_matrix(np.zeros((0, 4)))), "axis")}


@case("hinges")
def hinges():
    axes = [hinge_of(WALK[:frames], 3) for frames in (4, 5, 40)]
    return {"axes": numbers(axes, "clip", Axis("", DIRECTIONS))}


@case("joined clouds")
def joined_clouds():
    sizes = join_clouds(clips("sneak", "jog"), None, 10, 1, np.float64).sizes
    return {"finite": numbers(sizes < np.inf, "cloud")}
