"""Ray casting of shaded bodies on a ground with NumPy, so that films are written without a browser.

A body consists of tapered capsules (round cones), as `bodies.js` draws them: the union of balls whose centre
moves from one end to the other while their radius changes linearly, flattened from front to back. The first
intersection of the ray of a pixel is found in closed form. Camera, light and colours are those of the player.
"""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple

YAW = 0.7  # radians
PITCH = 0.25  # radians, downwards
FOCUS = 1.5  # focal length, as a multiple of the smaller side of the picture
NEAR = 0.1  # metres: nearer points are not drawn
GRAZING = 1e-9  # component of a ray along an axis, instead of a smaller one
TWICE = 2  # supersampling factor, which smooths edges
SKY = "#FAF7F0"
GROUND = "#ECE6DA"
WARM = np.array([1.22, 1.1, 0.95], np.float32)  # the light of the sun
SUN = (-0.45, 0.78, 0.44)  # direction of the sun: right, up and back, relative to the camera
SHADOW = 0.3  # darkness of shadows, from 0 to 1

# Columns of a capsule, as from `capsules_at`.
START = slice(0, 3)
START_RADIUS = 3
END = slice(4, 7)
END_RADIUS = 7
ENDS = slice(0, 8)  # two balls (x, y, z, radius)
AHEAD = slice(8, 11)  # the direction in which it is flattened
FLATNESS = 11
BALL = (2, 4)  # shape of `ENDS`, one row for each ball
RADIUS = 3  # column of a ball

Window = tuple[slice, slice]  # rows and columns of pixels
Floats = NDArray[np.float32]


def blend(colour: str, second: str, weight: float) -> Array:
    """Mix two colours, with the weight of the second, as red, green and blue from 0 to 1.

    Examples
    --------
    >>> blend("#000000", "#FFFFFF", 0.25).tolist()
    [0.25, 0.25, 0.25]
    """
    return (1 - weight) * np.array(to_rgb(colour)) + weight * np.array(to_rgb(second))


class _Cone(NamedTuple):
    """A capsule in camera coordinates: balls around a + u s with the radius r + u k, u from 0 to 1.

    Lengths are measured with `metric` = 1 + flat z zᵀ, in which flattened balls are spheres.
    """

    a: Array
    s: Array
    r: float
    k: float
    z: Array
    flat: float
    metric: Array


class ShadedPicture:
    """A picture on which lines on the ground are drawn, and then bodies with their shadows.

    Parameters
    ----------
    size : width and height, pixels.
    target : the position (x, y, z) at which the camera looks, metres.
    distance : the distance of the camera from the target, metres.
    yaw, pitch : the rotation of the camera about the vertical axis, and downwards, radians.
    """

    def __init__(
        self,
        size: tuple[int, int],
        target: Array,
        distance: float,
        *,
        yaw: float = YAW,
        pitch: float = PITCH,
    ) -> None:
        cos_yaw = np.cos(yaw)
        sin_yaw = np.sin(yaw)
        cos_pitch = np.cos(pitch)
        sin_pitch = np.sin(pitch)
        right = [cos_yaw, 0, -sin_yaw]
        up = [-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch]
        ahead = [-sin_yaw * cos_pitch, -sin_pitch, -cos_yaw * cos_pitch]
        self.axes = np.array([right, up, ahead])
        self.yaw = yaw
        self.eye = target - distance * self.axes[2]
        self.focus: float = FOCUS * min(size)  # pixels
        self.size = np.array(size)
        sun_right, sun_up, sun_back = SUN
        sun_x = sun_right * cos_yaw + sun_back * sin_yaw
        sun_z = sun_back * cos_yaw - sun_right * sin_yaw
        self.sun = np.array([sun_x, sun_up, sun_z])
        self.boxes: list[Array] = []  # which hide the bodies behind them, (low, high) corners, shape (2, 3)
        self.paper = _paper(size)
        self.pen = ImageDraw.Draw(self.paper)

    def pixels(self, points: ArrayLike) -> tuple[Array, Array]:
        """Project points (N, 3) to pixels (N, 2), with the scale, pixels per metre. NaN behind the camera."""
        right, up, ahead = self.axes @ (np.asarray(points, float) - self.eye).T
        scale = self.focus / np.where(ahead > NEAR, ahead, np.nan)
        return self.size / 2 + np.stack([right, -up], -1) * scale[:, None], scale

    def line(self, points: ArrayLike, colours: ArrayLike, width: float) -> None:
        """Draw a line through points (N, 3), `width` pixels wide, with one colour or N - 1 colours."""
        ends = (TWICE * self.pixels(points)[0]).tolist()
        inks = np.broadcast_to(_bytes(colours), (max(len(ends) - 1, 0), 3)).tolist()
        for start, end, ink in zip(ends[:-1], ends[1:], inks, strict=True):
            if not np.isnan(start[0] + end[0]):
                self.pen.line([*start, *end], tuple(ink), round(TWICE * width))

    def area(self, points: ArrayLike, colour: ArrayLike) -> None:
        """Fill a polygon with corners (N, 3), without those behind the camera."""
        pixels = TWICE * self.pixels(points)[0]
        corners = pixels[~np.isnan(pixels[:, 0])]
        if len(corners) > 2:
            self.pen.polygon(corners.ravel().tolist(), tuple(_bytes(colour).tolist()))

    def finished(self, pieces: Array, colours: Array) -> NDArray[np.uint8]:
        """Draw bodies and their shadows, and return the picture, shape (height, width, 3).

        Parameters
        ----------
        pieces : capsules as from `capsules_at`, shape (P, 12).
        colours : the colours of the capsules, shape (P, 3), from 0 to 1.
        """
        picture = np.asarray(self.paper.reduce(TWICE), np.float32) / 255
        width, height = self.size.tolist()
        shadows = np.zeros((height, width), np.float32)
        for piece in pieces:
            self._cast(shadows, piece)
        picture *= 1 - SHADOW * shadows[..., None]
        met = np.full((3, TWICE * height, TWICE * width), np.inf, np.float32)
        for number, piece in enumerate(pieces):
            self._meet(piece, number, met)
        for box in self.boxes:
            self._hide(box, met)
        rows, columns = np.nonzero(np.isfinite(met[0]))
        pixels = rows // TWICE * width + columns // TWICE
        counts = np.bincount(pixels, minlength=width * height)
        picture *= 1 - counts.reshape(height, width, 1) / TWICE**2
        light = self._lit(pieces, colours, (rows, columns), met[:, rows, columns])
        for channel, values in enumerate(light.T):
            sums = np.bincount(pixels, values / TWICE**2, width * height)
            picture[..., channel] += sums.reshape(height, width)
        return _bytes(picture)

    def _window(self, balls: Array, fine: int = 1) -> Window:
        """Return the rows and columns of pixels that contain balls (x, y, z, radius), metres."""
        centres, scale = self.pixels(balls[:, :RADIUS])
        reach = 1.1 * balls[:, RADIUS] * scale + 1
        low = (centres.T - reach).min(axis=1)
        high = (centres.T + reach).max(axis=1) + 1
        corners = (fine * np.array([low, high])).clip(0, fine * self.size)
        (first_column, first_row), (last_column, last_row) = np.nan_to_num(corners).astype(int).tolist()
        return slice(first_row, last_row), slice(first_column, last_column)

    def _rays(self, window: Window, fine: int = 1) -> tuple[Floats, Floats]:
        """Return the rays of pixels at a depth of one metre: right (1, W) and up (H, 1), metres."""
        rows, columns = window
        down = (np.arange(rows.start, rows.stop, dtype=np.float32) + 0.5) / fine
        right = (np.arange(columns.start, columns.stop, dtype=np.float32) + 0.5) / fine
        width, height = self.size.tolist()
        to_right = (right - width / 2) / self.focus
        to_top = (height / 2 - down) / self.focus
        return to_right[None], to_top[:, None]

    def _on_ground(self, window: Window) -> tuple[Array, Array]:
        """Return the intersections of the rays of pixels with the ground, x and z, (H, W) each, metres."""
        right, up = self._rays(window)
        axis_x, axis_y, axis_z = self.axes.T  # axes of the world in camera coordinates
        x = axis_x[0] * right + axis_x[1] * up + axis_x[2]
        y = axis_y[0] * right + axis_y[1] * up + axis_y[2]
        z = axis_z[0] * right + axis_z[1] * up + axis_z[2]
        distance = -self.eye[1] / np.minimum(y, -1e-3)
        return self.eye[0] + distance * x, self.eye[2] + distance * z

    def _cast(self, shadows: Floats, piece: Array) -> None:
        """Add the shadow of a capsule, a stadium on the ground that is softer and paler for high capsules."""
        start_radius = piece[START_RADIUS]
        end_radius = piece[END_RADIUS]
        ends = np.stack([piece[START], piece[END]])
        softness = 0.02 + 0.12 * ends[:, 1].clip(0)  # metres, at either end
        ends = ends - self.sun / self.sun[1] * ends[:, 1:2]  # projected to the ground along the light
        reaches = np.array([start_radius, end_radius]) + softness
        window = self._window(np.column_stack([ends, reaches]))
        x, z = self._on_ground(window)
        start_x, _, start_z = ends[0]
        axis_x, _, axis_z = ends[1] - ends[0]
        x = x - start_x
        z = z - start_z
        u = (x * axis_x + z * axis_z) / max(axis_x * axis_x + axis_z * axis_z, 1e-9)
        u = u.clip(0, 1)  # parameter of the nearest point on the axis
        radius = start_radius + u * (end_radius - start_radius)
        soft = softness[0] + u * (softness[1] - softness[0])
        distance = np.hypot(x - u * axis_x, z - u * axis_z)
        edge = ((distance - radius + 0.8 * soft) / (1.8 * soft)).clip(0, 1)
        smooth_edge = edge * edge * (3 - 2 * edge)
        shade = (1 - smooth_edge) * 0.05 / (0.05 + 1.2 * soft * soft)
        np.maximum(shadows[window], shade, out=shadows[window])

    def _cone(self, piece: Array) -> _Cone:
        """Convert a capsule to camera coordinates, or only the larger ball if it contains the other."""
        a = self.axes @ (piece[START] - self.eye)
        b = self.axes @ (piece[END] - self.eye)
        z = self.axes @ piece[AHEAD]
        flat = piece[FLATNESS] ** -2 - 1
        metric = np.eye(3) + flat * np.outer(z, z)
        r = float(piece[START_RADIUS])
        end_radius = float(piece[END_RADIUS])
        k = end_radius - r
        s = b - a
        if s @ metric @ s <= k * k:
            centre = b if k > 0 else a
            return _Cone(centre, 0 * s, max(r, end_radius), 0.0, z, flat, metric)
        return _Cone(a, s, r, k, z, flat, metric)

    def _meet(self, piece: Array, number: int, met: Floats) -> None:
        """Intersect rays with a capsule, and update the distance, the capsule and the u of first hits.

        The ball around a + u s has the radius r + u k. A point at a + e is deepest inside the ball with
        u = (e · s + r k) / (s · s - k²). A ray t d enters the cone of all balls, with unbounded u, at a root
        of a quadratic in t. There u, clipped to the ends, selects the ball, which the ray enters at a root of
        another quadratic.
        """
        a, s, r, k, z, flat, metric = self._cone(piece)
        window = self._window(piece[ENDS].reshape(BALL), TWICE)
        x, y = self._rays(window, TWICE)  # d = (x, y, 1)
        metric_s = metric @ s
        metric_a = metric @ a
        d_s = x * metric_s[0] + (y * metric_s[1] + metric_s[2])
        d_a = x * metric_a[0] + (y * metric_a[1] + metric_a[2])
        d_z = x * z[0] + (y * z[1] + z[2])
        d_d = x * x + (y * y + 1) + flat * d_z**2
        q = max(float(s @ metric @ s) - k * k, 1e-9)
        h = float(a @ metric @ s) - k * r
        c = float(a @ metric @ a) - r * r
        half = d_a - d_s * (h / q)
        constant = c - h * h / q
        discriminant = half * half - (d_d - d_s * d_s / q) * constant
        t = constant / (half + np.sqrt(discriminant.clip(0)))
        u = ((t * d_s - h) / q).clip(0, 1)
        half = d_a + d_s * u
        discriminant = half * half - d_d * (c + u * (2 * h + u * q))
        t = (half - np.sqrt(discriminant.clip(0))) / d_d
        is_first = (discriminant > 0) & (t > NEAR) & (t < met[0][window])
        for values, new in zip(met, (t, number, u), strict=True):
            np.copyto(values[window], new, where=is_first, casting="unsafe")

    def _hide(self, box: Array, met: Floats) -> None:
        """Drop the intersections of rays with bodies that are behind a box.

        A ray p = t d is between two parallel faces from t₁ to t₂, and in the box between all three pairs.
        """
        width, height = self.size.tolist()
        right, up = self._rays((slice(0, TWICE * height), slice(0, TWICE * width)), TWICE)
        starts = np.full(met.shape[1:], NEAR, np.float32)
        ends = np.full(met.shape[1:], np.inf, np.float32)
        for low, high, axis in zip(*(box - self.eye), self.axes.T, strict=True):
            to_right, to_top, ahead = axis
            along = right * to_right + (up * to_top + ahead)
            along = np.where(abs(along) < GRAZING, GRAZING, along)
            starts = np.maximum(starts, np.minimum(low / along, high / along))
            ends = np.minimum(ends, np.maximum(low / along, high / along))
        met[:, (starts < ends) & (starts < met[0])] = np.inf

    def _lit(self, pieces: Array, colours: Array, pixels: tuple[Indices, ...], met: Floats) -> Floats:
        """Shade the intersections of rays with bodies, (N, 3), as the shader of limbs in `bodies.js` does."""
        rows, columns = pixels
        distances, numbers, u = met[..., None]
        order = numbers[:, 0].astype(int)
        width, height = self.size.tolist()
        whole = (slice(0, TWICE * height), slice(0, TWICE * width))
        right, up = self._rays(whole, TWICE)
        depths = np.ones_like(met[0])
        rays = np.stack([right[0, columns], up[rows, 0], depths], axis=-1)
        view = rays @ self.axes.astype(np.float32)
        points = self.eye.astype(np.float32) + view * distances
        normals = _normals(pieces.astype(np.float32)[order], u, points)
        return self._shade(colours.astype(np.float32)[order], points, normals, _unit(view))

    def _shade(self, colours: Floats, points: Floats, normals: Floats, view: Floats) -> Floats:
        """Shade points (N, 3) of a surface with sky, ground and sun light, a bright rim and a highlight."""
        sky = np.array(to_rgb(SKY), np.float32)
        ground = np.array(to_rgb(GROUND), np.float32)
        sun = self.sun.astype(np.float32)
        facing = -(normals * view).sum(-1, keepdims=True)  # cosines of the angles to the camera
        sunward = (normals @ sun)[:, None]
        skyward = normals[:, 1:2] / 2 + 0.5
        sunlight = ((sunward + 0.4) / 1.4).clip(0, 1)
        light = 0.62 * ground * (1 - skyward) + 0.78 * sky * skyward + sunlight * sunlight * WARM
        rim = (1 - facing.clip(0)) ** 3 * 0.28 * (0.4 + 0.6 * skyward)
        reflection = 2 * sunward * facing + (view @ sun)[:, None]
        highlight = reflection.clip(0) ** 24 * 0.14
        nearness = 0.75 + 0.25 * (points[:, 1:2] / 0.6).clip(0, 1)  # darker near the ground
        lit: Floats = colours * light * nearness + rim * sky + highlight
        return lit


def _paper(size: tuple[int, int]) -> Image.Image:
    """Create the background, a gradient from the sky in the upper quarter to the ground."""
    weights = np.linspace(-1 / 3, 1, TWICE * size[1]).clip(0)[:, None]
    rows = (1 - weights) * to_rgb(SKY) + weights * to_rgb(GROUND)
    pixels = np.repeat(_bytes(rows)[:, None], TWICE * size[0], axis=1)
    return Image.fromarray(pixels)


def _normals(capsules: Floats, u: Floats, points: Floats) -> Floats:
    """Return unit normals (N, 3) at points on capsules, on the ball with parameter u of each."""
    offsets = points - (1 - u) * capsules[:, START] - u * capsules[:, END]
    ahead = capsules[:, AHEAD]
    flattening = (capsules[:, FLATNESS] ** -2 - 1) * (offsets * ahead).sum(-1)
    return _unit(offsets + ahead * flattening[:, None])


def _unit(vectors: Floats) -> Floats:
    """Normalise vectors (N, 3)."""
    unit: Floats = vectors / np.sqrt((vectors * vectors).sum(-1, keepdims=True))
    return unit


def _bytes(colours: ArrayLike) -> NDArray[np.uint8]:
    """Convert colours from 0 to 1 to bytes."""
    return (255 * np.asarray(colours).clip(0, 1) + 0.5).astype(np.uint8)
