"""Strides and steps cut out of clips, all on one grid of phases.

A stride runs from a strike of one foot to the next strike of the same foot, a step to that of the other. On
the grid the strikes lie at even phases from 0 to 1, so that phase for phase all examples do the same.

Notebook: 17-parametric-graphs
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.methods.parametric_graphs.examples import FINE, MARGIN, Examples, mixed_way, on_one_clock, tabled

STRIDE = "lrl"
STEP_LASTS = (0.23, 1.0)  # seconds, from strike to strike; others are no steps of a walk or run
STRAIGHT, GOES = np.radians(20), 0.3  # a stride that turns by less, and goes faster, m/s


def cut_strides(
    clips: Sequence[Motion],
    *,
    feet: str = STRIDE,
    by: str = "strikes",
    label: str = "",
    margin: float = MARGIN,
) -> Examples:
    """Cut clips at the strikes of their feet, and put all examples on one grid of phases [HG07, examples].

    Parameters
    ----------
    clips : of one skeleton and rate; feet that are not marked are marked by `feet.mark_plants`.
    feet : which strikes an example runs over: "lrl" for strides, "lr" and "rl" for steps.
    by : "strikes" makes time even between strikes [ours]; "curves" registers all examples with the one of
        median turn by registration curves [KG03], as the paper does.
    label : keep examples of which every frame has this label; "" for all.
    margin : of a stride, kept at both ends for the windows of transitions; quick strides need 0.5.

    Returns
    -------
    The examples, but those with other strikes between, steps outside 0.23 to 1 s, or too near a clip's end.

    Raises
    ------
    MocapError : for no clips, settings that are none of these, and where no example is found.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> len(strides) > 10, np.degrees(np.abs(strides.values[:, 0])).max().round() < 90
    (True, np.True_)
    """
    if by not in ("strikes", "curves"):
        raise MocapError(f"Examples are put on one clock by 'strikes' or by 'curves', got '{by}'.")
    if not clips:
        raise MocapError("Examples are cut out of one clip or more, got none.")
    clips = require_alike(clips)
    clips = [clip if clip.contacts else mark_plants(clip) for clip in clips]
    step, beyond = 2 / (len(feet) - 1) / FINE, round(margin * FINE)
    grid = np.asarray(np.arange(-beyond, round(1 / step) + beyond + 1) * step, float)
    tried = [(clip, frames) for clip in clips for frames in _examples(clip, feet, label, grid)]
    found = [(clip, frames) for clip, frames in tried if frames is not None]
    dropped = len(tried) - len(found)
    if not found:
        what = f"'{feet}' labelled '{label}'" if label else f"'{feet}'"
        raise MocapError(f"No example of {what} in {len(clips)} clips; {dropped} were left out.")
    found = on_one_clock(found, (0, -1)) if by == "curves" else found
    return _calibrated(tabled(found, grid, dropped=dropped), steps=feet != STRIDE)


def _strikes(clip: Motion) -> list[tuple[int, str]]:
    """List the frames at which feet come down, with the foot; a plant at the start began earlier."""
    left, right = (clip.skeleton.names[leg.ankle] for leg in find_legs(clip.skeleton))
    if missing := [name for name in (left, right) if name not in clip.contacts]:
        raise MocapError(f"'{clip.name}' does not say when {missing[0]} stands; mark_plants finds out.")
    starts = {foot: runs(clip.contacts[name])[:, 0].tolist() for name, foot in ((left, "l"), (right, "r"))}
    return sorted((frame, foot) for foot, frames in starts.items() for frame in frames if frame > 0)


def _examples(clip: Motion, feet: str, label: str, grid: Array) -> Iterator[Array | None]:
    """Yield the frames (G,) of each example at the phases of a grid; None for one that is no use."""
    events, count = _strikes(clip), len(feet)
    low, high = (seconds * clip.fps for seconds in STEP_LASTS)
    named = clip.labels[label] if label in clip.labels else np.full(len(clip), not label)
    for first in range(len(events) - count + 1):
        at = np.array([frame for frame, _ in events[first : first + count]], float)
        order = "".join(foot for _, foot in events[first : first + count])
        if order[0] != feet[0] or not named[int(at[0]) : int(at[-1]) + 1].all():
            continue
        gaps = np.diff(at)
        if order != feet or gaps.min() < low or gaps.max() > high:
            yield None
            continue
        before = at[0] - events[first - 1][0] if first else 0.0
        after = events[first + count][0] - at[-1] if first + count < len(events) else 0.0
        pairs = (before, gaps[0]), (after, gaps[-1])
        before, after = (own if low <= own <= high else gap for own, gap in pairs)
        phases = np.arange(-1, count + 1) / (count - 1)
        frames = np.interp(grid, phases, [at[0] - before, *at, at[-1] + after])
        yield frames if frames[0] >= 0 and frames[-1] <= len(clip) - 1 else None


def _calibrated(strides: Examples, *, steps: bool) -> Examples:
    """Take off what a straight step turns, and measure where the way leads beside where the body faces."""
    values, sway = strides.values.copy(), 0.0
    if steps:
        calm = np.abs(values[:, 0] - np.median(values[:, 0])) < np.radians(15)
        sway = float(np.median(values[calm, 0]))
        values[:, 0] -= sway
    straight = (np.abs(values[:, 0]) < STRAIGHT) & (values[:, 1] > GOES)
    ground, _ = mixed_way(strides, np.eye(len(values))[straight])
    ways = np.angle(np.diff(ground[:, strides.ends], axis=1))
    offset = float(np.median(ways)) if straight.any() else 0.0
    return replace(strides, values=values, sway=sway, offset=offset)
