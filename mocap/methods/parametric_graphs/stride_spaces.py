"""A space of strides: the blend weights of a stride with a given turn [KG04].

It is a `methods.match_webs.MotionSpace` as for any motion (`methods.match_webs.sample_space`). But the
weights of its samples are Gaussian in the turn, because there are many strides for one parameter. A small
number of examples of several parameters is blended d + 1 at a time.
"""

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import MocapError
from mocap.methods.match_webs.motion_spaces import MotionSpace
from mocap.methods.match_webs.target_weights import nearest_samples
from mocap.methods.parametric_graphs.examples import Examples, mixed_trajectory
from mocap.methods.parametric_graphs.tuned import TUNED

Space = MotionSpace[Examples]

PARAMETERS = ("turn", "speed")  # the columns of `Examples.values`
MISSING = {
    "turn": "a clip that turns to the left, and one to the right",
    "speed": "a clip that is slower, and one that is quicker",
}
SMALLEST = 1e-3  # weights below this fraction of the largest count as 0


def bell_weights(values: Array, targets: Array, width: Array | float) -> Array:
    """Compute Gaussian weights of all examples: w ∝ exp(-|(λ - λ_i) / h|² / 2) [ours; HG07 uses k nearest].

    With the k nearest strides, a change of the target by 2° changes the clip by 3 cm on average. With a
    Gaussian of 14° it is 0.2 cm. Edges require a smooth space.

    Parameters
    ----------
    values : shape (N, d), the parameters λ_i of the examples.
    targets : shape (M, d), the parameters λ.
    width : h, shape (d,) or one for all parameters.

    Returns
    -------
    Weights (M, N) whose rows sum to one.

    Examples
    --------
    >>> bell_weights(np.array([[0.0], [1.0]]), np.array([[0.0]]), np.ones(1)).round(3)
    array([[0.622, 0.378]])

    Notebook: 17-parametric-graphs
    """
    squares = (((targets[:, None] - values) / width) ** 2).sum(axis=-1)
    weights = np.exp(-(squares - squares.min(axis=1, keepdims=True)) / 2)
    weights[weights < SMALLEST] = 0
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def measure_mixes(strides: Examples, weights: Array) -> Array:
    """Compute the turn in radians and the speed in m/s of mixes with weights (M, N), shape (M, 2).

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> measured = measure_mixes(strides, np.eye(len(strides)))
    >>> measured[:2].round(3).tolist(), strides.values[:2].round(3).tolist()
    ([[-0.895, 0.977], [-1.545, 0.934]], [[-0.896, 0.977], [-1.545, 0.934]])

    Notebook: 17-parametric-graphs
    """
    ground, facing = mixed_trajectory(strides, weights)
    first, last = strides.ends
    length = np.abs(np.diff(ground[:, first : last + 1], axis=1)).sum(axis=1)
    turn = facing[:, last] - strides.sway
    speed = length / (weights @ strides.seconds)[:, last]
    return np.stack([turn, speed], axis=1)


def make_space(strides: Examples, width: float, low: float, high: float, *, parameter: str = "turn") -> Space:
    """Build a space of turns or speeds: sample mixes over a range, measure them [KG04], for [HG07, nodes].

    The turn of a mix with Gaussian weights differs from its target by 4° on average. Weights that are
    interpolated between the measured samples (`methods.match_webs.weights_for`) meet a target to 0.01°.

    Parameters
    ----------
    strides : N examples.
    width : standard deviation of the Gaussian, radians or m/s. About 14° suits captured strides.
    low, high : the range of turns, radians, or of speeds, m/s, which is reduced to that of the samples.
    parameter : "turn" or "speed".

    Raises
    ------
    MocapError : for another parameter, a range with fewer than three samples, fewer than two strides, and
        strides that do not vary.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.match_webs import weights_for
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> turn = measure_mixes(strides, weights_for(space, [[0.5]]))[0, 0]
    >>> float(turn.round(3))
    0.5
    >>> space, space.scale.tolist(), space.values[[0, 59, -1], 0].round(3).tolist()
    (MotionSpace(26 examples, 120 samples of 1 numbers), [0.8], [-1.215, 0.023, 1.237])


    Notebook: 17-parametric-graphs
    """
    if not low < high:
        raise MocapError(f"A range has ends low < high, got {low} and {high}.")
    if parameter not in PARAMETERS:
        raise MocapError(f"A space has the parameter 'turn' or 'speed', got {parameter!r}.")
    number = PARAMETERS.index(parameter)
    column = slice(number, number + 1)
    values = strides.values[:, column]
    if len(values) < 2 or np.ptp(values) < width / 2:
        got = f"{len(values)} with a {parameter} of {_range_text(parameter, values)}"
        missing = MISSING[parameter] if len(values) > 1 else f"clips that vary in their {parameter}"
        raise MocapError(f"A space takes 2 strides or more that vary, got {got}: add {missing}.")
    targets = np.linspace(low - width, high + width, TUNED.samples)[:, None]
    weights = bell_weights(values, targets, width)
    measured = measure_mixes(strides, weights)[:, column]
    lowest = np.array([max(low, measured.min())])
    highest = np.array([min(high, measured.max())])
    scale = np.maximum((highest - lowest) / 2, 1e-9)
    space = MotionSpace(strides, weights, measured, scale, (parameter,), lowest, highest)
    if len(space.reached) < 3:
        inside = f"{len(space.reached)} of {TUNED.samples} samples"
        reached = f"they come to a {parameter} of {_range_text(parameter, measured)}"
        raise MocapError(f"Only {inside} lie in the range: {reached}.")
    return space


def _range_text(parameter: str, values: Array) -> str:
    """Format the smallest and the largest of some values of a parameter."""
    return f"{parameter_text(parameter, values.min())} to {parameter_text(parameter, values.max())}"


def parameter_text(name: str, value: float) -> str:
    """Format a parameter with its unit.

    Examples
    --------
    >>> parameter_text("turn", np.pi / 2), parameter_text("speed", 1.25), parameter_text("ahead", 0.5)
    ('90°', '1.25 m/s', '0.50 m')
    """
    if name == "turn":
        return f"{np.degrees(value):.0f}°"
    if name == "speed":
        return f"{value:.2f} m/s"
    return f"{value:.2f} m"


def draw_parameters(space: Space, count: int, random: np.random.Generator) -> Array:
    """Draw random parameters (count, d) that the space can reach.

    A single parameter is drawn uniformly from its range. Several are drawn between samples, because corners
    of the range, such as sharp turns at high speed, may be empty.

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
    neighbours, _ = nearest_samples(values, values, space.scale, 8)
    weights = random.dirichlet(np.ones(3), count)
    base = random.integers(len(values), size=count)
    triples = neighbours[base[:, None], random.integers(neighbours.shape[1], size=(count, 3))]
    return np.asarray(np.einsum("ck,ckd->cd", weights, values[triples]))


def spread_parameters(space: Space, count: int) -> Array:
    """Spread at most `count` parameters (C, d) over those that a space reaches, its ends first [ours].

    A single parameter is spread evenly over its range. For several, the next sample is always the one
    farthest from those chosen before. Random parameters would cluster, and boxes interpolated between them
    would jump.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> spread_parameters(make_space(strides, 0.4, -0.8, 0.8), 3).round(2)
    array([[-0.8],
           [ 0. ],
           [ 0.8]])
    """
    if len(space.parameters) == 1:
        return np.linspace(space.low, space.high, count)
    values = space.reached
    ends = [*values.argmin(axis=0).tolist(), *values.argmax(axis=0).tolist()]
    chosen = list(dict.fromkeys(ends))[:count]
    distances = nearest_samples(values, values[chosen], space.scale, 1)[1][:, 0]
    while len(chosen) < min(count, len(values)):
        farthest = int(distances.argmax())
        chosen.append(farthest)
        to_farthest = np.linalg.norm((values - values[farthest]) / space.scale, axis=1)
        distances = np.minimum(distances, to_farthest)
    return values[chosen]
