"""A space of strides: ask for a turn, and get the weights of a blend that has it [KG04].

It is a `methods.match_webs.MotionSpace` like that of any motion (`methods.match_webs.sample_space`), but
its samples are bells about the turn that is asked: many strides fill one parameter. Few examples of many
parameters are blended d + 1 at a time.
"""

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import MocapError
from mocap.methods.match_webs.motion_spaces import MotionSpace
from mocap.methods.match_webs.target_weights import nearest_samples
from mocap.methods.parametric_graphs.examples import Examples, mixed_way

Space = MotionSpace[Examples]

SMALLEST = 1e-3  # a bell's weight below this share of the largest counts as 0
SAMPLES = 120  # of a space


def bell_weights(values: Array, asked: Array, width: Array | float) -> Array:
    """Weigh all examples by a bell: w ∝ exp(-|(λ - λ_i) / h|² / 2), (M, N) [ours; HG07 takes the k nearest].

    With the k nearest raw strides, a change of 2° in what is asked changes the clip by 3 cm on average; with
    a bell of 14° by 0.2 cm. A smooth space is what edges need.

    Examples
    --------
    >>> bell_weights(np.array([[0.0], [1.0]]), np.array([[0.0]]), np.ones(1)).round(3)
    array([[0.622, 0.378]])
    >>> bell_weights(np.array([[0.0], [3.7], [3.75]]), np.array([[0.0], [0.05]]), 1.0).round(4)
    array([[0.9989, 0.0011, 0.    ],
           [0.9977, 0.0013, 0.0011]])

    Notebook: 17-parametric-graphs
    """
    gaps = (((asked[:, None] - values) / width) ** 2).sum(axis=-1)
    weights = np.exp(-(gaps - gaps.min(axis=1, keepdims=True)) / 2)
    weights[weights < SMALLEST] = 0
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def measure_mixes(strides: Examples, weights: Array) -> Array:
    """Measure what mixes (M, N) come to: turn in radians and speed in m/s, (M, 2).

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> came = measure_mixes(strides, np.eye(len(strides)))
    >>> came[:2].round(3).tolist(), strides.values[:2].round(3).tolist()
    ([[-0.895, 0.977], [-1.545, 0.934]], [[-0.896, 0.977], [-1.545, 0.934]])

    Notebook: 17-parametric-graphs
    """
    ground, facing = mixed_way(strides, weights)
    zero, one = strides.ends
    way = np.abs(np.diff(ground[:, zero : one + 1], axis=1)).sum(axis=1)
    turn = facing[:, one] - strides.sway
    return np.stack([turn, way / (weights @ strides.seconds)[:, one]], axis=1)


def make_space(strides: Examples, width: float, low: float, high: float) -> Space:
    """Sample mixes all over the range, measure what each comes to, and keep both [KG04], for [HG07, nodes].

    A bell's mix does not come to what was asked, by 4° on average. Looked up among what the samples come to
    (`methods.match_webs.weights_for`), it does to 0.01°.

    Parameters
    ----------
    strides : N examples.
    width : of the bell, radians; about 14° for captured strides.
    low, high : the range of turns asked for, radians; it is cut to what the samples come to.

    Raises
    ------
    MocapError : for a range that is none or holds too few samples, fewer strides than three, and strides that
        do not vary.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.match_webs import weights_for
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> got = measure_mixes(strides, weights_for(space, [[0.5]]))[0, 0]
    >>> float(got.round(3))
    0.5
    >>> space, space.scale.tolist(), space.values[[0, 59, -1], 0].round(3).tolist()
    (MotionSpace(26 examples, 120 samples of 1 numbers), [0.8], [-1.215, 0.023, 1.237])

    Three samples in the range are enough. So are three strides that turn by -17° to 18°:

    >>> len(make_space(strides, 0.4, 0.0, 0.04).reached)
    3
    >>> three = make_space(strides.take(np.argsort(strides.values[:, 0])[12:15]), 0.4, -0.8, 0.8)
    >>> np.degrees([*three.low, *three.high]).round().tolist()
    [-17.0, 18.0]

    Notebook: 17-parametric-graphs
    """
    if not low < high:
        raise MocapError(f"A range has ends low < high, got {low} and {high}.")
    values = strides.values[:, :1]
    if len(values) < 3 or np.ptp(values) < width / 2:
        got = f"{len(values)} with a turn of {said('turn', values.min())} to {said('turn', values.max())}"
        raise MocapError(f"A space takes 3 strides or more that vary, got {got}: add clips.")
    mixes = bell_weights(values, np.linspace(low - width, high + width, SAMPLES)[:, None], width)
    come = measure_mixes(strides, mixes)[:, :1]
    ends = np.array([[max(low, come.min())], [min(high, come.max())]])
    space = MotionSpace(strides, mixes, come, np.maximum((ends[1] - ends[0]) / 2, 1e-9), ("turn",), *ends)
    if len(space.reached) < 3:
        inside = f"{len(space.reached)} of {SAMPLES} samples"
        turns = f"{said('turn', come.min())} to {said('turn', come.max())}"
        raise MocapError(f"Only {inside} lie in the range: they come to a turn of {turns}.")
    return space


def said(name: str, value: float) -> str:
    """Say a parameter with its unit.

    Examples
    --------
    >>> said("turn", np.pi / 2), said("speed", 1.25), said("ahead", 0.5)
    ('90°', '1.25 m/s', '0.50 m')
    """
    return f"{np.degrees(value):.0f}°" if name == "turn" else f"{value:.2f} m" + "/s" * (name == "speed")


def draw_parameters(space: Space, count: int, random: np.random.Generator) -> Array:
    """Draw parameters (count, d) that the space can come to.

    For one parameter evenly in its range; for more among the samples, because the corners of the range, such
    as fast and sharp at once, may hold none.

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
    near, _ = nearest_samples(values, values, space.scale, 8)
    shares, base = random.dirichlet(np.ones(3), count), random.integers(len(values), size=count)
    some = near[base[:, None], random.integers(near.shape[1], size=(count, 3))]
    return np.asarray(np.einsum("ck,ckd->cd", shares, values[some]))


def place_evenly(space: Space, count: int) -> Array:
    """Choose at most `count` parameters (C, d) that cover what a space reaches, its ends first [ours].

    For one parameter evenly in its range; for more each time the sample farthest from those chosen. Drawn at
    random they cluster, and boxes that are looked up among them jump.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> place_evenly(make_space(strides, 0.4, -0.8, 0.8), 3).round(2)
    array([[-0.8],
           [ 0. ],
           [ 0.8]])
    """
    if len(space.parameters) == 1:
        return np.linspace(space.low, space.high, count)
    values = space.reached
    chosen = list(dict.fromkeys([*values.argmin(axis=0).tolist(), *values.argmax(axis=0).tolist()]))[:count]
    gaps = nearest_samples(values, values[chosen], space.scale, 1)[1][:, 0]
    while len(chosen) < min(count, len(values)):
        chosen.append(int(gaps.argmax()))
        gaps = np.minimum(gaps, np.linalg.norm((values - values[chosen[-1]]) / space.scale, axis=1))
    return values[chosen]
