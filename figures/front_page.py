"""Draw the six pictures of the README by its commands, from the bundled clips.

`python figures/front_page.py` runs the commands of the section "What you get" in an empty folder, as they are
printed, and writes a picture of each result beside this script.
"""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image, ImageOps

from mocap import Motion, load, resample
from mocap.files import load_path
from mocap.plotting.picture import few_colours
from mocap.widgets import play
from mocap.widgets.player import Player
from mocap.widgets.shaded_picture import GROUND
from mocap.widgets.still_picture import still_picture

HERE = Path(__file__).parent
README = HERE.parent / "README.md"
SECTION = "## What you get"
SIZE = (720, 380)  # pixels
LETTERS = 40  # pixels, because the pictures are shown small
FPS = 30  # of all results
KEY = 2.0  # seconds, the time of the pose in keys.txt
AROUND = 0.5  # seconds before and after it
BESIDE = 2.5  # metres along x between the two bodies of the picture of retargeting
ROUND = 90  # frames of a cycle


def commands() -> list[str]:
    """List the commands of the section in order, those of its code block and those below the pictures."""
    _, _, rest = README.read_text("utf-8").partition(f"\n{SECTION}\n")
    section, *_ = rest.split("\n## ")
    blocks = re.findall(r"```sh\n(.*?)```", section, re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    rows = "".join(line for line in section.splitlines() if line.startswith("|"))
    return lines + re.findall(r"`(mocap [^`]*)`", rows)


def run_commands(folder: Path) -> None:
    """Run the commands in a folder, with the `mocap` of this Python."""
    found_first = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    for command in commands():
        print(command, flush=True)
        subprocess.run(command, shell=True, check=True, cwd=folder, env=os.environ | {"PATH": found_first})


def _clip(path: Path, start: float, end: float) -> Motion:
    """Read a part of a motion, from and to times in seconds."""
    return resample(load(path), FPS)[round(start * FPS) : round(end * FPS)]


def show_walk(folder: Path) -> Player:
    """Show the start of the new walk."""
    return play(_clip(folder / "mocap-demo" / "walk.bvh", 0, 3))


def show_bend(folder: Path) -> Player:
    """Show the start of the bent walk on its path."""
    bent = _clip(folder / "bent.bvh", 0, 9)
    points = load_path(folder / "path.svg").points
    half = bent[: len(bent) * 5 // 8]
    return play(half, path=points[: len(points) * 5 // 8])


def show_warp(folder: Path) -> Player:
    """Show the clip before and after the edit."""
    original = _clip(folder / "mocap-demo" / "walk.bvh", KEY - AROUND, KEY + AROUND)
    edited = _clip(folder / "reach.bvh", KEY - AROUND, KEY + AROUND)
    return play(original, edited, names=["before", "after"])


def show_retarget(folder: Path) -> Player:
    """Show the clip and its copy for a small body, side by side."""
    small = _clip(folder / "small" / "walk.bvh", 0, 2)
    roots = small.root_positions + np.array([BESIDE, 0, 0])
    original = _clip(folder / "mocap-demo" / "walk.bvh", 0, 2)
    return play(original, replace(small, root_positions=roots), names=["walk.bvh", "small/walk.bvh"])


def show_loop(folder: Path) -> Player:
    """Show two rounds of the repeated cycle, with a mark where it repeats."""
    loop = _clip(folder / "loop.bvh", 0, 6)
    return play(loop, seams=range(ROUND, len(loop), ROUND))


def show_crowd(folder: Path) -> Player:
    """Show all members of the group."""
    members = sorted((folder / "crowd").glob("member-*.bvh"))
    return play(*(_clip(member, 0, 9) for member in members))


Show = Callable[[Path], Player]

RESULTS: dict[str, Show] = {
    "walk": show_walk,
    "bend": show_bend,
    "warp": show_warp,
    "retarget": show_retarget,
    "loop": show_loop,
    "crowd": show_crowd,
}


def fitted(picture: bytes) -> bytes:
    """Return a picture in the middle of one of the common size."""
    content = Image.open(io.BytesIO(picture)).convert("RGB")
    padded = ImageOps.pad(content, SIZE, color=GROUND)
    return few_colours(padded, method=Image.Quantize.FASTOCTREE)


def draw_all(folder: Path) -> list[Path]:
    """Draw the results in a folder, write the pictures beside this script, and return their paths."""
    paths = []
    for name, show in RESULTS.items():
        scene = show(folder).scene
        picture = fitted(still_picture(scene, legend=False, letters=LETTERS))
        path = HERE / f"result_{name}.png"
        path.write_bytes(picture)
        paths.append(path)
    return paths


if __name__ == "__main__":
    with TemporaryDirectory() as results:
        run_commands(Path(results))
        draw_all(Path(results))
