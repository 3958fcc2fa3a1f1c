"""Animations and pictures of motions as files: films, still pictures, and pages with the player."""

import re
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain
from pathlib import Path
from tempfile import TemporaryFile

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from mocap._shared.atomic import replacing
from mocap._shared.progress import Progress
from mocap.body.motion import Motion, require_motions
from mocap.errors import MocapError, missing
from mocap.widgets.filmed_scene import FilmedScene
from mocap.widgets.player import play

SUFFIXES = (".gif", ".mp4", ".png", ".html")
SIZES = {".gif": (640, 360), ".mp4": (848, 480)}  # width and height of a film, pixels
SMALLEST = 64  # pixels, of a side of a film
LARGEST = 4096  # pixels
COLOURS = 128  # number of colours of a .gif
BACKGROUND = slice(8)  # columns of pixels at the left edge, for the colours of the background
ROUNDING = 1e-9  # frames, the rounding error of seconds · fps


def save_animation(  # noqa: PLR0913 (what moves, where it is written, and how it is seen)
    motion: Motion | Sequence[Motion],
    path: str | Path,
    *,
    discs: ArrayLike = (),
    fps: float = 25.0,
    size: tuple[int, int] | None = None,
    yaw: float | None = None,
    captions: bool = False,
    progress: Progress = iter,
) -> Path:
    """Save an animation of a motion: a body on the ground, its path, and a camera that follows it.

    Parameters
    ----------
    motion : one or more motions. Each of several has its own colour, and the camera follows all of them.
    path : the file. Its suffix selects the format: .gif or .mp4 for a film, .png for a still picture, .html
        for a stand-alone page with the player. If writing fails, no file is left.
    discs : obstacles on the ground, shape (N, 3), x, z and radius in metres.
    fps : frames per second of a film. The frames of a GIF last whole hundredths of a second, so 20, 25 and 50
        are exact.
    size : width and height of a film in pixels, by default 640 × 360 for .gif and 848 × 480 for .mp4.
    yaw : the direction from which the camera looks, radians about +y, where 0 looks towards -z, by default
        0.7. The reader of a page can change it.
    captions : whether a film shows the name of each motion in its colour; a page always does.
    progress : wraps the frames of a film as they are drawn, to show a bar.

    Returns
    -------
    The path of the file.

    Raises
    ------
    MocapError : for another suffix, for no motion, if the file cannot be written, and for .mp4 without
        imageio-ffmpeg.

    Examples
    --------
    >>> import tempfile
    >>> from mocap import datasets
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_animation(datasets.sample("walk_straight")[:60], Path(folder, "walk.gif")).stat().st_size > 0
    True
    """
    if isinstance(path, Motion):
        raise MocapError("The motion comes first: widgets.save_animation(motion, 'walk.gif').")
    motions = [motion] if isinstance(motion, Motion) else list(require_motions(motion))
    suffix = Path(path).suffix.lower()
    _check_film(motions, path, suffix, size)
    with replacing(path) as unfinished:
        player = play(*motions, discs=discs, yaw=yaw)
        if suffix in (".html", ".png"):
            unfinished.write_bytes(player.page().encode() if suffix == ".html" else player.picture)
        else:
            write = write_mp4 if suffix == ".mp4" else _write_gif
            scene = FilmedScene(player.scene)
            draw = partial(scene.captioned if captions else scene.picture, size=size or SIZES[suffix])
            frames = progress(range(int(scene.seconds * fps + ROUNDING) + 1))
            write((draw(frame / fps) for frame in frames), unfinished, fps)
    return Path(path)


def _check_film(
    motions: Sequence[Motion], path: str | Path, suffix: str, size: tuple[int, int] | None
) -> None:
    """Raise for another suffix, for no motion, for a size that no film has, and for .mp4 without ffmpeg."""
    if suffix not in SUFFIXES:
        raise MocapError(f"An animation is written as {', '.join(SUFFIXES[:-1])} or .html, got '{path}'.")
    if not motions:
        raise MocapError("There is no motion to show.")
    # Encoders need an even number of pixels.
    if size is not None and not all(SMALLEST <= side <= LARGEST and side % 2 == 0 for side in size):
        needs = f"an even width and height from {SMALLEST} to {LARGEST} pixels"
        raise MocapError(f"A film has {needs}, got {size[0]} × {size[1]}.")
    if suffix == ".mp4":
        require_ffmpeg()


def _write_gif(pictures: Iterator[NDArray[np.uint8]], path: Path, fps: float) -> None:
    """Write all pictures with one palette, so that unchanged pixels are written only once."""
    picture = next(pictures)
    colours = np.unique(picture.reshape(-1, 3) // 4 * 4, axis=0)  # a body has few pixels, but many colours
    background = picture[:, BACKGROUND].reshape(-1, 3)
    palette = Image.fromarray(np.concatenate([colours, background])[None]).quantize(COLOURS)
    images = map(Image.fromarray, chain([picture], pictures))
    first, *rest = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images)
    first.save(path, save_all=True, append_images=rest, duration=round(1000 / fps), loop=0)


def write_mp4(pictures: Iterator[NDArray[np.uint8]], path: Path, fps: float) -> None:
    """Encode pictures with ffmpeg, and raise its error, if any.

    Parameters
    ----------
    pictures : pictures of shape (height, width, 3), of even height and width.
    path : the file to write.
    fps : pictures per second.

    Raises
    ------
    MocapError : with the last line of ffmpeg's output.
    """
    import imageio_ffmpeg

    first = next(pictures)
    size = f"{first.shape[1]}x{first.shape[0]}"
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", f"{fps:g}", "-i", "-"]
    encoded = ["-preset", "veryfast", "-pix_fmt", "yuv420p", str(path)]
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-y", *raw, *encoded]
    with TemporaryFile() as said:
        ffmpeg = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=said, stderr=said)
        assert ffmpeg.stdin
        try:
            with suppress(OSError), ffmpeg.stdin as pipe:  # ffmpeg has ended with a message (Windows: EINVAL)
                for picture in chain([first], pictures):
                    pipe.write(np.ascontiguousarray(picture).data)
        finally:
            failed = ffmpeg.wait()
        said.seek(0)
        if failed:
            *_, last = said.read().decode(errors="replace").splitlines() or ["it ended early"]
            reason = re.sub(r"^(\[[^]]*\] )*", "", last)  # without the names of ffmpeg's components
            raise MocapError(f"ffmpeg cannot write the film: {reason[:120].strip()}.")


def require_ffmpeg() -> None:
    """Raise MocapError with a remedy if imageio-ffmpeg is not installed."""
    try:
        import imageio_ffmpeg  # noqa: F401
    except ImportError as error:
        raise missing("An .mp4, but no .gif, needs imageio-ffmpeg", "video") from error
