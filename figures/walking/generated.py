"""Walks generated from tables of figures: the clips that come with the package.

How a walk is made: a timing says for every frame how far the walker has come, in which phase of the cycle and
in which gait (`gait_timing`). The feet are planted along a path (`footsteps`). The gait's tables swing the
trunk and the arms (`gait`). The legs join the pelvis and the feet (`walking_body`). Small random differences
from step to step make every frame different.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError
from walking.footsteps import FootPath, SmoothPath, Steps, foot_path, smooth_path, winding
from walking.gait import GAITS, WALK, joint_angles, knee_flexion, mix, mix_rolls, pelvis_drift
from walking.gait_timing import Timing, changing, drift, halting, steady
from walking.walking_body import FIGURES, FOOT, FPS, HIPS, SKELETON, leg, pelvis_height

GRAVITY = 9.81
STANDING_KNEE = np.radians(18.0)
CLIPS = FIGURES["clips"]


def generate(name: str) -> Motion:
    """Make one of the bundled clips; every call gives the same bits.

    Parameters
    ----------
    name : one of `samples.SAMPLES`.

    Returns
    -------
    A motion of `walking_body.SKELETON` at 120 Hz: labelled, and with the footplants as `contacts`.

    Raises
    ------
    MocapError : for an unknown name.

    Examples
    --------
    >>> generate("walk_straight")
    Motion('walk_straight', 1201 frames at 120 Hz, 38 joints)
    """
    if name not in CLIPS:
        raise MocapError(f"No bundled clip '{name}'; there are: {', '.join(CLIPS)}, jump.")
    clip, seed = CLIPS[name], list(CLIPS).index(name)
    path, rng = smooth_path(winding(clip["path"])), np.random.default_rng(seed)
    if "speed" in clip:
        timing = steady(WALK, clip["speed"], path.length / clip["speed"], rng)
    elif "into" in clip:
        timing = changing((WALK, GAITS[clip["into"]]), clip["stages"], rng)
    else:
        timing = halting(WALK, clip["strides"], clip["rests"])
    return replace(_perform(path, timing, rng), name=name)


def generate_walk(
    path: ArrayLike, *, style: str = "walk", speed: float | None = None, seed: int = 0
) -> Motion:
    """Walk along a path on the ground, from its start to its end, at a steady speed.

    Parameters
    ----------
    path : shape (N, 2), metres: points (x, z); a smooth curve passes through them.
    style : one of "walk", "sneak", "jog".
    speed : metres per second; by default the style's own.
    seed : another number gives other small differences from step to step.

    Returns
    -------
    A motion of `walking_body.SKELETON` at 120 Hz, labelled `style`, with the footplants as `contacts`: the
    ankle (`lfoot`, `rfoot`) while the sole lies flat, the ball (`ltoes`, `rtoes`) until it leaves the ground.

    Raises
    ------
    MocapError : for an unknown style, points that make no path, a speed that is not above 0, or one that is
        too high for the legs.

    Examples
    --------
    >>> generate_walk([[0, 0], [0, 2], [1, 4]], speed=1.2)
    Motion('walk', 427 frames at 120 Hz, 38 joints)

    Notebook: 01b-motion-files
    """
    if style not in GAITS:
        raise MocapError(f"No style '{style}'; there are: {', '.join(GAITS)}.")
    gait = GAITS[style]
    speed = gait.speed if speed is None else speed
    if not (np.isfinite(speed) and speed > 0):
        raise MocapError(f"A walk needs a speed above 0, got {speed}.")
    curve, rng = smooth_path(path), np.random.default_rng(seed)
    return _perform(curve, steady(gait, speed, curve.length / speed, rng), rng)


class Travel(NamedTuple):
    """Where the body faces: `heading`, `bank` to the left (F,), radians; vectors `ahead`, `left` (F, 3)."""

    heading: Array
    bank: Array
    ahead: Array
    left: Array


def _travel(path: SmoothPath, timing: Timing) -> Travel:
    """Face along the path and lean into its turns: tan(bank) = v · dθ/dt / g."""
    heading = gaussian_filter1d(path.heading(timing.distance), 0.1 * FPS)
    push = np.gradient(timing.distance) * np.gradient(heading) * FPS**2
    bank = gaussian_filter1d(np.arctan(push / GRAVITY), 0.15 * FPS)
    level = np.zeros_like(heading)
    ahead = np.stack([np.sin(heading), level, np.cos(heading)], axis=-1)
    return Travel(heading, bank, ahead, np.stack([np.cos(heading), level, -np.sin(heading)], axis=-1))


def _plan(path: SmoothPath, timing: Timing, bank: Array, rng: np.random.Generator) -> dict[str, Steps]:
    """Plant each foot where the pelvis passes over it later, half a step's width to the side."""
    plans = {}
    for side, first, outwards in (("l", 0.0, 1), ("r", 0.5, -1)):
        strikes = np.arange(np.floor(timing.phase[0]) - 2, timing.phase[-1] + 2) + first
        strikes = strikes[~np.isin(strikes, timing.skipped)]
        weights = np.stack([np.interp(strikes, timing.phase, weight) for weight in timing.weights])
        under, width, toe_out = (
            mix([getattr(gait, name) for gait in timing.gaits], weights)
            for name in ("under", "step_width", "toe_out")
        )
        distance, lean = (
            np.interp(strikes + under, timing.phase, values) for values in (timing.distance, bank)
        )
        luck = rng.standard_normal((4, len(strikes)))
        yaws = path.heading(distance)
        left = outwards * (width / 2 + 0.009 * luck[0]) - 0.9 * np.tan(lean)
        places = path.at(distance + 0.012 * luck[1])
        places += left[:, None] * np.stack([np.cos(yaws), -np.sin(yaws)], axis=-1)
        yaws = yaws + outwards * np.radians(toe_out + 1.5 * luck[2])
        vigour = np.maximum(0.5, np.interp(strikes[1:] - 0.25, timing.phase, timing.vigour))
        rolls = [mix_rolls([gait.roll for gait in timing.gaits], weight) for weight in weights.T[:-1]]
        plans[side] = Steps(strikes, places, yaws, vigour * (1 + 0.03 * luck[3, 1:]), rolls)
    return plans


def _upper_body(timing: Timing, travel: Travel, rng: np.random.Generator) -> dict[str, Array]:
    """Swing the trunk and the arms, with noise; chest and head turn into a bend before the pelvis does."""
    amplitude = timing.vigour * (1 + 0.1 * drift(rng, timing.times, 1)[:, 0])
    swings = [joint_angles(gait, timing.phase, amplitude) for gait in timing.gaits]
    angles = {joint: mix([swing[joint] for swing in swings], timing.weights) for joint in swings[0]}
    for joint in ("lowerback", "upperback", "thorax", "upperneck", "lhumerus", "rhumerus"):
        angles[joint] += np.radians(1.3) * drift(rng, timing.times, 3)
    for joint in ("lradius", "rradius"):  # an elbow is a hinge: noise changes the angle, not the axis
        usual = np.linalg.norm(angles[joint], axis=-1).mean()
        angles[joint] *= 1 + np.radians(3.0) / usual * drift(rng, timing.times, 1)
    soon, later = (np.interp(timing.times + s, timing.times, travel.heading) for s in (0.12, 0.35))
    for joints, lead in (
        (("upperback", "thorax"), soon - travel.heading),
        (("upperneck", "head"), later - soon),
    ):
        for joint in joints:
            angles[joint][:, 1] += lead / 2
    angles["root"][:, 2] -= travel.bank
    return angles


def _perform(path: SmoothPath, timing: Timing, rng: np.random.Generator) -> Motion:
    """Plan with the seconds before the first and after the last frame, cut them off, and pose the body."""
    travel = _travel(path, timing)
    plans = _plan(path, timing, travel.bank, rng)
    angles = _upper_body(timing, travel, rng)
    turns = {joint: rotations.from_rotvec(turn[timing.inside]) for joint, turn in angles.items()}
    heading, bank, ahead, left = (values[timing.inside] for values in travel)
    timing = timing.cut()
    turns["root"] = rotations.multiply(rotations.about_y(heading), turns["root"])
    feet = {side: foot_path(steps, timing.phase, FOOT) for side, steps in plans.items()}
    swing = mix([pelvis_drift(gait, timing.phase, timing.vigour) for gait in timing.gaits], timing.weights)
    swing[:, [0, 2]] += 0.003 * drift(rng, timing.times, 2)
    x, z = path.at(timing.distance).T
    root = np.stack([x, swing[:, 1] * np.cos(bank), z], axis=-1)
    root += swing[:, :1] * left + swing[:, 2:] * ahead
    root[:, 1] = _ride(root, turns["root"], feet, timing)
    for side, foot in feet.items():
        turns |= leg(side, turns["root"], root, foot, ahead)
    still = np.broadcast_to(rotations.IDENTITY, (len(root), 4))
    pose = np.stack([turns.get(joint, still) for joint in SKELETON.names], axis=1)
    contacts = {side + "foot": foot.flat for side, foot in feet.items()}
    contacts |= {side + "toes": foot.planted for side, foot in feet.items()}
    return Motion(SKELETON, root, pose, FPS, timing.gaits[0].name, _labels(timing, feet), contacts)


def _ride(root: Array, pelvis: Array, feet: dict[str, FootPath], timing: Timing) -> Array:
    """Find the height of the pelvis; the less the walker moves, the straighter the knees."""
    hips = {side: rotations.rotate(pelvis, HIPS[side]) for side in feet}
    bends = {}
    for side, foot in feet.items():
        knee = mix([knee_flexion(gait, foot.stance) for gait in timing.gaits], timing.weights)
        bends[side] = STANDING_KNEE + timing.vigour * (knee - STANDING_KNEE)
    height_weight = mix([gait.height_weight for gait in timing.gaits], timing.weights)
    return pelvis_height(root, hips, feet, bends, height_weight)


def _labels(timing: Timing, feet: dict[str, FootPath]) -> dict[str, Mask]:
    """Label each frame with the gait that has the largest weight; "stand" where both soles lie flat."""
    standing = feet["l"].flat & feet["r"].flat
    most = timing.weights.argmax(axis=0)
    labels = {gait.name: (most == number) & ~standing for number, gait in enumerate(timing.gaits)}
    return labels | ({"stand": standing} if standing.any() else {})
