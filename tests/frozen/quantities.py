"""The quantities that frozen results consist of: arrays whose axes and unit have names."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

DIRECTIONS = ("x", "y", "z")
GROUND = ("z", "x")  # of a complex number: its real part, then its imaginary part
QUATERNION = ("w", "x", "y", "z")
EDGE = ("clip of the start", "frame of the start", "clip of the end", "frame of the end", "key")


@dataclass(frozen=True)
class Axis:
    """An axis of an array: its name in the singular and, where its places have names, these."""

    name: str
    labels: tuple[str, ...] = ()

    def describe(self, place: int) -> str:
        """Name one place: "frame 12", "joint lfoot", or "x" for a direction."""
        if not self.labels:
            return f"{self.name} {place}"
        return f"{self.name} {self.labels[place]}".lstrip()


FRAME = Axis("frame")
DIRECTION = Axis("", DIRECTIONS)


@dataclass(frozen=True)
class Quantity:
    """An array with the name of each axis and a unit, "" for numbers without one."""

    values: np.ndarray
    axes: tuple[Axis, ...]
    unit: str = ""

    def __post_init__(self) -> None:
        assert self.values.ndim == len(self.axes), (self.values.shape, self.axes)
        for length, axis in zip(self.values.shape, self.axes, strict=True):
            assert not axis.labels or len(axis.labels) == length, (length, axis)

    @property
    def exact(self) -> bool:
        """Whether these are whole numbers or truth values, which are compared without any tolerance."""
        return self.values.dtype.kind in "bui"


def joint_axis(skeleton) -> Axis:
    return Axis("joint", tuple(skeleton.names))


def positions(values, skeleton) -> Quantity:
    """Name positions or displacements of joints, shape (F, J, 3), in metres."""
    return Quantity(np.asarray(values), (FRAME, joint_axis(skeleton), DIRECTION), "m")


def roots(values) -> Quantity:
    """Name positions of a root, shape (F, 3), in metres."""
    return Quantity(np.asarray(values), (FRAME, DIRECTION), "m")


def rotations(values, skeleton) -> Quantity:
    """Name quaternions of joints, shape (F, J, 4)."""
    return Quantity(np.asarray(values), (FRAME, joint_axis(skeleton), Axis("", QUATERNION)))


def contacts(by_joint) -> Quantity:
    """Name the contacts of joints, truth values of shape (F,) each."""
    values = np.stack(list(by_joint.values()), axis=1)
    return Quantity(values, (FRAME, Axis("joint", tuple(by_joint))))


def numbers(values, *axes: str | Axis, unit: str = "") -> Quantity:
    """Name the axes of any numbers; complex ones become pairs, positions on the ground."""
    values = np.asarray(values)
    named = [axis if isinstance(axis, Axis) else Axis(axis) for axis in axes]
    if np.iscomplexobj(values):
        values = np.stack([values.real, values.imag], axis=-1)
        named.append(Axis("", GROUND))
    return Quantity(values, tuple(named), unit)


def edges(walk: Sequence) -> Quantity:
    """Name the edges of a walk, in its order."""
    rows = np.array([(*start, *end, key) for start, end, key in walk], np.int64)
    return Quantity(rows, (Axis("edge"), Axis("", EDGE)))


CASES: dict[str, Callable[..., dict[str, Quantity]]] = {}
CAPTURED = set()  # the names of cases that need captured clips: their folder is what they are called with


def case(name: str, captured: bool = False) -> Callable:
    """Register a function that computes a case, a dictionary of quantities by their names."""

    def register(compute: Callable) -> Callable:
        CASES[name] = compute
        if captured:
            CAPTURED.add(name)
        return compute

    return register
