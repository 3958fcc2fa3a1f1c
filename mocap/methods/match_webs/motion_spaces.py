"""Parameterised spaces of motions: random blends of examples, and their measured parameters [KG04].

Any function of a `Motion` that returns one or several numbers can be the measure. Three are provided: the
change of heading, the mean speed, and the position that the hand reaches. The nodes of parametric graphs are
also such spaces.
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

FPS = 30.0  # frame rate of the blends that are measured
TINY = 1e-9  # weights below this count as 0

E = TypeVar("E")  # a `Registration`, or examples on a grid of phases, with a method `blend`

Measure = Callable[[Motion], ArrayLike]
"""A function that measures one or several numbers of a motion."""


def heading_change(motion: Motion) -> float:
    """Compute the change of heading from the first frame to the last, radians, positive to the left.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(f"walk_5m_0.8_{degrees}") for degrees in (120, 0, -120)]
    >>> np.degrees([heading_change(walk) for walk in walks]).round(1).tolist()
    [114.7, 4.7, -104.7]

    Notebook: 16-match-webs
    """
    headings = np.unwrap(heading(motion.rotations[:, 0]))
    return float(headings[-1] - headings[0])


def mean_speed(motion: Motion) -> float:
    """Compute the mean speed of the root over the ground, metres per second.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_5m_1.4_0")
    >>> round(mean_speed(walk), 2), mean_speed(walk[:1])
    (1.4, 0.0)

    Notebook: 16-match-webs
    """
    length = np.abs(np.diff(on_ground(motion.root_positions))).sum()
    return float(length / max(motion.duration, 1 / motion.fps))


def hand_target(
    motion: Motion,
    hand: str = "rhand",
    shoulder: str = "rhumerus",
    *,
    at: float | None = None,  # reads: name: users give it as a keyword
) -> Array:
    """Compute the position of a hand at one moment, relative to the position and heading at the start.

    Parameters
    ----------
    motion : the motion, for example a punch.
    hand, shoulder : names of joints, by default those of the right arm in Acclaim files.
    at : the moment, as a fraction of the frames. By default that of the longest distance from shoulder to
        hand.

    Returns
    -------
    Shape (3,), metres to the left, above the ground, and ahead.

    Raises
    ------
    MocapError : for a joint that the skeleton does not have.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")[:120]
    >>> hand_target(walk).round(2).tolist(), hand_target(walk, at=0.5).round(2).tolist()
    ([-0.15, 0.77, 0.69], [-0.14, 0.77, 0.57])

    Notebook: 16-match-webs
    """
    tip, root = (motion.skeleton.index(name) for name in (hand, shoulder))
    points = joint_positions(motion)
    arms = np.linalg.norm(points[:, tip] - points[:, root], axis=1)
    moment = arms.argmax() if at is None else round(at * (len(motion) - 1))
    x, _, z = motion.root_positions[0]
    offset = points[moment, tip] - [x, 0, z]
    to_local = PlanarTransform(-float(heading(motion.rotations[0, 0])), 0.0, 0.0)
    return to_local.apply_points(offset)


def random_weights(
    values: ArrayLike, count: int, *, spread: float = 0.1, neighbours: int | None = None, seed: int = 0
) -> Array:
    """Draw the weights of random blends of d + 1 examples each, for a measure of d numbers.

    In the paper: [KG04, accessible region].

    One example is drawn at random, and d of those nearest to it. Their weights are uniform on the simplex,
    which is then scaled about its centre: w = (1 + (d + 1) δ) Dirichlet(1, …, 1) - δ. They add up to one, and
    none is below -δ. A draw with a weight above 1 + δ is rejected. The sampling is that of KG04 to the best
    of our knowledge, and the scaling is ours. Uniform numbers divided by their sum would concentrate in the
    centre, and weights clipped to -δ … 1 + δ would not add up to one.

    Parameters
    ----------
    values : shape (C, d), the measure of each example.
    count : number of blends.
    spread : δ, not negative.
    neighbours : number of nearest examples from which the d are drawn, at least d, by default all.
    seed : seed of the random numbers.

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
        nearest = ranked[first][ranked[first] != first][:neighbours]
        chosen = np.append(first, rng.choice(nearest, numbers, replace=False))
        while row.max() > 1 + spread or not row.any():
            row[chosen] = (1 + len(chosen) * spread) * rng.dirichlet(np.ones(len(chosen))) - spread
    return weights


@dataclass(frozen=True, eq=False, repr=False)
class MotionSpace(Generic[E]):
    """Sampled blends of examples, and their measured values.

    Parameters
    ----------
    examples : C examples on one clock, which are registered clips or examples on a grid of phases.
    weights : shape (S, C), the blend weights of the samples.
    values : shape (S, d), the measure of each sample.
    scale : shape (d,), the unit of distance in each number.
    parameters : names of the d numbers, such as "turn", for a node of a parametric graph.
    low, high : shape (d,), the range of targets, by default that of the values.
    """

    examples: E
    weights: Array
    values: Array
    scale: Array
    parameters: tuple[str, ...] = ()
    low: Array = field(default_factory=lambda: np.empty(0))
    high: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        limits = {"low": self.values.min(axis=0), "high": self.values.max(axis=0)}
        for key in ("weights", "values", "scale", "low", "high"):
            array = getattr(self, key)
            object.__setattr__(self, key, frozen(array if len(array) else limits[key], np.float64))

    def __repr__(self) -> str:
        examples = self.weights.shape[1]
        samples, numbers = self.values.shape
        return f"MotionSpace({examples} examples, {samples} samples of {numbers} numbers)"

    @property
    def reached(self) -> Array:
        """The values of the samples within the range, (R, d).

        Examples
        --------
        >>> space = MotionSpace(None, np.eye(3), np.array([[0.0], [1], [2]]), np.ones(1), low=np.ones(1))
        >>> space.reached.tolist(), space.high.tolist()
        ([[1.0], [2.0]], [2.0])
        """
        is_inside = (self.values >= self.low) & (self.values <= self.high)
        return self.values[is_inside.all(axis=1)]


def sample_space(
    examples: E,
    measure: Measure,
    *,
    count: int = 200,
    scale: ArrayLike | None = None,
    parameters: tuple[str, ...] = (),
) -> MotionSpace[E]:
    """Sample a space of motions: measure random blends of examples [KG04, sampling].

    The measure is not a simple function of the weights: the mean of two punches does not reach the point
    half-way between their targets. Therefore blends are computed and measured. The samples cover the
    accessible region.

    Parameters
    ----------
    examples : registered clips from `blending.register`, or examples on a grid of phases, such as those of
        `methods.parametric_graphs.cut_actions`, whose space can be a node of a graph.
    measure : a function of a `Motion` that returns d numbers, such as `heading_change` or `hand_target`.
    count : number of random blends, in addition to the examples.
    scale : shape (d,), the unit of distance in each number, such as 10° and 0.1 m/s. By default half the
        range of the samples' values.
    parameters : the names of the d numbers, for a node of a graph.

    Returns
    -------
    The examples and `count` samples.

    Raises
    ------
    MocapError : for fewer than d + 1 examples, and a measure that returns NaN, or varying shapes.

    Examples
    --------
    >>> from mocap.blending import registering
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> sample_space(registering.register(walks), mean_speed, count=10)
    MotionSpace(2 examples, 12 samples of 1 numbers)

    Notebook: 16-match-webs
    """
    blend, number = _blender(examples)
    unit_weights = np.eye(number)
    example_values = _measured(blend, measure, unit_weights)
    weights = random_weights(example_values, count)
    blend_values = _measured(blend, measure, weights, example_values.shape[1])
    values = np.concatenate([example_values, blend_values])
    all_weights = np.concatenate([unit_weights, weights])
    return MotionSpace(examples, all_weights, values, _scale_of(values, scale), parameters)


def _blender(examples: object) -> tuple[Callable[[Array], Motion], int]:
    """Return the function that blends examples by weights, and the number of examples."""
    if isinstance(examples, Registration):
        return partial(blend_of, examples, fps=FPS, rounds=0), len(examples.clips)
    on_grid: Any = examples
    return on_grid.blend, len(on_grid)


def _scale_of(values: Array, scale: ArrayLike | None) -> Array:
    """Return the scale of a space (d,), by default half the range of its values, or 1 if they are equal."""
    if scale is not None:
        return np.asarray(scale, float)
    width = np.ptp(values, axis=0) / 2
    return np.where(width > 0, width, 1.0)


def blend_of(
    registration: Registration, weights: ArrayLike, *, fps: float | None = None, rounds: int = 1
) -> Motion:
    """Blend the registered clips whose weights are not 0, as `blending.mix` does.

    Parameters
    ----------
    registration : the registration of C clips, such as the examples of a space.
    weights : shape (C,), such as from `weights_for`.
    fps : frames per second, by default that of the clips.
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
    used = np.flatnonzero(np.abs(w) > TINY)
    fields = ("clips", "times", "angles", "centres")
    parts = {key: tuple(getattr(registration, key)[number] for number in used) for key in fields}
    parts["contacts"] = tuple((joint, ends[:, used]) for joint, ends in registration.contacts)
    reference = int(np.abs(w[used]).argmax())
    reduced = replace(registration, reference=reference, costs=registration.costs[used], **parts)
    return mix(reduced, w[used] / w[used].sum(), fps=fps, rounds=rounds)


def _measured(blend: Callable[[Array], Motion], measure: Measure, rows: Array, numbers: int = 0) -> Array:
    """Measure the blends with weights (M, C), shape (M, d)."""
    values: list[Array] = []
    for row in rows:
        value = np.atleast_1d(np.asarray(measure(blend(row)), float))
        numbers = numbers or len(value)
        if value.shape != (numbers,) or not np.isfinite(value).all():
            got = shortened(str(value.tolist()))
            raise MocapError(f"A measure gives {numbers} finite numbers for each blend; this one gave {got}.")
        values.append(value)
    return np.reshape(values, (len(rows), numbers))
