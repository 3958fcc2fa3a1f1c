"""Clips whose knees hardly accelerate, or are straight, while their feet slide: hard ones for a clean-up."""

from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mocap.body import Motion, concatenate, find_legs, resample, rotations
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from mocap.feet.leg_track import UP, pose_leg, track_leg
from mocap.quality.seam_measures import foot_sliding


def noise(random: np.random.Generator, frames: int, width: float) -> np.ndarray:
    """Return smooth noise (F, 3) whose largest size is 1."""
    smooth = gaussian_filter1d(random.normal(size=(frames + 200, 3)), width, axis=0)[100:-100]
    return smooth / np.linalg.norm(smooth, axis=1).max()


def standing(pose: Motion, fps: float, *, knee: float, bow: float, sway: float) -> Motion:
    """Let a body stand for 5 s on knees bent by some degrees, breathe, bow, sway by metres, and tremble."""
    random, frames = np.random.default_rng(1), int(5 * fps)
    share = np.sin(np.linspace(0, np.pi, frames)) ** 2
    still = concatenate([replace(pose, fps=fps, contacts={}, labels={})] * frames)
    still = replace(still, root_positions=still.root_positions - 0.04 * share[:, None] * UP * (bow > 0))
    local, legs, ankles = still.rotations.copy(), find_legs(pose.skeleton), forward_kinematics(pose).positions
    nod = rotations.from_rotvec(
        np.radians(bow * share + np.sin(np.linspace(0, 8, frames)))[:, None] * [1, 0, 0]
    )
    spine = pose.skeleton.index("lowerback")
    local[:, spine] = rotations.multiply(nod, local[:, spine])
    poses = forward_kinematics(still)
    tracks = [track_leg(still, leg, poses) for leg in legs]
    rise = np.min(
        [
            np.sqrt(track.reach(np.radians(knee)) ** 2 - apart[:, 0] ** 2 - apart[:, 2] ** 2) - apart[:, 1]
            for track in tracks
            for apart in [track.hip - ankles[:, track.leg.ankle]]
        ],
        axis=0,
    )
    for track in tracks:
        wanted = ankles[:, track.leg.ankle] - track.hip - rise[:, None] * UP
        bend = track.flexion_at(np.linalg.norm(wanted, axis=-1))
        local[:, track.leg[:3]] = pose_leg(track, bend, wanted, np.zeros((frames, 3)))
        for joint in track.leg[:2]:
            tremble = np.radians(0.3) * noise(random, frames, fps / 10)
            local[:, joint] = rotations.multiply(local[:, joint], rotations.from_rotvec(tremble))
    roots = still.root_positions + rise[:, None] * UP + sway * noise(random, frames, fps / 3) * [1, 0.3, 1]
    return mark_plants(replace(still, root_positions=roots, rotations=local))


def slowed(motion: Motion, times: float) -> Motion:
    return mark_plants(replace(resample(motion, motion.fps * times), fps=motion.fps))


def unbent(motion: Motion, beyond: float) -> Motion:
    """Turn each knee until its straightest frames are straight, and some degrees more."""
    local, poses = motion.rotations.copy(), forward_kinematics(motion)
    for leg in find_legs(motion.skeleton):
        track = track_leg(motion, leg, poses)
        turn = np.percentile(track.flexion, 2) + np.radians(beyond)
        above = (motion.skeleton.parents[leg.hip], leg.hip, leg.knee)
        for parent, joint, share in zip(above, leg[:3], (0.5, -1.0, 0.5), strict=True):
            frame = rotations.from_matrix(poses.matrices[:, parent])
            axis = rotations.rotate(rotations.inverse(frame), track.axis)
            local[:, joint] = rotations.multiply(rotations.from_rotvec(share * turn * axis), local[:, joint])
    return mark_plants(replace(motion, rotations=local))


def jumps(motion: Motion, joints: list[int] | slice, span: int) -> np.ndarray:
    """Return second differences over `span` frames, (F - 2 span, joints), metres."""
    x = joint_positions(motion)[:, joints]
    return np.linalg.norm(x[2 * span :] - 2 * x[span:-span] + x[: -2 * span], axis=-1)


def check_clean_up(clip: Motion, least: float) -> tuple[int, int]:
    """Clean a clip up: plants are kept, stand still, and no knee pops from a picture of a film to the next.

    Returns how many planted frames are kept, and of how many.
    """
    cleaned = clean_up(clip)
    kept, asked = (
        sum(int((m.contacts[name] & mark).sum()) for name, mark in clip.contacts.items())
        for m in (cleaned, clip)
    )
    assert kept >= least * asked > 0
    assert max(slide.distance for slide in foot_sliding(cleaned)) < 1e-6
    moved = cleaned.root_positions - clip.root_positions
    legs = find_legs(clip.skeleton)
    assert np.all(moved[:, [0, 2]] == 0)
    assert np.abs(moved).max() <= 0.024 * legs[0].lengths(clip.skeleton)[:2].sum()
    own, now = (jumps(m, [leg.knee for leg in legs], max(1, round(clip.fps / 30))) for m in (clip, cleaned))
    assert (now - np.maximum(own, np.percentile(own, 99.9, method="lower"))).max() < 0.006
    own, now = (np.percentile(jumps(m, slice(None), 1), 99) * clip.fps**2 for m in (clip, cleaned))
    assert now <= 1.2 * max(own, 1.0)
    return kept, asked
