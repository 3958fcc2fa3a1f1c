"""What several tasks measure of an answer: nothing but its bones and places is read, no marks."""

from functools import cache
from itertools import combinations

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion, find_legs, joint_positions
from mocap.body.skeleton import reaches
from mocap.files.gltf_capsules import THICK
from mocap.quality import jumps, spread

LOW = 0.025  # metres: a foot joint this much over its lowest place slides as little as it likes
STANDING = 2  # percent of the heights of a foot joint: as high as it stands
USUAL = 99.9  # percent of the clips' own frames


def foot_sliding_speed(motion: Motion, clips: tuple[Motion, ...]) -> float:
    """Average how fast low feet slide, cm/s: each ankle's and ball's speed times 2 - 2^(height / 2.5 cm).

    Zhang et al., *Mode-Adaptive Neural Networks for Quadruped Motion Control* (2018), measure it so. Heights
    are above one floor for all answers, that of the clips. Above its own floor, more frames of a motion count
    as low if its feet always stand at one height, so that cleaned feet seemed to slide further.
    """
    feet = _foot_positions(motion)
    speed = np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=-1) * motion.fps
    height = (feet[..., 1] - floor_of(clips))[1:]
    return 100 * float((speed * np.clip(2 - 2 ** (height / LOW), 0, 1)).mean())


def _foot_positions(motion: Motion) -> Array:
    """Return the positions of the ankles and the balls, (F, 4, 3)."""
    joints = [joint for leg in find_legs(motion.skeleton) for joint in leg[2:]]
    return joint_positions(motion)[:, joints]


@cache
def floor_of(clips: tuple[Motion, ...]) -> Array:
    """Return how high ankles and balls stand in some clips, (4,), metres: the 2nd percentile of each."""
    heights = np.concatenate([_foot_positions(clip)[..., 1] for clip in clips])
    return np.asarray(np.percentile(heights, STANDING, axis=0))


def sliding_of_clips(clips: tuple[Motion, ...]) -> float:
    """Measure how fast low feet slide in the clips themselves, cm/s, averaged over their frames."""
    speeds = [foot_sliding_speed(clip, clips) for clip in clips]
    return float(np.average(speeds, weights=[len(clip) - 1 for clip in clips]))


def jolting(motion: Motion, clips: tuple[Motion, ...]) -> float:
    """Give the share of frames whose velocity jumps further than 99.9 % of the clips' own, percent."""
    return 100 * float((jumps(motion) > np.percentile(spread(clips).within(1), USUAL)).mean())


def shaking(motion: Motion, base: Motion) -> float:
    """Compare the 99th percentiles of the joints' accelerations with those of another motion."""
    tops = [np.percentile(accelerations(clip), 99) for clip in (motion, base)]
    return float(tops[0] / tops[1])


def accelerations(motion: Motion) -> Array:
    """Give the joints' accelerations, shape (F - 2, J), m/s²."""
    return np.asarray(np.linalg.norm(np.diff(joint_positions(motion), 2, axis=0), axis=-1) * motion.fps**2)


def through(motion: Motion, base: Motion) -> float:
    """Measure how deep two bones are in one another at most, beyond how deep they are in another motion, mm.

    Bones of 5 % of the longest limb or more count; each is a capsule as thick as the glTF writer draws it.
    Pairs that touch at rest, as those at a joint do, are left out.
    """
    skeleton = motion.skeleton
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    limbs = reaches(skeleton)
    beads = np.linspace(0, 1, 9)[:, None]  # along a bone
    radii = THICK * np.sqrt(limbs[0] * (lengths + limbs))
    bones = 1 + np.flatnonzero(lengths[1:] > 0.05 * limbs[0])
    posed = np.concatenate([skeleton.rest[None], joint_positions(base), joint_positions(motion)])
    worst = 0.0
    for first, second in combinations(bones, 2):
        start = posed[:, [skeleton.parents[first]]]
        second_start = posed[:, [skeleton.parents[second]]]
        bone = posed[:, [second]] - second_start
        offsets = start + beads * (posed[:, [first]] - start) - second_start  # of points along the first
        fractions = np.clip((offsets * bone).sum(-1) / lengths[second] ** 2, 0, 1)
        distances = np.linalg.norm(offsets - fractions[..., None] * bone, axis=-1).min(1)
        depths = radii[first] + radii[second] - distances
        of_base, of_motion = np.split(np.maximum(depths[1:], 0), 2)
        if depths[0] < 0:
            worst = max(worst, (of_motion - of_base).max())
    return 1000 * float(worst)
