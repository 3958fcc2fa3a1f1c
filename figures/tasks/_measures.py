"""What several tasks measure of an answer: nothing but its bones and places is read, no marks."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion, find_legs, joint_positions
from mocap.quality import jumps, spread

LOW = 0.025  # metres: a foot joint this much over its lowest place slides as little as it likes
USUAL = 99.9  # percent of the clips' own frames


def skate(motion: Motion) -> float:
    """Average how fast low feet slide, cm/s: each ankle's and ball's speed times 2 - 2^(height / 2.5 cm).

    Zhang et al., *Mode-Adaptive Neural Networks for Quadruped Motion Control* (2018), measure it so.
    """
    feet = joint_positions(motion)[:, [joint for leg in find_legs(motion.skeleton) for joint in leg[2:]]]
    speed = np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=-1) * motion.fps
    height = (feet[..., 1] - np.percentile(feet[..., 1], 2, axis=0))[1:]
    return 100 * float((speed * np.clip(2 - 2 ** (height / LOW), 0, 1)).mean())


def jolting(motion: Motion, clips: tuple[Motion, ...]) -> float:
    """Give the share of frames whose velocity jumps further than 99.9 % of the clips' own, percent."""
    return 100 * float((jumps(motion)[0] > np.percentile(spread(clips).within(1), USUAL)).mean())


def shaking(motion: Motion, base: Motion) -> float:
    """Compare the 99th percentiles of the joints' accelerations with those of another motion."""
    tops = [np.percentile(accelerations(clip), 99) for clip in (motion, base)]
    return float(tops[0] / tops[1])


def accelerations(motion: Motion) -> Array:
    """Give the joints' accelerations, shape (F - 2, J), m/s²."""
    return np.asarray(np.linalg.norm(np.diff(joint_positions(motion), 2, axis=0), axis=-1) * motion.fps**2)
