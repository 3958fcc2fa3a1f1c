"""A space of motions: blends of examples, sampled, to be asked for what they do [KG04].

Any function of a `Motion` can measure what it does, in a number or a few. Here are three: how far it turns,
how fast it goes, and where the hand reaches. The nodes of parametric graphs are such spaces, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field, replace
from functools import partial
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from mocap._shared.arrays import Array, frozen
from mocap._shared.records import dataclass
from mocap.blending.clocks import Registration, checked
from mocap.blending.mixing import mix
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading, on_ground
from mocap.errors import MocapError, shortened

FPS = 30.0  # of the blends that are measured

E = TypeVar("E")  # a `Registration`, or examples on one grid of phases that `blend` themselves

Measure = Callable[[Motion], ArrayLike]
"""Reads one number or a few off a motion."""


def turn(motion: Motion) -> float:
    """Measure how far the body turns from the first frame to the last, radians, to the left.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> np.degrees([turn(sample(f"walk_5m_0.8_{way}")) for way in (120, 0, -120)]).round(1).tolist()
    [114.7, 4.7, -104.7]

    Notebook: 16-match-webs
    """
    headings = np.unwrap(heading(motion.rotations[:, 0]))
    return float(headings[-1] - headings[0])


def mean_speed(motion: Motion) -> float:
    """Measure how fast the root goes over the ground on average, metres per second.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> round(mean_speed(walk := sample("walk_5m_1.4_0")), 2), mean_speed(walk[:1])
    (1.4, 0.0)

    Notebook: 16-match-webs
    """
    way = np.abs(np.diff(on_ground(motion.root_positions))).sum()
    return float(way / max(motion.duration, 1 / motion.fps))


def hand_target(
    motion: Motion, hand: str = "rhand", shoulder: str = "rhumerus", *, at: float | None = None
) -> Array:
    """Measure where a hand is at one moment, from where the body stands and faces at the start.

    Parameters
    ----------
    motion : such as a punch.
    hand, shoulder : names of joints; by default those of the right arm in Acclaim files.
    at : the moment, as a share of the frames; by default that in which the arm is longest.

    Returns
    -------
    Metres to the left, above the ground, and ahead, shape (3,).

    Raises
    ------
    MocapError : for a joint that is not there.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> second = sample("walk_straight")[:120]
    >>> hand_target(second).round(2).tolist(), hand_target(second, at=0.5).round(2).tolist()
    ([-0.15, 0.77, 0.69], [-0.14, 0.77, 0.57])

    Notebook: 16-match-webs
    """
    tip, root = (motion.skeleton.index(name) for name in (hand, shoulder))
    points = joint_positions(motion)
    arms = np.linalg.norm(points[:, tip] - points[:, root], axis=1)
    moment = arms.argmax() if at is None else round(at * (len(motion) - 1))
    x, _, z = motion.root_positions[0]
    away = points[moment, tip] - [x, 0, z]
    return PlanarTransform(-float(heading(motion.rotations[0, 0])), 0.0, 0.0).apply_points(away)


def random_weights(
    values: ArrayLike, count: int, *, spread: float = 0.1, near: int | None = None, seed: int = 0
) -> Array:
    """Draw the weights of random blends of d + 1 examples each, for a measure of d numbers.

    In the paper: [KG04, accessible region].

    One example is drawn at random, and d of those nearest to it. Their weights are even on the simplex, which
    is then stretched about its middle: w = (1 + (d + 1) δ) Dirichlet(1, …, 1) - δ. So they add up to one, and
    none is below -δ; a draw with one above 1 + δ is drawn again [KG04 samples so too, as far as recalled; the
    stretch is ours]. Even numbers divided by their sum would crowd in the middle, and weights cut off at
    -δ … 1 + δ would not add up to one.

    Parameters
    ----------
    values : shape (C, d), the measure of each example.
    count : of blends.
    spread : δ, not negative.
    near : from how many of the nearest examples the others are drawn, d or more; from all by default.
    seed : another one gives other blends.

    Returns
    -------
    Shape (count, C), rows that add up to one, each weight in [-δ, 1 + δ].

    Raises
    ------
    MocapError : for fewer than d + 1 examples, and values that are not finite.

    Examples
    --------
    >>> w = random_weights([[0.8], [1.1], [1.4]], 100, spread=0.1)
    >>> w.shape, bool(np.allclose(w.sum(axis=1), 1)), int((w != 0).sum(axis=1).max()), float(w.max().round(1))
    ((100, 3), True, 2, 1.1)

    Notebook: 16-match-webs
    """
    measured = np.asarray(values, float)
    if measured.ndim != 2 or not np.isfinite(measured).all():
        raise MocapError(f"Examples need finite values of shape (C, d), got shape {measured.shape}.")
    examples, numbers = measured.shape
    if examples < numbers + 1:
        raise MocapError(f"A measure of {numbers} numbers needs {numbers + 1} examples, got {examples}.")
    rng = np.random.default_rng(seed)
    width = measured.std(axis=0)
    scaled = measured / np.where(width > 0, width, 1)
    ranked = cdist(scaled, scaled).argsort(axis=1, kind="stable")
    weights = np.zeros((count, examples))
    for row in weights:
        first = rng.integers(examples)
        others = ranked[first][ranked[first] != first][:near]
        chosen = np.append(first, rng.choice(others, numbers, replace=False))
        while row.max() > 1 + spread or not row.any():
            row[chosen] = (1 + len(chosen) * spread) * rng.dirichlet(np.ones(len(chosen))) - spread
    return weights


@dataclass(frozen=True, eq=False, repr=False)
class MotionSpace(Generic[E]):
    """Samples of what blends of examples do.

    examples : C examples on one clock: registered clips, or those on a grid of `parametric_graphs`.
    weights : shape (S, C), of the samples.
    values : shape (S, d), the measure of each sample.
    scale : shape (d,), how much of each number counts as far as one of the others.
    parameters : d names of what it is asked by, such as "turn"; a node of a parametric graph has them.
    low, high : shape (d,), the range it is asked in; by default that of the values.
    """

    examples: E
    weights: Array
    values: Array
    scale: Array
    parameters: tuple[str, ...] = ()
    low: Array = field(default_factory=lambda: np.empty(0))
    high: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        ends = {"low": self.values.min(axis=0), "high": self.values.max(axis=0)}
        for key in ("weights", "values", "scale", "low", "high"):
            own = getattr(self, key)
            object.__setattr__(self, key, frozen(own if len(own) else ends[key], np.float64))

    def __repr__(self) -> str:
        examples, (samples, numbers) = self.weights.shape[1], self.values.shape
        return f"MotionSpace({examples} examples, {samples} samples of {numbers} numbers)"

    @property
    def reached(self) -> Array:
        """What the samples within the range come to, (R, d).

        Examples
        --------
        >>> space = MotionSpace(None, np.eye(3), np.array([[0.0], [1], [2]]), np.ones(1), low=np.ones(1))
        >>> space.reached.tolist(), space.high.tolist()
        ([[1.0], [2.0]], [2.0])
        """
        return self.values[((self.values >= self.low) & (self.values <= self.high)).all(axis=1)]


def sample_space(
    examples: E,
    measure: Measure,
    *,
    count: int = 200,
    scale: ArrayLike | None = None,
    parameters: tuple[str, ...] = (),
) -> MotionSpace[E]:
    """Blend examples at random, and measure each blend: samples of a space of motions [KG04, sampling].

    What a blend does is no simple function of its weights: the hand of half of two punches is not half-way
    between their targets. So blends are made and measured. Where the samples are is what can be reached.

    Parameters
    ----------
    examples : registered clips, from `blending.register`; or examples on a grid, such as those of
        `methods.parametric_graphs.cut_actions`, whose space can be a node of a graph.
    measure : a function of a `Motion` that gives d numbers, such as `turn` or `hand_target`.
    count : of random blends, beside the examples. 0 leaves the examples alone.
    scale : shape (d,): amounts of each number that count as equally far, such as 10° and 0.1 m/s. By default
        half the range of the samples' values.
    parameters : the names of the d numbers, for a node of a graph.

    Returns
    -------
    The examples and `count` samples.

    Raises
    ------
    MocapError : for fewer than d + 1 examples, and a measure that gives NaN, or more numbers now than then.

    Examples
    --------
    >>> from mocap.blending import registering
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> sample_space(registering.register(walks), mean_speed, count=10)
    MotionSpace(2 examples, 12 samples of 1 numbers)

    Notebook: 16-match-webs
    """
    own: Any = examples
    registered = isinstance(examples, Registration)
    blend = partial(blend_of, own, fps=FPS, rounds=0) if registered else own.blend
    alone = np.eye(len(own.clips if registered else own))
    known = _measured(blend, measure, alone)
    weights = random_weights(known, count)
    values = np.concatenate([known, _measured(blend, measure, weights, known.shape[1])])
    width = np.ptp(values, axis=0) / 2
    given = np.where(width > 0, width, 1.0) if scale is None else np.asarray(scale, float)
    return MotionSpace(examples, np.concatenate([alone, weights]), values, given, parameters)


def blend_of(
    registration: Registration, weights: ArrayLike, *, fps: float | None = None, rounds: int = 1
) -> Motion:
    """Blend registered clips as `blending.mix` does, by way of those alone whose weight is not 0.

    Parameters
    ----------
    registration : of C clips, such as that of a space.
    weights : shape (C,), such as from `weights_for`.
    fps : frames per second; the clips' own by default.
    rounds : as for `blending.mix`.

    Raises
    ------
    MocapError : for weights that are not C finite numbers or do not add up to one.

    Examples
    --------
    >>> from mocap.blending.registering import register
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(f"walk_5m_{speed}_0") for speed in (0.8, 1.1, 1.4)]
    >>> blend_of(register(walks), [0, 0.5, 0.5])
    Motion('walk + walk', 348 frames at 120 Hz, 2.89 s, 38 joints)

    Notebook: 16-match-webs
    """
    w = checked(weights, len(registration.clips))
    some = np.flatnonzero(np.abs(w) > 1e-9)
    of_clips = ("clips", "times", "angles", "centres")
    parts = {part: tuple(getattr(registration, part)[n] for n in some) for part in of_clips}
    parts["contacts"] = tuple((joint, ends[:, some]) for joint, ends in registration.contacts)
    reference = int(np.abs(w[some]).argmax())
    few = replace(registration, reference=reference, costs=registration.costs[some], **parts)
    return mix(few, w[some] / w[some].sum(), fps=fps, rounds=rounds)


def _measured(blend: Callable[[Array], Motion], measure: Measure, rows: Array, numbers: int = 0) -> Array:
    """Measure the blends of some weights (M, C): shape (M, d)."""
    values: list[Array] = []
    for row in rows:
        value = np.atleast_1d(np.asarray(measure(blend(row)), float))
        numbers = numbers or len(value)
        if value.shape != (numbers,) or not np.isfinite(value).all():
            got = shortened(str(value.tolist()))
            raise MocapError(f"A measure gives {numbers} finite numbers for each blend; this one gave {got}.")
        values.append(value)
    return np.reshape(values, (len(rows), numbers))
