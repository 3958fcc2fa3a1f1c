"""Pictures of clips before and after edits: `python figures/edits_looked_at.py OUT [CLIP ...]`.

Writes a sheet for each clip to OUT: its body at twelve moments before and after an edit, from the side, the
front and above, relative to the hips and the body's heading. Below them are the heights of the lowest joints
of both feet, the angles of both knees, and the paths of the ankles with their footplants. The edits take
turns over the clips; `CLIP:EDIT` chooses one. A clip is a file, or the name of a bundled one. A second sheet,
`--knee`, shows a leg frame by frame while its footplant passes from the ankle to the ball, before and after
the clean-up. Pictures of captured clips are to be looked at; none is stored here.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("agg")

import numpy as np
from clean_knees import knee_angles
from feet_under_edits import COMMANDS, Edit
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mocap
from mocap import datasets, editing, feet
from mocap._shared.arrays import Array, Indices
from mocap.body import Motion, find_legs, joint_positions
from mocap.body.legs import Leg
from mocap.body.limbs import with_roles
from mocap.errors import MocapError
from mocap.plotting.bodies import draw_body
from mocap.plotting.style import COLOURS, FLOOR, QUIET
from mocap.quality import judge

MOMENTS = 12  # of a clip that are drawn
SECONDS = 4.0  # of a clip
SIDES = ("left", "right")
ANKLE_TO_BALL = 14  # frames on either side of the hand-over of a footplant
THIN = 0.8  # points
THICK = 1.6  # points


class View(NamedTuple):
    """A direction to look from: which of (left, up, ahead) are the axes across and up in the picture."""

    across: int
    upwards: int


VIEWS = {"side": View(2, 1), "front": View(0, 1), "above": View(2, 0)}
UP = 1  # the axis that points up


class Pair(NamedTuple):
    """A clip before an edit, and what the edit makes of it."""

    edit: str
    source: Motion
    result: Motion


def seen_from_hips(motion: Motion) -> Array:
    """Return positions (F, J, 3) as left, up and ahead of the point on the floor below the hips."""
    positions = joint_positions(motion)
    left_leg, right_leg = find_legs(motion.skeleton)
    to_the_left = positions[:, left_leg.hip] - positions[:, right_leg.hip]
    to_the_left[:, 1] = 0.0
    to_the_left /= np.linalg.norm(to_the_left, axis=-1, keepdims=True)
    upwards = np.broadcast_to([0.0, 1.0, 0.0], to_the_left.shape)
    axes = np.stack([to_the_left, upwards, np.cross(to_the_left, upwards)], axis=1)
    floor = (positions[:, left_leg.hip] + positions[:, right_leg.hip]) / 2 * [1, 0, 1]
    return np.asarray(np.einsum("fij,fkj->fki", axes, positions - floor[:, None]))


def moments_of(motion: Motion) -> Indices:
    """Choose frames that are evenly spread over a motion."""
    return np.linspace(0, len(motion) - 1, MOMENTS).round().astype(int)


def draw_moments(ax: Axes, motion: Motion, view: View, title: str) -> None:
    """Draw a body at twelve moments side by side."""
    points = seen_from_hips(motion)[moments_of(motion)]
    flat = points[..., [view.across, view.upwards]]
    width = 1.1 * float(np.ptp(flat[..., 0], axis=1).max())
    for column, pose in enumerate(flat):
        draw_body(ax, motion.skeleton, pose + np.array([column * width, 0.0]), linewidths=THICK)
    if view.upwards == UP:
        ax.axhline(0.0, color=FLOOR, lw=THIN, zorder=0)
    ax.set_title(title, fontsize=9, loc="left")
    ax.autoscale_view()
    ax.set_aspect("equal")
    ax.set_axis_off()


def joints_of_foot(motion: Motion, leg: Leg) -> list[int]:
    """List the ankle of a leg and all joints below it."""
    skeleton = motion.skeleton
    return [joint for joint in range(len(skeleton)) if leg.ankle in skeleton.path_to_root(joint)]


def lowest_of_feet(motion: Motion) -> Array:
    """Return the height of the lowest joint of each foot, (F, 2), cm."""
    heights = 100 * joint_positions(motion)[..., 1]
    feet_joints = [joints_of_foot(motion, leg) for leg in find_legs(motion.skeleton)]
    return np.stack([heights[:, joints].min(axis=1) for joints in feet_joints], axis=-1)


def draw_curves(ax: Axes, pair: Pair, curves: Sequence[Array], title: str) -> None:
    """Draw a curve of each side over time, before the edit in grey and after it in colours."""
    for motion, values, is_after in zip(pair[1:], curves, (False, True), strict=True):
        seconds = np.arange(len(motion)) / motion.fps
        for side, of_side in zip(SIDES, values.T, strict=True):
            ax.plot(seconds, of_side, lw=THIN, color=COLOURS[side] if is_after else QUIET)
    ax.set_title(title, fontsize=9, loc="left")
    ax.axhline(0.0, color=FLOOR, lw=THIN, zorder=0)
    ax.tick_params(labelsize=7)


def draw_ankle_paths(ax: Axes, pair: Pair) -> None:
    """Draw the paths of the ankles from above, with the footplants as thick lines."""
    for motion, is_after in zip(pair[1:], (False, True), strict=True):
        marked = motion if motion.contacts else feet.mark_plants(motion)
        positions = joint_positions(marked)
        for side, leg in zip(SIDES, find_legs(marked.skeleton), strict=True):
            path = positions[:, leg.ankle][:, [2, 0]]
            colour = COLOURS[side] if is_after else QUIET
            ax.plot(*path.T, lw=THIN, color=colour)
            name = marked.skeleton.names[leg.ankle]
            planted = np.where(marked.contacts[name][:, None], path, np.nan)
            width = 4 * THICK if is_after else 2 * THICK
            ax.plot(*planted.T, lw=width, color=colour, alpha=0.6, solid_capstyle="round")
    ax.set_title("ankles from above, footplants thick", fontsize=9, loc="left")
    ax.set_aspect("equal", adjustable="datalim")
    ax.tick_params(labelsize=7)


def sheet(pair: Pair) -> Figure:
    """Draw a clip before and after an edit."""
    figure = Figure(figsize=(17, 21), layout="constrained")
    rows = figure.subplots(len(VIEWS) * 2 + 2, 1, height_ratios=[1.5, 1.5, 1.5, 1.5, 0.8, 0.8, 1.3, 1.3])
    states = [("before", pair.source), ("after", pair.result)]
    panels = [(name, view, state, motion) for name, view in VIEWS.items() for state, motion in states]
    for ax, (name, view, state, motion) in zip(rows, panels, strict=False):
        draw_moments(ax, motion, view, f"{name}, {state}")
    rows[-2].remove()
    rows[-1].remove()
    grid = rows[0].get_gridspec()
    bottom = grid[-2:, 0].subgridspec(2, 2)
    heights = [lowest_of_feet(pair.source), lowest_of_feet(pair.result)]
    draw_curves(figure.add_subplot(bottom[0, 0]), pair, heights, "lowest joint of a foot, cm (grey: before)")
    angles = [knee_angles(pair.source), knee_angles(pair.result)]
    draw_curves(figure.add_subplot(bottom[1, 0]), pair, angles, "angle of a knee, degrees")
    draw_ankle_paths(figure.add_subplot(bottom[:, 1]), pair)
    figure.suptitle(title_of(pair), fontsize=11)
    return figure


def title_of(pair: Pair) -> str:
    """Format the names of clip and edit, and the scores before and after it."""
    scores = []
    for motion in pair[1:]:
        judged = judge(motion)
        above = [f"{row.name} {row.ratio:.2f}" for row in judged.measures if row.ratio > 1]
        scores.append(f"{judged.score:.2f} {' '.join(above)}".strip())
    return f"{pair.source.name}: {pair.edit}; score {scores[0]}, then {scores[1]}"


def hand_over(motion: Motion) -> tuple[int, Leg]:
    """Find the first frame in which only the ball of a foot stands, after its ankle stood, and the leg."""
    margin = ANKLE_TO_BALL + 1
    for leg in find_legs(motion.skeleton):
        ankle, ball = (motion.contacts[motion.skeleton.names[joint]] for joint in leg[2:])
        passes = ankle[:-1] & ~ankle[1:] & ball[:-1] & ball[1:]
        frames = 1 + np.flatnonzero(passes)
        inside = frames[(frames >= margin) & (frames < len(motion) - margin)]
        if len(inside):
            return int(inside[len(inside) // 2]), leg
    raise MocapError(f"No footplant of '{motion.name}' passes from ankle to ball; choose another clip.")


def knee_sheet(clip: Motion) -> Figure:
    """Draw a leg frame by frame around a hand-over, before and after the clean-up, and the knee's angle."""
    marked = feet.mark_plants(clip)
    result = feet.clean_up(marked)
    frame, leg = hand_over(marked)
    frames = np.arange(frame - ANKLE_TO_BALL, frame + ANKLE_TO_BALL + 1)
    figure = Figure(figsize=(17, 9), layout="constrained")
    rows = figure.subplots(4, 1, height_ratios=[0.6, 0.6, 1, 1])
    legs_before, legs_after, angle_axes, second_axes = rows
    draw_leg(legs_before, marked, leg, frames, "before, frame by frame")
    draw_leg(legs_after, result, leg, frames, "after")
    side = find_legs(clip.skeleton).index(leg)
    for motion, colour in ((marked, QUIET), (result, COLOURS["left"])):
        angles = knee_angles(motion)[:, side]
        angle_axes.plot(frames, angles[frames], "o-", ms=3, lw=THIN, color=colour)
        second_axes.plot(frames, np.diff(angles, 2)[frames - 1], "o-", ms=3, lw=THIN, color=colour)
    for ax, title in zip(
        (angle_axes, second_axes), ("angle of the knee, degrees", "its second difference"), strict=True
    ):
        ax.set_title(f"{title} (grey: before)", fontsize=9, loc="left")
        ax.axvline(frame - 0.5, color=QUIET, lw=THIN)
        ax.set_xlim(frames[0] - 0.5, frames[-1] + 0.5)
    figure.suptitle(f"{clip.name}: the plant passes from ankle to ball in frame {frame}, {clip.fps:g} Hz")
    return figure


def draw_leg(ax: Axes, motion: Motion, leg: Leg, frames: Indices, title: str) -> None:
    """Draw a leg in each frame from the side, with the planted joints as dots."""
    heading_frame = seen_from_hips(motion)
    joints = [*leg, *(joint for joint in joints_of_foot(motion, leg) if joint not in leg)]
    contacts = {joint: motion.contacts[motion.skeleton.names[joint]] for joint in leg[2:]}
    for column, frame in enumerate(frames):
        flat = heading_frame[frame][:, [2, 1]] + [0.55 * column, 0.0]
        ax.plot(*flat[joints].T, "-", lw=THICK, color=COLOURS["left"])
        for joint, planted in contacts.items():
            ax.plot(*flat[joint], "o" if planted[frame] else ".", ms=5, color=COLOURS["right"])
    ax.axhline(0.0, color=FLOOR, lw=THIN, zorder=0)
    ax.set_title(f"{title}; footplants as large dots", fontsize=9, loc="left")
    ax.set_aspect("equal")
    ax.set_axis_off()


def cleaned(motion: Motion) -> Motion:
    """Clean the feet up, as `mocap feet` does."""
    return feet.clean_up(feet.mark_plants(motion))


EDITS: dict[str, Edit] = {"clean_up": cleaned, **COMMANDS}
TURNS = ("clean_up", "bend", "warp", "edit", "retarget", "loop", "blend", "mirror", "walk")


def load_clip(text: str, seconds: float) -> Motion:
    """Load the first seconds of a bundled clip or of a file."""
    clip = datasets.sample(text) if text in datasets.SAMPLES else mocap.load(text)
    return with_roles(clip[: round(seconds * clip.fps)])


def pairs_of(arguments: Sequence[str], seconds: float) -> list[Pair]:
    """Load clips, and edit each; clips that an edit refuses are left out, and named."""
    names = [argument.partition(":") for argument in arguments]
    clips = [load_clip(name, seconds) for name, _, _ in names]
    pairs = []
    for number, (clip, (_, _, chosen)) in enumerate(zip(clips, names, strict=True)):
        edit = chosen or TURNS[number % len(TURNS)]
        try:
            if edit == "retarget":
                result = editing.wear(clip, editing.stance_of(clips[number - 1]))
            else:
                result = EDITS[edit](clip)
        except (MocapError, ValueError) as error:
            print(f"left out: {clip.name}, {edit}: {error}", file=sys.stderr)
            continue
        pairs.append(Pair(edit, clip, with_roles(result)))
    return pairs


def main() -> None:
    """Read the options, and write the sheets."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("clips", nargs="*", default=list(datasets.SAMPLES), metavar="CLIP[:EDIT]")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="of each clip")
    parser.add_argument("--knee", action="store_true", help="draw a leg frame by frame instead")
    options = parser.parse_args()
    warnings.simplefilter("ignore", mocap.MocapWarning)
    options.out.mkdir(parents=True, exist_ok=True)
    if options.knee:
        for text in options.clips:
            clip = load_clip(text, options.seconds)
            knee_sheet(clip).savefig(options.out / f"knee_{clip.name}.png", dpi=60)
        return
    for number, pair in enumerate(pairs_of(options.clips, options.seconds)):
        path = options.out / f"{number:02}_{pair.source.name}_{pair.edit}.png"
        sheet(pair).savefig(path, dpi=60)
        print(f"{path.name}: {title_of(pair)}", flush=True)


if __name__ == "__main__":
    main()
