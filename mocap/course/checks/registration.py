"""Checks of notebook 15."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake


def _row(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw what is known of the row above, with cells that no path has reached, and a row of costs."""
    diagonal = rng.uniform(1, 5, 8)
    diagonal[rng.integers(0, 8, 2)] = np.inf
    best = np.minimum(diagonal, rng.uniform(1, 5, 8))
    best[0] = diagonal[0]
    return diagonal, best, rng.uniform(0, 2, 8)


def _shifted(row: Array) -> Array:
    return np.append(np.inf, row[:-1])


def _right(diagonal: Array, best: Array, costs: Array) -> Array:
    now = 2 * costs + _shifted(best)
    return np.array([now, np.minimum(np.minimum(now, costs + diagonal), costs + _shifted(now))])


def _right_from_any(diagonal: Array, best: Array, costs: Array) -> Array:
    now = 2 * costs + _shifted(best)
    least = np.minimum(now, costs + diagonal)
    for column in range(1, len(costs)):
        least[column] = min(least[column], costs[column] + least[column - 1])
    return np.array([now, least])


def _variant(  # noqa: PLR0913 (each argument is one line that a student may get wrong)
    diagonal: Array,
    best: Array,
    costs: Array,
    *,
    times: int = 2,
    start: Array | None = None,
    down: Array | None = None,
) -> Array:
    now = times * costs + (_shifted(best) if start is None else start)
    least = np.minimum(now, costs + (diagonal if down is None else down))
    return np.array([now, np.minimum(least, costs + _shifted(now))])


next_row = Check(
    name="next_row",
    asks="two rows of sums, shape (2, m): after a diagonal step, and the least of the three ways",
    start="first work out the sums after a diagonal step, for a step to the right in the new row needs them. "
    "Where no path can come from, the sum is infinite.",
    draw=_row,
    truth=_right,
    mistakes=[
        Mistake(
            lambda diagonal, best, costs: _variant(diagonal, best, costs, times=1),
            "a diagonal step advances both clips by a frame, so its cell counts twice.",
        ),
        Mistake(
            lambda diagonal, best, costs: _variant(diagonal, best, costs, start=np.roll(best, 1)),
            "column 0 has nothing to its left: `np.roll` brings the last column there. No diagonal step "
            "leads to it, so its sum is infinite.",
        ),
        Mistake(
            lambda diagonal, best, costs: _variant(diagonal, best, costs, start=_shifted(diagonal)),
            "a diagonal step may follow any step: go on from `best`, not from `diagonal`.",
        ),
        Mistake(
            lambda diagonal, best, costs: _variant(diagonal, best, costs, down=best),
            "one step down may not follow another: it goes on from `diagonal`, the diagonal steps' sums.",
        ),
        Mistake(
            _right_from_any,
            "one step to the right may not follow another, nor a step down: it goes on from the new sums "
            "after a diagonal step.",
        ),
        Mistake(
            lambda diagonal, best, costs: np.array(
                [
                    now := 2 * costs + _shifted(best),
                    np.minimum(np.minimum(now, costs + diagonal), costs + _shifted(diagonal)),
                ]
            ),
            "a step to the right stays in its row: it goes on from the new diagonal sums, not from those of "
            "the row above.",
        ),
        Mistake(
            lambda diagonal, best, costs: np.array(
                [now := 2 * costs + _shifted(best), np.minimum(now, costs + diagonal)]
            ),
            "there is a third way into a cell: a step to the right.",
        ),
    ],
)


def _moment(rng: np.random.Generator) -> tuple[float, complex, Array, Any, Array]:
    turns = rng.uniform(-3, 3, 3) + np.array([np.zeros(3), rng.normal(0, 0.4, 3)])
    moves = rng.normal(size=(3, 2)) @ [0.1, 0.1j]
    place = complex(*rng.normal(size=2))
    return float(rng.uniform(-3, 3)), place, turns, moves, rng.dirichlet(np.ones(3))


def _step(  # noqa: PLR0913 (what a student's function takes, and what it may get wrong)
    heading: float,
    place: complex,
    turns: Array,
    moves: Any,  # noqa: ANN401 (complex numbers)
    weights: Array,
    *,
    sign: float = -1,
    share: float = 0.5,
    halfway: Any = None,  # noqa: ANN401
) -> tuple[float, complex]:
    after = heading + sign * float(weights @ (turns[1] - turns[0]))
    at = (1 - share) * (turns[0] + heading) + share * (turns[1] + after)
    angles = at if halfway is None else halfway(at, turns, heading)
    return after, complex(place + weights @ (np.exp(1j * angles) * moves))


def _same_step(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    a, b = np.asarray(given, complex), np.asarray(wanted, complex)
    return bool(a.shape == b.shape and np.allclose(a, b, rtol=1e-8, atol=1e-9))


ground_step = Check(
    name="ground_step",
    asks="two values: the new φ, and the new centre as a complex number",
    start="first solve rule 1 for the new φ: the weighted mean of θ + φ is the same before and after. Then "
    "work out each clip's angle half-way, and turn its move by it.",
    draw=_moment,
    truth=_step,
    same=_same_step,
    mistakes=[
        Mistake(
            lambda *a: _step(*a, sign=1),
            "φ goes the wrong way: if the clips' angles θ grow, φ must fall by as much.",
        ),
        Mistake(
            lambda *a: _step(*a, halfway=lambda at, turns, heading: turns.mean(axis=0)),
            "a move is turned by its clip's angle θ *and* by the φ of the blend.",
        ),
        Mistake(
            lambda *a: _step(*a, halfway=lambda at, turns, heading: 0 * at),
            "that adds the moves as they were captured; turn each of them first.",
        ),
        Mistake(
            lambda *a: _step(*a, halfway=lambda at, turns, heading: -at),
            "the moves are turned to the wrong side: by exp(+i · angle).",
        ),
        Mistake(
            lambda *a: _step(*a, share=0),
            "those are the angles of the first frame; take them half-way to the second.",
        ),
        Mistake(
            lambda *a: _step(*a, share=1),
            "those are the angles of the second frame; take them half-way from the first.",
        ),
        Mistake(
            lambda heading, place, turns, moves, weights: _step(
                heading, place, turns, moves, weights, halfway=lambda at, _turns, _heading: weights @ at
            ),
            "each move has its own clip's angle: turn it first, and average afterwards.",
        ),
    ],
)


def _pace(slopes: Array, weights: Array) -> float:
    return float(weights @ slopes / weights.sum())


clock = Check(
    name="clock",
    asks="how far the common clock goes within one frame, in seconds",
    start="while the common clock goes one second, the clips go `slopes` seconds. Their weighted mean is how "
    "long the blend takes for it.",
    draw=lambda rng: (rng.uniform(0.4, 2.5, 3), rng.uniform(0.1, 2, 3), float(rng.uniform(0.01, 0.05))),
    truth=lambda slopes, weights, seconds: seconds / _pace(slopes, weights),
    mistakes=[
        Mistake(
            lambda slopes, weights, seconds: seconds * float(weights @ (1 / slopes) / weights.sum()),
            "that averages the clips' rates 1/S′. It is another mean, never a lower one, so the blend plays "
            "too fast; average the slopes, and divide by that.",
        ),
        Mistake(
            lambda slopes, weights, seconds: seconds * _pace(slopes, weights),
            "the wrong way round: where the clips need *more* seconds, the common clock goes slower.",
        ),
        Mistake(
            lambda slopes, weights, seconds: seconds / slopes[weights.argmax()],
            "that is the pace of the heaviest clip alone; all clips count by their weights.",
        ),
        Mistake(
            lambda slopes, weights, seconds: seconds / float(weights @ slopes),
            "the weights may have any sum here: divide by it.",
        ),
        Mistake(
            lambda slopes, weights, seconds: 1 / _pace(slopes, weights),
            "that is per second; a frame lasts `seconds`.",
        ),
    ],
)
