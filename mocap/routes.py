"""What is wished for along a path, and what it costs to go without."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Points = NDArray[np.complex128]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Prices:
    """What counts beside the squared distance from the path, in m² as if in one frame.

    Parameters
    ----------
    seam : a transition.
    match : times the transition's squared distance D: as if the body were off by it for so many frames.
    stray : times the fourth power of the distance in each frame, 1/m²: 100 doubles what 10 cm cost.
    label : a frame without the label asked for.
    late : times the square of the seconds late or early, in each frame.
    crowding : times the square of the metres too near to another, in each frame.
    """

    seam: float = 0.3
    match: float = 30.0
    stray: float = 100.0
    label: float = 0.1
    late: float = 0.2
    crowding: float = 1.0


@dataclass(frozen=True, eq=False)
class Route:
    """What is wished for along a path, at n points evenly spaced.

    Parameters
    ----------
    points : shape (n,), where to be, as complex z + ix.
    spacing : metres of path from point to point.
    label : shape (n,), the number of the label to bear there, -1 for any.
    clock : shape (n,), when to be there, in seconds; nan for any time.
    least : progress in metres a second that even standing counts as; [KGP02, 5.1] calls it γ.
    others : shape (K, T), where K others are in each frame, to be kept away from by `apart` metres.
    """

    points: Points
    spacing: float
    label: Indices
    clock: Array
    least: float = 0.1
    others: Points = field(default_factory=lambda: np.empty((0, 1), complex))
    apart: float = 0.8

    @property
    def length(self) -> float:
        """Metres from the first point to the last."""
        return (len(self.points) - 1) * self.spacing

    def at(self, along: Array) -> Points:
        """Give the points so many metres along; past the end the last one [KGP02, 5.1]."""
        place = np.clip(along / self.spacing, 0, len(self.points) - 1)
        before = np.minimum(place.astype(np.intp), len(self.points) - 2)
        start = self.points[before]
        return np.asarray(start + (place - before) * (self.points[before + 1] - start))

    def near(self, along: Array) -> Points:
        """Give the sample before, which is quicker."""
        return np.asarray(self.points[self.point(along)])

    def point(self, along: Array) -> Indices:
        """Find the number of the sample before; past the end the last."""
        place = np.maximum(along / self.spacing, 0)
        return np.minimum(place.astype(np.intp), len(self.points) - 1)

    @cached_property
    def ways(self) -> Points:
        """The directions in which the path goes on from its points, of length 1."""
        steps = np.diff(self.points)
        return np.asarray(steps[[*range(len(steps)), -1]] / np.abs(steps[[*range(len(steps)), -1]]))

    @cached_property
    def bare(self) -> bool:
        """Whether nothing but the path itself is wished for."""
        return not len(self.others) and bool((self.label < 0).all() and np.isnan(self.clock).all())
