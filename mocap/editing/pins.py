"""Where joints shall be: one value for plants, rails, floors and bars.

A pin is a box for a joint in a frame: `low` ≤ p ≤ `high` on each axis. The same number twice holds an axis,
-∞ and ∞ leave it free, and one of the two is a floor or a ceiling. For all of these one formula gives the gap
to close, clip(p, low, high) - p. [Gle98] and [LS99] list their constraints kind by kind; the box is ours.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Mask, frozen
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, legs_of
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.feet.ankle_targets import place_plants
from mocap.feet.footskate import settled_marks

Rows = slice | Sequence[int] | NDArray[np.intp] | Mask


@dataclass(frozen=True, eq=False)
class Pins:
    """Boxes for P joints in F frames [Gle98, constraints].

    Parameters
    ----------
    joints : P different joints, as indices.
    low, high : shape (F, P, 3), metres; an axis is held where they are equal, and free from -∞ to ∞.

    Raises
    ------
    MocapError : for a low above its high, a number that is none, and a joint that is given twice.

    Examples
    --------
    >>> rail = Pins((4,), [[[0.3, 0.9, -np.inf]]], [[[0.3, 0.9, np.inf]]])
    >>> rail.held
    array([[[ True,  True, False]]])
    >>> rail.gap(np.zeros((1, 5, 3)))
    array([[[0.3, 0.9, 0. ]]])

    Notebook: 14-levels
    """

    joints: tuple[int, ...]
    low: Array
    high: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(int(joint) for joint in self.joints))
        for key in ("low", "high"):
            object.__setattr__(self, key, frozen(getattr(self, key), np.float64))
        shape = (len(self.low), len(self.joints), 3)
        if self.low.shape != shape or self.high.shape != shape or len(set(self.joints)) < len(self.joints):
            raise MocapError(
                f"{len(self.joints)} different joints need low and high (F, {len(self.joints)}, 3), "
                f"got {self.low.shape} and {self.high.shape} for the joints {self.joints[:8]}."
            )
        _require_boxes(self.low, self.high, [f"joint {joint}" for joint in self.joints])

    def __len__(self) -> int:
        return len(self.low)

    @property
    def held(self) -> Mask:
        """The axes that are held, (F, P, 3)."""
        return np.asarray(self.low == self.high)

    @property
    def asked(self) -> Mask:
        """Where anything is asked of a joint, (F, P)."""
        return np.asarray((np.isfinite(self.low) | np.isfinite(self.high)).any(axis=-1))

    def at(self, rows: Rows) -> "Pins":
        """Take some frames."""
        return Pins(self.joints, self.low[rows], self.high[rows])

    def only(self, rows: Rows) -> "Pins":
        """Free all other frames."""
        keep = np.zeros((len(self), 1, 1), bool)
        keep[rows] = True
        return Pins(self.joints, np.where(keep, self.low, -np.inf), np.where(keep, self.high, np.inf))

    def gap(self, positions: Array) -> Array:
        """Measure clip(p, low, high) - p, (F, P, 3), metres, for all joints' positions (F, J, 3)."""
        places = positions[:, list(self.joints)]
        return np.asarray(np.clip(places, self.low, self.high) - places)


def pin(
    motion: Motion, joint: str | int, frames: Rows, low: ArrayLike, high: ArrayLike | None = None
) -> Pins:
    """Ask that a joint be at a place, or within a box, in some frames.

    Parameters
    ----------
    motion : F frames.
    joint : its name or its index.
    frames : a slice, the frames' numbers, or marks (F,).
    low : shape (3,), or one row for each of the frames, metres.
    high : the box's other corner; without it the joint is held at `low`. Of an axis from -∞ to ∞ nothing is
        asked.

    Returns
    -------
    The pins of this joint; `join_pins` joins several.

    Raises
    ------
    MocapError : for a joint or a frame that is not there, a low above its high, a place that is no number.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:60]
    >>> bar = pin(walk, "head", slice(20, 40), [-np.inf] * 3, [np.inf, 1.3, np.inf])
    >>> int(bar.asked.sum())
    20

    Notebook: 14-levels
    """
    name, number = _joint(motion.skeleton, joint)
    rows = _frames(motion, frames)
    lows, highs = np.full((len(motion), 1, 3), -np.inf), np.full((len(motion), 1, 3), np.inf)
    low = np.asarray(low, float)
    high = low if high is None else np.asarray(high, float)
    for kind, values in ((lows, low), (highs, high)):
        if values.shape not in ((3,), (len(rows), 3)):
            raise MocapError(f"'{name}': a place is (3,) or ({len(rows)}, 3) metres, got {values.shape}.")
        kind[rows, 0] = values
    _require_boxes(lows, highs, [f"'{name}'"])
    return Pins((number,), lows, highs)


def _require_boxes(low: Array, high: Array, names: Sequence[str]) -> None:
    """Raise `MocapError` unless -∞ ≤ low ≤ high ≤ ∞, and a place that is held is finite; (F, P, 3) each."""
    wrong = ~(low <= high) | (low == np.inf) | (high == -np.inf)
    if wrong.any():
        frame, pin, axis = np.argwhere(wrong)[0]
        raise MocapError(
            f"Frame {frame}, {names[pin]}: a pin needs low ≤ high, got {low[frame, pin, axis]:.4g} and "
            f"{high[frame, pin, axis]:.4g} for {'xyz'[axis]}; from -inf to inf an axis is free."
        )


def _joint(skeleton: Skeleton, joint: str | int) -> tuple[str, int]:
    """Find a joint's name and index."""
    number = skeleton.index(joint) if isinstance(joint, str) else int(joint)
    if not 0 <= number < len(skeleton):
        raise MocapError(f"No joint {number}: there are {len(skeleton)}, counted from 0.")
    return skeleton.names[number], number


def _frames(motion: Motion, frames: Rows) -> NDArray[np.intp]:
    """List the frames' numbers."""
    if isinstance(frames, slice):
        return np.arange(len(motion))[frames]
    rows = np.asarray(frames)
    if rows.dtype == bool and rows.shape == (len(motion),):
        return np.flatnonzero(rows)
    if rows.ndim != 1 or (rows.size and rows.dtype.kind not in "iu"):
        raise MocapError(f"Frames are numbers, a slice, or {len(motion)} marks; got shape {rows.shape}.")
    if rows.size and not (rows.min() >= 0 and rows.max() < len(motion)):
        off = int(rows[(rows < 0) | (rows >= len(motion))][0])
        raise MocapError(f"'{motion.name}' has no frame {off}: it has {len(motion)}, counted from 0.")
    return rows.astype(np.intp)


def join_pins(*several: Pins) -> Pins:
    """Join pins into one value: all of them hold together.

    Of two that hold one axis of a joint the later goes before; a held axis goes before a box; of two boxes
    the common part is taken, and the later one where they have none.

    Parameters
    ----------
    several : at least one, all of F frames.

    Raises
    ------
    MocapError : for no pins, and for two numbers of frames.

    Examples
    --------
    >>> floor = Pins((4,), [[[-np.inf, 0, -np.inf]]], [[[np.inf] * 3]])
    >>> bar = Pins((4,), [[[-np.inf] * 3]], [[[np.inf, 1.3, np.inf]]])
    >>> both = join_pins(floor, bar)
    >>> both.low[0, 0, 1], both.high[0, 0, 1]
    (np.float64(0.0), np.float64(1.3))

    Notebook: 14-levels
    """
    if not several or len({len(pins) for pins in several}) > 1:
        counts = ", ".join(str(len(pins)) for pins in several) or "none"
        raise MocapError(f"Pins that are joined need the same number of frames, got {counts}.")
    joints = tuple(dict.fromkeys(joint for pins in several for joint in pins.joints))
    low = np.full((len(several[0]), len(joints), 3), -np.inf)
    high = -low
    for pins in several:
        columns = [joints.index(joint) for joint in pins.joints]
        before_low, before_high = low[:, columns], high[:, columns]
        common = np.maximum(before_low, pins.low), np.minimum(before_high, pins.high)
        # An axis that is held already stays, unless it is held anew.
        held, stays = pins.held, before_low == before_high
        apart = common[0] > common[1]
        low[:, columns] = np.where(stays & ~held, before_low, np.where(held | apart, pins.low, common[0]))
        high[:, columns] = np.where(stays & ~held, before_high, np.where(held | apart, pins.high, common[1]))
    return Pins(joints, low, high)


def plant_pins(motion: Motion, legs: Sequence[Leg] | None = None) -> Pins:
    """Hold each planted ankle and ball at one place for as long as it stands: where it is on average.

    In the paper: [Gle98, constraints].

    The places are those of `feet.place_plants`. [Gle98] and [LS99] also let the place of a plant be unknown;
    in our trials that moved the places by 5 mm and saved 0.4 % of the cost.

    Parameters
    ----------
    motion : its `contacts` say when ankles and balls stand.
    legs : found by name by default.

    Raises
    ------
    MocapError : for legs that cannot be found, and marks that are missing.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> pins = plant_pins(sample("walk_straight"))
    >>> pins.joints, bool(pins.held.any(axis=(0, 2)).all())
    ((4, 5, 10, 11), True)

    Notebook: 12-path-editing
    """
    legs = legs_of(motion.skeleton, legs)
    positions, several = joint_positions(motion), []
    for leg, marks in zip(legs, settled_marks(motion, legs), strict=True):
        joints = (leg.ankle, leg.ball)
        tracks = (positions[:, leg.ankle], positions[:, leg.ball])
        places = place_plants(tracks, (marks[0], marks[1]), float(leg.lengths(motion.skeleton)[2]))
        several += [
            pin(motion, j, mark, place[mark]) for j, mark, place in zip(joints, marks, places, strict=True)
        ]
    return join_pins(*several)


def pin_errors(motion: Motion, pins: Pins) -> Array:
    """Measure how far each pinned joint is from its box, (F, P), metres; 0 where nothing is asked.

    Parameters
    ----------
    motion, pins : F frames.

    Raises
    ------
    MocapError : for pins of other frames or joints than the motion's.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> bool(pin_errors(walk, plant_pins(walk)).max() < 1e-9)  # generated feet stand still
    True

    Notebook: 12-path-editing
    """
    require_pins_of(motion, pins)
    return np.asarray(np.linalg.norm(pins.gap(joint_positions(motion)), axis=-1))


def require_pins_of(motion: Motion, pins: Pins) -> None:
    """Raise `MocapError` unless the pins have the motion's frames and joints of its skeleton."""
    if len(pins) != len(motion):
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, its pins have {len(pins)}.")
    for joint in pins.joints:
        _joint(motion.skeleton, joint)
