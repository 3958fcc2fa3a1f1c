"""N examples of one action on one grid of phases, so that phase for phase all of them do the same.

A margin on either side of the action leaves room for the windows of transitions. The ground is left out:
velocities and turning are as the body sees them, so that examples can be mixed.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import dataclass
from mocap.blending.registering import register
from mocap.body import rotations
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import heading, on_ground
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import distinct_joints

MARGIN = 0.38  # of an action, before and after it
FINE = 60  # phases per stride
Cut = tuple[Motion, Array]  # a clip, and its frames (G,) at the phases of a grid


@dataclass(frozen=True, eq=False)
class Examples:
    """N examples of one action on one grid of G phases; `cut_strides` and `cut_actions` make them.

    Parameters
    ----------
    skeleton, fps : of the clips.
    grid : shape (G,), phases; the action, such as a stride, begins at 0 and ends at 1.
    seconds : shape (N, G), since the action began: the time warp.
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

    def take(self, which: Mask | Indices) -> "Examples":
        """Keep some of the examples."""
        if not len(self.values[which]):
            raise MocapError(f"None of {len(self)} examples is left.")
        parts = ("seconds", "speeds", "turning", "heights", "poses", "contacts", "values")
        return replace(self, **{part: getattr(self, part)[which] for part in parts})

    def integrated(self, rates: NDArray[Any]) -> NDArray[Any]:
        """Integrate rates (M, G) over the phases, from phase 0 on.

        Examples
        --------
        >>> from mocap import body, datasets
        >>> from mocap.methods.parametric_graphs.strides import cut_strides
        >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
        >>> rates = np.array([np.ones(107), 2 * strides.grid])
        >>> strides.ends, strides.integrated(rates)[:, [0, 23, 53, 83, 106]].round(2).tolist()
        ((23, 83), [[-0.38, 0.0, 0.5, 1.0, 1.38], [0.15, 0.0, 0.25, 1.0, 1.91]])
        """
        step, zero = self.grid[1] - self.grid[0], self.ends[0]
        total = np.cumsum((rates[:, 1:] + rates[:, :-1]) / 2 * step, axis=1)
        total = np.concatenate([np.zeros((len(rates), 1)), total], axis=1)
        return np.asarray(total - total[:, zero : zero + 1])

    def blend(self, weights: Array) -> Motion:
        """Blend the action by weights (N,): one frame per phase from 0 to 1, as long as the mix takes.

        Examples
        --------
        A foot stands where it does in more than half of the mix, here in both:

        >>> from mocap import body, datasets
        >>> from mocap.methods.parametric_graphs.strides import cut_strides
        >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
        >>> blend = strides.blend(np.eye(len(strides))[[0, 2]].mean(axis=0))
        >>> len(blend), round(blend.duration, 3), strides.seconds[[0, 2], 83].round(3).tolist()
        (61, 1.1, [1.1, 1.1])
        >>> one, other = strides.contacts[[0, 2], 23:84, 0]
        >>> one.sum().tolist(), other.sum().tolist(), blend.contacts["lfoot"].sum().tolist()
        (12, 13, 12)
        """
        zero, one = self.ends
        rate = (one - zero) / float(weights @ self.seconds[:, one])
        return self.motion(weights, np.arange(zero, one + 1.0), rate)[0]

    def motion(self, weights: Array, places: Array, fps: float) -> tuple[Motion, Array]:
        """Blend by weights (N,) at F places between the G phases: the motion, and its heading (F,)."""
        (roots,), (turns,), (facing,) = self.mixed(weights[None], places[None])
        marks = np.tensordot(weights, self.contacts[:, np.rint(places).astype(int)], 1) > 0.5
        contacts = dict(zip(self.contact_names, marks.T, strict=True))
        return Motion(self.skeleton, roots, turns, fps, "blend", contacts=contacts), facing

    def mixed(self, weights: Array, places: Array) -> tuple[Array, Array, Array]:
        """Mix M poses at F places between the G phases: roots (M, F, 3), rotations, headings (M, F).

        The pose is a normalised sum of quaternions of one sign; heights are sums; the root's velocities are
        mixed as the body sees them [ours], and integrated.

        Parameters
        ----------
        weights : shape (M, N).
        places : shape (M, F), from 0 to G - 1.

        Examples
        --------
        Half of a stride that turns by 77° to the left, and half of one by 41° to the right:

        >>> from mocap import body, datasets
        >>> from mocap.methods.parametric_graphs.strides import cut_strides
        >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
        >>> weights, places = np.eye(len(strides))[[0, 2]].mean(axis=0), np.array([23, 53.25, 83, 106])
        >>> roots, turns, headings = strides.mixed(weights[None], places[None])
        >>> np.degrees(headings[0]).round().tolist()
        [0.0, 13.0, 34.0, 74.0]
        >>> roots[0].round(2).tolist()
        [[0.0, 0.99, 0.0], [0.03, 0.99, 0.52], [0.22, 1.0, 1.01], [0.52, 0.98, 1.24]]
        >>> np.linalg.norm(turns, axis=-1).round(9).tolist() == np.ones((1, 4, 38)).tolist()
        True
        """
        low = np.clip(places.astype(int), 0, len(self.grid) - 2)
        share, row, used = places - low, np.arange(len(weights))[:, None], np.flatnonzero(weights.any(axis=0))
        ground, facing = mixed_way(self, weights)
        ground, facing, heights = (
            part[row, low] * (1 - share) + part[row, low + 1] * share
            for part in (ground, facing, weights @ self.heights)
        )
        first, some = low.min(), self.poses[used, low.min() : low.max() + 2]
        poses = (weights[:, used] @ some.reshape(len(used), -1)).reshape(-1, *some.shape[1:])
        amount = share[..., None, None]
        turns = poses[row, low - first] * (1 - amount) + poses[row, low - first + 1] * amount
        turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
        turns[:, :, 0] = rotations.multiply(rotations.about_y(facing), turns[:, :, 0])
        return np.stack([ground.imag, heights, ground.real], axis=-1), turns, facing

    def require_joinable(self, other: "Examples") -> None:
        """Raise SkeletonMismatch or MocapError for examples of another skeleton, rate or marks."""
        self.skeleton.require_same(other.skeleton)
        if self.fps != other.fps:
            raise MocapError(f"Examples are joined at one rate, got {self.fps:g} and {other.fps:g} Hz.")
        if odd := set(self.contact_names) ^ set(other.contact_names):
            raise MocapError(f"Examples are joined with the same marks; some of them lack {min(odd)}.")


def on_one_clock(found: Sequence[Cut], within: tuple[int, int]) -> list[Cut]:
    """Put the frames of all examples on the clock of the one whose turn is the median [KG03].

    They are registered from the one to the other of two phases, by their numbers. Outside each clip goes on
    at its own pace: around punches, say, the examples are not one action any more.
    """
    first, last = within
    ends = [(int(frames[first]), int(np.ceil(frames[last]))) for _, frames in found]
    parts = [clip[a : b + 1] for (clip, _), (a, b) in zip(found, ends, strict=True)]
    turns = [float(np.ptp(np.unwrap(heading(part.rotations[:, 0])))) for part in parts]
    middle = int(np.argsort(turns)[len(turns) // 2])
    clock = (found[middle][1] - ends[middle][0]) / parts[0].fps  # seconds of the reference
    inner = np.clip(clock, 0, parts[middle].duration)
    times = register(parts, reference=middle, slack=0.0).times
    rows = []
    for (clip, _), (start, _), own in zip(found, ends, times, strict=True):
        warped = own(inner) + clock - inner
        rows.append((clip, np.clip(start + warped * clip.fps, 0, len(clip) - 1)))
    return rows


def cut_actions(clips: Sequence[Motion], spans: Sequence[tuple[int, int]]) -> Examples:
    """Cut one action out of each clip, register them, and put all on one grid of phases [HG07, examples].

    At both ends 0.38 of the action is kept for the windows of transitions, which take 0.3 s.

    Parameters
    ----------
    clips : one for each example, of one skeleton and rate; feet that are not marked are marked.
    spans : for each clip the frames at which the action begins and ends.

    Raises
    ------
    MocapError : for no clips, spans that are not one for each clip, and a margin that runs off a clip.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> walk = body.resample(datasets.sample("walk_straight"), 30)
    >>> cut = cut_actions([walk, walk, walk], [(23, 83), (100, 136), (194, 254)])
    >>> cut.grid[[0, -1]].round(2).tolist(), cut.dropped, cut.sway, cut.offset
    ([-0.38, 1.38], 0, 0.0, 0.0)
    >>> cut.seconds[:, [0, *cut.ends, -1]].round(2).tolist()
    [[-0.69, 0.0, 2.05, 2.81], [-0.77, 0.0, 1.14, 1.91], [-0.77, 0.0, 2.0, 2.77]]
    """
    if len(spans) != len(clips):
        raise MocapError(f"Actions are cut by one span for each clip, got {len(clips)} and {len(spans)}.")
    clips = require_alike(clips)
    margin = round(MARGIN * FINE)
    grid = np.arange(-margin, FINE + margin + 1) / FINE
    found = []
    for clip, (first, last) in zip(clips, spans, strict=True):
        frames = first + grid * (last - first)
        if not (first < last and frames[0] >= 0 and frames[-1] <= len(clip) - 1):
            action = f"an action from {first} to {last} with its margins takes those"
            beyond = f"{action} from {frames[0]:.0f} to {frames[-1]:.0f}"
            raise MocapError(f"'{clip.name}' has {len(clip)} frames; {beyond}: leave it more room, or out.")
        found.append((clip if clip.contacts else mark_plants(clip), frames))
    return tabled(on_one_clock(found, (margin, margin + FINE)), grid)


def tabled(found: Sequence[Cut], grid: Array, *, dropped: int = 0) -> Examples:
    """Take the motion at the frames (G,) of each clip."""
    step, names = grid[1] - grid[0], tuple(found[0][0].contacts)
    zero, one = np.searchsorted(grid, [-1e-9, 1 - 1e-9])
    rows = []
    for clip, frames in found:
        posed = clip.at(frames)
        roots, turns = posed.root_positions, posed.rotations.copy()
        facing, ground = np.unwrap(heading(turns[:, 0])), on_ground(roots)
        turns[:, 0] = rotations.multiply(rotations.about_y(-facing), turns[:, 0])
        near = np.round(frames).astype(int)
        contact = np.stack([clip.contacts[name][near] for name in names], axis=1)
        clock = (frames - frames[zero]) / clip.fps
        way = np.abs(np.diff(ground[zero : one + 1])).sum() / clock[one]
        speed, spin = np.gradient(ground, step) * np.exp(-1j * facing), np.gradient(facing, step)
        rows.append((clock, speed, spin, roots[:, 1], turns, contact, [facing[one] - facing[zero], way]))
    seconds, speeds, turning, heights, poses, contacts, values = map(np.array, zip(*rows, strict=True))
    poses[0] = rotations.continuous(poses[0])  # one sign from phase to phase, and for all examples
    poses *= np.where((poses * poses[0]).sum(axis=-1, keepdims=True) < 0, -1, 1)
    own = (clip.skeleton, clip.fps, grid, seconds, speeds, turning, heights, poses, contacts, names, values)
    return Examples(*own, dropped=dropped)


def mixed_way(examples: Examples, weights: Array) -> tuple[Points, Array]:
    """Mix velocities as the body sees them, and integrate: θ(u) = ∫ Σ w θ', p(u) = ∫ Σ w v e^{iθ} [ours].

    Places mixed instead would shorten a half left, half right stride of 90° by a third.

    Parameters
    ----------
    examples : N of them.
    weights : shape (M, N), of M mixes.

    Returns
    -------
    The ground (M, G), complex, and the heading (M, G), both 0 at phase 0.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> ground, heading = mixed_way(strides, np.eye(len(strides))[:1])
    >>> zero, one = strides.ends
    >>> np.degrees(heading[0, [zero, one]]).round().tolist(), ground[0, [zero, one]].round(2).tolist()
    ([0.0, 86.0], [0j, (0.61+0.63j)])

    Notebook: 17-parametric-graphs
    """
    facing = examples.integrated(weights @ examples.turning)
    return examples.integrated((weights @ examples.speeds) * np.exp(1j * facing)), facing
