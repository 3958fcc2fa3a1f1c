"""Strides and steps cut out of clips, all on one grid of phases.

A stride is the motion from a strike of one foot to its next strike, and a step is that to the next strike of
the other foot. Strikes have evenly spaced phases from 0 to 1, so that all examples correspond at each phase.

Notebook: 17-parametric-graphs
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap._shared.records import NamedTuple
from mocap.body.concatenation import require_compatible
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.methods.parametric_graphs.examples import (
    FINE,
    LEAST_MARGIN,
    Examples,
    margin_knots,
    mixed_trajectory,
    register_cuts,
    sample_cuts,
)
from mocap.methods.parametric_graphs.tuned import TUNED

STRIDE = "lrl"  # the strikes of a stride


def cut_strides(
    clips: Sequence[Motion],
    *,
    feet: str = STRIDE,
    by: str = "strikes",
    label: str = "",
    margin: float | None = TUNED.margin,
) -> Examples:
    """Cut clips at foot strikes, and sample all examples on one grid of phases [HG07, examples].

    Parameters
    ----------
    clips : clips of one skeleton and rate. Unless footplants are marked, `feet.mark_plants` detects them.
    feet : the strikes of an example in their order, "lrl" for strides, "lr" and "rl" for steps.
    by : "strikes" spaces phases evenly in time between strikes [ours]. "curves" registers all examples with
        the one of median rotation by registration curves [KG03], as the paper does.
    label : only examples with this label in every frame are kept, or all examples with "".
    margin : fraction of a stride that is kept before and after it for the windows of transitions. Quick
        strides need 0.5. None keeps as many frames as these windows need, 9 or more after a quick step, and
        loses fewer strides at the ends of clips.

    Returns
    -------
    The examples, without those that contain other strikes, that have steps shorter than 0.23 s or longer than
    1 s, or that are too near the ends of a clip.

    Raises
    ------
    MocapError : for no clips, unknown settings, and clips without an example.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> len(strides), strides.dropped
    (27, 2)
    >>> turn, speed = strides.values[0]
    >>> round(np.degrees(turn)), float(speed.round(2)), strides.seconds[0, strides.ends].round(2).tolist()
    (86, 0.9, [0.0, 1.1])
    """
    if by not in ("strikes", "curves"):
        raise MocapError(f"Examples are put on one clock by 'strikes' or by 'curves', got '{by}'.")
    clips = require_compatible(clips)
    clips = [clip if clip.contacts else mark_plants(clip) for clip in clips]
    step = 2 / (len(feet) - 1) / FINE
    margin_phases = round((TUNED.margin if margin is None else margin) * FINE)
    grid = np.asarray(np.arange(-margin_phases, round(1 / step) + margin_phases + 1) * step, float)
    cut = partial(_example_frames, feet=feet, label=label, grid=grid, is_shortest=margin is None)
    candidates = [(clip, frames) for clip in clips for frames in cut(clip)]
    cuts = [(clip, frames) for clip, frames in candidates if frames is not None]
    dropped = len(candidates) - len(cuts)
    if not cuts:
        wanted = f"'{feet}' labelled '{label}'" if label else f"'{feet}'"
        room = "half a stride" if margin else f"{LEAST_MARGIN / clips[0].fps:.2g} s"
        strikes = f"{len(feet)} foot strikes in a row, and {room} on either side"
        left_out = f"{dropped} were left out"
        raise MocapError(f"No example of {wanted} in {len(clips)} clips; {left_out}: add one with {strikes}.")
    if by == "curves":
        cuts = register_cuts(cuts, (0, -1))
    return _calibrated(sample_cuts(cuts, grid, dropped=dropped), steps=feet != STRIDE)


class _Strike(NamedTuple):
    """A foot strike: a frame and the foot, "l" or "r"."""

    frame: int
    foot: str


def _example_frames(
    clip: Motion, feet: str, label: str, grid: Array, is_shortest: bool = False
) -> Iterator[Array | None]:
    """Yield the frames (G,) of each example at the phases of a grid, or None for an unusable example.

    With `is_shortest`, the margins are the shortest that transitions need.
    """
    strikes = _strikes(clip)
    frames_at = _frames_with_shortest_margins if is_shortest else _frames_at
    count = len(feet)
    labelled = clip.labels[label] if label in clip.labels else np.full(len(clip), not label)
    for first in range(len(strikes) - count + 1):
        start = strikes[first]
        last = strikes[first + count - 1]
        if start.foot == feet[0] and labelled[start.frame : last.frame + 1].all():
            frames = frames_at(grid, strikes, first, feet, clip.fps)
            is_inside = frames is not None and frames[0] >= 0 and frames[-1] <= len(clip) - 1
            yield frames if is_inside else None


def _strikes(clip: Motion) -> list[_Strike]:
    """Find the foot strikes. A footplant in the first frame is left out, because it began earlier."""
    left_ankle, right_ankle = (clip.skeleton.names[leg.ankle] for leg in find_legs(clip.skeleton))
    missing = [name for name in (left_ankle, right_ankle) if name not in clip.contacts]
    if missing:
        raise MocapError(f"'{clip.name}' does not say when {missing[0]} stands; mark_plants finds out.")
    strikes = []
    for name, foot in ((left_ankle, "l"), (right_ankle, "r")):
        starts = runs(clip.contacts[name])[:, 0].tolist()
        strikes += [_Strike(frame, foot) for frame in starts if frame > 0]
    return sorted(strikes)


def _frames_at(grid: Array, strikes: Sequence[_Strike], first: int, feet: str, fps: float) -> Array | None:
    """Interpolate the frames (G,) of the example that starts at a strike, or return None for other `feet`.

    The margins extend to the strikes before and after, or, without these, by the duration of the next step.
    """
    frames = _strike_frames(strikes, first, feet, fps)
    if frames is None:
        return None
    steps = np.diff(frames)
    stop = first + len(feet)
    shortest, longest = (seconds * fps for seconds in TUNED.step_seconds)
    previous = frames[0] - strikes[first - 1].frame if first else 0.0
    following = strikes[stop].frame - frames[-1] if stop < len(strikes) else 0.0
    first_margin = previous if shortest <= previous <= longest else steps[0]
    last_margin = following if shortest <= following <= longest else steps[-1]
    phases = np.arange(-1, len(feet) + 1) / (len(feet) - 1)
    extended = [frames[0] - first_margin, *frames, frames[-1] + last_margin]
    return np.asarray(np.interp(grid, phases, extended))


def _frames_with_shortest_margins(
    grid: Array, strikes: Sequence[_Strike], first: int, feet: str, fps: float
) -> Array | None:
    """Interpolate the frames (G,) as `_frames_at`, with the shortest margins that transitions need."""
    frames = _strike_frames(strikes, first, feet, fps)
    if frames is None:
        return None
    phases = np.arange(len(feet)) / (len(feet) - 1)
    return np.asarray(np.interp(grid, *margin_knots(grid, phases.tolist(), frames.tolist())))


def _strike_frames(strikes: Sequence[_Strike], first: int, feet: str, fps: float) -> Array | None:
    """Return the frames of the strikes of an example (K,), or None for other `feet` and other durations."""
    example = strikes[first : first + len(feet)]
    frames = np.array([strike.frame for strike in example], float)
    steps = np.diff(frames)
    shortest, longest = (seconds * fps for seconds in TUNED.step_seconds)
    order = "".join(strike.foot for strike in example)
    if order != feet or steps.min() < shortest or steps.max() > longest:
        return None
    return frames


def _calibrated(strides: Examples, *, steps: bool) -> Examples:
    """Subtract the turn of a straight step, and measure the direction of travel relative to the heading."""
    values = strides.values.copy()
    sway = 0.0
    if steps:
        calm = np.abs(values[:, 0] - np.median(values[:, 0])) < TUNED.calm
        sway = float(np.median(values[calm, 0]))
        values[:, 0] -= sway
    straight = (np.abs(values[:, 0]) < TUNED.straight) & (values[:, 1] > TUNED.straight_speed)
    ground, _ = mixed_trajectory(strides, np.eye(len(values))[straight])
    directions = np.angle(np.diff(ground[:, strides.ends], axis=1))
    offset = float(np.median(directions)) if straight.any() else 0.0
    return replace(strides, values=values, sway=sway, offset=offset)
