"""A picture of shaded bodies on a ground, by NumPy alone: a film is written without a browser.

A body is round cones, as `bodies.js` draws them: balls whose centre goes from one end to the other while
their radius changes evenly, flattened from front to back. For each pixel it is solved in closed form which of
these balls its ray meets first. Camera, light and colours are the player's.
"""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from mocap._shared.arrays import Array, Indices

YAW, PITCH = 0.7, 0.25  # radians
NEAR = 0.1  # metres; what is nearer to the eye is not drawn
TWICE = 2  # drawn larger by this, then made smaller, so that edges are smooth
SKY, GROUND = "#FAF7F0", "#ECE6DA"
WARM = np.array([1.22, 1.1, 0.95], np.float32)  # the light of the sun
SUN = (-0.45, 0.78, 0.44)  # to the right, up and back, seen from the camera
SHADOW = 0.3  # how dark it is

Window = tuple[slice, slice]  # rows and columns of pixels
Floats = NDArray[np.float32]


def blend(colour: str, other: str, share: float) -> Array:
    """Mix two colours, as red, green and blue from 0 to 1.

    Examples
    --------
    >>> blend("#000000", "#FFFFFF", 0.25).tolist()
    [0.25, 0.25, 0.25]
    """
    return (1 - share) * np.array(to_rgb(colour)) + share * np.array(to_rgb(other))


class ShadedPicture:
    """A picture to which lines on the ground are drawn, and then bodies with their shadows.

    Parameters
    ----------
    size : width and height, pixels.
    target : the place (x, y, z) that the camera looks at, metres.
    distance : metres from the camera to there.
    """

    def __init__(self, size: tuple[int, int], target: Array, distance: float) -> None:
        (cy, sy), (cp, sp) = ((np.cos(a), np.sin(a)) for a in (YAW, PITCH))
        self.axes = np.array([[cy, 0, -sy], [-sy * sp, cp, -cy * sp], [-sy * cp, -sp, -cy * cp]])
        self.eye, self.focus, self.size = target - distance * self.axes[2], 1.5 * min(size), np.array(size)
        self.sun = np.array([SUN[0] * cy + SUN[2] * sy, SUN[1], SUN[2] * cy - SUN[0] * sy])
        share = np.linspace(-1 / 3, 1, TWICE * size[1]).clip(0)[:, None]
        rows = (1 - share) * to_rgb(SKY) + share * to_rgb(GROUND)
        self.paper = Image.fromarray(np.repeat(_bytes(rows)[:, None], TWICE * size[0], axis=1))
        self.pen = ImageDraw.Draw(self.paper)

    def pixels(self, points: ArrayLike) -> tuple[Array, Array]:
        """Give where points (N, 3) are in the picture, (N, 2), and a metre's pixels there; NaN behind."""
        right, up, far = self.axes @ (np.asarray(points, float) - self.eye).T
        scale = self.focus / np.where(far > NEAR, far, np.nan)
        return self.size / 2 + np.stack([right, -up], -1) * scale[:, None], scale

    def line(self, points: ArrayLike, colours: ArrayLike, width: float) -> None:
        """Draw a line through points (N, 3), so many pixels wide, of one colour or of N - 1."""
        ends = (TWICE * self.pixels(points)[0]).tolist()
        inks = np.broadcast_to(_bytes(colours), (max(len(ends) - 1, 0), 3)).tolist()
        for start, end, ink in zip(ends[:-1], ends[1:], inks, strict=True):
            if not np.isnan(start[0] + end[0]):
                self.pen.line([*start, *end], tuple(ink), round(TWICE * width))

    def area(self, points: ArrayLike, colour: ArrayLike) -> None:
        """Fill a polygon with corners (N, 3); those behind the camera are left out."""
        pixels = TWICE * self.pixels(points)[0]
        corners = pixels[~np.isnan(pixels[:, 0])]
        if len(corners) > 2:
            self.pen.polygon(corners.ravel().tolist(), tuple(_bytes(colour).tolist()))

    def finished(self, pieces: Array, colours: Array) -> NDArray[np.uint8]:
        """Return the picture with bodies and their shadows, shape (height, width, 3).

        Parameters
        ----------
        pieces : capsules as from `capsules_at`, shape (P, 12).
        colours : of each, shape (P, 3), from 0 to 1.
        """
        picture = np.asarray(self.paper.reduce(TWICE), np.float32) / 255
        wide, high = self.size.tolist()
        dark = np.zeros((high, wide), np.float32)
        for piece in pieces:
            self._cast(dark, piece)
        picture *= 1 - SHADOW * dark[..., None]
        met = np.full((3, TWICE * high, TWICE * wide), np.inf, np.float32)
        for number, piece in enumerate(pieces):
            self._meet(piece, number, met)
        rows, columns = at = np.nonzero(np.isfinite(met[0]))
        pixel = rows // TWICE * wide + columns // TWICE
        picture *= 1 - np.bincount(pixel, minlength=dark.size).reshape(high, wide, 1) / TWICE**2
        for channel, lit in enumerate(self._lit(pieces, colours, at, met[:, rows, columns]).T):
            picture[..., channel] += np.bincount(pixel, lit / TWICE**2, dark.size).reshape(high, wide)
        return _bytes(picture)

    def _window(self, balls: Array, fine: int = 1) -> Window:
        """Give the rows and columns that hold balls, each a row (x, y, z, radius), metres."""
        at, scale = self.pixels(balls[:, :3])
        reach = 1.1 * balls[:, 3] * scale + 1
        ends = fine * np.array([(at.T - reach).min(axis=1), (at.T + reach).max(axis=1) + 1])
        (left, top), (right, bottom) = np.nan_to_num(ends.clip(0, fine * self.size)).astype(int).tolist()
        return slice(top, bottom), slice(left, right)

    def _rays(self, window: Window, fine: int = 1) -> tuple[Floats, Floats]:
        """Give how far right, (1, W), and up, (H, 1), the ray of a pixel is one metre ahead."""
        down, right = ((np.arange(s.start, s.stop, dtype=np.float32) + 0.5) / fine for s in window)
        wide, high = self.size.tolist()
        return (right - wide / 2)[None] / self.focus, (high / 2 - down)[:, None] / self.focus

    def _cast(self, dark: Floats, piece: Array) -> None:
        """Let a capsule shade the ground: a stadium, the softer and the paler the higher the capsule is."""
        ends, radii = piece[:8].reshape(2, 4)[:, :3], piece[[3, 7]]
        soft = 0.02 + 0.12 * ends[:, 1].clip(0)
        ends = ends - self.sun / self.sun[1] * ends[:, 1:2]
        window = self._window(np.column_stack([ends, radii + soft]))
        right, up = self._rays(window)
        x, y, z = (r * right + u * up + a for r, u, a in self.axes.T)
        ahead = -self.eye[1] / np.minimum(y, -1e-3)
        (ax, _, az), (wx, _, wz) = ends[0], ends[1] - ends[0]
        x, z = self.eye[0] + ahead * x - ax, self.eye[2] + ahead * z - az
        u = ((x * wx + z * wz) / max(wx * wx + wz * wz, 1e-9)).clip(0, 1)
        r, s = (values[0] + u * (values[1] - values[0]) for values in (radii, soft))
        edge = ((np.hypot(x - u * wx, z - u * wz) - r + 0.8 * s) / (1.8 * s)).clip(0, 1)
        shade = (1 - edge * edge * (3 - 2 * edge)) * 0.05 / (0.05 + 1.2 * s * s)
        np.maximum(dark[window], shade, out=dark[window])

    def _meet(self, piece: Array, number: int, met: Floats) -> None:
        """Find where rays meet a capsule before what they have met: how far, which, and at which share u.

        The ball around a + u s has the radius r + u k. A point at a + e is farthest inside the ball of
        u = (e · s + r k) / (s · s - k²). The ray touches that ball where a quadratic is zero.
        """
        a, b = (self.axes @ (piece[at : at + 3] - self.eye) for at in (0, 4))
        z, flat = self.axes @ piece[8:11], piece[11] ** -2 - 1
        metric = np.eye(3) + flat * np.outer(z, z)  # which makes flattened balls round
        r, s, k = piece[3], b - a, piece[7] - piece[3]
        if s @ metric @ s <= k * k:  # one ball holds the other
            a, r, s, k = b if k > 0 else a, max(piece[3], piece[7]), 0 * s, 0.0
        window = self._window(piece[:8].reshape(2, 4), TWICE)
        x, y = self._rays(window, TWICE)
        along, towards = (x * v[0] + (y * v[1] + v[2]) for v in (metric @ s, metric @ a))
        ray = x * x + (y * y + 1) + flat * (x * z[0] + (y * z[1] + z[2])) ** 2
        q, h, rest = max(s @ metric @ s - k * k, 1e-9), a @ metric @ s - k * r, a @ metric @ a - r * r
        half, out = towards - along * (h / q), rest - h * h / q
        t = out / (half + np.sqrt((half * half - (ray - along * along / q) * out).clip(0)))
        u = ((t * along - h) / q).clip(0, 1)
        half = towards + along * u
        inside = half * half - ray * (rest + u * (2 * h + u * q))
        t = (half - np.sqrt(inside.clip(0))) / ray
        seen = (inside > 0) & (t > NEAR) & (t < met[0][window])
        for values, new in zip(met, (t, number, u), strict=True):
            np.copyto(values[window], new, where=seen, casting="unsafe")

    def _lit(self, pieces: Array, colours: Array, at: tuple[Indices, ...], met: Floats) -> Floats:
        """Light what the rays of pixels meet, (N, 3), as the shader of limbs in `bodies.js` does."""
        (far, number, u), (rows, columns) = met[..., None], at
        number = number[:, 0].astype(int)
        right, up = self._rays((slice(0, TWICE * self.size[1]), slice(0, TWICE * self.size[0])), TWICE)
        view = np.stack([right[0, columns], up[rows, 0], np.ones_like(met[0])], axis=-1)
        view = view @ self.axes.astype(np.float32)
        places = self.eye.astype(np.float32) + view * far
        capsules = pieces.astype(np.float32)[number]
        out, z = places - (1 - u) * capsules[:, :3] - u * capsules[:, 4:7], capsules[:, 8:11]
        normal = _unit(out + z * ((capsules[:, 11] ** -2 - 1) * (out * z).sum(-1))[:, None])
        view, sun = _unit(view), self.sun.astype(np.float32)
        facing, lit = -(normal * view).sum(-1, keepdims=True), (normal @ sun)[:, None]
        above, wrap = normal[:, 1:2] / 2 + 0.5, ((lit + 0.4) / 1.4).clip(0, 1)
        shine = (2 * lit * facing + (view @ sun)[:, None]).clip(0) ** 24 * 0.14
        low = 0.75 + 0.25 * (places[:, 1:2] / 0.6).clip(0, 1)
        sky, ground = (np.array(to_rgb(colour), np.float32) for colour in (SKY, GROUND))
        light = 0.62 * ground * (1 - above) + 0.78 * sky * above + wrap * wrap * WARM
        rim = (1 - facing.clip(0)) ** 3 * 0.28 * (0.4 + 0.6 * above)
        lit_up: Floats = colours.astype(np.float32)[number] * light * low + rim * sky + shine
        return lit_up


def _unit(vectors: Floats) -> Floats:
    unit: Floats = vectors / np.sqrt((vectors * vectors).sum(-1, keepdims=True))
    return unit


def _bytes(colours: ArrayLike) -> NDArray[np.uint8]:
    return (255 * np.asarray(colours).clip(0, 1) + 0.5).astype(np.uint8)
