"""A space of strides: ask for a turn and a speed, and get the weights of a blend that has them [KG04]."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices, Points
from mocap.errors import MocapError, MocapWarning
from mocap.methods.match_webs.wishes import nearest_samples, neighbour_weights
from mocap.methods.parametric_graphs.strides import Strides, mixed_way

PARAMETERS = ("turn", "speed")
SMALLEST = 1e-3  # a bell's weight below this share of the largest counts as 0
FEWEST = 5  # strides within two widths of each part of a range
SAMPLES = 120, 400  # of a space asked by one parameter, and by two
NEIGHBOURS = 2  # more than the parameters: with one more, as in [HG07, 4], boxes jump


@dataclass(frozen=True, eq=False)
class StrideSpace:
    """A smooth map from d parameters to mixes of strides; `make_space` shows an example.

    Parameters
    ----------
    strides : N examples.
    parameters : of `PARAMETERS`, d of them.
    values : shape (S, d), what S sampled mixes come to.
    mixes : shape (S, N), their weights.
    low, high : shape (d,), the range of the parameters.
    """

    strides: Strides
    parameters: tuple[str, ...]
    values: Array
    mixes: Array
    low: Array
    high: Array

    @property
    def columns(self) -> list[int]:
        """Which columns of `Strides.values` the parameters are."""
        return [PARAMETERS.index(name) for name in self.parameters]

    @property
    def scale(self) -> Array:
        """Half the range of each parameter: the unit of distances between parameters, (d,)."""
        return np.maximum((self.high - self.low) / 2, 1e-9)

    @property
    def reached(self) -> Array:
        """What the samples within the range come to, (R, d)."""
        return self.values[((self.values >= self.low) & (self.values <= self.high)).all(axis=1)]

    def weights(self, asked: ArrayLike) -> Array:
        """Mix the mixes of the nearest samples: parameters (M, d) give weights (M, N)."""
        near, shares = neighbours(np.atleast_2d(asked), self.values, self.scale)
        return np.asarray(np.einsum("mk,mkn->mn", shares, self.mixes[near]))

    @cached_property
    def sampled_poses(self) -> NDArray[np.float32]:
        """The poses of all sampled mixes, (S, G, J, 4), made once: a stride is then a mix of a few."""
        poses = self.strides.poses
        mixed = self.mixes.astype(np.float32) @ poses.reshape(len(poses), -1).astype(np.float32)
        return mixed.reshape(-1, *poses.shape[1:])

    def clipped(self, asked: ArrayLike) -> Array:
        """Bring parameters (..., d) into the range."""
        return np.clip(asked, self.low, self.high)


def neighbours(asked: Array, among: Array, scale: Array, count: int | None = None) -> tuple[Indices, Array]:
    """Find the nearest samples and weigh them: v ∝ 1/ε - 1/ε_k, ε_k the farthest's gap [HG07, Eqs. 1-2].

    The farthest of them always has the weight 0. So with d + 1 of them, as [HG07, 4] says, one parameter
    gives the nearest sample and nothing else, and boxes jump by 43°; d + 2 are taken [ours].

    Parameters
    ----------
    asked : shape (M, d).
    among : shape (S, d), the samples.
    scale : shape (d,), the unit of each parameter.
    count : how many; d + 2 by default.

    Returns
    -------
    The numbers of the samples and their weights, (M, k) each.

    Examples
    --------
    >>> near, weights = neighbours(np.array([[0.0]]), np.array([[4.0], [1], [2]]), np.ones(1))
    >>> near, weights
    (array([[1, 2, 0]]), array([[0.75, 0.25, 0.  ]]))
    """
    near, gaps = nearest_samples(asked, among, scale, count or asked.shape[1] + NEIGHBOURS)
    return near, neighbour_weights(gaps)


def bell_weights(values: Array, asked: Array, width: Array) -> Array:
    """Weigh all examples by a bell: w ∝ exp(-|(λ - λ_i) / h|² / 2), (M, N) [ours; HG07 takes the k nearest].

    With the k nearest raw strides, a change of 2° in what is asked changes the clip by 3 cm on average; with
    a bell of 14° by 0.2 cm. A smooth space is what edges need.

    Examples
    --------
    >>> bell_weights(np.array([[0.0], [1.0]]), np.array([[0.0]]), np.ones(1)).round(3)
    array([[0.622, 0.378]])

    Notebook: 17-parametric-graphs
    """
    gaps = (((asked[:, None] - values) / width) ** 2).sum(axis=-1)
    weights = np.exp(-(gaps - gaps.min(axis=1, keepdims=True)) / 2)
    weights[weights < SMALLEST] = 0
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def measure_mixes(strides: Strides, weights: Array, way: tuple[Points, Array] | None = None) -> Array:
    """Measure what mixes (M, N), whose way may be given, come to: turn in radians and speed in m/s, (M, 2).

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> bool(np.abs(measure_mixes(strides, np.eye(len(strides))) - strides.values).max() < 0.02)
    True

    Notebook: 17-parametric-graphs
    """
    ground, facing = way or mixed_way(strides, weights)
    zero, one = strides.ends
    way = np.abs(np.diff(ground[:, zero : one + 1], axis=1)).sum(axis=1)
    turn = facing[:, one] - facing[:, zero] - strides.sway
    return np.stack([turn, way / (weights @ strides.seconds)[:, one]], axis=-1)


def make_space(
    strides: Strides,
    width: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
    *,
    parameters: Sequence[str] = ("turn",),
) -> StrideSpace:
    """Sample mixes all over the range, measure what each comes to, and keep both [KG04], for [HG07, nodes].

    A bell's mix does not come to what was asked, by 4° on average. Looked up among what the samples come to,
    it does to 0.2°.

    Parameters
    ----------
    strides : N examples.
    width : of the bell for each parameter, (d,): radians, m/s; about 14° and 0.15 m/s for captured strides.
    low, high : the range asked for, (d,); it is cut to what the samples come to.
    parameters : what it is asked by, d of "turn" and "speed".

    Raises
    ------
    MocapError : for unknown parameters, a range that is none or holds too few samples, a width that is not
        above 0, fewer strides than d + 2, and strides that do not vary.

    Warns
    -----
    MocapWarning : where fewer than five strides are within two widths of some part of the range.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> got = measure_mixes(strides, space.weights([[0.5]]))[0, 0]
    >>> float(got.round(1))
    0.5

    Notebook: 17-parametric-graphs
    """
    names, columns = tuple(parameters), [PARAMETERS.index(name) for name in parameters if name in PARAMETERS]
    if not names or len(set(columns)) < len(names):
        raise MocapError(f"A space is asked by 'turn', 'speed' or both, got {', '.join(names) or 'none'}.")
    lowest, highest, width = ends = [np.atleast_1d(np.asarray(value, float)) for value in (low, high, width)]
    if {end.shape for end in ends} != {(len(names),)} or not (
        np.isfinite(ends).all() and (width > 0).all() and (lowest < highest).all()
    ):
        raise MocapError(f"A range has ends low < high and a width above 0, got {ends}.")
    values = strides.values[:, columns]
    _require_variety(names, values, width)
    if len(names) == 1:
        asked = np.linspace(lowest - width, highest + width, SAMPLES[0])
    else:
        random = np.random.default_rng(0)
        around = values[random.integers(len(values), size=SAMPLES[1])]
        asked = around + random.normal(size=around.shape) * width
    mixes = bell_weights(values, asked, width)
    come = measure_mixes(strides, mixes)[:, columns]
    lowest, highest = np.maximum(lowest, come.min(axis=0)), np.minimum(highest, come.max(axis=0))
    space = StrideSpace(strides, names, come, mixes, lowest, highest)
    if len(space.reached) < len(names) + NEIGHBOURS:
        raise MocapError(
            f"Only {len(space.reached)} of {len(asked)} samples lie in the range: they come to "
            + " and ".join(_spans(names, come))
            + "."
        )
    if len(names) == 1:  # of two parameters the samples are the range
        _warn_of_gaps(names[0], values[:, 0], width[0], np.linspace(lowest, highest, 25)[:, 0])
    return space


def said(name: str, value: float) -> str:
    """Say a parameter with its unit."""
    return f"{np.degrees(value):.0f}°" if name == "turn" else f"{value:.2f} m/s"


def _spans(names: tuple[str, ...], values: Array) -> list[str]:
    ends = zip(names, values.min(axis=0), values.max(axis=0), strict=True)
    return [f"a {name} of {said(name, low)} to {said(name, high)}" for name, low, high in ends]


def _require_variety(names: tuple[str, ...], values: Array, width: Array) -> None:
    """Refuse strides that are too few, or hardly differ in what they shall be asked by."""
    if len(values) < len(names) + NEIGHBOURS:
        raise MocapError(
            f"A space asked by {' and '.join(names)} takes {len(names) + NEIGHBOURS} strides or more, "
            f"got {len(values)}: add clips, or longer ones, for a stride needs room at its ends."
        )
    spread = np.ptp(values, axis=0) / width
    if spread.min() < 1 / 2:
        raise MocapError(
            f"{len(values)} strides hardly vary, with {_spans(names, values)[spread.argmin()]}: "
            "ask by something else, or add clips that vary."
        )


def _warn_of_gaps(name: str, values: Array, width: float, parts: Array) -> None:
    """Warn of parts of a range with hardly any stride."""
    near = (np.abs(parts[:, None] - values) <= 2 * width).sum(axis=1)
    if near.min() < FEWEST:
        warnings.warn(
            f"Only {near.min()} of {len(values)} strides are near a {name} of "
            f"{said(name, parts[near.argmin()])}: blends there hardly differ; narrow the range or add clips.",
            MocapWarning,
            stacklevel=3,
        )


def draw_parameters(space: StrideSpace, count: int, random: np.random.Generator) -> Array:
    """Draw parameters (count, d) that the space can come to.

    For one parameter evenly in its range; for two among the samples, because the corners of the range, fast
    and sharp at once, may hold none.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> draw_parameters(space, 5, np.random.default_rng(0)).shape
    (5, 1)
    """
    if len(space.parameters) == 1:
        return np.asarray(random.uniform(space.low, space.high, (count, 1)))
    values = space.reached
    near, _ = neighbours(values, values, space.scale, min(8, len(values)))
    shares, base = random.dirichlet(np.ones(3), count), random.integers(len(values), size=count)
    some = near[base[:, None], random.integers(near.shape[1], size=(count, 3))]
    return np.asarray(np.einsum("ck,ckd->cd", shares, values[some]))
