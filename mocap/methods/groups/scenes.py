"""Where a group should go, what stands in its way, and which clips keep clear of it.

Because every clip's extent is known, most tests for collisions are one comparison of discs; this is the known
bounds of [LCF05]. The rest is ours.
"""

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Indices, Points
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
        if not np.isfinite(start):
            raise MocapError(f"A group starts at a finite place, got {start}.")
        if not self.points or not np.isfinite(self.points).all():
            raise MocapError(
                f"A scene has one point z + ix to pass or more, all finite; got {self.points}."[:200]
            )
        if np.ndim(self.points) != 1:
            raise MocapError(f"A point of a scene is one complex number z + ix, got {self.points[0]}."[:200])
        if not (0 < self.near < np.inf and 0 <= self.body < np.inf):
            raise MocapError(
                "A scene is passed within more than 0 m and kept clear of by 0 m or more; "
                f"got {self.near} m and {self.body} m."
            )
        if any(other.ndim != 2 or not other.size or not np.isfinite(other).all() for other in self.others):
            raise MocapError("Other groups are finite places in a table of frames by members, one or more.")
        for centre, radius in self.discs:
            if not (np.isfinite(centre) and np.isfinite(radius) and radius > 0):
                raise MocapError(f"An obstacle has a centre and a radius above 0, got {centre}, {radius}.")
            if abs(start - centre) < radius:
                raise MocapError(
                    f"The group starts inside the obstacle at x={centre.imag:g}, z={centre.real:g}."
                )


class Exits:
    """The C clips that leave a node, side by side; shorter ones stay where they end.

    Parameters
    ----------
    graph : whose clips.
    node : that they leave.
    """

    def __init__(self, graph: GroupGraph, node: int) -> None:
        self.numbers = graph.leaving(node)
        self.clips = [graph.clips[number] for number in self.numbers]
        self.centres = np.array([clip.disc[0] for clip in self.clips])
        self.radii = np.array([clip.disc[1] for clip in self.clips])
        self.turns = np.array([clip.turn for clip in self.clips])
        frames = np.arange(max((len(clip.places) for clip in self.clips), default=0))
        rows = [clip.places[np.minimum(frames, len(clip.places) - 1)] for clip in self.clips]
        self.places = np.reshape(rows, (len(rows), len(frames), graph.members))  # (C, F, N)
        self.middles = self.places.mean(axis=2)


class Obstacles:
    """What a clip may run into, and how often bounds alone were enough.

    Parameters
    ----------
    scene : whose discs and other groups.
    bounds : compare bounds first; without them every frame is tested.
    """

    def __init__(self, scene: Scene, *, bounds: bool = True) -> None:
        self.spots = np.array([spot for spot, _ in scene.discs], dtype=np.complex128)
        self.sizes = np.array([radius + scene.body for _, radius in scene.discs])
        self.others, self.bounds = scene.others, bounds
        self.tested = self.spared = 0

    def free(self, exits: Exits, at: Placed, frame: int) -> Indices:
        """List which of the clips that leave a node keep clear of all, laid at a place, from a frame on."""
        spots = at.sees(self.spots)
        reach = exits.radii[:, None] + self.sizes
        near = np.abs(exits.centres[:, None] - spots) <= (reach if self.bounds else np.inf)
        self.spared += near.size - int(near.sum())
        free = np.ones(len(exits.clips), bool)
        for disc in np.flatnonzero(near.any(axis=0)):
            rows = np.flatnonzero(near[:, disc] & free)  # a clip that hits one disc is not tested again
            self.tested += len(rows)
            gaps = np.abs(exits.places[rows] - spots[disc])
            free[rows] = gaps.min(axis=(1, 2)) >= self.sizes[disc]
        kept = np.flatnonzero(free)
        for other in self.others:
            kept = kept[[self._apart(exits.clips[row], at, frame, other) for row in kept]]
        return kept

    def _apart(self, clip: GroupClip, at: Placed, frame: int, other: Points) -> bool:
        """Say whether a clip keeps away from the members of another group in the same frames."""
        frames = frame + np.arange(len(clip.places))
        others = at.sees(other[np.minimum(frames, len(other) - 1)])
        if self.bounds and np.abs(others - clip.disc[0]).min() > clip.disc[1] + APART:
            self.spared += 1
            return True
        self.tested += 1
        return bool(np.abs(clip.places[:, :, None] - others[:, None]).min() >= APART)
