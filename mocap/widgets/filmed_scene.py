"""The scene of a player, drawn at a moment without a browser: for films.

A scene holds what the player's scripts draw: joints as 16-bit numbers, sent as second differences over time.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array
from mocap.plotting.bodies import rims
from mocap.plotting.style import FLOOR, QUIET
from mocap.widgets.shaded_picture import GROUND, ShadedPicture, blend
from mocap.widgets.walk_figure import capsules_at

AROUND = 9  # metres of ground that are drawn to each side, beyond the characters
FADE, PALE = 2.0, 0.7  # seconds from now, until which a path gets paler, and how pale
GREY = "#737B8C"  # the middle of a body
STEP = 0.1  # seconds between points of a path
SCENE = re.compile(r'<div class="mocap-player">.*?<script type="application/json">(.*?)</script>', re.DOTALL)


class FilmedScene:
    """The characters of a player, and the camera that follows them.

    Parameters
    ----------
    scene : as `Player.scene`.

    Examples
    --------
    >>> from mocap import datasets
    >>> from mocap.widgets import play
    >>> film = FilmedScene(play(datasets.sample("walk_straight")).scene)
    >>> film.seconds, film.picture(1.0, (320, 200)).shape
    (9.641666666666667, (200, 320, 3))
    """

    def __init__(self, scene: dict[str, Any]) -> None:
        self.scene, self.seconds = scene, (scene["frames"] - 1) / scene["fps"]
        data = zlib.decompress(scene["data"])
        self.clouds: list[Array] = []  # each (F, J, 3), metres
        for character in scene["characters"]:
            shape = (character["joints"], 3, character["frames"])
            changes = np.frombuffer(data, "<u2", int(np.prod(shape)), character["offset"]).reshape(shape)
            numbers = changes.cumsum(-1, dtype="u2").cumsum(-1, dtype="u2")
            self.clouds.append(np.moveaxis(numbers, -1, 0) * character["step"] + character["low"])
        self.times = np.append(np.arange(0.0, self.seconds, STEP), self.seconds)
        self.ways = [np.array([self.pose(n, t)[0] for t in self.times]) for n in range(len(self.clouds))]
        ways = np.array(self.ways) * [1, 0, 1]
        centres = ways.mean(axis=0)
        self.spread = float(np.linalg.norm(ways - centres, axis=-1).max())
        self.targets = gaussian_filter1d(centres, 0.4 / STEP, axis=0, mode="nearest")

    def pose(self, number: int, time: float) -> Array:
        """Place the drawn joints of a character, (J, 3), metres; who has come to the end stands there."""
        cloud, at = self.clouds[number], time * self.scene["characters"][number]["fps"]
        frame = min(int(at + 1e-6), len(cloud) - 1)
        here, after = cloud[frame], cloud[min(frame + 1, len(cloud) - 1)]
        return np.asarray(here + min(at - frame, 1.0) * (after - here))

    def picture(self, time: float, size: tuple[int, int]) -> NDArray[np.uint8]:
        """Draw the ground, the paths and the bodies, shape (height, width, 3).

        Parameters
        ----------
        time : seconds; beyond the end the motion starts again.
        size : width and height of the picture, pixels.
        """
        time = time % self.seconds if time > self.seconds > 0 else time
        target = np.array([np.interp(time, self.times, along) for along in self.targets.T])
        page = ShadedPicture(size, target + np.array([0, 0.9, 0]), 4.2 + 1.5 * self.spread)
        reach = AROUND + round(self.spread)
        ends = np.linspace(-reach, reach, 15)
        for off in range(-reach, reach + 1, 1 + reach // 30):
            far = np.hypot(off, ends[1:] - reach / 14)[:, None] / (reach + 1)
            inks = to_rgb(FLOOR) + far.clip(0, 1) * (np.array(to_rgb(GROUND)) - to_rgb(FLOOR))
            for way in ([ends, 0 * ends, 0 * ends + off], [0 * ends + off, 0 * ends, ends]):
                page.line(np.round(target) + np.transpose(way), inks, 1)
        for rim in rims(self.scene["obstacles"]):
            page.area(rim, to_rgb(QUIET))
        asked = np.insert(np.reshape(self.scene["asked"], (-1, 2)), 1, 0.0, axis=1)
        page.line(asked, blend(QUIET, GROUND, 0.3), 5)
        pieces: list[Array] = []
        colours: list[ArrayLike] = []
        for number, character in enumerate(self.scene["characters"]):
            sides = self._draw_path(page, number, time)
            pieces.append(capsules_at(character, self.pose(number, time)))
            colours += [sides[side] for *_, side in character["pieces"]]
        return page.finished(np.concatenate(pieces), np.array(colours))

    def _draw_path(self, page: ShadedPicture, number: int, time: float) -> list[ArrayLike]:
        """Draw a character's path, seams and footprints, strong around now; give its body's colours now.

        They are those of the middle, the left and the right of a body, whose pieces say 0, 1 and -1.
        """
        character, way = self.scene["characters"][number], self.ways[number] * [1, 0, 1]
        sources = character["sources"] or [{"start": 0.0, "colour": character["path_colour"]}]
        middles = (self.times[1:] + self.times[:-1]) / 2
        which = np.searchsorted([source["start"] for source in sources], [*middles, time], "right") - 1
        inks = np.array([to_rgb(source["colour"]) for source in sources])[which[:-1]]
        pale = PALE * np.minimum(np.abs(middles - time) / FADE, 1)[:, None]
        page.line(way, (1 - pale) * inks + pale * to_rgb(GROUND), 2.5)
        for seam in rims([[*self.pose(number, at)[0, [0, 2]], 0.07] for at in character["seams"]]):
            page.area(seam, to_rgb(self.scene["marks"]["seam"]))
        for start, end, x, z, side in character["prints"]:
            if start <= time < end + FADE:
                pale = PALE * max(0.0, (time - end) / FADE)
                page.area(rims([[x, z, 0.055]])[0], blend(self.scene["sides"][side], GROUND, pale))
        own = sources[which[-1]]["colour"] if character["sources"] else character["colour"]
        if len(self.clouds) > 1:
            return [to_rgb(own), blend(own, "#FFFFFF", 0.2), blend(own, "#000000", 0.2)]
        middle, *sides = self.scene["sides"]
        return [to_rgb(GREY if own == middle else own), *(blend(side, GREY, 0.25) for side in sides)]


def stored_scene(page: str) -> FilmedScene | None:
    """Read the player in the HTML of an output; None where there is none.

    Parameters
    ----------
    page : the HTML.
    """
    found = SCENE.search(page)
    scene = json.loads(found[1]) if found else None
    return FilmedScene(scene | {"data": base64.b64decode(scene["data"])}) if scene else None
