"""Motions as files to look at: films, strips of poses, pages with the player."""

import re
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from tempfile import TemporaryFile

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import ArrayLike, NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from mocap._shared.atomic import replacing
from mocap._shared.progress import Progress
from mocap.body import Motion, joint_positions, resample
from mocap.errors import MocapError, missing
from mocap.plotting.stick_figures import StickFigure, filled, ground_axes, look_at, rims, to_picture
from mocap.plotting.style import PATH, QUIET, own_colour
from mocap.widgets.player import play

SUFFIXES = (".gif", ".mp4", ".png", ".html")


def save_animation(
    motion: Motion | Sequence[Motion],
    path: str | Path,
    *,
    discs: ArrayLike = (),
    fps: float = 25.0,
    progress: Progress = iter,
) -> Path:
    """Write a motion as a file to look at: a stick figure on the ground, its path, a camera that follows it.

    Parameters
    ----------
    motion : what to show; of several, each has a colour, and the camera follows them all.
    path : the file to write; nothing is left behind when writing fails. Its ending decides: .gif or .mp4 is a
        film, .png a strip of poses, .html a page with the player, which needs nothing else.
    discs : obstacles on the ground, shape (N, 3), x, z and radius in metres.
    fps : frames per second of a film; a GIF counts in hundredths of a second, so 20, 25 and 50 are exact.
    progress : wraps the frames of a film as they are drawn, to show a bar.

    Returns
    -------
    The path.

    Raises
    ------
    MocapError : for another ending, for no motion, where the file cannot be written, and for .mp4 without
        imageio-ffmpeg.

    Examples
    --------
    >>> import tempfile
    >>> from mocap import datasets
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_animation(datasets.sample("walk_straight")[:60], Path(folder, "walk.gif")).stat().st_size > 0
    True
    """
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise MocapError(f"An animation is written as {', '.join(SUFFIXES[:-1])} or .html, got '{path}'.")
    motions = [motion] if isinstance(motion, Motion) else list(motion)
    if not motions:
        raise MocapError("There is no motion to show.")
    if suffix == ".mp4":
        require_ffmpeg()
    with replacing(path) as beside:
        if suffix in (".html", ".png"):
            player = play(*motions, discs=discs)
            beside.write_bytes(player.page().encode() if suffix == ".html" else player.picture)
        else:
            write = write_mp4 if suffix == ".mp4" else _write_gif
            write(_pictures(motions, discs, fps, progress), beside, fps)
    return Path(path)


def _pictures(
    motions: Sequence[Motion], discs: ArrayLike, fps: float, progress: Progress
) -> Iterator[NDArray[np.uint8]]:
    """Draw a film, frame by frame, each of shape (500, 500, 3); who has come to the end stands there."""
    motions = [resample(motion, fps) for motion in motions]
    frames = max(map(len, motions))
    clouds = [joint_positions(motion)[np.minimum(np.arange(frames), len(motion) - 1)] for motion in motions]
    roots = np.stack([cloud[:, 0, [0, 2]] for cloud in clouds])  # (C, F, 2)
    centres = gaussian_filter1d(roots.mean(axis=0), fps / 3, axis=0, mode="nearest")
    reach = 1.0 + float(np.linalg.norm(roots - centres, axis=-1).max()) * (len(motions) > 1)
    figure = Figure(figsize=(5, 5))
    canvas = FigureCanvasAgg(figure)  # whatever pyplot's backend is, this one needs no screen
    ax = ground_axes(centres[0], reach, ax=filled(figure))
    obstacles, outlines = Poly3DCollection(np.zeros((1, 3, 3)), facecolors=QUIET, zorder=0.5), rims(discs)
    ax.add_collection3d(obstacles)
    bodies = []
    for number, motion in enumerate(motions):
        colour, way = own_colour(number, len(motions)), to_picture(motion.root_positions * [1, 0, 1])
        ax.plot(*way.T, color=colour or PATH, linewidth=1.5, zorder=1)
        bodies.append(StickFigure(motion.skeleton, ax, colour=colour))
    for frame in progress(range(frames)):
        look_at(ax, centres[frame], reach)
        middle, side = np.insert(centres[frame], 1, 0.0), 2.5 * reach * np.array([1, 0, 1])
        near = np.clip(outlines, middle - side, middle + side)  # matplotlib cannot draw behind the camera
        obstacles.set_verts(to_picture(near))
        for body, cloud in zip(bodies, clouds, strict=True):
            body.pose(cloud[frame])
        canvas.draw()
        yield np.array(canvas.buffer_rgba())[..., :3]


def _write_gif(pictures: Iterator[NDArray[np.uint8]], path: Path, fps: float) -> None:
    first, *rest = (Image.fromarray(p).quantize(32, dither=Image.Dither.NONE) for p in pictures)
    first.save(path, save_all=True, append_images=rest, duration=round(1000 / fps), loop=0)


def write_mp4(pictures: Iterator[NDArray[np.uint8]], path: Path, fps: float) -> None:
    """Give ffmpeg the pictures, one after the other, and raise what it complains of.

    Parameters
    ----------
    pictures : each of shape (height, width, 3), of even height and width.
    path : the file to write.
    fps : pictures per second.

    Raises
    ------
    MocapError : what ffmpeg says.
    """
    import imageio_ffmpeg

    first = next(pictures)
    size = f"{first.shape[1]}x{first.shape[0]}"
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", f"{fps:g}", "-i", "-"]
    made = ["-preset", "veryfast", "-pix_fmt", "yuv420p", str(path)]
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-y", *raw, *made]
    with TemporaryFile() as said:
        ffmpeg = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=said, stderr=said)
        assert ffmpeg.stdin
        try:
            with suppress(BrokenPipeError), ffmpeg.stdin as pipe:
                for picture in chain([first], pictures):
                    pipe.write(np.ascontiguousarray(picture).data)
        finally:
            failed = ffmpeg.wait()
        said.seek(0)
        if failed:
            *_, last = said.read().decode(errors="replace").splitlines() or ["it ended early"]
            reason = re.sub(r"^(\[[^]]*\] )*", "", last)  # without ffmpeg's own names
            raise MocapError(f"ffmpeg cannot write the film: {reason[:120].strip()}.")


def require_ffmpeg() -> None:
    """Raise a sentence where imageio-ffmpeg is not installed."""
    try:
        import imageio_ffmpeg  # noqa: F401
    except ImportError as error:
        raise missing("An .mp4, but no .gif, needs imageio-ffmpeg", "video") from error
