"""The film of the sample project: `python figures/sample_film.py` writes `teaching/sample-film.mp4`.

Two scenes: one walk through one graph along a drawn line, which sneaks past a dog; and a jog that is bent
onto a line. Beside the film stands a strip of its pictures, for pages that play no films.
"""

from __future__ import annotations

import subprocess
import warnings
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import imageio_ffmpeg
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from mocap import MocapWarning, Motion, body, datasets, editing, graphs, resample
from mocap.course.teaching.board import font_of
from mocap.graphs import compile_graph
from mocap.steering import PathRequest, follow_path
from mocap.widgets import play
from mocap.widgets.film import write_mp4
from mocap.widgets.filmed_scene import FilmedScene

FOLDER = Path(__file__).parents[1] / "notebooks" / "teaching"
FPS = 20.0  # pictures per second
SIZE = (640, 480)  # pixels
INK = "#2B2F3D"  # of the words
DOG = [[1.3, 11.0, 0.35]]  # x, z and radius
HOME = [[0, 0], [0, 8], [2, 14], [6, 19], [6, 25], [2, 31], [-2, 33]]  # x and z of the line, metres
RUN = [[-2, 33], [-8, 36], [-12, 31], [-8, 26], [-14, 22], [-10, 16], [-15, 12], [-12, 6]]
PICTURES = (3, 9, 15, 30, 44, 52)  # seconds of the film, on the strip
SAID = {  # from these seconds on
    "home": {0: "It is late. The dog sleeps.", 6: "Quiet now.", 23: "Past it. Home is not far.", 40: ""},
    "run": {
        0: "No: the last bus!",
        4: "No clip runs round these bends:",
        9: "the jog is bent onto the line.",
    },
}
THANKS = "Clips: walk, sneak and jog,\ngenerated, bundled with mocap,\nBSD-3-Clause"


def scenes() -> dict[str, tuple[Motion, body.GroundPath]]:
    """Make the motions: what plays, and the line that was asked for."""
    clips = [resample(datasets.sample(name), 30) for name in datasets.SAMPLES]
    graph = compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.05)))
    home = body.spline(HOME)
    run = body.spline(RUN)
    quiet = PathRequest(labels=[(0, "walk"), (7, "sneak"), (16, "walk")])
    hasty = PathRequest(labels=[(0, ""), (3, "jog")])
    walked = follow_path(graph, home, quiet)
    bent = follow_path(graph, run, hasty, bend=editing.LIMIT)
    print(f"home: {walked.report()}")
    print(f"run: {bent.report()}")
    return {"home": (walked.motion(clean=True), home), "run": (bent.motion(), run)}


def pictures(motion: Motion, line: body.GroundPath, said: dict[int, str]) -> Iterator[NDArray[np.uint8]]:
    """Draw a scene: the body, the line, the dog, and a sentence below them."""
    scene = FilmedScene(play(motion, path=line.points, discs=DOG).scene)
    font = font_of(22)
    for frame in range(int(scene.seconds * FPS) + 1):
        page = Image.fromarray(scene.picture(frame / FPS, SIZE))
        text = said[max(second for second in said if second <= frame / FPS)]
        ImageDraw.Draw(page).text((SIZE[0] / 2, SIZE[1] - 44), text, INK, font, anchor="ma")
        yield np.asarray(page)


def film() -> Iterator[NDArray[np.uint8]]:
    """Give all pictures, and three seconds of thanks."""
    for name, (motion, line) in scenes().items():
        yield from pictures(motion, line, SAID[name])
    page = Image.new("RGB", SIZE, "#FAF7F0")
    middle = (SIZE[0] / 2, SIZE[1] / 2)
    ImageDraw.Draw(page).multiline_text(
        middle, THANKS, INK, font_of(22), anchor="mm", align="center", spacing=10
    )
    yield from [np.asarray(page)] * round(3 * FPS)


def write_small(shown: list[NDArray[np.uint8]], path: Path) -> None:
    """Write a film in half the bytes that the package takes, at ten times the time."""
    with TemporaryDirectory() as folder:
        write_mp4(iter(shown), Path(folder, "film.mp4"), FPS)
        smaller = ["-preset", "veryslow", "-crf", "28", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        files = ["-v", "error", "-y", "-i", str(Path(folder, "film.mp4"))]
        subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), *files, *smaller, str(path)], check=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore", MocapWarning)
    shown = list(film())
    write_small(shown, FOLDER / "sample-film.mp4")
    strip = [shown[round(second * FPS)] for second in PICTURES]
    image = Image.fromarray(np.concatenate(strip, axis=1)).resize((1440, 180))
    image.save(FOLDER / "sample-film.png", optimize=True)
    print(f"{len(shown) / FPS:.0f} s, {(FOLDER / 'sample-film.mp4').stat().st_size / 1e6:.2f} MB")
