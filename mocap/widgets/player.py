"""A player of motions for notebooks and pages, which needs only a browser.

Scripts draw the scene, and this module packs its data for all scripts of the package. Coordinates are
quantised to 16 bits between the minimum and the maximum of a clip, so that 20 metres are divided into steps
of 0.3 mm, at no more than 60 frames per second. Each channel is stored as second differences over time, which
are small and compress well. `numbersOf` in `player_scene.js` integrates them.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices, runs
from mocap._shared.quantities import described
from mocap._shared.records import dataclass
from mocap.body import Motion, Skeleton, joint_positions
from mocap.body.body_sides import head_joints
from mocap.body.motion import require_motion
from mocap.errors import MocapError
from mocap.feet.footplants import find_footprints, mark_plants
from mocap.plotting.bodies import bones
from mocap.plotting.style import ASTRAY, COLOURS, MARK, PATH, distinct_names, own_colour, source_colours
from mocap.synthesis.walk_to_motion import Seam
from mocap.widgets.embedding import SHADED, SHARED, Embedded
from mocap.widgets.still_picture import still_picture
from mocap.widgets.walk_figure import posed

SIDES = ("middle", "left", "right")  # in scripts a side is its index here
LOOK = {"sides": [COLOURS[side] for side in SIDES], "marks": {"seam": MARK, "astray": ASTRAY}}
SCREEN = 60.0  # frames per second of a screen. Frames of a faster clip are left out
LARGEST_UINT16 = 65535
SMALLEST_RANGE = 1e-6  # metres, the smallest range of coordinates, so that no step is 0


def packed_body(skeleton: Skeleton) -> tuple[Indices, dict[str, Any]]:
    """Choose the joints of a body that are drawn, and pack its bones and capsules.

    Returns
    -------
    joints : the root and the joints at which bones end, in order.
    body : a description in which joints are numbered in this order: `bones` in rows (from, to, number of the
        side), the `head` or None, and the `parts` and `pieces` of `posed`.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> joints, body = packed_body(SKELETON)
    >>> len(joints), body["joints"], body["bones"][0]
    (38, 38, [1, 2, 1])
    """
    starts, ends, sides = bones(skeleton)
    joints = np.unique([0, *starts, *ends])
    pairs = np.searchsorted(joints, [starts, ends]).T.tolist()
    drawn_heads = [joint for joint in head_joints(skeleton) if joint in joints]
    heads = np.searchsorted(joints, drawn_heads).tolist()
    lines = [[*pair, SIDES.index(side)] for pair, side in zip(pairs, sides, strict=True)]
    body = {"joints": len(joints), "bones": lines, "head": heads[-1] if heads else None}
    return joints, body | posed(skeleton, joints)


def packed(values: Array, low: Array | float, step: Array | float, kind: str) -> bytes:
    """Quantise channels over time, and pack their second differences.

    Parameters
    ----------
    values : shape (F, ...), a channel for each index of the other axes.
    low, step : the origin and the unit of the numbers, one for all or one for each index of the last axis.
    kind : "<u2" for numbers up to 65535, whose differences wrap around, or "<i4".

    Examples
    --------
    >>> np.frombuffer(packed(np.array([[0.0], [0.1], [0.3]]), 0.0, 0.1, "<i4"), "<i4").tolist()
    [0, 1, 1]
    """
    numbers = np.round((values - low) / step).astype(kind)
    changes = np.diff(numbers, 2, axis=0, prepend=np.zeros_like(numbers, shape=(2, *numbers.shape[1:])))
    return np.moveaxis(changes, 0, -1).tobytes()


def packed_character(
    motion: Motion, colour: str, step: float | None = None, positions: Array | None = None
) -> tuple[dict[str, Any], bytes]:
    """Pack the positions of a motion's drawn joints, for `Character` in `player_scene.js`.

    Parameters
    ----------
    motion : the motion, of which at most 60 frames per second are packed.
    colour : the colour of the body and its path.
    step : the unit of coordinates, metres, by default the smallest that 16 bits allow.
    positions : the positions of all joints, shape (F, J, 3), metres, by default those of `joint_positions`.

    Returns
    -------
    A description of the numbers, and the packed numbers.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> character, data = packed_character(sample("walk_straight"), "#000000")
    >>> character["fps"], character["frames"], len(data) == 2 * 3 * character["joints"] * character["frames"]
    (60.0, 579, True)
    """
    joints, body = packed_body(motion.skeleton)
    stride = max(1, int(motion.fps / SCREEN))
    if positions is None:
        positions = joint_positions(motion)
    points = positions[::stride, joints]  # (F, J, 3)
    low = points.min(axis=(0, 1))
    high = points.max(axis=(0, 1))
    steps = np.full(3, step) if step else np.maximum(high - low, SMALLEST_RANGE) / LARGEST_UINT16
    character = {"name": motion.name, "fps": motion.fps / stride, "frames": len(points), **body}
    character |= {"low": low.tolist(), "step": steps.tolist()}
    character |= {"colour": colour, "path_colour": colour}
    character |= {"sources": [], "seams": [], "astray": [], "prints": []}
    return character, packed(points, low, steps, "<u2")


def with_contacts(motion: Motion) -> Motion:
    """Mark the footplants of a motion without contacts, unless its body has no legs."""
    if motion.contacts:
        return motion
    try:
        return mark_plants(motion)
    except MocapError:
        return motion


def _packed_footprints(motion: Motion) -> list[list[float]]:
    """List the footprints of a motion in rows (start, end, x, z, number of the side), seconds and metres."""
    rows = []
    for footprint in find_footprints(with_contacts(motion)):
        start = footprint.start / motion.fps
        end = footprint.end / motion.fps
        side = SIDES.index(footprint.side)
        rows.append([start, end, round(footprint.x, 3), round(footprint.z, 3), side])
    return rows


Sources = Sequence[tuple[int, str]]
BOX = 6  # numbers of a box: x, y and z of two corners
FAR = 0.15  # metres, the distance from the requested path beyond which the path of a walk is red


def play(  # noqa: PLR0913 (what moves, what to mark on its path, and how to look at it)
    *motions: Motion,
    sources: Sources = (),
    seams: Iterable[Seam | int] = (),
    path: ArrayLike = (),
    off: ArrayLike = (),  # reads: name: a public parameter
    discs: ArrayLike = (),
    boxes: ArrayLike = (),
    positions: Sequence[Array] = (),
    follow: bool = True,
    alt: str = "",
    names: Sequence[str] = (),
    yaw: float | None = None,
) -> Player:
    """Play motions in a notebook. The reader can rotate the view, step, and change the speed.

    Parameters
    ----------
    motions : one or more characters. Frames are those of the first.
    sources : the sources of the first motion, as pairs (first frame, name of the clip), as from
        `synthesis.sources`. Each clip has its own colour.
    seams : the transitions of the first motion, as from `synthesis.seams`, or their frames, which are marked.
    path : the requested path, shape (N, 2), points (x, z) in metres.
    off : distance from that path in each frame of the first motion, shape (F,), metres, as in
        `steering.Followed.off`. Beyond 15 cm, the path of the motion is red.
    discs : obstacles on the ground, shape (N, 3), x, z and radius in metres.
    boxes : things such as a stone or a table, shape (N, 6), x, y and z of the lowest corner, and of the
        highest one, in metres. Bodies that are placed side by side have a copy each.
    positions : the joint positions of each motion, shape (F, J, 3), metres, by default those of
        `body.joint_positions`.
    follow : whether the camera follows the first character.
    alt : a sentence for readers who do not see the player. By default it contains names and durations.
    names : the name of each motion in the legend, by default that of its clip. Equal names are numbered.
    yaw : the direction from which the camera looks first, radians about +y, by default 0.7.

    Returns
    -------
    The player. A notebook shows it as the last line of a cell, and `Player.page` returns a page to share.

    Raises
    ------
    MocapError : without a motion, and for objects that are not motions, such as a list of motions. Also if
        there is not one name for each motion, and for a box whose highest corner is below its lowest one.

    Examples
    --------
    >>> from mocap import datasets
    >>> play(datasets.sample("walk_straight"))
    Player('A figure plays walk_straight, ...')

    Notebook: 01b-motion-files
    """
    if not motions:
        raise MocapError("There is no motion to play.")
    for motion in motions:
        if isinstance(motion, list | tuple):
            raise MocapError(f"Motions are played one by one, got {described(motion)}: write play(*clips).")
        require_motion(motion)
    if names:
        motions = _renamed(motions, names)
    seam_frames = tuple(seam if isinstance(seam, int) else seam.frame for seam in seams)
    points = np.reshape(np.asarray(path, float), (-1, 2))
    astray = runs(np.asarray(off, float) > FAR)
    obstacles = np.reshape(np.asarray(discs, float), (-1, 3))
    props = _checked_boxes(boxes)
    shown = tuple(positions) or tuple(joint_positions(motion) for motion in motions)
    look: dict[str, Any] = {"follow": follow, "description": alt, "yaw": yaw}
    return Player(motions, tuple(sources), seam_frames, points, astray, obstacles, props, shown, **look)


def _checked_boxes(boxes: ArrayLike) -> Array:
    """Return boxes as rows of six numbers, and raise for corners in the wrong order."""
    rows = np.asarray(boxes, float)
    if rows.size and rows.shape[-1] != BOX:
        raise MocapError(f"A box has six numbers, x, y, z of two corners, got shape {rows.shape}.")
    rows = rows.reshape(-1, BOX)
    for low, high in rows.reshape(-1, 2, 3):
        if not (low <= high).all():
            raise MocapError(
                f"A box begins at its lowest corner, got {low.tolist()} and then {high.tolist()}."
            )
    return rows


def _renamed(motions: Sequence[Motion], names: Sequence[str]) -> tuple[Motion, ...]:
    """Return the motions with other names."""
    if isinstance(names, str) or len(names) != len(motions):
        raise MocapError(
            f"names= is a list of {len(motions)} names, one for each motion, got {described(names)}."
        )
    return tuple(replace(motion, name=name) for motion, name in zip(motions, names, strict=True))


@dataclass(frozen=True, eq=False, repr=False)
class Player(Embedded):
    """A player, as returned by `play`, which a notebook shows live, as a picture, or as a sentence.

    Examples
    --------
    >>> from mocap import datasets
    >>> player = play(datasets.sample("walk_straight"))
    >>> player.scene["fps"], player.scene["frames"]
    (120.0, 1158)
    >>> player.page()[:15]
    '<!doctype html>'
    """

    motions: Sequence[Motion]
    sources: Sources
    seams: tuple[int, ...]
    path: Array
    astray: Indices  # stretches of frames [start, end)
    discs: Array
    boxes: Array
    positions: Sequence[Array]
    follow: bool
    description: str
    yaw: float | None = None
    scripts = (*SHADED, *SHARED, Path(__file__).with_name("player.js"))
    __repr__ = Embedded.__repr__  # a record would print its fields

    @property
    def alt(self) -> str:
        """The alternative text, by default with the names and the duration of the motions."""
        count = len(self.motions)
        subject = "A figure plays" if count == 1 else f"{count} figures play"
        seconds = max(motion.duration for motion in self.motions)
        return self.description or f"{subject} {self.heading}, {seconds:.1f} s."

    @property
    def heading(self) -> str:
        """The distinct names of the motions."""
        return ", ".join(dict.fromkeys(motion.name for motion in self.motions))

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The scene that scripts draw, with the numbers of each character in `data`, at its `offset`."""
        characters: list[dict[str, Any]] = []
        data = b""
        sources = len({name for _, name in self.sources})
        names = distinct_names([motion.name for motion in self.motions])
        for number, (motion, positions) in enumerate(zip(self.motions, self.positions, strict=True)):
            colour = own_colour(number, len(self.motions), sources) or COLOURS["middle"]
            character, block = packed_character(motion, colour, positions=positions)
            character |= {"name": names[number], "offset": len(data), "prints": _packed_footprints(motion)}
            characters.append(character)
            data += block
        self._mark_first(characters[0])
        fps = self.motions[0].fps
        scene = {"alt": self.alt, "number": 0, "reports": False, "follow": self.follow, **LOOK}
        scene |= {"fps": fps, "frames": max(1 + round(motion.duration * fps) for motion in self.motions)}
        scene |= {} if self.yaw is None else {"yaw": self.yaw}
        scene |= {"asked": self.path.round(3).tolist(), "obstacles": self.discs.round(3).tolist()}
        scene["boxes"] = self.boxes.round(3).tolist()
        return scene | {"characters": characters, "data": zlib.compress(data)}

    def _mark_first(self, character: dict[str, Any]) -> None:
        """Add the colours of the path, its sources, seams and red stretches to the first character."""
        fps = self.motions[0].fps
        character["path_colour"] = PATH if len(self.motions) == 1 else character["colour"]
        colours = source_colours([name for _, name in self.sources])
        for frame, name in self.sources:
            character["sources"].append({"start": frame / fps, "name": name, "colour": colours[name]})
        character["seams"] = [seam / fps for seam in self.seams]
        character["astray"] = (self.astray / fps).tolist()

    @cached_property
    def picture(self) -> bytes:
        """The picture without scripts, a PNG of shaded bodies that are apart from each other."""
        return still_picture(self.scene)
