"""Checks of constraints: whether they are of a motion, whether a pose can meet them, and their errors."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.editing.constraints import Pins
from mocap.editing.poses import MotionOrPoses, motion_of, poses_of
from mocap.errors import MocapError, warn

TOLERANCE = 0.005  # metres: constraints with a smaller error cause no warning
SLACK = 1e-6  # metres by which constraints may be farther apart than the bones between them: rounding


def pin_errors(motion: MotionOrPoses, pins: Pins) -> Array:
    """Compute the distance of each constrained joint from its box, (F, P + R), metres; 0 if it is free.

    Parameters
    ----------
    motion, pins : F frames. The error of a rotation is 0.3 m times the angle.

    Raises
    ------
    MocapError : for constraints of other frames or joints than the motion's.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing import plant_pins
    >>> walk = sample("walk_straight")
    >>> bool(pin_errors(walk, plant_pins(walk)).max() < 5e-9)  # generated feet stand still
    True

    Notebook: 12-path-editing
    """
    require_pins_of(motion_of(motion), pins)
    return pins.errors(poses_of(motion))


def require_pins_of(motion: Motion, pins: Pins) -> None:
    """Raise `MocapError` unless the constraints have the motion's frames and joints of its skeleton."""
    if len(pins) != len(motion):
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, its pins have {len(pins)}.")
    if unknown := [joint for joint in pins.joints if not 0 <= joint < len(motion.skeleton)]:
        raise MocapError(f"No joint {unknown[0]}: there are {len(motion.skeleton)}, counted from 0.")


def require_reachable(motion: Motion, pins: Pins, first_frame: int = 0) -> None:
    """Raise `MocapError` for constraints that no pose can meet.

    Two boxes are at least ‖max(low₁ - high₂, low₂ - high₁, 0)‖ apart. Two joints are at most as far apart as
    the bones between them are long together. A solver would not notice: it tears the feet off their
    positions, and converges.

    Parameters
    ----------
    motion, pins : F frames.
    first_frame : the number of the first of them in the clip, which the error counts from.

    Raises
    ------
    MocapError : naming the frame, both joints, and both lengths.
    """
    skeleton = motion.skeleton
    paths = [set(skeleton.path_to_root(joint)) for joint in pins.joints]
    for a, b in combinations(range(len(pins.joints)), 2):
        distances = _distances_between_boxes(pins, a, b)
        worst = int(distances.argmax())
        bones = sorted(paths[a] ^ paths[b])
        reach = np.linalg.norm(skeleton.offsets[bones], axis=1).sum()
        if distances[worst] > reach + SLACK:
            first = skeleton.names[pins.joints[a]]
            second = skeleton.names[pins.joints[b]]
            request = f"'{second}' would be {distances[worst]:.2f} m from '{first}'"
            raise MocapError(
                f"Frame {first_frame + worst}: {request}, the bones between reach {reach:.2f} m."
            )


def _distances_between_boxes(pins: Pins, a: int, b: int) -> Array:
    """Compute the least distances (F,) between points of the boxes in columns a and b, metres."""
    from_b_up_to_a = pins.low[:, a] - pins.high[:, b]
    from_a_up_to_b = pins.low[:, b] - pins.high[:, a]
    gaps = np.maximum(np.maximum(from_b_up_to_a, from_a_up_to_b), 0.0)
    return np.asarray(np.linalg.norm(gaps, axis=1))


def warn_of_errors(
    motion: Motion,
    joints: Sequence[int],
    errors: Array,
    tolerance: float = TOLERANCE,
    first_frame: int = 0,
) -> None:
    """Warn of the constraint with the largest error, if that is above a tolerance.

    Parameters
    ----------
    motion : F frames.
    joints : of the P + R constraints, as from `Pins.indices`.
    errors : of the motion, as from `pin_errors`, (F, P + R), metres.
    tolerance : metres.
    first_frame : the number of the motion's first frame in the clip, which the warning counts from.

    Examples
    --------
    >>> import warnings
    >>> from mocap.datasets import sample
    >>> from mocap.editing import pin
    >>> walk = sample("walk_straight")[:9]
    >>> higher = pin(walk, "root", [5, 6], walk.root_positions[5] + [0, 0.02, 0])
    >>> hardly = pin(walk, "root", [5], walk.root_positions[5] + [0, 0.004, 0])
    >>> with warnings.catch_warnings(record=True, action="always") as said:
    ...     for pins in (higher, hardly):
    ...         warn_of_errors(walk, pins.indices, pin_errors(walk, pins))
    >>> print(*(warning.message for warning in said))
    'walk_straight', frame 6: 'root' is 21.6 mm off its pin, and pins of 2 frames are missed: are they
    within reach, and do they agree?
    """
    if errors.max(initial=0.0) > tolerance:
        frame, number = np.unravel_index(errors.argmax(), errors.shape)
        name = motion.skeleton.names[joints[int(number)]]
        worst = f"'{name}' is {1000 * errors[frame, number]:.3g} mm off its pin"
        frames = int((errors > tolerance).any(axis=1).sum())
        missed = f"pins of {frames} frames are missed"
        question = "are they within reach, and do they agree?"
        warn(f"'{motion.name}', frame {first_frame + frame}: {worst}, and {missed}: {question}")
