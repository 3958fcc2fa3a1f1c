"""Proposed labels for a clip: its pace, its turns, and where it stands. A person corrects them.

Speeds are compared as Froude numbers, v² / (g l), with the leg length l, so that small and large bodies have
the same limits. People change from a walk to a run at a Froude number of about one half [Ale89].
"""

from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion, require_motion
from mocap.body.planar import heading, on_ground
from mocap.files.label_tables import LabelRow, rows_of

GRAVITY = 9.81  # m/s²
RUNS = 0.5  # Froude number, about 2.1 m/s for a leg of 0.9 m [Ale89]. Higher, slow runs are called walks
STANDS = 0.005  # Froude number, about 0.2 m/s, above the sway of people who stand. Higher, slow steps stand
TURNS = np.radians(20)  # radians per second: a circle of 3.4 m at 1.2 m/s. Lower, straight walks turn
SMOOTHING = 0.5  # seconds of the window over which speeds are averaged. Shorter, steps are seen as stops
STRIDE = 1.2  # seconds over which turns are averaged, one stride, in which hips turn to and fro
SHORTEST = 0.4  # seconds. A shorter stretch takes the label before it


def propose_labels(motion: Motion) -> list[LabelRow]:
    """Propose labels for a clip by its pace ("stand", "walk", "run") and its turns ("turn left" and "right").

    Every frame has one label of pace. The speed is that of the root on the ground, averaged over half a
    second, and the turn is the rate of its heading, averaged over a stride. A clip that has labels keeps
    them: its rows are those of `files.label_tables.rows_of`.

    Parameters
    ----------
    motion : F frames of a body with legs.

    Raises
    ------
    MocapError : for a body without legs.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets import sample
    >>> clip = replace(sample("stop_and_go"), labels={})
    >>> [row.label for row in propose_labels(clip)][:4]
    ['stand', 'walk', 'turn left', 'stand']
    """
    require_motion(motion)
    if motion.labels:
        return rows_of(motion)
    pace = _pace(motion)
    angles = np.unwrap(heading(motion.rotations[:, 0]))
    turning = _rate(angles, motion.fps, STRIDE)
    side = _settled((turning > TURNS).astype(int) - (turning < -TURNS), motion.fps)
    labels = {"stand": pace == 0, "walk": pace == 1, "run": pace > 1}
    labels |= {"turn left": side > 0, "turn right": side < 0}
    return rows_of(replace(motion, labels=labels))


def standing_frames(motion: Motion) -> Mask:
    """Return in which frames (F,) a body stands, by its pace.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> bool(standing_frames(sample("stop_and_go"))[:200].all()), bool(standing_frames(sample("jog")).any())
    (True, False)
    """
    return np.asarray(_pace(motion) == 0)


def _pace(motion: Motion) -> Indices:
    """Return the pace in each frame: 0 standing, 1 walking, 2 running."""
    speed = np.abs(_rate(on_ground(motion.root_positions), motion.fps, SMOOTHING))
    shortest = min(leg.lengths(motion.skeleton)[:2].sum() for leg in find_legs(motion.skeleton))
    froude = speed**2 / (GRAVITY * shortest)
    return _settled((froude >= STANDS).astype(int) + (froude >= RUNS), motion.fps)


def _rate(values: Array | Points, fps: float, window: float) -> Array:
    """Return the mean rate of change over a window around each frame, which is shorter at the ends."""
    half = max(1, round(window * fps / 2))
    frames = np.arange(len(values))
    start = np.maximum(frames - half, 0)
    stop = np.minimum(frames + half, len(values) - 1)
    return np.asarray((values[stop] - values[start]) * fps / np.maximum(stop - start, 1))


def _settled(kinds: Indices, fps: float) -> Indices:
    """Give each stretch shorter than `SHORTEST` the kind before it, or at the start the kind after it."""
    borders = np.flatnonzero(np.diff(kinds, prepend=kinds[0] - 1))
    lengths = np.diff([*borders, len(kinds)])
    chosen = kinds[borders]
    is_long = lengths >= SHORTEST * fps
    if not is_long.any():
        return np.full(len(kinds), np.bincount(kinds - kinds.min()).argmax() + kinds.min())
    source = np.maximum.accumulate(np.where(is_long, np.arange(len(borders)), -1))
    source = np.where(source < 0, int(is_long.argmax()), source)
    return np.asarray(np.repeat(chosen[source], lengths))
