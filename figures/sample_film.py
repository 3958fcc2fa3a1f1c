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
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from mocap import MocapWarning, Motion, body, datasets, editing, graphs, resample
from mocap.graphs import compile_graph
from mocap.plotting.stick_figures import StickFigure, filled, ground_axes, look_at, rims, to_picture
from mocap.steering import Wishes, follow_path
from mocap.widgets.film import write_mp4

FOLDER = Path(__file__).parents[1] / "notebooks" / "teaching"
FPS, REACH = 20.0, 1.5  # pictures per second; metres around the body that are seen
DOG = [[1.3, 11.0, 0.35]]  # x, z and radius
HOME = [[0, 0], [0, 8], [2, 14], [6, 19], [6, 25], [2, 31], [-2, 33]]  # x and z of the line, metres
RUN = [[-2, 33], [-8, 36], [-12, 31], [-8, 26], [-14, 22], [-10, 16], [-15, 12], [-12, 6]]
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
    home, run = body.spline(HOME), body.spline(RUN)
    quiet = Wishes(labels=[(0, "walk"), (7, "sneak"), (16, "walk")])
    hasty = Wishes(labels=[(0, ""), (3, "jog")])
    walked, bent = follow_path(graph, home, quiet), follow_path(graph, run, hasty, bend=editing.LIMIT)
    for name, found in (("home", walked), ("run", bent)):
        print(f"{name}: {found.report()}")
    return {"home": (walked.motion(clean=True), home), "run": (bent.motion(), run)}


def pictures(motion: Motion, line: body.GroundPath, said: dict[int, str]) -> Iterator[NDArray[np.uint8]]:
    """Draw a scene: the figure, the line, the dog, and a sentence below them."""
    motion = resample(motion, FPS)
    places = body.joint_positions(motion)
    centres = gaussian_filter1d(places[:, 0, [0, 2]], FPS / 2, axis=0, mode="nearest")
    figure = Figure(figsize=(4.8, 4.8))
    canvas = FigureCanvasAgg(figure)
    ax = ground_axes(centres[0], REACH, ax=filled(figure))
    track = to_picture(np.insert(line.points, 1, 0.0, axis=1))
    dog = to_picture(rims(DOG)[0])
    (asked,) = ax.plot([], [], [], color="0.25", linewidth=2)
    (rim,) = ax.plot([], [], [], color="0.25", linewidth=5)
    who = StickFigure(motion.skeleton, ax)
    text = figure.text(0.5, 0.05, "", ha="center", fontsize=15)
    for frame, centre in enumerate(centres):
        look_at(ax, centre, REACH)
        middle = to_picture(np.insert(centre, 1, 0.0))
        for drawn, points in ((asked, track), (rim, dog)):
            near = points[np.abs(points - middle).max(axis=-1) < 2 * REACH]
            drawn.set_data_3d(*near.T)
        who.pose(places[frame])
        text.set_text(said[max(second for second in said if second <= frame / FPS)])
        canvas.draw()
        yield np.array(canvas.buffer_rgba())[..., :3]


def film() -> Iterator[NDArray[np.uint8]]:
    """Give all pictures, and three seconds of thanks."""
    for name, (motion, line) in scenes().items():
        yield from pictures(motion, line, SAID[name])
    figure = Figure(figsize=(4.8, 4.8))
    canvas = FigureCanvasAgg(figure)
    figure.text(0.5, 0.5, THANKS, ha="center", va="center", fontsize=15)
    canvas.draw()
    yield from [np.array(canvas.buffer_rgba())[..., :3]] * round(3 * FPS)


def write_small(shown: list[NDArray[np.uint8]], path: Path) -> None:
    """Write a film in half the bytes that the package takes, at ten times the time."""
    with TemporaryDirectory() as folder:
        write_mp4(iter(shown), Path(folder, "film.mp4"), FPS)
        how = ["-preset", "veryslow", "-crf", "27", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        given = ["-v", "error", "-y", "-i", str(Path(folder, "film.mp4")), *how, str(path)]
        subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), *given], check=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore", MocapWarning)
    shown = list(film())
    write_small(shown, FOLDER / "sample-film.mp4")
    strip = [shown[round(second * FPS)] for second in (3, 14, 18, 38, 54, 61)]
    image = Image.fromarray(np.concatenate(strip, axis=1)).resize((1440, 240))
    image.quantize(64).save(FOLDER / "sample-film.png", optimize=True)
    print(f"{len(shown) / FPS:.0f} s, {(FOLDER / 'sample-film.mp4').stat().st_size / 1e6:.2f} MB")
