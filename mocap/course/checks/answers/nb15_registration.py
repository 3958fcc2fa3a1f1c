"""Notebook 15: inputs, right answers and mistakes of `next_row` and `ground_step`."""

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.course.checks.answers.common import Arguments


def shifted(row: Array) -> Array:
    """Shift a row by one column to the right."""
    return np.append(np.inf, row[:-1])


# ---- next_row


def draw_next_row(rng: np.random.Generator) -> Arguments:
    """Draw what is known of the row above, with cells that no path has reached, and a row of costs."""
    diagonal = rng.uniform(1, 5, 8)
    diagonal[rng.integers(0, 8, 2)] = np.inf
    best = np.minimum(diagonal, rng.uniform(1, 5, 8))
    best[0] = diagonal[0]
    return diagonal, best, rng.uniform(0, 2, 8)


def right_next_row(diagonal: Array, best: Array, costs: Array) -> Array:
    """Return what is known of the next row of a path's costs: its last step not diagonal, and any."""
    diagonal_sums = 2 * costs + shifted(best)
    return np.array(
        [
            diagonal_sums,
            np.minimum(np.minimum(diagonal_sums, costs + diagonal), costs + shifted(diagonal_sums)),
        ]
    )


def mistake_diagonal_counted_once(diagonal: Array, best: Array, costs: Array) -> object:
    """Add the cost of a cell once, not twice, after a diagonal step."""
    diagonal_sums = costs + shifted(best)
    return np.array(
        [
            diagonal_sums,
            np.minimum(np.minimum(diagonal_sums, costs + diagonal), costs + shifted(diagonal_sums)),
        ]
    )


def mistake_rolled(diagonal: Array, best: Array, costs: Array) -> object:
    """Enter column 0 by a diagonal step from the best sum of the last column."""
    diagonal_sums = 2 * costs + np.roll(best, 1)
    return np.array(
        [
            diagonal_sums,
            np.minimum(np.minimum(diagonal_sums, costs + diagonal), costs + shifted(diagonal_sums)),
        ]
    )


def mistake_from_diagonal_alone(diagonal: Array, best: Array, costs: Array) -> object:
    """Allow a diagonal step only after another diagonal step."""
    diagonal_sums = 2 * costs + shifted(diagonal)
    return np.array(
        [
            diagonal_sums,
            np.minimum(np.minimum(diagonal_sums, costs + diagonal), costs + shifted(diagonal_sums)),
        ]
    )


def mistake_two_steps_down(diagonal: Array, best: Array, costs: Array) -> object:
    """Allow a step down after any step: it adds the cost to the best sum of the row above."""
    diagonal_sums = 2 * costs + shifted(best)
    return np.array(
        [diagonal_sums, np.minimum(np.minimum(diagonal_sums, costs + best), costs + shifted(diagonal_sums))]
    )


def mistake_right_from_above(diagonal: Array, best: Array, costs: Array) -> object:
    """Add the cost of a step to the right to the diagonal sum of the row above, one column to the left."""
    diagonal_sums = 2 * costs + shifted(best)
    return np.array(
        [diagonal_sums, np.minimum(np.minimum(diagonal_sums, costs + diagonal), costs + shifted(diagonal))]
    )


def mistake_no_step_to_the_right(diagonal: Array, best: Array, costs: Array) -> object:
    """Return as the best sums the smaller of those after a diagonal step and a step down."""
    diagonal_sums = 2 * costs + shifted(best)
    return np.array([diagonal_sums, np.minimum(diagonal_sums, costs + diagonal)])


# ---- ground_step


def draw_ground_step(rng: np.random.Generator) -> Arguments:
    """Draw a heading and a place, the turns and moves of three clips over a step, and weights."""
    turns = rng.uniform(-3, 3, 3) + np.array([np.zeros(3), rng.normal(0, 0.4, 3)])
    moves = np.asarray(rng.normal(size=(3, 2)) @ [0.1, 0.1j], complex)
    place = complex(*rng.normal(size=2))
    return float(rng.uniform(-3, 3)), place, turns, moves, rng.dirichlet(np.ones(3))


def right_ground_step(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> tuple[float, complex]:
    """Go one step by the weighted turns; each move is turned by the mean of before and after."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + new_heading)
    return new_heading, complex(place + weights @ (np.exp(1j * angles) * moves))


def mistake_heading_added(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Add the weighted mean of Δθ to φ instead of subtracting it."""
    new_heading = heading + float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + new_heading)
    return new_heading, complex(place + weights @ (np.exp(1j * angles) * moves))


def mistake_heading_left_out(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Rotate each move by the clip's mean angle θ without the blend's φ."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = turns.mean(axis=0)
    return new_heading, complex(place + weights @ (np.exp(1j * angles) * moves))


def mistake_moves_not_turned(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Add the weighted mean of the moves as they were captured."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    return new_heading, complex(place + weights @ moves)


def mistake_turned_backwards(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Rotate each move by exp(-i angle), with the right mean angle."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + new_heading)
    return new_heading, complex(place + weights @ (np.exp(-1j * angles) * moves))


def mistake_first_frame(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Rotate each move by θ + φ of the first frame."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = turns[0] + heading
    return new_heading, complex(place + weights @ (np.exp(1j * angles) * moves))


def mistake_second_frame(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Rotate each move by θ + φ of the second frame."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = turns[1] + new_heading
    return new_heading, complex(place + weights @ (np.exp(1j * angles) * moves))


def mistake_mean_angle(heading: float, place: complex, turns: Array, moves: Points, weights: Array) -> object:
    """Rotate all moves by the weighted mean of the clips' angles."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + new_heading)
    return new_heading, complex(place + weights @ (np.exp(1j * (weights @ angles)) * moves))


def mistake_equal_weights_of_turns(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Subtract the unweighted mean of Δθ from φ."""
    new_heading = heading - float(np.mean(turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + new_heading)
    return new_heading, complex(place + weights @ (np.exp(1j * angles) * moves))


def mistake_equal_weights_of_moves(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> object:
    """Add the unweighted mean of the rotated moves."""
    new_heading = heading - float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + new_heading)
    return new_heading, complex(place + np.mean(np.exp(1j * angles) * moves))
