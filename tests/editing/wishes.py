"""Wishes that several tests ask of a walk: a stone, a bar, a hand, a rail; and how well they are met."""

from functools import cache
from pathlib import Path

import numpy as np

from mocap._shared.arrays import runs
from mocap.body import Motion, joint_positions, resample, rotations
from mocap.datasets.samples import sample
from mocap.editing.constraint_checks import pin_errors
from mocap.editing.constraints import Pins
from mocap.editing.pins import join_pins, pin, plant_pins
from mocap.feet import clean_up, mark_plants
from mocap.files.load_save import load
from tests.refusals import quietly

FEET = ("lfoot", "ltoes", "rfoot", "rtoes")
HEAD = ("head_end", "head", "upperneck", "lowerneck")
NOISE = ("hand", "finger", "thumb", "_end")


@cache
def walk(fps: float = 120.0) -> Motion:
    """Four seconds of a bundled walk."""
    return resample(sample("walk_straight")[100:600], fps)


@cache
def captured(folder: Path, file: str = "cmu/16/16_15.amc", last: int | None = 600) -> Motion:
    """Four seconds of a captured walk with feet that stand; the left arm of 16_15 snaps in frame 1."""
    return quietly(clean_up, mark_plants(load(folder / file)[12:last]))


def stone(clip: Motion, height: float, step: int = 1) -> Pins:
    """Put one step of the left foot higher, by default the second; all other plants stay."""
    pins, down = plant_pins(clip), runs(clip.contacts["ltoes"])
    start, stop = down[step]
    up = np.zeros(pins.low.shape)
    for column, joint in enumerate(pins.joints):
        if clip.skeleton.names[joint] in FEET[:2]:
            up[start:stop, column, 1] = height
    return Pins(pins.joints, pins.low + up, pins.high + up)


def bar(clip: Motion, height: float, middle: int, *, around: float = 0.25) -> Pins:
    """Hang a bar across the way: head and neck shall pass under it; feet stay planted."""
    along = (clip.root_positions[-1] - clip.root_positions[0]) * [1, 0, 1]
    along /= np.linalg.norm(along)
    away = (joint_positions(clip) - clip.root_positions[middle]) @ along
    free, below = [-np.inf] * 3, [np.inf, height, np.inf]
    names = [name for name in HEAD if name in clip.skeleton.names]
    near = {name: np.abs(away[:, clip.skeleton.index(name)]) < around for name in names}
    return join_pins(plant_pins(clip), *(pin(clip, name, near[name], free, below) for name in names))


def hand(clip: Motion, frames, around: int, ahead=(-0.15, 0.30, 0.15)) -> Pins:
    """Ask the right wrist to a place that is off its own in frame `around`, seen from the body."""
    wrist = clip.skeleton.index("rwrist")
    place = joint_positions(clip)[around, wrist] + rotations.rotate(clip.rotations[around, 0], ahead)
    return pin(clip, wrist, frames, place)


def hand_at(clip: Motion, frames) -> Pins:
    """Ask the hand to such a place in some frames, each by itself; feet stay planted."""
    return join_pins(plant_pins(clip), *(hand(clip, [frame], frame) for frame in frames))


def far_hand(clip: Motion) -> Pins:
    """Ask the right wrist to a place five metres above it, in ten frames."""
    place = joint_positions(clip)[240, clip.skeleton.index("rwrist")]
    return pin(clip, "rwrist", slice(240, 250), place + np.array([0, 5, 0]))


def rms(errors: np.ndarray, pins: Pins) -> float:
    """Return the rms error in frames in which something is asked, metres."""
    return float(np.sqrt((errors[pins.constrained.any(axis=1)] ** 2).mean()))


def body(motion: Motion) -> list[int]:
    """List the joints without hands, fingers, thumbs and end sites, where captured noise lives."""
    return [j for j, n in enumerate(motion.skeleton.names) if not any(w in n.lower() for w in NOISE)]


def accelerations(motion: Motion, share: float = 99) -> float:
    """Return a percentile of the body's accelerations, m/s²."""
    pushes = np.diff(joint_positions(motion)[:, body(motion)], 2, axis=0) * motion.fps**2
    return float(np.percentile(np.linalg.norm(pushes, axis=-1), share))


def smoothness(motion: Motion, base: Motion) -> float:
    """Return the accelerations' 99th percentile over the source's."""
    return accelerations(motion) / accelerations(base)


def shakes(motion: Motion, base: Motion, pins: Pins) -> float:
    """Return the accelerations' 95th percentile within half a second of what is asked, over the source's."""
    asked = np.flatnonzero(pin_errors(base, pins).max(axis=1) > 0.01)
    near = slice(max(0, asked[0] - round(base.fps / 2)), asked[-1] + round(base.fps / 2))
    return accelerations(motion[near], 95) / accelerations(base[near], 95)


def neck(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Return which way trunk and head point, (F, 3) each."""
    points, index = joint_positions(motion), motion.skeleton.index
    base = points[:, index("lowerneck")]
    return base - points[:, 0], points[:, index("head")] - base


def between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the angles between ways (F, 3), degrees."""
    return np.degrees(rotations.angle_between(rotations.between(a, b), rotations.IDENTITY))


def bones(motion: Motion) -> float:
    """Return by how much a bone in space is longer or shorter than the skeleton's, at most, metres."""
    positions, skeleton = joint_positions(motion), motion.skeleton
    lengths = np.linalg.norm(positions[:, 1:] - positions[:, skeleton.parents[1:]], axis=-1)
    return float(np.abs(lengths - np.linalg.norm(skeleton.offsets[1:], axis=-1)).max())
