"""A player for notebooks and pages: bodies that move; it needs nothing but a browser.

Scripts draw; this module packs what they draw. Coordinates are sent as 16-bit numbers between
the lowest and the highest of a clip, so 20 metres are cut into steps of 0.3 mm, and at no more than 60 frames
per second. What is sent are their second differences over time: these are small, and compress well.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices, runs
from mocap.body import Motion, joint_positions
from mocap.errors import MocapError
from mocap.feet.footplants import find_footprints
from mocap.plotting.bodies import film_strip
from mocap.plotting.bodies_on_path import bodies_along
from mocap.plotting.picture import legible, small_png
from mocap.plotting.style import COLOURS, PATH, own_colour, source_colours
from mocap.synthesis.walk_to_motion import Seam
from mocap.widgets.embedding import SHADED, SHARED, Embedded
from mocap.widgets.packing import LOOK, SIDES, packed_character, with_contacts

Sources = Sequence[tuple[int, str]]

ASTRAY = 0.15  # metres off the path that was asked for, from where on a walk's path is red
WALKS = 1.0  # metres of ground that a motion covers at least, to be drawn along its path


def play(  # noqa: PLR0913 (what moves, what to mark on its path, and how to look at it)
    *motions: Motion,
    sources: Sources = (),
    seams: Iterable[Seam | int] = (),
    path: ArrayLike = (),
    off: ArrayLike = (),
    discs: ArrayLike = (),
    places: Sequence[Array] = (),
    follow: bool = True,
    alt: str = "",
) -> Player:
    """Play motions in the notebook; the reader can turn the view, step, and change the speed.

    Parameters
    ----------
    motions : one or more characters; frames are counted by the first.
    sources : where the first motion comes from, as pairs (frame, name of the clip from there on), as from
        `synthesis.sources`; each clip has its colour.
    seams : where the first motion takes a transition, as from `synthesis.seams`, or frames; they are marked.
    path : a path that was asked for, shape (N, 2), points (x, z) in metres.
    off : metres from there in each frame of the first motion, shape (F,), as in `Followed.off`; where it is
        more than 15 cm off, its path is red.
    discs : obstacles on the ground, shape (N, 3), x, z and radius in metres.
    places : of the joints of each motion, shape (F, J, 3), by a function of one's own; by default the
        package's.
    follow : whether the camera follows the first character.
    alt : a sentence for readers who do not see it; by default it gives names and seconds.

    Returns
    -------
    The player; a notebook shows it as the last line of a cell, and its `page()` is a file to share.

    Raises
    ------
    MocapError : without a motion.

    Examples
    --------
    >>> from mocap import datasets
    >>> play(datasets.sample("walk_straight"))
    Player('A figure plays walk_straight, ...')

    Notebook: 01b-motion-files
    """
    if not motions:
        raise MocapError("There is no motion to play.")
    return Player(
        motions,
        tuple(sources),
        tuple(seam if isinstance(seam, int) else seam.frame for seam in seams),
        np.reshape(np.asarray(path, float), (-1, 2)),
        runs(np.asarray(off, float) > ASTRAY),
        np.reshape(np.asarray(discs, float), (-1, 3)),
        tuple(places) or tuple(joint_positions(motion) for motion in motions),
        follow,
        alt,
    )


@dataclass(frozen=True, eq=False, repr=False)
class Player(Embedded):
    """What `play` returns; a notebook shows it live, as a picture or a sentence.

    Examples
    --------
    >>> from mocap import datasets
    >>> player = play(datasets.sample("walk_straight"))
    >>> player.scene["fps"], player.scene["frames"]
    (120.0, 1201)
    >>> player.page()[:15]
    '<!doctype html>'
    """

    motions: Sequence[Motion]
    sources: Sources
    seams: tuple[int, ...]
    path: Array
    astray: Indices  # stretches of frames [start, end)
    discs: Array
    places: Sequence[Array]
    follow: bool
    said: str
    scripts = (*SHADED, *SHARED, Path(__file__).with_name("player.js"))

    @property
    def alt(self) -> str:
        """What was said with the motions, else their names and seconds."""
        count = len(self.motions)
        who = "A figure plays" if count == 1 else f"{count} figures play"
        seconds = max(motion.duration for motion in self.motions)
        return self.said or f"{who} {self.heading}, {seconds:.1f} s."

    @property
    def heading(self) -> str:
        """The different names of the motions."""
        return ", ".join(dict.fromkeys(motion.name for motion in self.motions))

    @cached_property
    def scene(self) -> dict[str, Any]:
        """What the scripts draw; `data` holds all characters' numbers, compressed, each from its `offset`."""
        characters: list[dict[str, Any]] = []
        data, count = b"", len(self.motions)
        for number, (motion, places) in enumerate(zip(self.motions, self.places, strict=True)):
            colour = own_colour(number, count) or COLOURS["middle"]
            about, block = packed_character(motion, colour, places=places)
            prints = [  # from, until (seconds), x, z (metres), number of the side
                [p.start / motion.fps, p.end / motion.fps, round(p.x, 3), round(p.z, 3), SIDES.index(p.side)]
                for p in find_footprints(with_contacts(motion))
            ]
            characters.append(about | {"offset": len(data), "prints": prints})
            data += block
        first, fps = characters[0], self.motions[0].fps
        first["path_colour"] = PATH if count == 1 else first["colour"]
        colours = source_colours([name for _, name in self.sources])
        first["sources"] = [{"start": f / fps, "name": n, "colour": colours[n]} for f, n in self.sources]
        first["seams"] = [seam / fps for seam in self.seams]
        first["astray"] = (self.astray / fps).tolist()
        return {
            **{"alt": self.alt, "number": 0, "reports": False, "follow": self.follow, **LOOK},
            "fps": fps,
            "frames": max(1 + round(motion.duration * fps) for motion in self.motions),
            "asked": self.path.round(3).tolist(),
            "obstacles": self.discs.round(3).tolist(),
            "characters": characters,
            "data": zlib.compress(data),
        }

    @cached_property
    def picture(self) -> bytes:
        """The whole motion as a PNG, for places where no script runs; who stays in place is shown in time."""
        ground = self.motions[0].root_positions[:, [0, 2]]
        if max(np.ptp(ground, axis=0)) < WALKS and not len(self.path):
            return small_png(film_strip(self.motions))
        marks: dict[str, Any] = {"sources": self.sources, "seams": self.seams, "path": self.path}
        return small_png(legible(bodies_along(*self.motions, discs=self.discs, places=self.places, **marks)))
