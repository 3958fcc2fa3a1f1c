"""The scene of a player, drawn at a given time without a browser, for films.

A scene contains the data of the player's scripts: joint positions as 16-bit numbers, stored as second
differences over time.
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
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array
from mocap.plotting.props import box_faces, boxes_with, diamonds, rims
from mocap.plotting.style import FLOOR, QUIET
from mocap.widgets.shaded_picture import GROUND, SKY, YAW, ShadedPicture, blend
from mocap.widgets.walk_figure import capsules_at

AROUND = 9  # metres of ground that are drawn on each side, beyond the characters
FADE = 2.0  # seconds before and after the current time in which a path becomes paler
PALE = 0.7  # weight of the ground's colour in a path beyond that time
GREY = "#737B8C"  # the middle of a body
STEP = 0.1  # seconds between points of a path
SMOOTHING = 0.4  # seconds, the standard deviation of the Gaussian that smooths the camera's path
ROUNDING = 1e-6  # frames, tolerance of the time of a frame
GRID_PIECES = 14  # pieces of a line of the grid on the ground, each of one colour
CELLS = 30  # largest number of squares of the grid on each side of its centre
PATH_WIDTH = 2.5  # pixels
ASKED_WIDTH = 5  # pixels, width of the requested path
SEAM_RADIUS = 0.1  # metres
FOOTPRINT_RADIUS = 0.055  # metres
EYE_LEVEL = np.array([0, 0.9, 0])  # metres, the height at which the camera looks
NEAREST = 4.2  # metres, the distance of the camera from a single character
ZOOM = 1.5  # additional metres of distance for each metre between characters
BRIGHTNESS = (0.0, 0.45, 0.2)  # of the faces of boxes that are perpendicular to x, y and z
SMALLEST_TEXT = 10  # pixels, the height of a name
TEXT_LINES = 26  # lines of names that fit into a picture
FLAT = [1, 0, 1]  # factor that projects points to the ground
XZ = [0, 2]
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
        self.scene = scene
        self.seconds = (scene["frames"] - 1) / scene["fps"]
        data = zlib.decompress(scene["data"])
        self.clouds: list[Array] = []  # each (F, J, 3), metres
        for character in scene["characters"]:
            shape = (character["joints"], 3, character["frames"])
            changes = np.frombuffer(data, "<u2", int(np.prod(shape)), character["offset"]).reshape(shape)
            numbers = changes.cumsum(-1, dtype="u2").cumsum(-1, dtype="u2")
            self.clouds.append(np.moveaxis(numbers, -1, 0) * character["step"] + character["low"])
        self.times = np.append(np.arange(0.0, self.seconds, STEP), self.seconds)
        self.paths = [self._path(number) for number in range(len(self.clouds))]
        paths = np.array(self.paths) * FLAT
        centres = paths.mean(axis=0)
        self.spread = float(np.linalg.norm(paths - centres, axis=-1).max())
        self.targets = gaussian_filter1d(centres, SMOOTHING / STEP, axis=0, mode="nearest")

    def _path(self, number: int) -> Array:
        """Return the positions of a character's root at `times`, (T, 3), metres."""
        return np.array([self.pose(number, time)[0] for time in self.times])

    def pose(self, number: int, time: float) -> Array:
        """Interpolate the positions of a character's drawn joints, (J, 3), metres, constant after its end."""
        cloud = self.clouds[number]
        frames = time * self.scene["characters"][number]["fps"]
        frame = min(int(frames + ROUNDING), len(cloud) - 1)
        joints = cloud[frame]
        next_joints = cloud[min(frame + 1, len(cloud) - 1)]
        return np.asarray(joints + min(frames - frame, 1.0) * (next_joints - joints))

    def picture(self, time: float, size: tuple[int, int]) -> NDArray[np.uint8]:
        """Draw the ground, the paths and the bodies, shape (height, width, 3).

        Parameters
        ----------
        time : seconds. After the end, the motion starts again.
        size : width and height of the picture, pixels.
        """
        time = time % self.seconds if time > self.seconds > 0 else time
        target = np.array([np.interp(time, self.times, coordinate) for coordinate in self.targets.T])
        distance = NEAREST + ZOOM * self.spread
        page = ShadedPicture(size, target + EYE_LEVEL, distance, yaw=self.scene.get("yaw", YAW))
        self.draw_grid(page, np.round(target), AROUND + round(self.spread))
        self.draw_props(page)
        asked_path = np.insert(np.reshape(self.scene["asked"], (-1, 2)), 1, 0.0, axis=1)
        page.line(asked_path, blend(QUIET, GROUND, 0.3), ASKED_WIDTH)
        pieces: list[Array] = []
        colours: list[ArrayLike] = []
        for number, character in enumerate(self.scene["characters"]):
            self._draw_path(page, number, time)
            pieces.append(capsules_at(character, self.pose(number, time)))
            sides = self.body_colours(number, time)
            colours += [sides[side] for *_, side in character["pieces"]]
        return page.finished(np.concatenate(pieces), np.array(colours))

    def captioned(self, time: float, size: tuple[int, int]) -> NDArray[np.uint8]:
        """Draw a picture as `picture` does, with the names of the characters in the colours of their bodies.

        Parameters
        ----------
        time, size : as for `picture`.
        """
        image = Image.fromarray(self.picture(time, size))
        pen = ImageDraw.Draw(image)
        height = max(SMALLEST_TEXT, size[1] // TEXT_LINES)
        font = ImageFont.load_default(size=height)
        for number, character in enumerate(self.scene["characters"]):
            red, green, blue = np.asarray(self.body_colours(number, time)[0], float)
            colour = (round(255 * red), round(255 * green), round(255 * blue))
            pen.text((height, (0.7 + 1.4 * number) * height), character["name"][:60], fill=colour, font=font)
        return np.asarray(image)

    def draw_grid(self, page: ShadedPicture, centre: Array, reach: int, colour: str = FLOOR) -> None:
        """Draw a grid on the ground, `reach` metres to each side of a centre, where it fades out."""
        ends = np.linspace(-reach, reach, GRID_PIECES + 1)
        middles = ends[1:] - reach / GRID_PIECES
        zeros = np.zeros_like(ends)
        floor = np.array(to_rgb(colour))
        ground = np.array(to_rgb(GROUND))
        for offset in range(-reach, reach + 1, self.cell(reach)):
            fading = np.hypot(offset, middles)[:, None] / (reach + 1)
            inks = floor + fading.clip(0, 1) * (ground - floor)
            offsets = zeros + offset
            page.line(centre + np.stack([ends, zeros, offsets], axis=-1), inks, 1)
            page.line(centre + np.stack([offsets, zeros, ends], axis=-1), inks, 1)

    def draw_props(self, page: ShadedPicture, moved: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Draw the discs on the ground and the boxes, whose faces differ in brightness.

        Parameters
        ----------
        page : the picture.
        moved : the translations of the bodies, shape (3,) or (N, 3), metres: each has its boxes with it.
        """
        boxes = boxes_with(self.scene["boxes"], moved)
        page.boxes = list(boxes)
        for rim in rims(self.scene["obstacles"]):
            page.area(rim, to_rgb(QUIET))
        for axis, corners in box_faces(boxes, page.eye):
            page.area(corners, blend(QUIET, SKY, BRIGHTNESS[axis]))

    def cell(self, reach: int) -> int:
        """Return the side of the squares of a grid, metres."""
        return 1 + reach // CELLS

    def _draw_path(self, page: ShadedPicture, number: int, time: float) -> None:
        """Draw a character's path, seams and footprints, paler with their distance in time."""
        character = self.scene["characters"][number]
        middles = (self.times[1:] + self.times[:-1]) / 2
        paleness = PALE * np.minimum(np.abs(middles - time) / FADE, 1)[:, None]
        inks = (1 - paleness) * self.path_colours(number, middles) + paleness * to_rgb(GROUND)
        page.line(self.paths[number] * FLAT, inks, PATH_WIDTH)
        seams = [[*self.pose(number, seam)[0, XZ], SEAM_RADIUS] for seam in character["seams"]]
        for diamond in diamonds(seams, page.yaw):
            page.area(diamond, to_rgb(self.scene["marks"]["seam"]))
        for start, end, x, z, side in character["prints"]:
            if start <= time < end + FADE:
                colour = blend(self.scene["sides"][side], GROUND, PALE * max(0.0, (time - end) / FADE))
                page.area(rims([[x, z, FOOTPRINT_RADIUS]])[0], colour)

    def path_colours(self, number: int, times: Array) -> Array:
        """Return the colours of a path at some times, (T, 3), which are those of its sources."""
        character = self.scene["characters"][number]
        sources = character["sources"] or [{"start": 0.0, "colour": character["path_colour"]}]
        colours = np.array([to_rgb(source["colour"]) for source in sources])
        return np.asarray(colours[_sources_at(sources, times)])

    def body_colours(self, number: int, time: float) -> list[ArrayLike]:
        """Return the colours of the middle, the left and the right of a body, at indices 0, 1 and -1."""
        character = self.scene["characters"][number]
        colour = character["colour"]
        if character["sources"]:
            colour = character["sources"][_sources_at(character["sources"], time)]["colour"]
        if len(self.clouds) > 1:
            return [to_rgb(colour), blend(colour, "#FFFFFF", 0.2), blend(colour, "#000000", 0.2)]
        middle, *sides = self.scene["sides"]
        if colour == middle:
            colour = GREY
        return [to_rgb(colour), *(blend(side, GREY, 0.25) for side in sides)]


def _sources_at(sources: list[dict[str, Any]], times: ArrayLike) -> Any:  # noqa: ANN401
    """Return the indices of the sources of a motion at some times."""
    return np.searchsorted([source["start"] for source in sources], times, "right") - 1


def stored_scene(page: str) -> FilmedScene | None:
    """Read the player in the HTML of an output, or return None if there is none.

    Parameters
    ----------
    page : the HTML.
    """
    match = SCENE.search(page)
    if match is None:
        return None
    scene = json.loads(match[1])
    return FilmedScene(scene | {"data": base64.b64decode(scene["data"])})
