"""Strides and steps cut out of clips, all on one grid of phases.

A stride runs from a strike of one foot to the next strike of the same foot, a step to that of the other. On
the grid the strikes lie at even phases from 0 to 1, so that phase for phase all examples do the same; a
margin on either side leaves room for the windows of transitions. The ground is left out: velocities and
turning are as the body sees them, so that examples can be mixed.

Notebook: 17-parametric-graphs
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Mask, Points, runs
from mocap.blending.registering import register
from mocap.body import rotations
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import heading, on_ground
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import distinct_joints

STRIDE, LEFT_STEP, RIGHT_STEP = "lrl", "lr", "rl"
MARGIN, WIDEST = 0.38, 0.5  # of a stride, before the first and after the last strike
FINE = 60  # phases per stride
STEP_LASTS = (0.23, 1.0)  # seconds, from strike to strike; others are no steps of a walk or run
STRAIGHT, GOES = np.radians(20), 0.3  # a stride that turns by less, and goes faster, m/s


@dataclass(frozen=True, eq=False)
class Strides:
    """N examples on one grid of G phases; `cut_strides` makes them.

    Parameters
    ----------
    skeleton, fps : of the clips.
    grid : shape (G,), phases; the first strike is at 0, the last at 1.
    seconds : shape (N, G), since the first strike: the time warp.
    speeds : shape (N, G), complex, metres of ground per phase as seen from the body.
    turning : shape (N, G), radians per phase.
    heights : shape (N, G), of the root, metres.
    poses : shape (N, G, J, 4), the root's without its heading.
    contacts : shape (N, G, C), and `contact_names`, C of them.
    values : shape (N, 2), the turn in radians and the speed in m/s.
    sway : radians that the pelvis turns on a straight example without turning: 0 for strides.
    offset : radians from where the body faces at a strike to where it goes; 0 where no example goes straight.
    dropped : examples that were left out.
    """

    skeleton: Skeleton
    fps: float
    grid: Array
    seconds: Array
    speeds: Points
    turning: Array
    heights: Array
    poses: Array
    contacts: Array
    contact_names: tuple[str, ...]
    values: Array
    sway: float = 0.0
    offset: float = 0.0
    dropped: int = 0

    def __len__(self) -> int:
        return len(self.values)

    @cached_property
    def joints(self) -> list[int]:
        """The joints that windows are compared by, each place once."""
        return distinct_joints(self.skeleton)

    @property
    def ends(self) -> tuple[int, int]:
        """The numbers of phases 0 and 1 on the grid."""
        first, last = np.searchsorted(self.grid, [-1e-9, 1 - 1e-9])
        return int(first), int(last)

    def take(self, which: Mask) -> "Strides":
        """Keep some of the examples."""
        if not np.any(which):
            raise MocapError(f"None of {len(self)} examples is left.")
        parts = ("seconds", "speeds", "turning", "heights", "poses", "contacts", "values")
        return replace(self, **{part: getattr(self, part)[which] for part in parts})

    def integrated(self, rates: NDArray[Any]) -> NDArray[Any]:
        """Integrate rates (M, G) over the phases, from the first strike on."""
        step, zero = self.grid[1] - self.grid[0], self.ends[0]
        total = np.cumsum((rates[:, 1:] + rates[:, :-1]) / 2 * step, axis=1)
        total = np.concatenate([np.zeros((len(rates), 1)), total], axis=1)
        return np.asarray(total - total[:, zero : zero + 1])

    def require_joinable(self, other: "Strides") -> None:
        """Raise SkeletonMismatch or MocapError for examples of another skeleton, rate or marks."""
        self.skeleton.require_same(other.skeleton)
        if self.fps != other.fps:
            raise MocapError(f"Strides are joined at one rate, got {self.fps:g} and {other.fps:g} Hz.")
        if odd := set(self.contact_names) ^ set(other.contact_names):
            raise MocapError(f"Strides are joined with the same marks; some of them lack {min(odd)}.")


def cut_strides(
    clips: Sequence[Motion],
    *,
    feet: str = STRIDE,
    by: str = "strikes",
    label: str = "",
    margin: float = MARGIN,
) -> Strides:
    """Cut clips at the strikes of their feet, and put all examples on one grid of phases [HG07, examples].

    Parameters
    ----------
    clips : of one skeleton and rate; feet that are not marked are marked by `feet.mark_plants`.
    feet : which strikes an example runs over: "lrl" for strides, "lr" and "rl" for steps.
    by : "strikes" makes time even between strikes [ours]; "curves" registers all examples with the one of
        median turn by registration curves [KG03], as the paper does.
    label : keep examples of which every frame has this label; "" for all.
    margin : of a stride, kept at both ends for the windows of transitions; quick strides need 0.5, the most.

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
    if feet not in (STRIDE, LEFT_STEP, RIGHT_STEP):
        raise MocapError(f"Examples run over the strikes 'lrl', 'lr' or 'rl', got '{feet}'.")
    if by not in ("strikes", "curves"):
        raise MocapError(f"Examples are put on one clock by 'strikes' or by 'curves', got '{by}'.")
    if not 0 < margin <= WIDEST:
        raise MocapError(f"A margin is above 0 and at most {WIDEST} of a stride, got {margin}.")
    if not clips:
        raise MocapError("Strides are cut out of one clip or more, got none.")
    require_alike(clips)
    clips = [clip if clip.contacts else mark_plants(clip) for clip in clips]
    step, beyond = 2 / (len(feet) - 1) / FINE, round(margin * FINE)
    grid = np.asarray(np.arange(-beyond, round(1 / step) + beyond + 1) * step, float)
    tried = [(clip, frames) for clip in clips for frames in _examples(clip, feet, label, grid)]
    found = [(clip, frames) for clip, frames in tried if frames is not None]
    dropped = len(tried) - len(found)
    if not found:
        what = f"'{feet}' labelled '{label}'" if label else f"'{feet}'"
        raise MocapError(f"No example of {what} in {len(clips)} clips; {dropped} were left out.")
    found = _registered(found) if by == "curves" else found
    return _calibrated(_tabled(found, grid, dropped), steps=feet != STRIDE)


def _strikes(clip: Motion) -> list[tuple[int, str]]:
    """List the frames at which feet come down, with the foot; a plant at the start began earlier."""
    left, right = (clip.skeleton.names[leg.ankle] for leg in find_legs(clip.skeleton))
    missing = [name for name in (left, right) if name not in clip.contacts]
    if missing:
        raise MocapError(f"'{clip.name}' does not say when {missing[0]} stands; mark_plants finds out.")
    events = [
        (int(f), foot) for name, foot in ((left, "l"), (right, "r")) for f in runs(clip.contacts[name])[:, 0]
    ]
    return sorted(event for event in events if event[0] > 0)


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
        before, after = (
            own if low <= own <= high else gap for own, gap in ((before, gaps[0]), (after, gaps[-1]))
        )
        phases = np.arange(-1, count + 1) / (count - 1)
        frames = np.interp(grid, phases, [at[0] - before, *at, at[-1] + after])
        yield frames if frames[0] >= 0 and frames[-1] <= len(clip) - 1 else None


def _registered(found: list[tuple[Motion, Array]]) -> list[tuple[Motion, Array]]:
    """Put the frames of all examples on the clock of the one whose turn is the median [KG03]."""
    clips = [clip[int(frames[0]) : int(np.ceil(frames[-1])) + 1] for clip, frames in found]
    turns = [float(np.ptp(np.unwrap(heading(clip.rotations[:, 0])))) for clip in clips]
    middle, fps = int(np.argsort(turns)[len(turns) // 2]), clips[0].fps
    registration = register(clips, reference=middle, slack=0.0)
    clock = (found[middle][1] - int(found[middle][1][0])) / fps
    on_clock = []
    for (whole, frames), times, clip in zip(found, registration.times, clips, strict=True):
        warped = np.clip(times(clock) * fps, 0, len(clip) - 1) + int(frames[0])
        on_clock.append((whole, np.maximum.accumulate(warped)))
    return on_clock


def _tabled(found: list[tuple[Motion, Array]], grid: Array, dropped: int) -> Strides:
    """Take the motion at the frames of all examples."""
    step, names = grid[1] - grid[0], tuple(found[0][0].contacts)
    zero, one = np.searchsorted(grid, [-1e-9, 1 - 1e-9])
    rows = []
    for clip, frames in found:
        posed = clip.at(frames)
        roots, turns = posed.root_positions, posed.rotations.copy()
        facing, ground = np.unwrap(heading(turns[:, 0])), on_ground(roots)
        turns[:, 0] = rotations.multiply(rotations.about_y(-facing), turns[:, 0])
        near = np.round(frames).astype(int)
        contact = np.stack([clip.contacts[name][near] for name in names], axis=-1)
        clock = (frames - frames[zero]) / clip.fps
        way = np.abs(np.diff(ground[zero : one + 1])).sum() / clock[one]
        speed, spin = np.gradient(ground, step) * np.exp(-1j * facing), np.gradient(facing, step)
        rows.append((clock, speed, spin, roots[:, 1], turns, contact, [facing[one] - facing[zero], way]))
    seconds, speeds, turning, heights, poses, contacts, values = map(np.array, zip(*rows, strict=True))
    poses[0] = rotations.continuous(poses[0])  # one sign from phase to phase, and for all examples
    poses *= np.where((poses * poses[0]).sum(axis=-1, keepdims=True) < 0, -1, 1)
    own = (clip.skeleton, clip.fps, grid, seconds, speeds, turning, heights, poses, contacts, names, values)
    return Strides(*own, dropped=dropped)


def _calibrated(strides: Strides, *, steps: bool) -> Strides:
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


def mixed_way(strides: Strides, weights: Array) -> tuple[Points, Array]:
    """Mix velocities as the body sees them, and integrate: θ(u) = ∫ Σ w θ', p(u) = ∫ Σ w v e^{iθ} [ours].

    Places mixed instead would shorten a half left, half right stride of 90° by a third.

    Parameters
    ----------
    strides : N examples.
    weights : shape (M, N), of M mixes.

    Returns
    -------
    The ground (M, G), complex, and the heading (M, G), both 0 at the first strike.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> ground, heading = mixed_way(strides, np.eye(len(strides))[:2])
    >>> ground.shape == heading.shape == (2, len(strides.grid))
    True
    """
    facing = strides.integrated(weights @ strides.turning)
    return strides.integrated((weights @ strides.speeds) * np.exp(1j * facing)), facing
