"""Strides and steps cut out of clips, all on one grid of phases.

A stride runs from a strike of one foot to the next strike of the same foot, a step to that of the other. On
the grid the strikes lie at even phases from 0 to 1, so that phase for phase all examples do the same.

Notebook: 17-parametric-graphs
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, runs
from mocap._shared.easing import quintic_step
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError
from mocap.feet.ankle_targets import place_plants
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
    >>> len(strides) > 10, np.degrees(np.abs(strides.values[:, 0])).max().round() < 90
    (True, np.True_)
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
    """Yield the frames (G,) of each example at the phases of a grid; None for one that is no use."""
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
NEAR = np.radians(5)  # a turn that the other kind nearly has
EXAMPLES = 60  # of a change, at most


def changing_strides(first: Examples, second: Examples, *, stands: str = "") -> Examples:
    """Fade strides of one kind into strides of another, phase by phase [ours; KG03's transition on phases].

    Each stride of the first kind is paired with the one of the second that turns most like it. Between the
    phases 0.2 and 0.8 all rates and poses go from the one to the other, with level ends; so its start fits
    what follows the first kind, and its end what comes before the second.

    Parameters
    ----------
    first, second : examples over the same phases, of one skeleton and rate.
    stands : "first" or "second" for examples that do not walk, such as punches: of them only the beginning
        or the end is in the change, each foot of the walker takes its step from there or to there, and pairs
        need not turn alike.

    Returns
    -------
    At most 60 examples, of turns that both kinds have.

    Raises
    ------
    MocapError, SkeletonMismatch : for examples over other phases, and of other skeletons or rates.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.body import resample
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> kinds = [cut_strides([resample(sample(f"walk_6m_{speed}_0"), 30)]) for speed in (0.7, 1.65)]
    >>> speeds = [kind.values[:, 1].mean() for kind in (kinds[0], changing_strides(*kinds), kinds[1])]
    >>> bool(speeds[0] < speeds[1] < speeds[2])
    True
    """
    if len(first.grid) != len(second.grid) or not np.allclose(first.grid, second.grid):
        raise MocapError("A change goes between examples over the same phases.")
    first.require_joinable(second)
    one, other = _pairs(first, second, any_turn=bool(stands))
    first, second = first.take(one), second.take(other)
    first = _held(first, -1, FROM) if stands == "first" else first
    second = _held(second, TO, 2) if stands == "second" else second
    return _stepped(first, second)


def _faded(first: Examples, second: Examples, swings: Indices, marks: Array) -> Examples:
    """Fade all rates and poses between the phases 0.2 and 0.8, but legs while they swing."""
    grid = first.grid
    apart = (first.poses * second.poses).sum(axis=-1, keepdims=True) < 0  # q and -q are one rotation
    poses = (first.poses, np.where(apart, -second.poses, second.poses))
    paces = [np.gradient(some.seconds, grid[1] - grid[0], axis=1) for some in (first, second)]
    share = quintic_step((grid - FROM) / (TO - FROM))
    shares = np.tile(share[:, None], (len(first), 1, len(first.skeleton)))
    for leg, pairs in zip(find_legs(first.skeleton), swings, strict=True):
        start, stop = grid[pairs.T[..., None]]
        shares[..., leg] = quintic_step((grid - start) / (stop - start))[..., None]

    def faded(before: NDArray[Any], after: NDArray[Any], share: Array = share) -> NDArray[Any]:
        return np.asarray((1 - share) * before + share * after)

    turns = faded(*poses, shares[..., None])
    return replace(
        first,
        speeds=faded(first.speeds, second.speeds),
        turning=faded(first.turning, second.turning),
        heights=faded(first.heights, second.heights),
        seconds=first.integrated(faded(*paces)),  # how long a phase lasts is what fades
        poses=turns / np.linalg.norm(turns, axis=-1, keepdims=True),
        contacts=marks,
        sway=(first.sway + second.sway) / 2,
        offset=(first.offset + second.offset) / 2,
        dropped=0,
    )


def _stepped(first: Examples, second: Examples) -> Examples:
    """Let each foot stand where the first kind stands until it swings, then where the second one does."""
    grid, legs, every = first.grid, find_legs(first.skeleton), np.eye(len(first))
    until, since = (grid < 1)[:, None], (grid > 0)[:, None]
    marks = np.where(until, first.contacts, 1) * np.where(since, second.contacts, 1)
    names = [[first.contact_names.index(first.skeleton.names[joint]) for joint in leg[2:]] for leg in legs]
    swings = np.array([[_swing(row, first.ends) for row in marks[..., name].max(axis=-1)] for name in names])
    made = _faded(first, second, swings, marks)
    poses, heights, contacts = made.poses.copy(), made.heights.copy(), marks.copy()
    places, (zero, one) = np.arange(len(grid)), first.ends
    for row, weights in enumerate(every):
        rate = (one - zero) / made.seconds[row, one]
        moved, facing = made.motion(weights, places, rate)
        after, turned = second.motion(weights, places, rate)
        lay = PlanarTransform(facing[one], *moved.root_positions[one, [0, 2]]) @ PlanarTransform(turned[one], *after.root_positions[one, [0, 2]]).inverse()
        ways = [joint_positions(some) for some in (first.motion(weights, places, rate)[0], lay.apply_motion(after))]
        held = {}
        for leg, (start, stop) in zip(legs, swings[:, row], strict=True):
            ankle, ball = np.where((places < (start + stop) / 2)[:, None], *(way[:, leg[2:]].transpose(1, 0, 2) for way in ways))
            stands = tuple(moved.contacts[first.skeleton.names[joint]] for joint in leg[2:])
            held |= dict(zip(leg[2:], place_plants((ankle, ball), stands, leg.lengths(first.skeleton)[2])))
        clean = clean_up(moved, held=held)
        turns = clean.rotations.copy()
        turns[:, 0] = rotations.multiply(rotations.about_y(-facing), turns[:, 0])
        poses[row] = turns * np.where((turns * poses[row]).sum(-1, keepdims=True) < 0, -1, 1)
        heights[row] = clean.root_positions[:, 1]
        contacts[row] = np.stack([clean.contacts[name] for name in first.contact_names], axis=1)
    made = replace(made, poses=poses, heights=heights, contacts=contacts)
    return replace(made, values=measure_mixes(made, every))


def _swing(stands: Array, ends: tuple[int, int]) -> tuple[int, int]:
    """Find the frames between which a foot swings that comes down at a phase in (0, 1]."""
    zero, one = ends
    found = [(max(a - 1, zero), b) for a, b in runs(stands < 0.5).tolist() if zero < b - 2 and b <= one + 2]
    return max(found, key=lambda pair: pair[1] - pair[0])


def _held(examples: Examples, low: float, high: float) -> Examples:
    """Let examples stand still before one phase and after another."""
    rows = np.searchsorted(examples.grid, np.clip(examples.grid, low, high) - 1e-9)
    goes = rows == np.arange(len(rows))
    moved = {part: getattr(examples, part) * goes for part in ("speeds", "turning")}
    stood = {part: getattr(examples, part)[:, rows] for part in ("heights", "poses")}
    return replace(examples, **moved, **stood, contacts=np.maximum(examples.contacts, ~goes[:, None]))


def _pairs(first: Examples, second: Examples, any_turn: bool) -> tuple[Indices, Indices]:
    """Pair examples of two kinds, spread over their turns: any two, or those that turn most alike."""
    turns, others = first.values[:, 0], second.values[:, 0]
    if any_turn:
        count = max(len(turns), len(others))
        return np.resize(_spread(turns), count)[:EXAMPLES], np.resize(_spread(others), count)[:EXAMPLES]
    shared = np.flatnonzero((turns >= others.min() - NEAR) & (turns <= others.max() + NEAR))
    if not len(shared):
        raise MocapError("The two kinds have no turn in common, so that none can change into the other.")
    one = shared[_spread(turns[shared])]
    return one, np.abs(turns[one][:, None] - others).argmin(axis=1)


def _spread(turns: Array) -> Indices:
    """Choose examples that are spread evenly in the order of their turns."""
    places = np.unique(np.linspace(0, len(turns) - 1, EXAMPLES).round().astype(int))
    return np.asarray(np.argsort(turns)[places])
