"""Where joints shall be, and how they are turned: one value for plants, rails, floors, bars and limits.

A pin is a box for a joint in a frame: `low` ≤ p ≤ `high` on each axis. The same number twice holds an axis,
-∞ and ∞ leave it free, and one of the two is a floor or a ceiling. For all of these one formula gives the gap
to close, clip(p, low, high) - p. How a joint is turned is such a p as well: a rotation vector times 0.3 m.
[Gle98] and [LS99] list their constraints kind by kind; the box is ours.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Mask, frozen
from mocap._shared.records import dataclass
from mocap.body.kinematics import GlobalPoses, forward_kinematics, joint_positions
from mocap.body.limbs import Leg, find_legs, with_roles
from mocap.body.motion import Motion, require_motion
from mocap.body.skeleton import Skeleton
from mocap.editing.turns import Turn
from mocap.errors import MocapError
from mocap.feet.ankle_targets import place_plants
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import settled_marks

Rows = slice | Sequence[int] | NDArray[np.intp] | Mask


@dataclass(frozen=True, eq=False)
class Pins:
    """Boxes for P joints' places and for T turns in F frames [Gle98, constraints].

    Parameters
    ----------
    joints : P different joints, as indices.
    low, high : shape (F, P + T, 3), metres; an axis is held where they are equal, and free from -∞ to ∞.
    turns : T turns that are in a box too, from `limit_turns` and `keep_turned`.

    Raises
    ------
    MocapError : for a low above its high, a number that is none, and a joint that is given twice.

    Examples
    --------
    >>> rail = Pins((4,), [[[0.3, 0.9, -np.inf]]], [[[0.3, 0.9, np.inf]]])
    >>> rail.held
    array([[[ True,  True, False]]])
    >>> rail.gap(np.zeros((1, 1, 3)))
    array([[[0.3, 0.9, 0. ]]])

    Notebook: 14-levels
    """

    joints: tuple[int, ...]
    low: Array
    high: Array
    turns: tuple[Turn, ...] = ()

    if TYPE_CHECKING:  # what a caller may pass: `__post_init__` makes arrays of it

        def __init__(
            self, joints: Sequence[int], low: ArrayLike, high: ArrayLike, turns: tuple[Turn, ...] = ...
        ) -> None: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(int(joint) for joint in self.joints))
        for key in ("low", "high"):
            object.__setattr__(self, key, frozen(getattr(self, key), np.float64))
        shape = (len(self.low), len(self.ends), 3)
        are_different = len(set(self.joints)) == len(self.joints)
        if not are_different or self.low.shape != shape or self.high.shape != shape:
            raise MocapError(f"{len(self.joints)} different joints need boxes {shape}, got {self.low.shape}.")
        is_ordered = self.low <= self.high  # False for what is no number
        is_finite = (self.low < np.inf) & (self.high > -np.inf)
        wrong = np.argwhere(~(is_ordered & is_finite))
        if len(wrong):
            frame, pin, axis = wrong[0]
            low = self.low[frame, pin, axis]
            high = self.high[frame, pin, axis]
            got = f"{low:.4g} and {high:.4g} for {'xyz'[axis]}"
            needs = f"a pin needs low ≤ high, got {got}; from -inf to inf an axis is free"
            raise MocapError(f"Frame {frame}, joint {self.ends[pin]}: {needs}.")

    def __len__(self) -> int:
        return len(self.low)

    @property
    def ends(self) -> list[int]:
        """The joints of all boxes, those of the turns behind those of the places."""
        return [*self.joints, *(turn.joint for turn in self.turns)]

    @property
    def held(self) -> Mask:
        """The axes that are held, (F, P + T, 3)."""
        return np.asarray(self.low == self.high)

    # reads: name: public, and goes when the pins are split into boxes
    @property
    def asked(self) -> Mask:
        """Where anything is asked of a joint, (F, P + T)."""
        return np.asarray((np.isfinite(self.low) | np.isfinite(self.high)).any(axis=-1))

    # reads: name: public, and goes when the pins are split into boxes
    def at(self, rows: Rows) -> "Pins":
        """Take some frames."""
        turns = (turn._replace(reference=turn.reference[rows]) for turn in self.turns)
        return Pins(self.joints, self.low[rows], self.high[rows], tuple(turns))

    # reads: name: public, and goes when the pins are split into boxes
    def only(self, rows: Rows) -> "Pins":
        """Free all other frames."""
        keep = np.zeros((len(self), 1, 1), bool)
        keep[rows] = True
        low = np.where(keep, self.low, -np.inf)
        high = np.where(keep, self.high, np.inf)
        return Pins(self.joints, low, high, self.turns)

    def places(self, motion: Motion, poses: GlobalPoses) -> Array:
        """Give what the boxes are for, (F, P + T, 3), metres, from a motion and its joints in the world."""
        arms = (turn.arm(motion, poses.matrices)[:, None] for turn in self.turns)
        return np.hstack([poses.positions[:, list(self.joints)], *arms])

    def gap(self, places: Array) -> Array:
        """Measure clip(p, low, high) - p, (F, P + T, 3), metres."""
        return np.asarray(np.clip(places, self.low, self.high) - places)

    def movers(self, skeleton: Skeleton) -> list[list[int]]:
        """Find the joints whose turns move what each box is for."""
        movers = [skeleton.path_to_root(joint)[1:] for joint in self.joints]
        for turn in self.turns:
            movers.append(skeleton.path_to_root(turn.joint) if turn.world else [turn.joint])
        return movers


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
    >>> pin(walk, 0, [40], [0, 1, 0]).low[40].tolist()  # the root, at one place
    [[0.0, 1.0, 0.0]]

    Notebook: 14-levels
    """
    require_motion(motion)
    number = motion.skeleton.index(joint) if isinstance(joint, str) else int(joint)
    if isinstance(frames, int | float):
        raise MocapError(f"A pin takes a list of frames, got {frames}: write [{frames:.0f}].")
    try:
        rows = np.arange(len(motion))[frames if isinstance(frames, slice) else list(frames)]
    except IndexError:
        counted = f"'{motion.name}' has {len(motion)} frames, counted from 0"
        takes = f"frames are their numbers, a slice, or {len(motion)} marks"
        raise MocapError(f"{counted}; {takes}.") from None
    shape = (len(motion), 1, 3)
    pins_low = np.full(shape, -np.inf)
    pins_high = np.full(shape, np.inf)
    for box, corner in ((pins_low, low), (pins_high, low if high is None else high)):
        got = np.shape(corner)
        if got not in ((3,), (len(rows), 3)):
            raise MocapError(f"'{joint}': a place is (3,) or ({len(rows)}, 3) metres, got {got}.")
        box[rows, 0] = corner
    pins = Pins((number,), pins_low, pins_high)
    require_pins_of(motion, pins)
    return pins


def join_pins(*parts: Pins) -> Pins:
    """Join pins into one value: all of them hold together.

    Of two that hold one axis of a joint the later goes before; a held axis goes before a box; of two boxes
    the common part is taken, and the later one where they have none.

    Parameters
    ----------
    parts : at least one, all of F frames.

    Raises
    ------
    MocapError : for no pins, and for two numbers of frames.

    Examples
    --------
    >>> floor = Pins((4,), [[[-np.inf, 0, -np.inf]]], [[[np.inf] * 3]])
    >>> bar = Pins((4,), [[[-np.inf] * 3]], [[[np.inf, 1.3, np.inf]]])
    >>> both = join_pins(floor, bar)
    >>> float(both.low[0, 0, 1]), float(both.high[0, 0, 1])
    (0.0, 1.3)

    Notebook: 14-levels
    """
    if not parts or len({len(part) for part in parts}) > 1:
        counts = ", ".join(str(len(part)) for part in parts) or "none"
        raise MocapError(f"Pins that are joined need the same number of frames, got {counts}.")
    joints = tuple(dict.fromkeys(joint for part in parts for joint in part.joints))
    turns = tuple(turn for part in parts for turn in part.turns)
    shape = (len(parts[0]), len(joints) + len(turns), 3)
    low = np.full(shape, -np.inf)
    high = np.full(shape, np.inf)
    first_turn = len(joints)
    for part in parts:
        next_turn = first_turn + len(part.turns)
        columns = [*map(joints.index, part.joints), *range(first_turn, next_turn)]
        merged = _merged_boxes(low[:, columns], high[:, columns], part)
        low[:, columns], high[:, columns] = merged
        first_turn = next_turn
    return Pins(joints, low, high, turns)


def _merged_boxes(low: Array, high: Array, later: Pins) -> tuple[Array, Array]:
    """Merge boxes with those of later pins, in the same columns, by the order of `join_pins`."""
    common_low = np.maximum(low, later.low)
    common_high = np.minimum(high, later.high)
    is_disjoint = common_low > common_high
    is_held = low == high
    is_later = later.held | (is_disjoint & ~is_held)
    choices = [is_later, is_disjoint]  # the first that is true counts
    merged_low = np.select(choices, [later.low, low], common_low)
    merged_high = np.select(choices, [later.high, high], common_high)
    return merged_low, merged_high


def plant_pins(motion: Motion, legs: Sequence[Leg] | None = None, heights: ArrayLike | None = None) -> Pins:
    """Hold each planted ankle and ball at one place for as long as it stands: where it is on average.

    In the paper: [Gle98, constraints].

    [Gle98] and [LS99] also let the place of a plant be unknown; in our trials that saved 0.4 % of the cost.

    Parameters
    ----------
    motion : its `contacts` say when ankles and balls stand.
    legs : by default those of `body.find_legs`.
    heights : shape (legs, 2), metres: how high ankle and ball stand, if not where they are. An ankle and a
        ball that stand together are then as far apart as the flat foot is long.

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
    legs = find_legs(motion.skeleton) if legs is None else legs
    positions = joint_positions(motion)
    parts = []
    for number, (leg, marks) in enumerate(zip(legs, settled_marks(motion, legs), strict=True)):
        tracks = np.swapaxes(positions[:, [leg.ankle, leg.ball]], 0, 1)  # (2, F, 3)
        length = float(leg.lengths(motion.skeleton)[2])
        if heights is None:
            places = place_plants((tracks[0], tracks[1]), (marks[0], marks[1]), length)
        else:
            places = _places_at_heights(tracks, marks, length, np.asarray(heights, float)[number])
        planted = marks[..., None]
        low = np.where(planted, places, -np.inf)
        high = np.where(planted, places, np.inf)
        joints = leg[2:] if leg.has_ball else leg[2:3]
        boxes = slice(len(joints))
        parts.append(Pins(joints, np.swapaxes(low[boxes], 0, 1), np.swapaxes(high[boxes], 0, 1)))
    return join_pins(*parts)


def _places_at_heights(tracks: Array, marks: Mask, length: float, heights: Array) -> Array:
    """Place the plants of an ankle and a ball (2, F, 3) on the ground, then lift them to two heights."""
    ankle, ball = heights
    flat_tracks = tracks * [1, 0, 1]
    flat_length = np.sqrt(length**2 - (ankle - ball) ** 2)
    places = place_plants((flat_tracks[0], flat_tracks[1]), (marks[0], marks[1]), flat_length)
    places[..., 1] = heights[:, None]
    return places


def pin_errors(motion: Motion, pins: Pins) -> Array:
    """Measure how far each pinned joint is from its box, (F, P + T), metres; 0 where nothing is asked.

    Parameters
    ----------
    motion, pins : F frames. A turn is missed by 0.3 m times the angle.

    Raises
    ------
    MocapError : for pins of other frames or joints than the motion's.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> bool(pin_errors(walk, plant_pins(walk)).max() < 5e-9)  # generated feet stand still
    True

    Notebook: 12-path-editing
    """
    require_pins_of(motion, pins)
    places = pins.places(motion, forward_kinematics(motion))
    return np.asarray(np.linalg.norm(pins.gap(places), axis=-1))


def require_pins_of(motion: Motion, pins: Pins) -> None:
    """Raise `MocapError` unless the pins have the motion's frames and joints of its skeleton."""
    if len(pins) != len(motion):
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, its pins have {len(pins)}.")
    if unknown := [joint for joint in pins.joints if not 0 <= joint < len(motion.skeleton)]:
        raise MocapError(f"No joint {unknown[0]}: there are {len(motion.skeleton)}, counted from 0.")


def with_plants(motion: Motion, legs: Sequence[Leg] | None = None) -> Motion:
    """Mark when ankles and balls stand, unless the motion says it of all of them."""
    require_motion(motion)
    if legs is None:
        motion = with_roles(motion)
        legs = find_legs(motion.skeleton)
    names = {motion.skeleton.names[joint] for leg in legs for joint in (leg.ankle, leg.ball)}
    return motion if names <= set(motion.contacts) else mark_plants(motion, legs)
