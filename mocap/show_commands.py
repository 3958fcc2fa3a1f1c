"""The commands that show: `mocap view` and `mocap figures`."""

import argparse
import sys
import tempfile
import webbrowser
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mocap.progress import bar

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]


def add_view(commands: "Commands") -> None:
    """Add `mocap view`."""
    view = commands.add_parser(
        "view",
        help="play a clip in the browser",
        description="Play a clip in the browser, on a page that needs nothing else and can be passed on.",
    )
    add = view.add_argument
    add("clip", type=Path, help="an .amc or .bvh file")
    add("-o", "--out", type=Path, help="keep the page, or a .gif, .mp4 or .png instead, and open no browser")
    add("--skeleton", type=Path, help="the .asf file of an .amc clip (default: the one beside it that fits)")
    add("--fps", type=float, help="frames a second (default: what the file says; 120 for .amc)")
    add("--scale", type=float, help="metres in a unit (default: 0.01; for .amc what .asf says)")
    view.set_defaults(run=_view)


def _view(options: argparse.Namespace) -> int:
    from mocap import files, plotting

    clip = files.load(options.clip, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    out = options.out or Path(tempfile.mkdtemp(prefix="mocap-"), f"{options.clip.stem}.html")
    plotting.save_animation(clip, out, progress=partial(bar, what="drawing"))
    print(f"{'wrote':<12} {out}")
    if options.out is None and not webbrowser.open(out.as_uri()):
        print("mocap: no browser opened; open that page yourself.", file=sys.stderr)
    return 0


def add_figures(commands: "Commands") -> None:
    """Add `mocap figures`."""
    figures = commands.add_parser(
        "figures",
        help="draw the pictures of the README and the course anew",
        description="Draw the pictures of the README and of the notebooks' headers.",
    )
    figures.add_argument("folder", nargs="?", type=Path, default=Path("figures"), help="where to write them")
    figures.set_defaults(run=_figures)


def _figures(options: argparse.Namespace) -> int:
    from mocap import gallery

    for path in gallery.draw_all(options.folder):
        print(f"{'wrote':<12} {path}")
    return 0
