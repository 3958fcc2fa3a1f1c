"""Strides and steps cut out of clips, all on one grid of phases.

A stride runs from a strike of one foot to the next strike of the same foot, a step to that of the other. On
the grid the strikes lie at even phases from 0 to 1, so that phase for phase all examples do the same.

Notebook: 17-parametric-graphs
"""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Indices, runs
from mocap._shared.easing import quintic_step
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from mocap.methods.parametric_graphs.examples import FINE, MARGIN, Examples, mixed_way, on_one_clock, tabled
from mocap.methods.parametric_graphs.stride_spaces import measure_mixes

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
    >>> len(strides), strides.dropped
    (27, 2)
    >>> turn, speed = strides.values[0]
    >>> round(np.degrees(turn)), float(speed.round(2)), strides.seconds[0, strides.ends].round(2).tolist()
    (86, 0.9, [0.0, 1.1])
    """
    if by not in ("strikes", "curves"):
        raise MocapError(f"Examples are put on one clock by 'strikes' or by 'curves', got '{by}'.")
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


def _examples(clip: Motion, feet: str, label: str, grid: Array) -> Iterator[Array | None]:
    """Yield the frames (G,) of each example at the phases of a grid; None for one that is no use.

    Examples
    --------
    Steps before and after a stride are as long as its own, where no strike tells. All must be in the clip:

    >>> from mocap import body, datasets
    >>> clip = body.resample(datasets.sample("walk_straight"), 30)[:61]
    >>> def strides(left, right, last=60):
    ...     marks = {"lfoot": np.isin(np.arange(61), left), "rfoot": np.isin(np.arange(61), right)}
    ...     marked = replace(clip, contacts=marks, labels={"walk": np.arange(61) <= last})
    ...     found = _examples(marked, "lrl", "walk", np.array([-0.5, 0, 0.25, 1, 1.5]))
    ...     return [None if frames is None else frames.tolist() for frames in found]
    >>> strides([15, 45], [30]), strides([0, 14, 44], [29]), strides([16, 46], [31])
    ([[0.0, 15.0, 22.5, 45.0, 60.0]], [None], [None])
    >>> strides([3, 14, 40], [27])  # limping
    [None, [3.0, 14.0, 20.5, 40.0, 53.0]]

    A step takes 0.23 to 1 s, at 30 Hz 7 to 30 frames. The label must be there up to the last strike:

    >>> strides([10, 40], [3, 33, 47]), strides([10, 39], [3, 33, 46])
    ([[3.0, 10.0, 21.5, 40.0, 47.0]], [None])
    >>> strides([10, 47], [3, 17, 54], last=47), strides([10, 48], [3, 17, 55])
    ([[3.0, 10.0, 13.5, 47.0, 54.0]], [None])
    >>> strides([10, 47], [3, 17, 54], last=46)
    []
    >>> strides([31, 45], [1, 38, 53]), strides([32, 46], [1, 39, 53])
    ([[1.0, 31.0, 34.5, 45.0, 53.0]], [[25.0, 32.0, 35.5, 46.0, 53.0]])
    """
    left, right = (clip.skeleton.names[leg.ankle] for leg in find_legs(clip.skeleton))
    if missing := [name for name in (left, right) if name not in clip.contacts]:
        raise MocapError(f"'{clip.name}' does not say when {missing[0]} stands; mark_plants finds out.")
    starts = ((foot, runs(clip.contacts[name])[:, 0].tolist()) for name, foot in ((left, "l"), (right, "r")))
    # The frames at which feet come down, with the foot; a plant at the start began earlier.
    events = sorted((frame, foot) for foot, frames in starts for frame in frames if frame > 0)
    count = len(feet)
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


FROM, TO = 0.2, 0.8  # phases between which a change takes place
STEP = (0.05, 0.95)  # phases between which feet step to their new places: seams blend what is beyond
NEAR = np.radians(5)  # a turn that the other kind nearly has
EXAMPLES = 60  # of a change, at most


def changing_strides(first: Examples, second: Examples, *, stands: str = "") -> Examples:
    """Fade strides of one kind into strides of another, phase by phase [ours; KG03's transition on phases].

    Each stride of the first kind is paired with the one of the second that turns most like it. Between the
    phases 0.2 and 0.8 all rates and poses go from the one to the other, with level ends; so its start fits
    what follows the first kind, and its end what comes before the second. A foot goes from where it stands in
    the first to where it stands in the second while it swings, and rests before and after.

    Parameters
    ----------
    first, second : examples over the same phases, of one skeleton and rate.
    stands : "first" or "second" for examples that do not walk, such as punches: of them only the beginning
        or the end is in the change, and pairs need not turn alike.

    Returns
    -------
    At most 60 examples, of turns that both kinds have; without pairs of which some foot does not swing.

    Raises
    ------
    MocapError, SkeletonMismatch : for examples over other phases, and of other skeletons or rates; for steps,
        in which one foot stands.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.body import resample
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> kinds = [cut_strides([resample(sample(f"walk_6m_{speed}_0"), 30)]) for speed in (0.7, 1.65)]
    >>> speeds = [kind.values[:, 1].mean() for kind in (kinds[0], changing_strides(*kinds), kinds[1])]
    >>> np.round(speeds, 2).tolist()
    [0.7, 1.08, 1.7]
    """
    if len(first.grid) != len(second.grid) or not np.allclose(first.grid, second.grid):
        raise MocapError("A change goes between examples over the same phases.")
    first.require_joinable(second)
    one, other = _pairs(first, second, any_turn=bool(stands))
    first, second = first.take(one), second.take(other)
    first = _held(first, -1, FROM) if stands == "first" else first
    second = _held(second, TO, 2) if stands == "second" else second
    shares = _shares(first, second)
    if not (steps := np.flatnonzero(np.isfinite(shares).all(axis=(1, 2)))).size:
        raise MocapError("In a change each foot swings, but in none of the pairs: cut strides, not steps.")
    first, second, shares = first.take(steps), second.take(steps), shares[steps]
    made = _stepped(_faded(first, second, shares), first, second, shares)
    return replace(made, values=measure_mixes(made, np.eye(len(made))))


def _shares(first: Examples, second: Examples) -> Array:
    """Say how far joints are faded, (N, G, J): a leg's while it swings; nan if it never does."""
    grid, (zero, one), skeleton = first.grid, first.ends, first.skeleton
    stands = np.where(grid[:, None] < 1, first.contacts, 1) * np.where(grid[:, None] > 0, second.contacts, 1)
    shares = np.tile(quintic_step((grid - FROM) / (TO - FROM))[:, None], (len(first), 1, len(skeleton)))
    for leg in find_legs(skeleton):
        foot = [first.contact_names.index(skeleton.names[joint]) for joint in leg[2:]]
        for row, (ankle, ball) in enumerate(np.moveaxis(stands[..., foot], -1, 1)):
            air = [span for span in runs(ankle < 0.5) if zero + 2 < span[1] <= one + 2]  # up to a strike
            off, on = max(air, key=np.ptp) if air else (0, 1)
            off += ball[off:on].argmin() - 1  # the ball leaves the ground last
            start, stop = np.clip(grid[[max(off, 0), on]], *STEP) if air else (np.nan, np.nan)
            shares[row, :, list(leg)] = quintic_step((grid - start) / (stop - start))
    return shares


def _faded(first: Examples, second: Examples, shares: Array) -> Examples:
    """Fade poses by the shares of joints, and all rates by the root's; what is half faded does not stand."""
    share, step = shares[..., 0], first.grid[1] - first.grid[0]
    parts = ("speeds", "turning", "heights")
    rates = {part: [getattr(some, part) for some in (first, second)] for part in parts}
    rates["seconds"] = [np.gradient(some.seconds, step, axis=1) for some in (first, second)]
    made = {part: (1 - share) * before + share * after for part, (before, after) in rates.items()}
    made["seconds"] = first.integrated(made["seconds"])  # how long a phase lasts is what fades
    apart = (first.poses * second.poses).sum(axis=-1, keepdims=True) < 0  # q and -q are one rotation
    turns = (1 - shares[..., None]) * first.poses + shares[..., None] * np.where(apart, -1, 1) * second.poses
    made["poses"] = turns / np.linalg.norm(turns, axis=-1, keepdims=True)
    feet = shares[..., [first.skeleton.index(name) for name in first.contact_names]]
    made["contacts"] = np.where(feet <= 0, first.contacts, np.where(feet >= 1, second.contacts, 0))
    middle = {part: (getattr(first, part) + getattr(second, part)) / 2 for part in ("sway", "offset")}
    return replace(first, **made, **middle, dropped=0)


def _stepped(made: Examples, first: Examples, second: Examples, shares: Array) -> Examples:
    """Lead each foot from its way in the first kind to that in the second, laid on where the change ends."""
    poses, heights, one = made.poses.copy(), made.heights.copy(), made.ends[1]
    for row, weights in enumerate(np.eye(len(made))):
        clock = np.arange(float(len(made.grid))), FINE / made.seconds[row, one]
        (moved, facing), (after, turned) = (some.motion(weights, *clock) for some in (made, second))
        turn = np.exp(1j * (facing[one] - turned[one]))
        at, there = (on_ground(some.root_positions[one]) for some in (moved, after))
        laid = PlanarTransform.from_complex(turn, at - turn * there).apply_motion(after)
        a, b = (joint_positions(some) for some in (first.motion(weights, *clock)[0], laid))
        ways = np.swapaxes(a + shares[row, ..., None] * (b - a), 0, 1)
        always = dict.fromkeys(moved.contacts, np.ones(len(made.grid), bool))
        with warnings.catch_warnings(action="ignore", category=MocapWarning):  # of feet in the air
            led = clean_up(replace(moved, contacts=always), held=dict(enumerate(ways)))
        clean = clean_up(replace(led, contacts=moved.contacts))
        turns, heights[row] = clean.rotations.copy(), clean.root_positions[:, 1]
        turns[:, 0] = rotations.multiply(rotations.about_y(-facing), turns[:, 0])
        poses[row] = turns * np.where((turns * poses[row]).sum(axis=-1, keepdims=True) < 0, -1, 1)
    return replace(made, heights=heights, poses=poses)


def _held(examples: Examples, low: float, high: float) -> Examples:
    """Let examples stand still before one phase and after another."""
    rows = np.searchsorted(examples.grid, np.clip(examples.grid, low, high) - 1e-9)
    goes = rows == np.arange(len(rows))
    held = {part: getattr(examples, part) * goes for part in ("speeds", "turning")}
    held |= {part: getattr(examples, part)[:, rows] for part in ("heights", "poses")}
    return replace(examples, **held, contacts=np.maximum(examples.contacts, ~goes[:, None]))


def _pairs(first: Examples, second: Examples, any_turn: bool) -> tuple[Indices, Indices]:
    """Pair examples of two kinds, spread over their turns: any two, or those that turn most alike.

    Examples
    --------
    Of the first kind some turn too far, by more than 5° beyond the second kind. They count where any will do:

    >>> from types import SimpleNamespace
    >>> first, second = (
    ...     SimpleNamespace(values=np.radians(turns)[:, None]) for turns in ([29, 31, -19, -21, 0], [25, -15])
    ... )
    >>> [part.tolist() for part in _pairs(first, second, any_turn=False)]
    [[2, 4, 0], [1, 1, 0]]
    >>> [part.tolist() for part in _pairs(first, second, any_turn=True)]
    [[3, 2, 4, 0, 1], [1, 0, 1, 0, 1]]
    """
    turns, others = first.values[:, 0], second.values[:, 0]
    near = any_turn | (turns >= others.min() - NEAR) & (turns <= others.max() + NEAR)
    if not (shared := np.flatnonzero(near)).size:
        raise MocapError("The two kinds have no turn in common, so that none can change into the other.")
    orders = np.argsort(turns[shared]), np.argsort(others)
    evenly = (np.linspace(0, len(order) - 1, EXAMPLES).round().astype(int) for order in orders)
    one, other = (order[np.unique(places)] for order, places in zip(orders, evenly, strict=True))
    if any_turn:
        count = min(max(len(turns), len(others)), EXAMPLES)
        return np.resize(one, count), np.resize(other, count)
    return shared[one], np.abs(turns[shared[one]][:, None] - others).argmin(axis=1)
