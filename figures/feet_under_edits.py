"""Measure feet under every edit: `python figures/feet_under_edits.py [CLIP ...] [--seconds 4]`.

Prints a table of commands and clips. Each cell has two distances beyond those of the source, in cm: how far
the lowest joint is under the floor, and how far the lowest toe tip is under its lowest position in the
source. With clips of several bodies, each is also retargeted to every body, and both are depths under the
floor.
"""

import argparse
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

import mocap
from mocap import blending, body, datasets, editing, feet, files, graphs
from mocap._shared.arrays import Array
from mocap.body import GroundPath, Motion
from mocap.body.limbs import find_legs, roles, with_roles
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.mirroring import mirror_above_floor
from mocap.editing.stances import Stance
from mocap.editing.toes import lowest_heights
from mocap.editing.warp_plans import load_plan, warp
from mocap.errors import MocapError
from mocap.synthesis import random_walk, to_motion

BUNDLED = ("walk_straight", "walk_circle", "walk_curve_1", "walk_curve_2", "stop_and_go", "jog", "sneak")
SECONDS = 4.0
MILLIMETRE = 0.001  # metres: the request of a warp
REACH = 0.15  # metres: the request of an edit
UP = np.array([0.0, 1.0, 0.0])
NAMES = {"warp": "warp 1 mm", "edit": "edit 15 cm"}

Edit = Callable[[Motion], Motion]


def wrist_of(motion: Motion) -> str:
    """Name a joint at the end of an arm."""
    joints = roles(motion.skeleton)
    return motion.skeleton.names[joints.get("left wrist", joints["pelvis"])]


def warped(motion: Motion) -> Motion:
    """Move a wrist by a millimetre in the middle of a clip, as `mocap warp` does."""
    with tempfile.TemporaryDirectory() as folder:
        keys = Path(folder, "keys.txt")
        keys.write_text(f"at {len(motion) // 2} {wrist_of(motion)} 0 {MILLIMETRE} 0\n")
        return warp(feet.mark_plants(motion), load_plan(keys, motion))


def edited(motion: Motion) -> Motion:
    """Raise a wrist by 15 cm for a moment, as `editing.edit` does."""
    frames = range(len(motion) // 2, len(motion) // 2 + 3)
    name = wrist_of(motion)
    position = body.joint_positions(motion)[len(motion) // 2, motion.skeleton.index(name)]
    pins = editing.pin(motion, name, frames, position + REACH * UP)
    return editing.edit(feet.mark_plants(motion), pins)


def bent(motion: Motion) -> Motion:
    """Bend a walk into an arc, as `mocap bend` does."""
    length = editing.ride_of(motion).path.length
    angles = np.linspace(0, np.pi / 2, 60)
    radius = length / (np.pi / 2)
    points = radius * np.stack([1 - np.cos(angles), np.sin(angles)], axis=1)
    return editing.bend(motion, GroundPath(points)).motion


def looped(motion: Motion) -> Motion:
    """Close a cycle, as `mocap loop --clean` does."""
    return editing.loop(motion, clean=True)


def blended(motion: Motion) -> Motion:
    """Blend a clip with itself, a tenth faster, as `mocap blend --clean` does."""
    faster = editing.retime(motion, [(0.0, 0.0), (0.9 * motion.duration, motion.duration)])
    pair = [feet.mark_plants(replace(clip, contacts={})) for clip in (motion, faster)]
    registration = blending.register(pair, slack=0.3)
    return clean_feet(blending.mix(registration, [0.5, 0.5]), lowest_heights(pair))


def walked(motion: Motion) -> Motion:
    """Walk at random through the graph of a clip, as `mocap walk --random --clean` does."""
    graph = graphs.prune(graphs.build([motion], window=round(motion.fps / 3), threshold=0.08))
    return to_motion(graph, random_walk(graph, seconds=SECONDS, seed=1), clean=True)


def converted(motion: Motion) -> Motion:
    """Write a clip, and read it again, as `mocap convert` does."""
    with tempfile.TemporaryDirectory() as folder:
        files.save(motion, Path(folder, "clip.bvh"))
        return mocap.load(Path(folder, "clip.bvh"), scale=0.01, up="y")


COMMANDS: dict[str, Edit] = {
    "warp": warped,
    "edit": edited,
    "bend": bent,
    "loop": looped,
    "blend": blended,
    "walk": walked,
    "mirror": mirror_above_floor,
    "convert": converted,
}


def tips_of(motion: Motion) -> list[int]:
    """List the joints of the feet that end them: below the balls, or the balls."""
    skeleton = motion.skeleton
    legs = find_legs(skeleton)
    joints = range(len(skeleton))
    below = [joint for joint in joints for leg in legs if leg.ankle in skeleton.path_to_root(joint)]
    return [joint for joint in below if not skeleton.children(joint)]


def depths(motion: Motion) -> tuple[float, float]:
    """Measure how far the lowest joint is under the floor, and the height of the lowest toe tip, cm."""
    heights = 100 * body.joint_positions(motion)[..., 1]
    return max(0.0, -float(heights.min())), float(heights[:, tips_of(motion)].min())


def distances_beyond(motion: Motion, result: Motion) -> Array:
    """Measure how far the lowest joint and the lowest tip are below those of the source, cm, (2,)."""
    sunk, tip = depths(motion)
    new_sunk, new_tip = depths(result)
    return np.maximum([new_sunk - sunk, tip - new_tip], 0.0)


def _measured(command: Edit, motion: Motion) -> Array:
    """Measure what a command writes, cm, (2,)."""
    return distances_beyond(motion, command(motion))


def retargeted(motion: Motion, stance: Stance) -> Array:
    """Measure a retargeted clip: both numbers are depths under the floor beyond the source's, cm, (2,)."""
    result = editing.wear(motion, stance)
    depth, tip = depths(motion)
    new_depth, new_tip = depths(result)
    return np.maximum([new_depth - depth, max(0.0, -new_tip) - max(0.0, -tip)], 0.0)


def load_clips(paths: list[str], seconds: float) -> Iterator[Motion]:
    """Read the clips, or the bundled ones."""
    clips = (mocap.load(path) for path in paths) if paths else map(datasets.sample, BUNDLED)
    for clip in clips:
        yield with_roles(clip[: 1 + round(seconds * clip.fps)])


def bodies_of(clips: list[Motion]) -> dict[str, Stance]:
    """Find the stance of each body, by the name of its first clip."""
    stances: dict[str, Stance] = {}
    for clip in clips:
        if clip.skeleton not in [stance.skeleton for stance in stances.values()]:
            stances[clip.name] = editing.stance_of(clip)
    return stances


def cell(measure: Callable[[], Array]) -> Array:
    """Measure two distances; NaN where a command refuses a clip, which is printed."""
    try:
        return measure()
    except (MocapError, ValueError) as error:
        print(str(error)[:120], file=sys.stderr)
        return np.full(2, np.nan)


def main(paths: list[str], seconds: float, chosen: list[str]) -> None:
    """Print a row for each clip, and the worst of each command."""
    warnings.simplefilter("ignore")
    clips = [*load_clips(paths, seconds)]
    stances = bodies_of(clips) if "retarget" in chosen else {}
    commands = [name for name in chosen if name in COMMANDS]
    columns = commands + [f"to {name}"[:14] for name in stances]
    print(f"{'clip':34}" + "".join(f"{NAMES.get(name, name):>15}" for name in columns))
    rows = []
    for clip in clips:
        measures = [partial(_measured, COMMANDS[name], clip) for name in commands]
        measures += [partial(retargeted, clip, stance) for stance in stances.values()]
        rows.append([cell(measure) for measure in measures])
        print_row(clip.name[-34:], rows[-1])
    print_row("worst", list(np.nanmax(np.array(rows), axis=0)))


def print_row(name: str, cells: list[Array]) -> None:
    """Print the two distances of each cell."""
    print(f"{name:34}" + "".join(f"{sunk:8.1f} {tip:6.1f}" for sunk, tip in cells), flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clips", nargs="*")
    parser.add_argument("--seconds", type=float, default=SECONDS)
    parser.add_argument("--commands", nargs="*", default=[*COMMANDS, "retarget"])
    options = parser.parse_args()
    started = time.perf_counter()
    main(options.clips, options.seconds, options.commands)
    print(f"{time.perf_counter() - started:.0f} s", file=sys.stderr)
