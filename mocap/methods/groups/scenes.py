"""Where a group should go, what stands in its way, and which clips keep clear of it.

Because every clip's extent is known, most tests for collisions are one comparison of discs; this is the known
bounds of [LCF05]. The rest is ours.
"""

from typing import Any, NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.errors import MocapError
from mocap.methods.groups.flocking import APART, Disc
from mocap.methods.groups.group_clips import GroupClip
from mocap.methods.groups.group_graphs import GroupGraph, Placed


class Scene(NamedTuple):
    """Where a group should go, and what stands in its way.

    `points` (complex, metres) to pass in order, the group's middle within `near` of each; `discs` to stay
    clear of, by `body` for each member; `others`, (F, N) places of members of other groups, ten per second
    from the same moment on, to stay 0.60 m away from. An other stays where its places end.

    Examples
    --------
    >>> Scene((8 + 0j,), ((4 + 0j, 0.5),)).near
    1.0
    """

    points: tuple[complex, ...]
    discs: tuple[Disc, ...] = ()
    near: float = 1.0
    body: float = 0.3
    others: tuple[Points, ...] = ()

    def check(self, start: complex) -> None:
        """Raise MocapError for what makes no sense, and for a start nowhere or inside a disc."""
        if not self.points or np.ndim(self.points) != 1 or not np.isfinite([start, *self.points]).all():
            raise MocapError(
                f"A scene has finite points z + ix to pass, one or more, from a start; got {self.points}"[
                    :190
                ]
                + f" from {start}."
            )
        for centre, radius in self.discs:
            if not (np.isfinite(centre) and 0 < radius < np.inf):
                raise MocapError(f"An obstacle has a centre and a radius above 0, got {centre}, {radius}.")
            if abs(start - centre) < radius:
                raise MocapError(
                    f"The group starts inside the obstacle at x={centre.imag:g}, z={centre.real:g}."
                )


class Exits(NamedTuple):
    """The C clips that leave a node, side by side, which all last as long.

    `places` (C, F, N), complex, and their `middles` (C, F); `centres`, `radii` and `turns` (C,).
    """

    numbers: list[int]
    clips: list[GroupClip]
    places: Points
    middles: Points
    centres: Points
    radii: Array
    turns: Points

    @classmethod
    def of(cls, graph: GroupGraph, node: int) -> "Exits":
        """Take the clips that leave a node, which all last as long."""
        numbers = graph.leaving(node)
        clips = [graph.clips[number] for number in numbers]
        bounds: Any = zip(*((*clip.disc, clip.turn) for clip in clips), strict=True)
        places = np.array([clip.places for clip in clips])
        return cls(numbers, clips, places, places.mean(axis=2), *map(np.array, bounds))


class Obstacles:
    """What a clip may run into, and how often bounds alone were enough.

    Parameters
    ----------
    scene : whose discs and other groups.
    """

    def __init__(self, scene: Scene) -> None:
        self.spots = np.array([spot for spot, _ in scene.discs], dtype=np.complex128)
        self.sizes = np.array([radius + scene.body for _, radius in scene.discs])
        self.others = scene.others
        self.tested = self.spared = 0

    def free(self, exits: Exits, at: Placed, frame: int) -> Indices:
        """List which of the clips that leave a node keep clear of all, laid at a place, from a frame on."""
        spots = at.sees(self.spots)
        near = np.abs(exits.centres[:, None] - spots) <= exits.radii[:, None] + self.sizes
        self.spared += near.size - int(near.sum())
        free = np.ones(len(exits.clips), bool)
        for disc in np.flatnonzero(near.any(axis=0)):
            rows = np.flatnonzero(near[:, disc] & free)  # a clip that hits one disc is not tested again
            self.tested += len(rows)
            free[rows] = np.abs(exits.places[rows] - spots[disc]).min(axis=(1, 2)) >= self.sizes[disc]
        frames = frame + np.arange(exits.places.shape[1])
        for other in self.others:
            members = at.sees(other[np.minimum(frames, len(other) - 1)])
            for row in np.flatnonzero(free):
                if np.abs(members - exits.centres[row]).min() > exits.radii[row] + APART:
                    self.spared += 1
                    continue
                self.tested += 1
                free[row] = np.abs(exits.places[row][:, :, None] - members[:, None]).min() >= APART
        return np.flatnonzero(free)
