"""The unit and the vertical axis of clips, decided from their evidence [ours].

The unit is one that files are written in, and gives a person of a likely height. Two clocks check it: a free
fall accelerates by 9.81 m/s², and the period of a stride grows with the length of the leg. Clips of one set
have one unit and one vertical axis, so their evidence is added up. What is not certain stays as the format
has it by default, unless no body has that size, and the doubt is stated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.files.space_evidence import GRAVITY, LEG, Evidence, direction
from mocap.files.tuned import TUNED

UNITS = {
    1.0: "m",
    0.1: "dm",
    0.01: "cm",
    0.001: "mm",
    0.0254: "inch",
    0.3048: "foot",
    0.056444: "5.64 cm",
}
"""The names of units, by their lengths in metres. 5.64 cm is the unit of CMU's data."""

PRIOR = dict(zip(UNITS, (0.30, 0.03, 0.50, 0.04, 0.06, 0.02, 0.05), strict=True))
"""The fraction of files in each unit."""

ROOT_OFFSET = "the root's OFFSET"

_AROUND_Z = rotations.from_rotvec([0, 0, np.pi / 2])

UPRIGHT: dict[str, Array] = {"y": rotations.IDENTITY, "z": rotations.Z_UP, "x": _AROUND_Z}
UPRIGHT |= {"-z": rotations.inverse(rotations.Z_UP), "-x": rotations.inverse(_AROUND_Z)}
UPRIGHT["-y"] = rotations.multiply(_AROUND_Z, _AROUND_Z)
"""The rotation that turns each axis into y."""


class Space(NamedTuple):
    """The space that clips are read in.

    scale : metres in a unit of the file.
    up : the axis that points up: "y", "z", "x", "-y", "-z" or "-x".
    height : of the body, metres.
    doubt : what else may be meant, as a clause; "" if the space is certain, or nothing is known.
    usual : the unit and the axis that nobody needs to be told: those of the format, or of the caller.
    decided : the parameters, of `scale`, `up` and `root_offset`, that neither the user nor the format says.
    root_offset : "add" if the positions of the root are relative to its offset, "ignore" if they replace it;
        None if it has no offset.
    """

    scale: float
    up: str
    height: float
    doubt: str
    usual: tuple[float, str]
    decided: tuple[str, ...] = ()
    root_offset: str | None = None

    def choices(self) -> tuple[float, str, str | None]:
        """Return what `files.load` needs to read a clip in this space: scale, up and root_offset."""
        return self.scale, self.up, self.root_offset

    def _is_relative(self) -> bool:
        """Return whether the frames show that the positions of the root are relative to its offset."""
        return self.root_offset == "add" and "root_offset" in self.decided

    def clause(self) -> str:
        """State the unit, the axis, the height of the body, a relative root, and the doubt.

        A small body that moves at the pace of an adult has the same numbers as an adult in another unit.
        Therefore the height in the default unit is stated too, if there may be such a body.
        """
        stated = f"{unit_name(self.scale)} a unit, {self.up} up: {self.height:.2f} m tall"
        stated += f", {ROOT_OFFSET} added" if self._is_relative() else ""
        if self.doubt:
            return f"{stated}; {self.doubt}"
        by_default = self.height * self.usual[0] / self.scale
        smallest, largest = TUNED.default_height
        is_chosen = "scale" in self.decided and self.scale != self.usual[0]
        if is_chosen and smallest <= by_default <= largest:
            return f"{stated} ({by_default:.2f} m if it is {unit_name(self.usual[0])} a unit)"
        return stated

    def overruled_by(self, names: Mapping[str, str]) -> str:
        """Name the parameters that overrule the space, as a sentence; "" if the surface has none of them.

        Parameters
        ----------
        names : of the parameters `scale`, `up` and `root_offset` on the surface that is used.
        """
        states_offset = self._is_relative() or ROOT_OFFSET in self.doubt
        decided = [name for name in self.decided if name != "root_offset" or states_offset]
        available = [names[name] for name in decided if name in names]
        if not available:
            return ""
        *first, last = available
        return f"{', '.join(first)} and {last} overrule it." if first else f"{last} overrules it."

    def sentence(self, names: Mapping[str, str]) -> str:
        """State the space, the doubt, and the parameters that overrule it; "" if there is nothing to state.

        Parameters
        ----------
        names : as for `overruled_by`.
        """
        if (self.scale, self.up) == self.usual and not self.doubt and not self._is_relative():
            return ""
        return f"read as {self.clause()}. {self.overruled_by(names)}".rstrip()


def unit_name(scale: float) -> str:
    """Name a unit.

    Examples
    --------
    >>> unit_name(0.01), unit_name(0.0254), unit_name(0.5)
    ('1 cm', '1 inch', '0.5 m')
    """
    name = UNITS.get(scale, f"{scale:g} m")
    return name if name[0].isdigit() else f"1 {name}"


def upright(motion: Motion, up: str) -> Motion:
    """Rotate a motion whose given axis points up so that y does."""
    if up == "y":
        return motion
    turn = UPRIGHT[up]
    skeleton = motion.skeleton
    roots = rotations.rotate(turn, motion.root_positions)
    offsets = rotations.rotate(turn, skeleton.offsets)
    local = rotations.multiply(rotations.multiply(turn, motion.rotations), rotations.inverse(turn))
    turned = replace(skeleton, offsets=offsets, axes=np.tile(turn, (len(skeleton), 1)))
    return replace(motion, skeleton=turned, root_positions=roots, rotations=local)


def require_axis(up: str | None) -> None:
    """Raise unless an axis is one that may point up, or None.

    Examples
    --------
    >>> require_axis("w")
    Traceback (most recent call last):
    mocap.errors.MocapError: up must be 'y', 'z', '-y', '-z', 'x' or '-x', got 'w'.
    """
    if up is not None and up not in UPRIGHT:
        raise MocapError(f"up must be 'y', 'z', '-y', '-z', 'x' or '-x', got {str(up)[:20]!r}.")


def require_root_offset(root_offset: str | None) -> None:
    """Raise unless a value is one that `files.load` takes for the offset of the root.

    Examples
    --------
    >>> require_root_offset("yes")
    Traceback (most recent call last):
    mocap.errors.MocapError: root_offset must be 'add' or 'ignore', got 'yes'.
    """
    if root_offset not in (None, "add", "ignore"):
        raise MocapError(f"root_offset must be 'add' or 'ignore', got {str(root_offset)[:20]!r}.")


def decide(
    evidence: Sequence[Evidence],
    default: tuple[float, str],
    *,
    scale: float | None,
    up: str | None,
    root_offset: str | None = None,
) -> Space:
    """Decide the space of a set of clips.

    Parameters
    ----------
    evidence : of each clip that shows a body; may be empty.
    default : the unit in metres, and the axis, that the format has by default.
    scale, up, root_offset : what the user or the file says; None to decide it.
    """
    usual_scale, usual_up = default
    spoken = (scale or usual_scale, up or usual_up)
    choices = {"scale": scale, "up": up}
    if any(clip.root_offset.any() for clip in evidence):
        choices["root_offset"] = root_offset
    decided = tuple(name for name, value in choices.items() if value is None)
    if not evidence:
        return Space(*spoken, 0.0, "", spoken, decided, root_offset)
    axis, other_axis = _axis(evidence, usual_up)
    unit, other_unit = _unit(evidence, usual_scale)
    size = float(np.median([clip.size for clip in evidence]))
    doubts = {"up": f"perhaps {other_axis} is up" if other_axis else ""}
    if other_unit and _is_stated(size * unit, size * other_unit):
        doubts["scale"] = f"{size * other_unit:.2f} m if it is {unit_name(other_unit)} a unit"
    chosen = (scale or unit, up or axis)
    if "root_offset" in decided:
        root_offset, doubts["root_offset"] = _root_offset(evidence, chosen[1])
    doubt = ", or ".join(text for name, text in doubts.items() if text and name in decided)
    return Space(*chosen, size * chosen[0], doubt, spoken, decided, root_offset)


def _root_offset(evidence: Sequence[Evidence], axis: str) -> tuple[str, str]:
    """Return whether to "add" the root's offset to its positions or to "ignore" it, and the doubt, or "".

    It is added if the offset lifts a body that is a leg's length below the floor onto it.
    """
    height = float(np.median([clip.root_offset @ direction(axis) / clip.size for clip in evidence]))
    floor = float(np.median([clip.floors[axis] / clip.size for clip in evidence]))
    if height < TUNED.root_height or abs(floor + height) > height / 2:
        return "ignore", ""
    if abs(floor + height) < TUNED.floor_error:
        return "add", ""
    return "ignore", f"perhaps {ROOT_OFFSET} is to be added"


def _axis(evidence: Sequence[Evidence], usual: str) -> tuple[str, str]:
    """Return the vertical axis, and the one that it may be instead, "" for none."""
    scores = {axis: float(np.mean([clip.scores[axis] for clip in evidence])) for axis in UPRIGHT}
    ranked = sorted(scores, key=lambda axis: scores[axis] + (0.15 if axis == usual else 0.0), reverse=True)
    best, second = ranked[:2]
    stands = _stands(evidence)
    if best == usual:
        return best, "" if stands else second
    lead = scores[best] - scores[second]
    if lead >= TUNED.sure_axis and _feet_stand(evidence, best):
        return best, ""
    on_floor = all(clip.on_floor for clip in evidence)
    if lead >= TUNED.probable_axis and on_floor and stands:
        return best, usual
    is_stated = scores[best] - scores[usual] >= TUNED.sure_axis or not stands
    return usual, best if is_stated else ""


def _feet_stand(evidence: Sequence[Evidence], axis: str) -> bool:
    """Check whether the lowest joint stands still if an axis points up, or all clips stand on the floor."""
    stillness = max(clip.stillness[axis] for clip in evidence)
    nothing_moves = all(max(clip.stillness.values()) == 0 for clip in evidence)
    return stillness > TUNED.still_foot or (nothing_moves and all(clip.on_floor for clip in evidence))


def _unit(evidence: Sequence[Evidence], usual: float) -> tuple[float, float | None]:
    """Return the unit in metres, and the one that it may be instead, None if it is certain."""
    probability = _unit_probabilities(evidence)
    best, second = sorted(UNITS, key=lambda unit: probability[unit], reverse=True)[:2]
    size = float(np.median([clip.size for clip in evidence]))
    is_adult = _stands(evidence) and _is_adult(size * best)
    error = _median_clock_error(evidence, best)
    is_confirmed = best in TUNED.common_units or error < TUNED.confirming_clock
    if is_adult and is_confirmed and probability[best] >= TUNED.sure_unit:
        return best, None
    is_refuted = np.isfinite(error) and error > TUNED.refuting_clock
    is_probable = is_adult and not is_refuted and probability[best] >= TUNED.probable_unit
    smallest, largest = TUNED.default_height
    if best == usual:
        return best, None if is_probable else second
    is_taken = is_probable or not smallest <= size * usual <= largest
    return (best, second) if is_taken else (usual, best)


def _is_adult(metres: float) -> bool:
    """Check whether a height is that of an adult beyond doubt."""
    smallest, largest = TUNED.sure_height
    return smallest <= metres <= largest


def _is_stated(height: float, other_height: float) -> bool:
    """Check whether a doubt helps: the other unit gives a likely height, or this one an unlikely height."""
    smallest, largest = TUNED.likely_height
    shortest, tallest = TUNED.person_height
    return smallest <= other_height <= largest or not shortest <= height <= tallest


def _median_clock_error(evidence: Sequence[Evidence], unit: float) -> float:
    """Return the median error of the clocks as a logarithm, without its sign; infinite if there is none."""
    errors = [_clock_error(clip, unit) for clip in evidence]
    sizes = [abs(error) for error in errors if error is not None]
    return float(np.median(sizes)) if sizes else np.inf


def _stands(evidence: Sequence[Evidence]) -> bool:
    """Check whether the body stands in most clips."""
    return bool(np.mean([clip.stands for clip in evidence]) > 0.5)


def _unit_probabilities(evidence: Sequence[Evidence]) -> dict[float, float]:
    """Return the probability of each unit, from the usual ones, the size of the body, and the clocks."""
    size = float(np.median([clip.size for clip in evidence]))
    logs = []
    for unit, prior in PRIOR.items():
        log = np.log(prior * _height_density(size * unit))
        for clip in evidence:
            log -= _clock_penalty(clip, unit)
        logs.append(log)
    weights = np.exp(np.array(logs) - max(logs))
    return dict(zip(UNITS, (weights / weights.sum()).tolist(), strict=True))


def _height_density(metres: float) -> float:
    """Return the probability density of a body's height: adults, few children, anything else now and then."""
    mean, spread = TUNED.adult_height
    deviation = (np.log(metres) - np.log(mean)) / spread
    adult = np.exp(-(deviation**2) / 2) / (spread * np.sqrt(2 * np.pi))
    child = 1 / np.log(1.3 / 0.6) if 0.6 < metres < 1.3 else 0.0
    toy_or_giant = 1 / np.log(100) if 0.05 < metres < 5 else 1e-4
    return float(0.95 * adult + 0.03 * child + 0.02 * toy_or_giant)


def _fall_error(clip: Evidence, unit: float) -> float | None:
    """Return the logarithm of the acceleration in free fall over that of gravity."""
    return None if clip.fall is None else float(np.log(clip.fall * unit / GRAVITY))


def _stride_error(clip: Evidence, unit: float) -> float | None:
    """Return the logarithm of the leg's length over the one that the stride tells; None for no stride.

    A leg of 0.051 g T² s^0.7 metres has strides of period T and length s legs: fitted to forty clips, from
    slow walks to runs, with a spread of 0.2 of the logarithm.
    """
    if clip.stride is None or not 0.7 < clip.stride.length < 4.5:
        return None
    leg = 0.051 * GRAVITY * clip.stride.period**2 * clip.stride.length**0.7
    return float(np.log(LEG * clip.size * unit / leg))


def _clock_error(clip: Evidence, unit: float) -> float | None:
    """Return the error of the better clock of a clip; None if it has none."""
    fall = _fall_error(clip, unit)
    return _stride_error(clip, unit) if fall is None else fall


def _clock_penalty(clip: Evidence, unit: float) -> float:
    """Return how much the clocks of a clip speak against a unit, as a logarithm."""
    penalty = 0.0
    for error, spread in ((_fall_error(clip, unit), 0.2), (_stride_error(clip, unit), 0.3)):
        if error is not None:
            penalty += min(TUNED.clock_weight, (error / spread) ** 2 / 2)
    return penalty
