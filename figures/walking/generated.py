"""Walks generated from tables of figures: the clips that come with the package.

A timing says for every frame the distance, the phase and the gait (`gait_timing`). The feet are planted along
a path (`footplanning`). The gait's harmonics swing trunk and arms (`gait`). The standing legs carry the
pelvis, and the swinging ones follow it (`leg_motion`). Small random differences from step to step make every
frame different.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Mask
from mocap.body import euler, rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError
from walking.footplanning import OUTWARDS, Travel, follow, plan_footplants
from walking.footsteps import SmoothPath, smooth_path, winding
from walking.gait import GAITS, WALK, arm_angles, mix, pelvis_drift, trunk_angles
from walking.gait_timing import Timing, changing, drift, halting, steady
from walking.leg_motion import Stance, pelvis_height, push_off, stand, swing, target_knee
from walking.walking_body import FIGURES, FOOT, FPS, HIPS, SKELETON, TOO_LONG, leg

CLIPS = FIGURES["clips"]
ELBOW = np.array(FIGURES["arms"]["hinge"])  # the left elbow's axis
STILL = {name: np.radians(row) for name, row in FIGURES["arms"]["still"].items()}
SPINE = ("lowerback", "upperback", "thorax")
NECK = ("lowerneck", "upperneck", "head")
MIRRORED = {"l": np.array([1.0, 1.0, 1.0]), "r": np.array([1.0, -1.0, -1.0])}
ZXY = [2, 0, 1]  # axes in the order in which an arm turns about them
WOBBLE = np.radians(0.8)  # of trunk and arms
CHEST_LEADS = 0.12  # seconds: the chest turns into a bend before the pelvis does
HEAD_LEADS = 0.35
PELVIS_BANKS = 0.6  # share of the lean in a curve, measured on CMU 16 and others: 0.5 to 0.7
CHEST_BANKS = (
    0.15  # so that the trunk has a third of the lean, as theirs (0.3 to 0.4); the head stays upright
)
SWAY = 0.003  # metres: also of one who stands
LOWEST = 0.8  # metres: a pelvis sinks so low only for steps that are longer than the legs
STANDING_VIGOUR = 0.3  # a walker who moves less, with both soles flat, stands


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
    >>> generate("walk_straight").fps
    120.0
    """
    if name not in CLIPS:
        raise MocapError(f"No bundled clip '{name}'; there are: {', '.join(CLIPS)}, jump.")
    clip = CLIPS[name]
    rng = np.random.default_rng(list(CLIPS).index(name))
    path = smooth_path(winding(clip["path"]))
    if "into" in clip:
        timing = changing((WALK, GAITS[clip["into"]]), path, clip["stages"], rng)
    elif "rests" in clip:
        timing = halting(WALK, path, clip["strides"], clip["rests"])
    else:
        timing = steady(WALK, path, None, rng)
    return replace(_perform(path, timing, rng), name=name)


def generate_walk(
    path: ArrayLike, *, style: str = "walk", speed: float | None = None, seed: int = 0
) -> Motion:
    """Walk along a path on the ground, from its start to its end.

    Parameters
    ----------
    path : shape (N, 2), metres: points (x, z); a smooth curve passes through them.
    style : one of "walk", "sneak", "jog".
    speed : metres per second, kept also in curves. By default the style's own on straight lines; in curves
        the walker slows down as people do (`gait_timing`).
    seed : another number gives other small differences from step to step.

    Returns
    -------
    A motion of `walking_body.SKELETON` at 120 Hz, labelled `style`, with the footplants as `contacts`: the
    ankle (`lfoot`, `rfoot`) while the sole is flat, the ball (`ltoes`, `rtoes`) until it leaves the ground.

    Raises
    ------
    MocapError : for an unknown style, points that make no path, a speed that is not above 0, or one that is
        too high for the legs.

    Examples
    --------
    >>> walk = generate_walk([[0, 0], [0, 2], [1, 4]], speed=1.2)
    >>> walk.name, round(float(walk.root_positions[-1, 2]), 1)
    ('walk', 4.0)

    Notebook: 01b-motion-files
    """
    if style not in GAITS:
        raise MocapError(f"No style '{style}'; there are: {', '.join(GAITS)}.")
    if speed is not None and not (np.isfinite(speed) and speed > 0):
        raise MocapError(f"A walk needs a speed above 0, got {speed}.")
    rng = np.random.default_rng(seed)
    curve = smooth_path(path)
    return _perform(curve, steady(GAITS[style], curve, speed, rng), rng)


def _perform(path: SmoothPath, timing: Timing, rng: np.random.Generator) -> Motion:
    """Pose the body in all planned frames, and cut off the seconds before the first and after the last."""
    travel = follow(path, timing)
    plants = {side: plan_footplants(path, timing, travel, side, rng) for side in OUTWARDS}
    turns = _upper_body(timing, travel, rng)
    root = _ground_track(path, timing, travel, rng)
    hips = {side: rotations.rotate(turns["root"], HIPS[side]) for side in OUTWARDS}
    stances = {side: stand(plants[side], timing.phase, FOOT) for side in OUTWARDS}
    root[:, 1] = pelvis_height(root, hips, stances, timing)
    inside = timing.inside
    if root[inside, 1].min() < LOWEST:
        raise MocapError(TOO_LONG)
    shown = {joint: turn[inside] for joint, turn in turns.items()}
    for side, stance in stances.items():
        hip = root + hips[side]
        standing = push_off(plants[side], stance, hip, target_knee(stance, timing), FOOT)
        foot = swing(plants[side], standing, hip, travel.heading, timing)
        shown |= leg(side, shown["root"], root[inside], foot.cut(inside), travel.ahead[inside])
    still = np.broadcast_to(rotations.IDENTITY, shown["root"].shape)
    pose = np.stack([shown.get(joint, still) for joint in SKELETON.names], axis=1)
    contacts = {side + "foot": stance.flat[inside] for side, stance in stances.items()}
    contacts |= {side + "toes": stance.planted[inside] for side, stance in stances.items()}
    labels = _labels(timing, stances)
    return Motion(SKELETON, root[inside], pose, FPS, timing.gaits[-1].name, labels, contacts)


def _ground_track(path: SmoothPath, timing: Timing, travel: Travel, rng: np.random.Generator) -> Array:
    """Put the pelvis above the path, at the gait's own height, and let it sway and surge: (F, 3), metres."""
    drifts = [pelvis_drift(gait, timing.phase, timing.vigour) for gait in timing.gaits]
    sway, height, surge = mix(drifts, timing.weights).T
    x, z = path.point(timing.distance).T
    root = np.stack([x, height, z], axis=-1)
    root += sway[:, None] * travel.leftwards + surge[:, None] * travel.ahead
    root[:, [0, 2]] += SWAY * drift(rng, timing.times, 2)
    return np.asarray(root)


def _upper_body(timing: Timing, travel: Travel, rng: np.random.Generator) -> dict[str, Array]:
    """Swing pelvis, spine, head and arms: {joint: rotations (F, 4)}, the root's in the world."""
    vigour = timing.vigour * (1 + 0.06 * drift(rng, timing.times, 1)[:, 0])
    pelvis, thorax, head = (_trunk(part, timing, vigour) for part in ("pelvis", "thorax", "head"))
    soon = np.interp(timing.times + CHEST_LEADS, timing.times, travel.heading)
    later = np.interp(timing.times + HEAD_LEADS, timing.times, travel.heading)
    pelvis[:, 2] -= PELVIS_BANKS * travel.bank
    thorax[:, 1] += soon - travel.heading
    thorax[:, 2] -= CHEST_BANKS * travel.bank
    thorax += WOBBLE * drift(rng, timing.times, 3)
    head[:, 1] += later - travel.heading
    head += WOBBLE * drift(rng, timing.times, 3)
    angles = {"root": pelvis}
    angles |= {joint: (thorax - pelvis) / len(SPINE) for joint in SPINE}
    angles |= {joint: (head - thorax) / len(NECK) for joint in NECK}
    turns = {joint: rotations.from_rotvec(angle) for joint, angle in angles.items()}
    turns["root"] = rotations.multiply(rotations.about_y(travel.heading), turns["root"])
    for side in OUTWARDS:
        turns |= _arm(side, timing, vigour, thorax[:, 0], rng)
    return turns


def _trunk(part: str, timing: Timing, vigour: Array) -> Array:
    """Swing a middle part of the body: rotation vectors (F, 3) relative to the heading."""
    angles = [trunk_angles(getattr(gait, part), timing.phase, vigour) for gait in timing.gaits]
    return mix(angles, timing.weights)


def _arm(side: str, timing: Timing, vigour: Array, nod: Array, rng: np.random.Generator) -> dict[str, Array]:
    """Swing an arm: {joint: rotations (F, 4) relative to the parent}.

    `nod` (F,), radians, is the lean of the thorax, against which the arm hangs down.
    """
    phase = timing.phase - (0.5 if side == "r" else 0.0)
    swings = [arm_angles(gait.arm, phase, vigour) for gait in timing.gaits]
    angles = {name: mix([swing[name] for swing in swings], timing.weights) for name in swings[0]}
    noise = WOBBLE * drift(rng, timing.times, 3)
    mirror = MIRRORED[side]
    upper = np.stack([angles["out"], -angles["swing"] - nod, angles["twist"]], axis=-1) + noise
    hinge = ELBOW / np.linalg.norm(ELBOW) * mirror
    bend = np.outer(angles["elbow"] + noise[:, 0], hinge)
    hand = np.outer(angles["hand"], [1.0, 0.0, 0.0]) + STILL["hand"] * mirror
    turns = {
        "humerus": euler.from_euler("ZXY", upper * mirror[ZXY]),
        "radius": rotations.from_rotvec(bend),
        "hand": rotations.from_rotvec(hand),
    }
    for joint in ("wrist", "fingers"):
        still = np.tile(STILL[joint] * mirror, (len(phase), 1))
        turns[joint] = rotations.from_rotvec(still)
    return {side + joint: turn for joint, turn in turns.items()}


def _labels(timing: Timing, stances: Mapping[str, Stance]) -> dict[str, Mask]:
    """Label each frame: "stand" with both soles flat and hardly a movement, else the gait.

    Of two gaits the second one has the frames in which its weight is `labelled_from` or more. For a sneak
    this is 0.1: no frame that is visibly crouched is labelled "walk".
    """
    inside = timing.inside
    standing = stances["l"].flat & stances["r"].flat & (timing.vigour < STANDING_VIGOUR)
    walking = ~standing[inside]
    first = timing.gaits[0]
    labels = {first.name: walking}
    for second, weight in zip(timing.gaits[1:], timing.weights[1:], strict=True):
        changed = weight[inside] >= second.labelled_from
        labels = {first.name: walking & ~changed, second.name: walking & changed}
    return labels | ({"stand": standing[inside]} if standing[inside].any() else {})
