"""Checks of notebook 09."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake

expected_cost = Check(
    name="expected_cost",
    asks="the mean cost of the transition that a walk takes, with odds in proportion to 1 / cost",
    start="divide 1 / costs by its sum to get probabilities; add up probability times cost.",
    draw=lambda rng: (rng.uniform(90, 600, rng.integers(1, 12)),),
    truth=lambda costs: len(costs) / np.sum(1 / costs),
    mistakes=[
        Mistake(np.mean, "that is the mean of all costs; a walk takes the cheap ones more often."),
        Mistake(np.min, "a walk does not always take the cheapest; it only takes it more often."),
        Mistake(
            lambda costs: np.sum(costs**2) / np.sum(costs),
            "your odds are in proportion to the cost, as in the homework; they must be to 1 / cost.",
        ),
        Mistake(
            lambda costs: float(len(costs)),
            "1 / costs does not add up to 1, so it is no probability yet; divide it by its sum.",
        ),
        Mistake(
            lambda costs: len(costs) / np.sum(1 / costs) / 2,
            "that the successor gets half decides whether a transition is taken, not which one.",
        ),
        Mistake(
            lambda costs: np.mean(1 / costs),
            "that is the mean of 1 / cost; the probabilities weight the costs.",
        ),
        Mistake(
            lambda costs: 1 / np.sum(1 / costs),
            "that is probability times cost of one transition; add up over all of them.",
        ),
    ],
)


def _odds(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of a small graph in which some nodes have no successor."""
    size = int(rng.integers(4, 9))
    odds = rng.uniform(size=(size, size)) * (rng.uniform(size=(size, size)) < 0.5)
    odds[rng.integers(size)] = 0
    sums = odds.sum(axis=1, keepdims=True)
    return np.divide(odds, sums, out=np.zeros_like(odds), where=sums > 0), int(rng.integers(2, 12))


alive = Check(
    name="alive",
    asks="the share of all walks that can take this many steps, from starts that are equally likely",
    start="np.linalg.matrix_power(odds, steps)[i, j] is the probability to come from i to j.",
    draw=_odds,
    truth=lambda odds, steps: np.linalg.matrix_power(odds, steps).sum(axis=1).mean(),
    mistakes=[
        Mistake(
            lambda odds, steps: (odds**steps).sum(axis=1).mean(),
            "`**` raises each entry to a power; a matrix power multiplies matrices: np.linalg.matrix_power.",
        ),
        Mistake(
            lambda odds, steps: 1 - np.linalg.matrix_power(odds, steps).sum(axis=1).mean(),
            "that is the share that dies; give the share that lives.",
        ),
        Mistake(
            lambda odds, steps: np.linalg.matrix_power(odds, steps).sum(),
            "that adds up over all starts; each start has the same probability, so take their mean.",
        ),
        Mistake(
            lambda odds, steps: np.linalg.matrix_power(odds, steps).mean(),
            "add up over all places where a walk can be, and take the mean over the starts only.",
        ),
        Mistake(
            lambda odds, steps: odds.sum(axis=1).mean() ** steps,
            "this is the share after one step, to a power; but walks do not stay evenly spread.",
        ),
        Mistake(
            lambda odds, steps: (odds.sum(axis=1) ** steps).mean(),
            "this asks `steps` times whether the *start* has a successor; the walk moves on.",
        ),
        Mistake(
            lambda odds, steps: np.linalg.matrix_power(odds, steps - 1).sum(axis=1).mean(),
            "that is one step too few.",
        ),
        Mistake(
            lambda odds, steps: np.linalg.matrix_power(odds, steps + 1).sum(axis=1).mean(),
            "that is one step too many.",
        ),
        Mistake(
            lambda odds, steps: odds.sum(axis=1).mean(),
            "that is the share after one step.",
        ),
    ],
)


def _pairs(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw two measurements on the same paths, which differ less than the paths do."""
    before = rng.gamma(3.0, 2.0, int(rng.integers(5, 20)))
    return before, before * rng.uniform(0.7, 1.1) + rng.normal(0, 0.3, len(before))


paired_gain = Check(
    name="paired_gain",
    asks="the quartiles and the median (25, 50, 75 %) of before - after, path by path",
    start="subtract first, path by path; then np.percentile(differences, [25, 50, 75]).",
    draw=_pairs,
    truth=lambda before, after: np.percentile(before - after, [25, 50, 75]),
    mistakes=[
        Mistake(
            lambda before, after: np.percentile(before, [25, 50, 75]) - np.percentile(after, [25, 50, 75]),
            "you subtract the quartiles; that forgets which results belong to the same path. Subtract first.",
        ),
        Mistake(
            lambda before, after: np.percentile(after - before, [25, 50, 75]),
            "the sign is the other way round: a gain is what `after` has less than `before`.",
        ),
        Mistake(
            lambda before, after: np.percentile(np.abs(before - after), [25, 50, 75]),
            "the absolute value hides the paths on which it became worse.",
        ),
        Mistake(
            lambda before, after: np.percentile(np.sort(before) - np.sort(after), [25, 50, 75]),
            "sorting breaks the pairs: entry n of both must be the same path.",
        ),
        Mistake(
            lambda before, after: np.median(before - after),
            "that is the median; the quartiles are asked for, too.",
        ),
        Mistake(
            lambda before, after: np.percentile(before - after, [0.25, 0.5, 0.75]),
            "np.percentile takes percent: 25, not 0.25.",
        ),
    ],
)
