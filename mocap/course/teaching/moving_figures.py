"""The stick figures of a player that a notebook has stored, drawn at a moment.

A stored player holds what its scripts draw: joints as 16-bit numbers, sent as second differences over time.
The camera is that of the player: it stands `distance` metres away, turned by `YAW`, looking down by `PITCH`.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from PIL import Image, ImageDraw
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array

YAW, PITCH = 0.7, 0.25  # radians
FOLLOWED = 15.0  # metres of ground up to which the camera shows all of it
TWICE = 2  # drawn larger by this, then made smaller, so that lines are smooth
GROUND, PAPER, INK = "#DDDDDD", "#FFFFFF", "#333333"
SCENE = re.compile(r'<div class="mocap-player">.*?<script type="application/json">(.*?)</script>', re.DOTALL)


@dataclass(frozen=True, eq=False)
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

    scene: dict[str, Any]
    points: list[Array]  # per character, (F, J, 3)

    @property
    def seconds(self) -> float:
        """How long they move."""
        return float((self.scene["frames"] - 1) / self.scene["fps"])

    @cached_property
    def _targets(self) -> tuple[Array, float]:
        """Where the camera looks in each frame of the first character, and from how far away."""
        longest = max(map(len, self.points))
        roots = np.stack([cloud[np.minimum(np.arange(longest), len(cloud) - 1), 0] for cloud in self.points])
        centres, spread = roots.mean(axis=0), float(np.ptp(roots[..., [0, 2]], axis=(0, 1)).max())
        apart = float(np.linalg.norm(roots - centres, axis=-1).max()) if len(roots) > 1 else 0.0
        if len(roots) > 1 and spread < FOLLOWED:
            return np.broadcast_to(roots.mean(axis=(0, 1)), centres.shape), 3.5 + spread
        fps = self.scene["characters"][0]["fps"]
        return gaussian_filter1d(centres, fps / 2, axis=0, mode="nearest"), 4.0 + 1.5 * apart

    def picture(self, time: float, size: tuple[int, int]) -> Image.Image:
        """Draw the ground, the paths and the bodies.

        Parameters
        ----------
        time : seconds; after the end the motion starts again.
        size : width and height of the picture, pixels.
        """
        time %= self.seconds or 1.0
        canvas = Image.new("RGB", (TWICE * size[0], TWICE * size[1]), PAPER)
        targets, distance = self._targets
        frame = min(len(targets) - 1, round(time * self.scene["characters"][0]["fps"]))
        pen = _Pen(canvas, targets[frame] * [1, 0, 1] + [0, 0.9, 0], distance)
        pen.ground(targets[frame])
        if len(self.scene["asked"]) > 1:
            pen.line(np.insert(np.array(self.scene["asked"]), 1, 0.0, axis=1), "#BBBBBB", 6)
        bodies = list(zip(self.scene["characters"], self.points, strict=True))
        for character, cloud in bodies:
            self._trail(pen, character, cloud)
        for character, cloud in sorted(bodies, key=lambda body: -pen.far(_at(body[0], body[1], time)[0])):
            self._body(pen, character, _at(character, cloud, time), time)
        return canvas.reduce(TWICE)

    def _trail(self, pen: _Pen, character: dict[str, Any], cloud: Array) -> None:
        root, fps = cloud[:, 0] * [1, 0, 1], character["fps"]
        sources = character["sources"] or [{"start": 0, "colour": character["path_colour"]}]
        starts = [(round(source["start"] * fps), source["colour"]) for source in sources]
        for (start, colour), (end, _) in zip(starts, [*starts[1:], (len(root), "")], strict=True):
            pen.line(root[start : end + 1 : 4], colour, 3)
        for seam in character["seams"]:
            pen.diamond(root[min(len(root) - 1, round(seam * fps))], self.scene["marks"]["seam"])

    def _body(self, pen: _Pen, character: dict[str, Any], pose: Array, time: float) -> None:
        own = character["colour"]
        for source in character["sources"]:
            own = source["colour"] if source["start"] <= time else own
        pen.lines(pose * [1, 0, 1], [bone[:2] for bone in character["bones"]], "#DADADA", 0.05)
        for side in (1, 0, 2):
            bones = [bone[:2] for bone in character["bones"] if bone[2] == side]
            pen.lines(pose, bones, self.scene["sides"][side] if side else own, 0.04)
        if character["head"] is not None:
            pen.disc(pose[character["head"]], 0.095, own)


class _Pen:
    """Draws what stands in the world on a picture."""

    def __init__(self, canvas: Image.Image, target: Array, distance: float) -> None:
        self.draw, self.size = ImageDraw.Draw(canvas), np.array(canvas.size)
        (cy, sy), (cp, sp) = ((np.cos(a), np.sin(a)) for a in (YAW, PITCH))
        self.eye = target + distance * np.array([sy * cp, sp, cy * cp])
        self.axes = np.array([[cy, 0, -sy], [-sy * sp, cp, -cy * sp], [-sy * cp, -sp, -cy * cp]])
        self.focus = 1.5 * min(canvas.size)

    def _pixels(self, points: Array) -> tuple[Array, Array]:
        right, up, far = self.axes @ (np.atleast_2d(points) - self.eye).T
        far = np.maximum(far, 0.1)
        return (self.size / 2 + np.stack([right, -up], -1) * (self.focus / far)[:, None]), far

    def far(self, point: Array) -> float:
        """Give how far a point is from the eye, metres."""
        return float(self._pixels(point)[1][0])

    def line(self, points: Array, colour: str, width: float) -> None:
        """Draw a line through points, as wide everywhere; what lies behind the eye is left out."""
        if len(points) > 1:
            pixels, far = self._pixels(points)
            for part in np.split(np.arange(len(points)), np.flatnonzero(far <= 0.1)):
                run = [tuple(pixels[number]) for number in part if far[number] > 0.1]
                if len(run) > 1:
                    self.draw.line(run, colour, round(TWICE * width), joint="curve")

    def lines(self, points: Array, pairs: list[list[int]], colour: str, metres: float) -> None:
        """Draw bones between pairs of points, so thick in metres, with round ends."""
        pixels, far = self._pixels(points)
        width = max(2, round(metres * self.focus / float(far.mean())))
        for a, b in pairs:
            self.draw.line([*map(tuple, pixels[[a, b]])], colour, width)
            x, y = pixels[b]
            self.draw.ellipse([x - width / 2, y - width / 2, x + width / 2, y + width / 2], colour)

    def disc(self, point: Array, metres: float, colour: str) -> None:
        """Draw a ball of a radius in metres."""
        ((x, y),), far = self._pixels(point)
        reach = metres * self.focus / float(far[0])
        self.draw.ellipse([x - reach, y - reach, x + reach, y + reach], colour)

    def diamond(self, point: Array, colour: str) -> None:
        """Draw a diamond on the ground, as it marks a seam."""
        corners, far = self._pixels(point + 0.07 * np.array([[1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1]]))
        if far.min() > 0.1:
            self.draw.polygon([*map(tuple, corners)], colour)

    def ground(self, centre: Array, reach: int = 7) -> None:
        """Draw a line on the ground for each metre around a place."""
        x, z = np.round(centre[[0, 2]])
        along = np.linspace(-reach, reach, 29)
        for off in range(-reach, reach + 1):
            self.line(np.stack([np.full(29, x + off), np.zeros(29), z + along], -1), GROUND, 1)
            self.line(np.stack([x + along, np.zeros(29), np.full(29, z + off)], -1), GROUND, 1)


def stored_figures(page: str) -> Figures | None:
    """Read the player in the HTML of an output; None where there is none.

    Parameters
    ----------
    page : the HTML.
    """
    found = SCENE.search(page)
    if not found:
        return None
    scene = json.loads(found[1])
    data = zlib.decompress(base64.b64decode(scene["data"]))
    return Figures(scene, [_unpacked(character, data) for character in scene["characters"]])


def _unpacked(character: dict[str, Any], data: bytes) -> Array:
    """Add the second differences up, and return the joints, shape (F, J, 3), metres."""
    shape = (character["joints"], 3, character["frames"])
    changes = np.frombuffer(data, "<u2", int(np.prod(shape)), character["offset"]).reshape(shape)
    numbers = np.cumsum(np.cumsum(changes, -1, dtype="u2"), -1, dtype="u2")
    points: Array = np.moveaxis(numbers, -1, 0) * np.array(character["step"]) + np.array(character["low"])
    return points


def _at(character: dict[str, Any], cloud: Array, time: float) -> Array:
    """Give the pose nearest to a time; who has come to the end stands there."""
    return np.asarray(cloud[min(len(cloud) - 1, round(time * character["fps"]))])
