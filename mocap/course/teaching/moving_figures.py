"""The stick figures of a player that a notebook has stored, drawn at a moment.

A stored player holds what its scripts draw: joints as 16-bit numbers, sent as second differences over time.
The camera is that of the player: it stands some metres away, turned by `YAW`, looking down by `PITCH`.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from typing import Any

import numpy as np
from PIL import Image, ImageDraw
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array

YAW, PITCH = 0.7, 0.25  # radians
REACH = 7  # metres of ground that are drawn to each side
NEAR = 0.1  # metres; what is nearer to the eye is not drawn
TWICE = 2  # drawn larger by this, then made smaller, so that lines are smooth
SCENE = re.compile(r'<div class="mocap-player">.*?<script type="application/json">(.*?)</script>', re.DOTALL)


class Figures:
    """The characters of a stored player.

    Examples
    --------
    >>> from mocap import datasets
    >>> from mocap.widgets import play
    >>> figures = stored_figures(play(datasets.sample("walk_straight")).html())
    >>> figures.seconds, figures.picture(1.0, (320, 200)).size
    (10.0, (320, 200))
    """

    def __init__(self, scene: dict[str, Any], data: bytes) -> None:
        self.scene, self.seconds = scene, (scene["frames"] - 1) / scene["fps"]
        self.points = [_unpacked(character, data) for character in scene["characters"]]  # each (F, J, 3)
        frames = np.arange(max(map(len, self.points)))
        roots = np.stack([cloud[np.minimum(frames, len(cloud) - 1), 0] for cloud in self.points])
        centres = roots.mean(axis=0)
        self.distance = 4.0 + 1.5 * float(np.linalg.norm(roots - centres, axis=-1).max())
        self.fps = scene["characters"][0]["fps"]
        self.targets = gaussian_filter1d(centres, self.fps / 2, axis=0, mode="nearest")

    def picture(self, time: float, size: tuple[int, int]) -> Image.Image:
        """Draw the ground, the paths and the bodies.

        Parameters
        ----------
        time : seconds; after the end the motion starts again.
        size : width and height of the picture, pixels.
        """
        time %= self.seconds or 1.0
        canvas = Image.new("RGB", (TWICE * size[0], TWICE * size[1]), "#FFFFFF")
        target = self.targets[min(len(self.targets) - 1, round(time * self.fps))] * [1, 0, 1]
        pen = _Pen(canvas, target + np.array([0, 0.9, 0]), self.distance)
        for off in range(-REACH, REACH + 1):
            for line in ([[off, 0, -REACH], [off, 0, REACH]], [[-REACH, 0, off], [REACH, 0, off]]):
                start, end = np.round(target) + line
                pen.line(np.linspace(start, end, 29), "#DDDDDD", TWICE)
        pen.line(np.insert(np.reshape(self.scene["asked"], (-1, 2)), 1, 0.0, axis=1), "#BBBBBB", 6 * TWICE)
        for character, cloud in zip(self.scene["characters"], self.points, strict=True):
            self._draw(pen, character, cloud, time)
        return canvas.reduce(TWICE)

    def _draw(self, pen: _Pen, character: dict[str, Any], cloud: Array, time: float) -> None:
        """Draw a character's path, coloured by its sources, its seams and its body."""
        ground, fps, colour = cloud[:, 0] * [1, 0, 1], character["fps"], character["colour"]
        sources = character["sources"] or [{"start": 0, "colour": character["path_colour"]}]
        for source, end in zip(sources, [*(s["start"] for s in sources[1:]), len(cloud) / fps], strict=True):
            path = ground[round(source["start"] * fps) : round(end * fps) + 1 : 4]
            pen.line(path, source["colour"], 3 * TWICE)
            if character["sources"] and source["start"] <= time:
                colour = source["colour"]
        for seam in character["seams"]:
            pen.dots(ground[[min(len(cloud) - 1, round(seam * fps))]], self.scene["marks"]["seam"], 0.06)
        pose = cloud[min(len(cloud) - 1, round(time * fps))]  # who has come to the end stands there
        for start, end, _ in character["bones"]:
            pen.line(pose[[start, end]] * [1, 0, 1], "#DADADA", 0.05)
        for start, end, side in sorted(character["bones"], key=lambda bone: -(bone[2] == 1)):
            pen.line(pose[[start, end]], self.scene["sides"][side] if side else colour, 0.04)
        if character["head"] is not None:
            pen.dots(pose[[character["head"]]], colour, 0.095)


class _Pen:
    """Draws what stands in the world on a picture; widths are whole pixels or, below 1, metres."""

    def __init__(self, canvas: Image.Image, target: Array, distance: float) -> None:
        self.draw, self.size = ImageDraw.Draw(canvas), np.array(canvas.size)
        (cy, sy), (cp, sp) = ((np.cos(a), np.sin(a)) for a in (YAW, PITCH))
        self.eye = target + distance * np.array([sy * cp, sp, cy * cp])
        self.axes = np.array([[cy, 0, -sy], [-sy * sp, cp, -cy * sp], [-sy * cp, -sp, -cy * cp]])

    def _pixels(self, points: Array) -> tuple[Array, Array]:
        """Give where points (N, 3) are in the picture, (N, 2), and the pixels of a metre there, (N,)."""
        right, up, far = self.axes @ (points - self.eye).T
        scale = 1.5 * min(self.size) / np.where(far > NEAR, far, np.nan)
        return self.size / 2 + np.stack([right, -up], -1) * scale[:, None], scale

    def line(self, points: Array, colour: str, width: float) -> None:
        """Draw a line; a width below one is in metres, and such a line has round ends."""
        pixels, scale = self._pixels(points)
        for start, end, metre in zip(pixels[:-1], pixels[1:], scale[:-1] + scale[1:], strict=True):
            if not np.isnan(metre):
                wide = width if width >= 1 else width * metre / 2
                self.draw.line([*start, *end], colour, max(2, round(wide)))
        if width < 1:
            self.dots(points, colour, width / 2)

    def dots(self, points: Array, colour: str, metres: float) -> None:
        """Draw discs of so many metres."""
        for (x, y), metre in zip(*self._pixels(points), strict=True):
            if not np.isnan(metre):
                reach = metres * metre
                self.draw.ellipse([x - reach, y - reach, x + reach, y + reach], colour)


def stored_figures(page: str) -> Figures | None:
    """Read the player in the HTML of an output; None where there is none.

    Parameters
    ----------
    page : the HTML.
    """
    found = SCENE.search(page)
    scene = json.loads(found[1]) if found else None
    return Figures(scene, zlib.decompress(base64.b64decode(scene["data"]))) if scene else None


def _unpacked(character: dict[str, Any], data: bytes) -> Array:
    """Add the second differences up, and return the joints, shape (F, J, 3), metres."""
    shape = (character["joints"], 3, character["frames"])
    changes = np.frombuffer(data, "<u2", int(np.prod(shape)), character["offset"]).reshape(shape)
    numbers = np.cumsum(np.cumsum(changes, -1, dtype="u2"), -1, dtype="u2")
    points: Array = np.moveaxis(numbers, -1, 0) * np.array(character["step"]) + np.array(character["low"])
    return points
