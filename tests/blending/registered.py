"""Walks to register, generated and captured; what is measured of their blends; and the ways that fail."""

import itertools
from dataclasses import replace
from functools import cache

import numpy as np

from mocap._shared.arrays import runs
from mocap.body import Motion, find_legs, heading, joint_positions, on_ground, rotations
from mocap.datasets.samples import sample
from mocap.feet import mark_plants
from mocap.files.load_save import load
from mocap.matching.point_clouds import align, point_cloud
from mocap.quality.seam_measures import foot_sliding

SPEEDS, TURNS = (0.8, 1.1, 1.4), (-120, 0, 120)  # metres per second, degrees within 5 m
HALF = np.array([0.5, 0.5])


@cache
def walks():
    """Nine generated walks of 5 m, with plants that are exact by construction: {(speed, turn): motion}."""
    return {pair: sample("walk_5m_{}_{}".format(*pair)) for pair in itertools.product(SPEEDS, TURNS)}


@cache
def captured(folder, trial):
    """A trial of subject 16 of the CMU database at 120 Hz, its plants marked."""
    subject = trial.split("_")[0]
    skeleton = folder / "cmu" / subject / f"{subject}.asf"
    return mark_plants(load(folder / "cmu" / subject / f"{trial}.amc", fps=120.0, skeleton=skeleton))


def feet(motion):
    return [joint for leg in find_legs(motion.skeleton) for joint in (leg.ankle, leg.ball)]


def foot_sliding_speed(motion):
    """The least ground speed of any ankle or ball, cm/s, the mean of all frames: one foot always stands."""
    ground = on_ground(joint_positions(motion)[:, feet(motion)])
    return 100 * float(np.abs(np.diff(ground, axis=0)).min(axis=1).mean()) * motion.fps


def slides(motion):
    """The largest stray of each whole plant from its mean place, cm."""
    whole = [plant for plant in foot_sliding(motion) if plant.start > 0 and plant.stop < len(motion)]
    return np.array([plant.distance for plant in whole])


def knees(motion):
    """The range from the 1st to the 99th percentile of the knees' angles, degrees."""
    ranges = []
    for leg in find_legs(motion.skeleton):
        angle = np.degrees(np.linalg.norm(rotations.to_rotvec(motion.rotations[:, leg.knee]), axis=-1))
        ranges.append(np.subtract(*np.percentile(angle, [99, 1])))
    return float(np.mean(ranges))


def way(motion):
    """The length of the root's way over the ground, metres."""
    return float(np.abs(np.diff(on_ground(motion.root_positions))).sum())


def turned(motion):
    """How far the body has turned from first to last, degrees."""
    facing = np.unwrap(heading(motion.rotations[:, 0]))
    return float(np.degrees(facing[-1] - facing[0]))


def strikes(motion):
    """When each foot starts to stand, seconds: left, right."""
    names, found = motion.skeleton.names, []
    for leg in find_legs(motion.skeleton):
        stands = motion.contacts[names[leg.ankle]] | motion.contacts[names[leg.ball]]
        found.append(np.array([start for start, _ in runs(stands) if start > 0]) / motion.fps)
    return found


def strike_errors(registration):
    """How far the second clip's strikes are from where the timewarp puts those of the first, ms."""
    first, second = registration.clips
    errors = []
    for ours, theirs in zip(strikes(first), strikes(second), strict=True):
        for strike in ours[(ours >= registration.span[0]) & (ours <= registration.span[1])]:
            at = float(registration.times[1](strike))
            if 0.05 < at < second.duration - 0.05:
                errors.append(1000 * np.abs(theirs - at).min())
    return errors


def at_times(motion, seconds):
    """A motion at other times: a clip as it would be, had it been played at another pace."""
    return replace(motion.at(np.asarray(seconds) * motion.fps), labels={}, contacts={})


def frame_by_frame(a, b, *, stretch=False):
    """Half and half without a timewarp: frame i with frame i, or both stretched to the mean duration."""
    if stretch:
        phase = np.linspace(0, 1, int((a.duration + b.duration) / 2 * a.fps) + 1)
        a, b = at_times(a, phase * a.duration), at_times(b, phase * b.duration)
    count = min(len(a), len(b))
    clouds = (point_cloud(clip[:12]).reshape(-1, 3) for clip in (a, b))
    b = align(*clouds).apply_motion(b)
    roots = (a.root_positions[:count] + b.root_positions[:count]) / 2
    turns = rotations.slerp(a.rotations[:count], b.rotations[:count], np.full((count, 1), 0.5))
    return Motion(a.skeleton, roots, turns, a.fps, "frame by frame")
