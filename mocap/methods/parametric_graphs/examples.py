"""N examples of one action on one grid of phases, so that corresponding events have the same phase.

A margin before and after the action leaves room for the windows of transitions. Instead of positions on the
ground, examples store velocities and rotation rates relative to the body, which can be mixed.
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
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion
from mocap.body.planar import heading, on_ground
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.matching.point_clouds import distinct_joints
from mocap.methods.parametric_graphs.tuned import TUNED

FINE = 60  # phases per stride
HALF = 5  # frames of a window of a transition on either side of its centre
LEAST_MARGIN = HALF + TUNED.span + 1  # frames that transitions need before and after an action, one to round
TWO_SEAMS = 3 * HALF + TUNED.span + 2  # frames after the start that two consecutive transitions need
Cut = tuple[Motion, Array]
"""A clip, and its frames (G,) at the phases of a grid."""


@dataclass(frozen=True, eq=False)
class Examples:
    """N examples of one action on one grid of G phases, as from `cut_strides` and `cut_actions`.

    Parameters
    ----------
    skeleton, fps : the skeleton and the frame rate of the clips.
    grid : shape (G,), phases. The action, such as a stride, begins at 0 and ends at 1.
    seconds : shape (N, G), the time warp: seconds since the beginning of the action.
    speeds : shape (N, G), complex z + ix, ground velocity relative to the heading, metres per phase.
    turning : shape (N, G), rotation rate of the heading, radians per phase.
    heights : shape (N, G), heights of the root, metres.
    poses : shape (N, G, J, 4), rotations, of which those of the root are relative to the heading.
    contacts : shape (N, G, C), contacts of the C joints `contact_names`.
    values : shape (N, 2), the turn, which is the change of heading in radians, and the speed in m/s.
    sway : rotation of the pelvis in a straight example, radians, which is 0 for strides.
    offset : angle from the heading at a strike to the direction of travel, radians, or 0 if no example is
        straight.
    dropped : number of examples that were left out.
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
        """The joints whose positions are compared in windows, without coincident joints."""
        return distinct_joints(self.skeleton)

    @property
    def ends(self) -> tuple[int, int]:
        """The indices of the phases 0 and 1 in the grid."""
        return _ends(self.grid)

    def take(self, rows: Mask | Indices) -> "Examples":
        """Return the examples of some rows."""
        if not len(self.values[rows]):
            raise MocapError(f"None of {len(self)} examples is left.")
        parts = ("seconds", "speeds", "turning", "heights", "poses", "contacts", "values")
        return replace(self, **{part: getattr(self, part)[rows] for part in parts})

    def integrated(self, rates: NDArray[Any]) -> NDArray[Any]:
        """Integrate rates (M, G) over the phases, with the value 0 at phase 0.

        Examples
        --------
        >>> from mocap import body, datasets
        >>> from mocap.methods.parametric_graphs.strides import cut_strides
        >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
        >>> rates = np.array([np.ones(107), 2 * strides.grid])
        >>> strides.ends, strides.integrated(rates)[:, [0, 23, 53, 83, 106]].round(2).tolist()
        ((23, 83), [[-0.38, 0.0, 0.5, 1.0, 1.38], [0.15, 0.0, 0.25, 1.0, 1.91]])
        """
        step = self.grid[1] - self.grid[0]
        first, _ = self.ends
        total = np.cumsum((rates[:, 1:] + rates[:, :-1]) / 2 * step, axis=1)
        total = np.concatenate([np.zeros((len(rates), 1)), total], axis=1)
        return np.asarray(total - total[:, first : first + 1])

    def blend(self, weights: Array) -> Motion:
        """Blend the action with weights (N,), one frame for each phase from 0 to 1, at the mean duration.

        Examples
        --------
        A foot is in contact if examples with more than half of the weight have the contact, here both:

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
        first, last = self.ends
        rate = (last - first) / float(weights @ self.seconds[:, last])
        return self.motion(weights, np.arange(first, last + 1.0), rate)[0]

    def motion(self, weights: Array, positions: Array, fps: float) -> tuple[Motion, Array]:
        """Blend with weights (N,) at F positions between the G phases. Also return the heading (F,)."""
        (roots,), (poses,), (facing,) = self.mixed(weights[None], positions[None])
        marks = np.tensordot(weights, self.contacts[:, np.rint(positions).astype(int)], 1) > 0.5
        contacts = dict(zip(self.contact_names, marks.T, strict=True))
        return Motion(self.skeleton, roots, poses, fps, "blend", contacts=contacts), facing

    def mixed(self, weights: Array, positions: Array) -> tuple[Array, Array, Array]:
        """Mix M motions at F positions between the G phases.

        A pose is a normalised sum of quaternions in one hemisphere. Heights are weighted sums. The root's
        velocities relative to the body are mixed [ours] and integrated.

        Parameters
        ----------
        weights : shape (M, N).
        positions : shape (M, F), from 0 to G - 1. For example, 2.5 is half-way between phases 2 and 3 of the
            grid.

        Returns
        -------
        Root positions (M, F, 3), rotations (M, F, J, 4) and headings (M, F).

        Examples
        --------
        The mean of a stride that turns by 86° to the left and one that turns by 17° to the right:

        >>> from mocap import body, datasets
        >>> from mocap.methods.parametric_graphs.strides import cut_strides
        >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
        >>> weights = np.eye(len(strides))[[0, 2]].mean(axis=0)
        >>> roots, poses, headings = strides.mixed(weights[None], np.array([[23, 53.25, 83, 106]]))
        >>> np.degrees(headings[0]).round().tolist()
        [0.0, 13.0, 34.0, 74.0]
        >>> roots[0].round(2).tolist()
        [[0.0, 0.99, 0.0], [0.03, 0.99, 0.52], [0.22, 1.0, 1.01], [0.52, 0.98, 1.24]]
        >>> poses.shape
        (1, 4, 38, 4)
        """
        low = np.clip(positions.astype(int), 0, len(self.grid) - 2)
        fraction = positions - low
        mix = np.arange(len(weights))[:, None]

        def interpolated(values: NDArray[Any]) -> NDArray[Any]:
            return _between(values[mix, low], values[mix, low + 1], fraction)

        grid_ground, grid_facing = mixed_trajectory(self, weights)
        ground = interpolated(grid_ground)
        facing = interpolated(grid_facing)
        heights = interpolated(weights @ self.heights)
        poses = self._mixed_poses(weights, low, fraction)
        poses[:, :, 0] = rotations.multiply(rotations.about_y(facing), poses[:, :, 0])
        return np.stack([ground.imag, heights, ground.real], axis=-1), poses, facing

    def _mixed_poses(self, weights: Array, low: Indices, fraction: Array) -> Array:
        """Mix poses, (M, F, J, 4), at fractions (M, F) of the steps that begin at phases `low` (M, F)."""
        used = np.flatnonzero(weights.any(axis=0))
        first = low.min()
        window = self.poses[used, first : low.max() + 2]
        rows = weights[:, used] @ window.reshape(len(used), -1)
        sums = rows.reshape(-1, *window.shape[1:])
        mix = np.arange(len(weights))[:, None]
        number = low - first
        poses = _between(sums[mix, number], sums[mix, number + 1], fraction[..., None, None])
        poses /= np.linalg.norm(poses, axis=-1, keepdims=True)
        return poses

    def require_joinable(self, other: "Examples") -> None:  # reads: name: as in `Skeleton.require_same`
        """Raise SkeletonMismatch or MocapError for examples of another skeleton, rate or contacts."""
        self.skeleton.require_same(other.skeleton)
        if self.fps != other.fps:
            raise MocapError(f"Examples are joined at one rate, got {self.fps:g} and {other.fps:g} Hz.")
        unshared = set(self.contact_names) ^ set(other.contact_names)
        if unshared:
            raise MocapError(f"Examples are joined with the same marks; some of them lack {min(unshared)}.")


def _between(start: NDArray[Any], end: NDArray[Any], fraction: Array) -> NDArray[Any]:
    """Interpolate linearly from the start, at fraction 0, to the end, at 1."""
    return np.asarray(start * (1 - fraction) + end * fraction)


def _ends(grid: Array) -> tuple[int, int]:
    """Return the indices of the phases 0 and 1 in a grid."""
    first, last = np.searchsorted(grid, [-1e-9, 1 - 1e-9])
    return int(first), int(last)


def register_cuts(cuts: Sequence[Cut], within: tuple[int, int]) -> list[Cut]:
    """Register all examples with the one of median rotation, by registration curves [KG03].

    They are registered between two phases, given by their indices in the grid. Before and after these, each
    clip keeps its own pace, because there the examples need not show the same action.
    """
    first, last = within
    starts = [int(frames[first]) for _, frames in cuts]
    stops = [int(np.ceil(frames[last])) for _, frames in cuts]
    parts = [clip[start : stop + 1] for (clip, _), start, stop in zip(cuts, starts, stops, strict=True)]
    angles = [float(np.ptp(np.unwrap(heading(part.rotations[:, 0])))) for part in parts]
    reference = int(np.argsort(angles)[len(angles) // 2])
    _, reference_frames = cuts[reference]
    clock = (reference_frames - starts[reference]) / parts[0].fps
    registered_clock = np.clip(clock, 0, parts[reference].duration)
    curves = register(parts, reference=reference, slack=0.0).times
    registered = []
    for (clip, _), start, curve in zip(cuts, starts, curves, strict=True):
        seconds = curve(registered_clock) + clock - registered_clock
        registered.append((clip, np.clip(start + seconds * clip.fps, 0, len(clip) - 1)))
    return registered


def cut_actions(
    clips: Sequence[Motion],
    spans: Sequence[tuple[int, int]],
    *,
    margin: float | None = TUNED.margin,
) -> Examples:
    """Cut one action out of each clip, register them, and sample all on one grid of phases [HG07, examples].

    Parameters
    ----------
    clips : one for each example, of one skeleton and rate. Footplants are detected unless they are marked.
    spans : for each clip, the frames at which the action begins and ends.
    margin : fraction of the action that is kept before and after it for the windows of transitions, or None
        for as many frames as these need: 9, or more after an action of less than half a second.

    Raises
    ------
    MocapError : for no clips, another number of spans than clips, and a margin that exceeds its clip.

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
    clips = require_compatible(clips)
    side = round((TUNED.margin if margin is None else margin) * FINE)
    grid = np.arange(-side, FINE + side + 1) / FINE
    cuts = []
    for clip, (first, last) in zip(clips, spans, strict=True):
        frames = first + grid * (last - first)
        if margin is None:
            frames = np.interp(grid, *margin_knots(grid, [0.0, 1.0], [first, last]))
        if not (first < last and frames[0] >= 0 and frames[-1] <= len(clip) - 1):
            action = f"an action from {first} to {last} with its margins takes those"
            need = f"{action} from {frames[0]:.0f} to {frames[-1]:.0f}"
            raise MocapError(f"'{clip.name}' has {len(clip)} frames; {need}: leave it more room, or out.")
        cuts.append((clip if clip.contacts else mark_plants(clip), frames))
    return sample_cuts(register_cuts(cuts, (side, side + FINE)), grid)


def margin_knots(grid: Array, phases: Sequence[float], frames: Sequence[float]) -> tuple[Array, Array]:
    """Extend the phases of events and their frames (K,) by the least margins of a grid, (K + 2,) each.

    The transitions into and out of a quick action would overlap, so the second is centred after its end.

    Examples
    --------
    >>> phases, frames = margin_knots(np.array([-0.5, 0, 1, 1.5]), [0, 1], [20, 60])
    >>> phases.tolist(), frames.tolist()
    ([-0.5, 0.0, 1.0, 1.5], [11, 20, 60, 69])
    """
    needed_after = max(LEAST_MARGIN, TWO_SEAMS - (frames[-1] - frames[0]))
    extended_frames = [frames[0] - LEAST_MARGIN, *frames, frames[-1] + needed_after]
    return np.array([grid[0], *phases, grid[-1]]), np.array(extended_frames)


def sample_cuts(cuts: Sequence[Cut], grid: Array, *, dropped: int = 0) -> Examples:
    """Sample the motion of each clip at its frames (G,), and collect the examples."""
    names = tuple(cuts[0][0].contacts)
    samples = [_sample(clip, frames, grid, names) for clip, frames in cuts]
    arrays: dict[str, Any] = {}
    for part in samples[0]:
        arrays[part] = np.array([sample[part] for sample in samples])
    poses = arrays["poses"]
    poses[0] = rotations.continuous(poses[0])  # consistent signs over the phases, and in all examples
    products = (poses * poses[0]).sum(axis=-1, keepdims=True)
    poses *= np.where(products < 0, -1, 1)
    clip, _ = cuts[-1]
    arrays |= {"contact_names": names, "dropped": dropped}
    return Examples(clip.skeleton, clip.fps, grid, **arrays)


def _sample(clip: Motion, frames: Array, grid: Array, names: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Sample one example at frames (G,). Return the arrays of `Examples` without the axis N."""
    first, last = _ends(grid)
    step = grid[1] - grid[0]
    motion = clip.at(frames)
    facing = np.unwrap(heading(motion.rotations[:, 0]))
    poses = motion.rotations.copy()
    poses[:, 0] = rotations.multiply(rotations.about_y(-facing), poses[:, 0])
    ground = on_ground(motion.root_positions)
    seconds = (frames - frames[first]) / clip.fps
    length = np.abs(np.diff(ground[first : last + 1])).sum()
    nearest = np.round(frames).astype(int)
    sampled = {"seconds": seconds, "heights": motion.root_positions[:, 1], "poses": poses}
    sampled["speeds"] = np.gradient(ground, step) * np.exp(-1j * facing)
    sampled["turning"] = np.gradient(facing, step)
    sampled["contacts"] = np.stack([clip.contacts[name][nearest] for name in names], axis=1)
    sampled["values"] = np.array([facing[last] - facing[first], length / seconds[last]])
    return sampled


def mixed_trajectory(examples: Examples, weights: Array) -> tuple[Points, Array]:
    """Mix velocities relative to the body and integrate them: θ(u) = ∫ Σ w θ', p(u) = ∫ Σ w v e^{iθ} [ours].

    If positions were mixed instead, a mix of strides by 90° to the left and to the right would be shortened
    by a third.

    Parameters
    ----------
    examples : N examples.
    weights : shape (M, N), the weights of M mixes.

    Returns
    -------
    The ground points (M, G), complex, and the headings (M, G), both 0 at phase 0.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> ground, heading = mixed_trajectory(strides, np.eye(len(strides))[:1])
    >>> first, last = strides.ends
    >>> np.degrees(heading[0, [first, last]]).round().tolist(), ground[0, [first, last]].round(2).tolist()
    ([0.0, 86.0], [0j, (0.61+0.63j)])

    Notebook: 17-parametric-graphs
    """
    facing = examples.integrated(weights @ examples.turning)
    return examples.integrated((weights @ examples.speeds) * np.exp(1j * facing)), facing
