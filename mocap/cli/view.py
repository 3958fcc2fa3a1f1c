"""The command `mocap view`: play a clip in the browser."""

import sys
import tempfile
import webbrowser
from pathlib import Path

from mocap import widgets
from mocap._shared.atomic import require_writable
from mocap.cli.options import Reading, bar, tell


def view(clip: Path, *, out: Path | None = None, reading: Reading) -> None:
    """Play a clip in the browser.

    Play a clip in the browser. The page is one file that works without a network.

    Parameters
    ----------
    clip : an .amc, .bvh or AMASS .npz file.
    out : an .html, .gif, .mp4 or .png to write; opens no browser.
    """
    if out:
        require_writable(out)
    motion = reading.load(clip)
    page = out or Path(tempfile.mkdtemp(prefix="mocap-"), f"{clip.stem}.html")
    widgets.save_animation(motion, page, progress=bar("drawing"))
    tell(wrote=page)
    if not out and not webbrowser.open(page.as_uri()):
        print("mocap: no browser opened; open that page yourself.", file=sys.stderr)
