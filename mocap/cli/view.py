"""The command `mocap view`: play a clip in the browser."""

import argparse
import sys
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import files, widgets
from mocap._shared.atomic import require_writable
from mocap.cli.options import add_reading, bar, require_amc

if TYPE_CHECKING:
    from mocap.cli.options import Commands


def add_view(commands: "Commands") -> None:
    """Add `mocap view`."""
    view = commands.add_parser(
        "view",
        help="play a clip in the browser",
        description="Play a clip in the browser. The page is one file that works without a network.",
    )
    add = view.add_argument
    add("clip", type=Path, help="an .amc, .bvh or AMASS .npz file")
    add("-o", "--out", type=Path, help="an .html, .gif, .mp4 or .png to write; opens no browser")
    add_reading(view)
    view.set_defaults(run=_view)


def _view(options: argparse.Namespace) -> int:
    if options.out:
        require_writable(options.out)
    require_amc(options.clip, options.skeleton)
    clip = files.load(options.clip, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    out = options.out or Path(tempfile.mkdtemp(prefix="mocap-"), f"{options.clip.stem}.html")
    widgets.save_animation(clip, out, progress=bar("drawing"))
    print(f"{'wrote':<12} {out}")
    if options.out is None and not webbrowser.open(out.as_uri()):
        print("mocap: no browser opened; open that page yourself.", file=sys.stderr)
    return 0
