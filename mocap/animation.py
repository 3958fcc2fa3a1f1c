"""Motions as files to look at."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from mocap.atomic import replacing
from mocap.errors import MocapError
from mocap.kinematics import joint_positions
from mocap.motion import Motion, resample
from mocap.progress import Progress
from mocap.stage import StickFigure, filled, look_at, stage, to_picture
from mocap.style import PATH


def save_animation(motion: Motion, path: str | Path, *, fps: float = 25.0, progress: Progress = iter) -> Path:
    """Write an animated GIF: the stick figure on the ground, followed by the camera, and its path.

    Parameters
    ----------
    motion : what to show.
    path : the file to write, ending in .gif; nothing is left behind when writing fails.
    fps : pictures a second; GIFs count in hundredths of a second, so 25, 50 and 20 are exact.
    progress : wraps the pictures as they are drawn, to show a bar.

    Returns
    -------
    The path.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    if Path(path).suffix.lower() != ".gif":
        raise MocapError(f"An animation is written as .gif, got '{path}'.")
    motion = resample(motion, fps)
    points = joint_positions(motion)
    centres = gaussian_filter1d(motion.root_positions[:, [0, 2]], fps / 3, axis=0, mode="nearest")
    figure = Figure(figsize=(5, 5))
    canvas = FigureCanvasAgg(figure)  # draws whatever pyplot is set to, and needs no screen
    ax = stage(centres[0], ax=filled(figure))
    ax.plot(*to_picture(motion.root_positions * [1, 0, 1]).T, color=PATH, linewidth=1.5, zorder=1)
    body = StickFigure(motion.skeleton, ax)
    pictures = []
    for frame in progress(range(len(motion))):
        look_at(ax, centres[frame], 1.0)
        body.pose(points[frame])
        canvas.draw()
        pictures.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"))
    first, *rest = (picture.quantize(32, dither=Image.Dither.NONE) for picture in pictures)
    with replacing(path) as beside:
        first.save(beside, save_all=True, append_images=rest, duration=round(1000 / fps), loop=0)
    return Path(path)
