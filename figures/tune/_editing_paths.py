"""Trials of the constants of paths, bending, keys, mirror images, cycles, stances and retargeting.

- Bends: walks along an S, around a corner of 135° and on a circle of 0.7 m. Off: the distance of the root
  from the line, where it is not rounded, cm; rounded: from the rounded parts. Rate: the largest rate by which
  a walk is turned, over the limit. Kept: planted frames after the clean-up, percent. Shakes: accelerations
  over those of the clip. `standing_speed` and `walking_speed`: of a clip that stands and walks.
- Rounding: corners of 90°, 135° and 170°, and a zigzag. Cut: the distance of the rounded line, cm; moved: the
  length of line that is moved by more than 1 cm, m; length: of the rounded lines over the requested ones.
- Paths: sway: of the root about its path, cm, and its largest distance from the path. Wags: the standard
  deviation of the path's heading over a second, degrees. Corner: the turning rate of a walk at a right angle,
  degrees per second. Cut: the distance of the frames from that corner, cm. Curls: the largest second
  difference of the frames of a body that stands, mm.
- Pace: the error of the law of pace on turns, percent. Leans: of pelvis and trunk over that of the legs. Both
  are medians over captured turns, if these are here, or else of generated ones, which do not lean.
- Keys: accelerations of an arm around a hand that is 30 cm away for a moment, over the clip's own.
- Mirror images of bodies whose bones are 5 % off: the distance of joints from the exact image, cm. K: the
  largest angle between K and the nearer of its usual values. Warned, snapped: how many of four bodies.
- Cycles: seam, missed (cm), their seconds, and the distance between both ends after the clean-up (mm).
- Stances: which rest poses, frames of a clip that stands and walks, and short clips are accepted as stances.
- Retargeting to a child: the least angle of a knee, degrees; planted frames that are kept, percent; how far
  the hips are moved, cm; shakes as above; warned: how many of three lengths of steps.
"""

import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from _trials import RATE, Clips, Collection, Row, Trial, cmu
from scipy.ndimage import uniform_filter1d

from mocap._shared.arrays import Array
from mocap.body import GroundPath, Motion, Skeleton, circle, find_legs, joint_positions, rotations, s_curve
from mocap.body.limbs import FEET, roles
from mocap.editing import (
    bend,
    displaced,
    find_loop,
    keys_around,
    loop,
    mirror,
    moving_frames,
    offsets,
    plants_kept,
    posed,
    proportioned,
    retarget,
    ride_of,
    stance_of,
    symmetry,
    tuned,
)
from mocap.editing.foot_heights import heights_from_balls, is_pose, standing_heights
from mocap.editing.keys import Key
from mocap.editing.line_rounding import round_line
from mocap.editing.path_editing import Ride
from mocap.editing.stances import stance_of_pose, stance_of_zero
from mocap.editing.turning import bends_of, places_on
from mocap.errors import MocapError, MocapWarning
from mocap.feet import clean_up, mark_plants

SECONDS = 6.0  # of a clip
SHORT = 2.5  # seconds of a clip that is retargeted
PACE = 1.3  # metres per second, of a walk on lines
STRIDE = 1.0  # seconds, about
GRAVITY = 9.81  # metres per second squared
HAND = (0.2, 0.2, 0.1)  # metres from the wrist, to the body's left, up and ahead
PUSH = 0.006  # metres, the amplitude of a sine that makes feet slide
NOISE = 0.05  # of lengths of bones
STANDING_SPEED = 0.2  # metres per second
TURNING = 0.15  # radians per metre: from this curvature on, leans are compared
RATIOS = (0.6, 1.5, 3.0)  # scales of steps, over the ratio of the legs
STANDING = Collection("a clip that stands and walks", ("stop_and_go",))
CAPTURED_TURNS = Collection("CMU 16, walks and turns", cmu("16", *range(11, 35)), RATE)
GENERATED_TURNS = Collection("two generated turns", ("walk_curve_1", "walk_circle"), RATE)


@cache
def turns() -> Clips:
    """Return captured turns, or generated ones if those are not here."""
    return CAPTURED_TURNS.load() or GENERATED_TURNS.load() or ()


@cache
def walks(clips: Clips) -> list[Motion]:
    """Return the first seconds of clips, with clean feet."""
    return [clean_up(mark_plants(clip[: round(SECONDS * clip.fps)])) for clip in clips]


def warned(function: Callable[..., object], *arguments: object) -> int:
    """Return 1 if a call warns or is refused, or else 0."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", MocapWarning)
        try:
            function(*arguments)
        except (MocapError, MocapWarning):
            return 1
    return 0


def corner(degrees: float, side: float = 2.5) -> GroundPath:
    """Return a line with one corner."""
    angle = np.radians(degrees)
    return GroundPath([[0, 0], [0, side], [side * np.sin(angle), side + side * np.cos(angle)]])


def shaking(motion: Motion) -> float:
    """Return the 99th percentile of second differences of positions, metres."""
    jumps = np.linalg.norm(np.diff(joint_positions(motion), 2, axis=0), axis=-1)
    return float(np.percentile(jumps, 99))


def bent(clips: Clips) -> Row:
    """Bend walks to three lines."""
    distances = []
    rounded = [0.0]
    rates = []
    kept = []
    shakes = []
    limit = tuned.TUNED.turning_limit
    for walk in walks(clips):
        ride = ride_of(walk, stride=tuned.TUNED.path_knots)
        for line in (s_curve(8.0), corner(135.0), circle(0.7)):
            result = bend(walk, line, ride=ride, limit=limit)
            distances += result.off[~result.rounded].tolist()
            rounded += result.off[result.rounded].tolist()
            rates.append(float(np.abs(result.turned).max() / limit))
            kept.append(plants_kept(result.motion, result.laid))
            shakes.append(shaking(result.motion) / shaking(walk))
    row = {"off, cm": 100 * float(np.mean(distances)), "worst, cm": 100 * max(distances)}
    row |= {"rounded, cm": 100 * max(rounded), "rate": max(rates)}
    return row | {"kept, %": 100 * min(kept), "shakes": max(shakes)}


def bent_with_pauses(_clips: Clips) -> Row:
    """Bend a clip that stands and walks."""
    return bent(STANDING.load() or ())


def rounded_lines(_clips: Clips) -> Row:
    """Round four lines for a steady walk."""
    cut = []
    moved = []
    lengths = []
    rates = []
    fps = 30.0
    limit = tuned.TUNED.turning_limit
    along = np.arange(0, 30, PACE / fps)
    ride = Ride(GroundPath([[0, 0], [0, along[-1]]]), along)
    zigzag = GroundPath([[1.2 * (number % 2), 0.5 * number] for number in range(7)])
    for line in (corner(90.0), corner(135.0), corner(170.0), zigzag):
        result = round_line(line, ride, fps, limit)
        cut.append(100 * float(result.moved.max()))
        moved.append(float(np.mean(result.moved > 0.01)) * line.length)
        lengths.append(result.path.length / line.length)
        metres, ratio = places_on(result.path, ride, fps, limit)
        turned = np.abs(np.diff(moving_frames(result.path, metres).angle))
        line_rates = fps * turned * np.sqrt(ratio[1:])
        rates.append(float(line_rates[metres[1:] < result.path.length].max() / limit))
    row = {"cut at 135°, cm": cut[1], "cut, cm": max(cut), "moved, m": sum(moved)}
    return row | {"length": max(lengths), "least length": min(lengths), "rate": max(rates)}


def paths(clips: Clips) -> Row:
    """Fit paths to walks."""
    sway = []
    worst = []
    wags = []
    for walk in walks(clips):
        ride = ride_of(walk, stride=tuned.TUNED.path_knots)
        frames = moving_frames(ride.path, ride.along)
        distances = np.hypot(walk.root_positions[:, 0] - frames.x, walk.root_positions[:, 2] - frames.z)
        sway.append(100 * float(np.sqrt(np.mean(distances**2))))
        worst.append(100 * float(distances.max()))
        window = round(walk.fps)
        trend = np.convolve(frames.angle, np.ones(window) / window, mode="valid")
        deviation = frames.angle[window // 2 :][: len(trend)] - trend
        wags.append(float(np.degrees(deviation.std())))
    return {"sway, cm": float(np.mean(sway)), "off, cm": max(worst), "wags, °": float(np.mean(wags))}


def frames_on_lines(_clips: Clips) -> Row:
    """Move frames along a corner and the path of a clip that stands and walks."""
    chord = tuned.TUNED.chord
    fps = 60.0
    along = np.arange(0.5, 4.5, PACE / fps)
    line = corner(90.0)
    frames = moving_frames(line, along, chord=chord)
    apex = line.points[1]
    cut = float(np.hypot(frames.x - apex[0], frames.z - apex[1]).min())
    corner_rate = float(np.degrees(np.abs(np.diff(np.asarray(frames.angle))).max() * fps))
    curls = []
    for clip in STANDING.load() or ():
        ride = ride_of(clip)
        origins = moving_frames(ride.path, ride.along, chord=chord)
        jumps = np.hypot(np.diff(origins.x, 2), np.diff(origins.z, 2))
        is_slow = np.gradient(ride.along)[1:-1] * clip.fps < STANDING_SPEED
        curls.append(float(jumps[is_slow].max(initial=0.0)))
    return {"corner, °/s": corner_rate, "cut, cm": 100 * cut, "curls, mm": 1000 * max(curls)}


def accepted_paths(_clips: Clips) -> Row:
    """Count seconds that have a path, but stand, and seconds that have none, but walk."""
    standing = 0
    walking = 0
    for clip in STANDING.load() or ():
        window = round(clip.fps)
        for start in range(0, len(clip) - window, window):
            part = clip[start : start + window]
            length = np.hypot(*np.diff(part.root_positions[[0, -1]][:, [0, 2]], axis=0)[0])
            is_refused = warned(ride_of, part)
            standing += length < STANDING_SPEED and not is_refused
            walking += length > 2 * STANDING_SPEED and is_refused
    return {"standing": standing, "walking refused": walking}


def pace(_clips: Clips) -> Row:
    """Compare the pace of clips in their turns with the law."""
    errors = []
    for clip in turns():
        ride = ride_of(clip)
        law = bends_of(ride.path)
        expected = np.interp(ride.along, law.along, law.pace)
        speed = np.gradient(ride.along) * clip.fps
        straight = speed[expected > 0.98]
        if len(straight) > clip.fps:
            errors.append(100 * float(np.abs(speed / np.median(straight) - expected).mean()))
    return {"error, %": float(np.mean(errors)) if errors else float("nan"), "clips": len(errors)}


def leans(_clips: Clips) -> Row:
    """Compare the leans of clips in their turns: of pelvis and trunk over those of the legs."""
    of_pelvis = []
    of_trunk = []
    for clip in turns():
        slopes = _lean_slopes(clip)
        if slopes is not None:
            of_pelvis.append(slopes[1] / slopes[0])
            of_trunk.append(slopes[2] / slopes[0])
    pelvis = float(np.median(of_pelvis)) if of_pelvis else float("nan")
    trunk = float(np.median(of_trunk)) if of_trunk else float("nan")
    chosen = tuned.TUNED
    row = {"pelvis": pelvis, "trunk": trunk, "clips": len(of_trunk)}
    return row | {"error": abs(pelvis - chosen.pelvis_lean) + abs(trunk - chosen.trunk_lean)}


def _lean_slopes(clip: Motion) -> Array | None:
    """Return leans of legs, pelvis and trunk per radian of balance; None if a clip does not turn."""
    ride = ride_of(clip)
    frames = moving_frames(ride.path, ride.along)
    bends = bends_of(ride.path)
    curvature = np.interp(ride.along, bends.along, bends.curvature)
    if np.abs(curvature).max() < TURNING:
        return None
    balance = np.arctan(curvature * (np.gradient(ride.along) * clip.fps) ** 2 / GRAVITY)
    heading = np.asarray(frames.angle)
    leftward = np.stack([np.cos(heading), np.zeros(len(clip)), -np.sin(heading)], axis=1)
    positions = joint_positions(clip)
    legs = find_legs(clip.skeleton)
    neck = positions[:, roles(clip.skeleton)["neck"]]
    hips = positions[:, [leg.hip for leg in legs]]
    ankles = positions[:, [leg.ankle for leg in legs]]
    across = hips[:, 0] - hips[:, 1]
    of_pelvis = np.arctan2(-across[:, 1], np.hypot(across[:, 0], across[:, 2]))
    upward = [(hips - ankles).mean(axis=1), neck - hips.mean(axis=1)]
    of_legs, of_trunk = (np.arctan2((part * leftward).sum(axis=1), part[:, 1]) for part in upward)
    angles = np.stack([of_legs, of_pelvis, of_trunk, balance])
    means = uniform_filter1d(angles, round(STRIDE * clip.fps))  # without the sway of each stride
    return np.array([np.polyfit(means[-1], mean, 1)[0] for mean in means[:-1]])


def hand_keys(clips: Clips) -> Row:
    """Move a hand by one key."""
    shakes = []
    for walk in walks(clips):
        middle = len(walk) // 2
        wrist = walk.skeleton.index("rwrist")
        offset = rotations.rotate(walk.rotations[middle, 0], HAND)
        target = joint_positions(walk)[middle, wrist] + offset
        pose = posed(walk, middle, {"rwrist": target})
        keys = keys_around(walk, [Key(middle, pose)], tuned.TUNED.key_margin)
        warped = displaced(walk, offsets(walk, keys))
        event = slice(middle - round(walk.fps / 2), middle + round(walk.fps / 2))
        peaks = []
        for motion in (warped, walk):
            jumps = np.linalg.norm(np.diff(joint_positions(motion)[event, wrist], 2, axis=0), axis=-1)
            peaks.append(float(np.percentile(jumps, 99)))
        shakes.append(peaks[0] / peaks[1])
    return {"shakes, mean": float(np.mean(shakes)), "shakes, worst": max(shakes)}


def _lopsided(skeleton: Skeleton, factor: float) -> Skeleton:
    """Return a skeleton whose left shin has another length."""
    values = skeleton.offsets.copy()
    values[find_legs(skeleton)[0].ankle] *= factor
    return replace(skeleton, offsets=values)


def _rotated(skeleton: Skeleton, degrees: float) -> Skeleton:
    """Return a skeleton whose rest pose is rotated about the vertical axis."""
    rotation = rotations.about_y(np.radians(degrees))
    return replace(skeleton, offsets=rotations.rotate(rotation, skeleton.offsets))


def mirrored(clips: Clips) -> Row:
    """Mirror walks of bodies with uneven bones."""
    random = np.random.default_rng(0)
    distances = []
    angles = []
    lopsided = 0
    snapped = 0
    for walk in walks(clips)[:2]:
        skeleton = walk.skeleton
        uneven = skeleton.offsets * (1 + NOISE * random.normal(size=(len(skeleton), 3)))
        motion = replace(walk, skeleton=replace(skeleton, offsets=uneven))
        partners, across, turns = symmetry(motion.skeleton)
        positions = joint_positions(mirror(motion)) - mirror(motion).root_positions[:, None]
        exact = (joint_positions(motion) - motion.root_positions[:, None])[:, partners] * [-1, 1, 1]
        distances.append(100 * float(np.linalg.norm(positions - exact, axis=-1).mean()))
        reflection = np.eye(3) - 2 * np.outer(across, across)
        opposite = rotations.from_matrix(-reflection)
        from_usual = [rotations.angle_between(turns, usual) for usual in (rotations.IDENTITY, opposite)]
        angles.append(float(np.degrees(np.minimum(*from_usual).max())))
        lopsided += sum(
            warned(mirror, replace(walk, skeleton=_lopsided(skeleton, factor)))
            for factor in (0.99, 0.98, 0.96, 0.9)
        )
        axes = [symmetry(_rotated(skeleton, degrees))[1] for degrees in (2, 5, 15, 30)]
        snapped += sum(int(np.abs(axis).max() == 1.0) for axis in axes)
    row = {"off, cm": float(np.mean(distances)), "K, °": max(angles)}
    return row | {"warned": lopsided, "snapped": snapped}


def cycles(clips: Clips) -> Row:
    """Find and close the best cycle of each clip."""
    seams = []
    missed = []
    seconds = []
    ends = []
    for clip in clips:
        cycle = find_loop(clip)
        seams.append(100 * cycle.seam)
        missed.append(100 * cycle.missed)
        seconds.append((cycle.last - cycle.first) / clip.fps)
        closed = loop(clip, cycle, straight=True, clean=True)
        relative = joint_positions(closed) - closed.root_positions[:, None]
        ends.append(1000 * float(np.abs(relative[0] - relative[-1]).max()))
    row = {"seam, cm": float(np.mean(seams)), "missed, cm": float(np.mean(missed))}
    return row | {"takes, s": float(np.mean(seconds)), "ends, mm": max(ends)}


def rest_poses(clips: Clips) -> Row:
    """Count rest poses that are accepted: tilted sideways, and with thighs ahead, by 0 to 90 degrees."""
    tilted = 0
    sitting = 0
    for clip in clips:
        skeleton = clip.skeleton
        for degrees in (0, 10, 20, 40, 60, 90):
            angle = np.radians(degrees)
            sideways = rotations.from_rotvec([0, 0, angle])
            offsets_of_rest = rotations.rotate(sideways, skeleton.offsets)
            tilted += not warned(stance_of_zero, replace(skeleton, offsets=offsets_of_rest), 0.03)
            forward = rotations.from_rotvec([-angle, 0, 0])
            values = skeleton.offsets.copy()
            knees = [leg.knee for leg in find_legs(skeleton)]
            values[knees] = rotations.rotate(forward, values[knees])
            sitting += not warned(stance_of_zero, replace(skeleton, offsets=values), 0.03)
    return {"tilted": tilted, "sitting": sitting, "of": 6 * len(clips)}


def poses(_clips: Clips) -> Row:
    """Count frames that are accepted as stances: of a body that stands, and of one that walks."""
    accepted = {True: 0, False: 0}
    count = {True: 0, False: 0}
    moved = 0
    for walk in STANDING.load() or ():
        ride = ride_of(walk)
        is_slow = np.gradient(ride.along) * walk.fps < STANDING_SPEED
        for frame in range(0, len(walk), round(walk.fps / 5)):
            is_standing = bool(is_slow[frame])
            count[is_standing] += 1
            try:
                with warnings.catch_warnings(action="ignore", category=MocapWarning):
                    stance_of_pose(walk[frame : frame + 1])
            except MocapError:
                continue
            accepted[is_standing] += 1
        moved += _moved_poses(walk)
    row = {"standing, %": 100 * accepted[True] / max(1, count[True])}
    return row | {"steps, %": 100 * accepted[False] / max(1, count[False]), "moved": moved}


def _moved_poses(walk: Motion) -> int:
    """Count warnings for a rest pose on the floor that is moved down and up."""
    rest = np.tile(rotations.IDENTITY, (1, len(walk.skeleton), 1))
    pose = replace(walk[:1], rotations=rest)
    height = pose.root_positions[:, 1] - joint_positions(pose)[..., 1].min()
    moved = 0
    for metres in (-0.2, -0.02, 0.1, 0.4):
        roots = np.array([[0.0, height[0] + metres, 0.0]])
        moved += warned(stance_of_pose, replace(pose, root_positions=roots))
    return moved


def short_clips(clips: Clips) -> Row:
    """Count parts of walks, of 1 to 30 frames, that are poses, and those for which no stance is found."""
    as_poses = 0
    refused = 0
    for walk in walks(clips):
        for frames in (1, 2, 3, 5, 8, 15, 30):
            for start in range(0, len(walk) - 30, round(walk.fps)):
                part = replace(walk[start : start + frames], contacts={})
                as_poses += is_pose(part)
                refused += warned(stance_of, part)
    return {"poses": as_poses, "refused": refused}


def run_heights(clips: Clips) -> Row:
    """Estimate heights of ankles from balls alone, and compare them with those of flat feet."""
    errors = []
    for walk in walks(clips):
        joints = roles(walk.skeleton)
        exact = standing_heights(walk, joints)
        estimated = heights_from_balls(walk, joints)
        errors += [1000 * (estimated[role] - exact[role]) for role in FEET if role.endswith("ankle")]
    return {"mean, mm": float(np.mean(errors)), "worst, mm": float(np.abs(errors).max())}


def worn(clips: Clips) -> Row:
    """Retarget walks to a child: its own steps, and those of the adult."""
    knees = []
    kept = []
    hips = []
    shakes = []
    warnings_of_steps = 0
    for walk in walks(clips):
        part = walk[: round(SHORT * walk.fps)]
        push = PUSH * np.sin(np.arange(len(part))[:, None] / part.fps * [5, 0, 3])
        part = replace(part, root_positions=part.root_positions + push)
        adult = stance_of(walk)
        child = proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85)
        for ratio in RATIOS:
            warnings_of_steps += warned(_worn, part, child, adult, ratio)
        with warnings.catch_warnings(action="ignore", category=MocapWarning):
            result = _worn(part, child, adult, 1.5)
        knees.append(_least_knee_angle(result))
        kept.append(100 * plants_kept(result, part))
        hips.append(100 * float(np.ptp(result.root_positions[:, 1])))
        shakes.append(shaking(result) / shaking(part))
    row = {"knee, °": min(knees), "kept, %": min(kept), "rise, cm": max(hips)}
    return row | {"shakes": max(shakes), "warned": warnings_of_steps}


def _worn(motion: Motion, child: object, adult: object, ratio: float) -> Motion:
    """Retarget a motion, with steps that are `ratio` times as long as in proportion."""
    return retarget(motion, child, adult, scale=ratio * child.leg / adult.leg)


def _least_knee_angle(motion: Motion) -> float:
    """Return the least angle by which a knee is bent, degrees."""
    positions = joint_positions(motion)
    angles = []
    for leg in find_legs(motion.skeleton):
        thigh = positions[:, leg.knee] - positions[:, leg.hip]
        shin = positions[:, leg.ankle] - positions[:, leg.knee]
        cosines = (thigh * shin).sum(axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shin, axis=1)
        angles.append(float(np.degrees(np.arccos(np.clip(cosines, -1, 1))).min()))
    return min(angles)


# reads: statement: a table
TRIALS = {
    "path_knots": Trial(paths, (0.4, 0.7, 1.2, 1.6)),
    "chord": Trial(frames_on_lines, (0.02, 0.1, 0.5), needs_clips=False),
    "chord_blur": Trial(frames_on_lines, (0.2, 0.4, 0.9), needs_clips=False),
    "shortest_path": Trial(accepted_paths, (0.1, 0.3, 1.0), needs_clips=False),
    "bend_radius": Trial(pace, (0.6, 0.9, 2.0), needs_clips=False),
    "bend_blur": Trial(bent, (0.05, 0.4)),
    "speed_blur": Trial(bent, (0.1, 0.6)),
    "standing_speed": Trial(bent_with_pauses, (0.1, 0.4), needs_clips=False),
    "walking_speed": Trial(bent_with_pauses, (0.3, 0.9), needs_clips=False),
    "corner_ratio": Trial(bent, (0.6, 0.3, 0.8)),
    "corner_speed": Trial(bent, (0.6, 0.1)),
    "rate_margin": Trial(bent, (1.0, 0.8)),
    "lowest_ratio": Trial(bent, (0.7, 0.1)),
    "highest_ratio": Trial(bent, (1.0, 2.0)),
    "pelvis_lean": Trial(leans, (0.25, 0.75), needs_clips=False),
    "trunk_lean": Trial(leans, (0.0, 0.5), needs_clips=False),
    "turning_limit": Trial(bent, (np.radians(60.0), np.radians(150.0))),
    "line_spacing": Trial(rounded_lines, (0.1, 0.025), needs_clips=False),
    "line_reach": Trial(rounded_lines, (0.2, 0.05), needs_clips=False),
    "reach_growth": Trial(rounded_lines, (1.4, 1.05), needs_clips=False),
    "reach_slope": Trial(rounded_lines, (0.0, 0.1, 0.3, 1.0), needs_clips=False),
    "widest_reach": Trial(rounded_lines, (1.5, 4.0), needs_clips=False),
    "largest_cut": Trial(rounded_lines, (1.0, 3.0), needs_clips=False),
    "least_length": Trial(rounded_lines, (0.9, 0.3), needs_clips=False),
    "loop_radius": Trial(rounded_lines, (1.0, 1.4), needs_clips=False),
    "pursuit_distance": Trial(rounded_lines, (0.2, 1.2), needs_clips=False),
    "pursuit_step": Trial(rounded_lines, (0.25, 0.75), needs_clips=False),
    "tightest_radius": Trial(rounded_lines, (0.1, 0.4), needs_clips=False),
    "key_margin": Trial(hand_keys, (0.15, 0.3, 0.8)),
    "lopsided": Trial(mirrored, (0.003, 0.03)),
    "mirror_axis": Trial(mirrored, (np.radians(3.0), np.radians(20.0))),
    "mirror_margin": Trial(mirrored, (0.02, 0.6)),
    "mirror_ridge": Trial(mirrored, (1e-2, 1e-9)),
    "loop_rate": Trial(cycles, (15.0, 60.0)),
    "loop_rows": Trial(cycles, (60, 200)),
    "loop_percentile": Trial(cycles, (50.0, 100.0)),
    "loop_motion": Trial(cycles, (0.0, 0.5, 1.0)),
    "loop_slack": Trial(cycles, (1.0, 1.3)),
    "loop_margin": Trial(cycles, (0.3, 1.0, 6.0)),
    "loop_seam": Trial(cycles, (0.1, 0.4)),
    "hips_level": Trial(rest_poses, (15.0, 50.0)),
    "thighs_hanging": Trial(rest_poses, (15.0, 80.0)),
    "pose_frames": Trial(short_clips, (1, 10)),
    "pose_seconds": Trial(short_clips, (0.02, 0.3)),
    "ankle_rise": Trial(poses, (0.02, 0.15), needs_clips=False),
    "ankle_lead": Trial(poses, (0.1, 0.5), needs_clips=False),
    "pose_below": Trial(poses, (0.01, 0.3), needs_clips=False),
    "pose_above": Trial(poses, (0.05, 0.6), needs_clips=False),
    "run_percentile": Trial(run_heights, (10.0, 50.0)),
    "worn_knots": Trial(worn, (0.06, 0.25, 0.5)),
    "worn_decay": Trial(worn, (0.2, 0.05)),
    "worn_passes": Trial(worn, (2, 10)),
    "worn_stiffness": Trial(worn, (1.0, 16.0)),
    "worn_slide": Trial(worn, (1.0, 0.01)),
    "worn_hips": Trial(worn, (0.1, 2.0)),
}
FIXED = {"loop_longest": "it bounds the memory of the search, and changes no result"}
