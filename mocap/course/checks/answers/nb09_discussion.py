"""Notebook 09: inputs, right answers and mistakes of `alive` and `added_terms`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments, draw_odds

# ---- alive


def draw_alive(rng: np.random.Generator) -> Arguments:
    """Draw the probabilities of a Markov chain that can end, and a number of steps."""
    return draw_odds(rng)


def right_alive(odds: Array, steps: int) -> float:
    """Return the mean probability of taking so many steps."""
    return float(np.linalg.matrix_power(odds, steps).sum(axis=1).mean())


def mistake_entrywise_power(odds: Array, steps: int) -> object:
    """Return the mean row sum of the matrix with each entry raised to the power."""
    return (odds**steps).sum(axis=1).mean()


def mistake_dying(odds: Array, steps: int) -> object:
    """Return one minus the right probability."""
    return 1 - right_alive(odds, steps)


def mistake_sum_over_starts(odds: Array, steps: int) -> object:
    """Return the sum of all entries of the matrix power, the probabilities of all starts added up."""
    return np.linalg.matrix_power(odds, steps).sum()


def mistake_mean_over_places(odds: Array, steps: int) -> object:
    """Return the mean of all entries of the matrix power, over starts and ends."""
    return np.linalg.matrix_power(odds, steps).mean()


def mistake_power_of_mean(odds: Array, steps: int) -> object:
    """Return the mean probability of taking one step, raised to the number of steps."""
    return odds.sum(axis=1).mean() ** steps


def mistake_start_asked_again(odds: Array, steps: int) -> object:
    """Return the mean over the starts of the probability of one step, raised to the number of steps."""
    return (odds.sum(axis=1) ** steps).mean()


def mistake_step_too_few(odds: Array, steps: int) -> object:
    """Return the mean probability of taking one step fewer."""
    return np.linalg.matrix_power(odds, steps - 1).sum(axis=1).mean()


def mistake_step_too_many(odds: Array, steps: int) -> object:
    """Return the mean probability of taking one step more."""
    return np.linalg.matrix_power(odds, steps + 1).sum(axis=1).mean()


def mistake_starts_that_survive(odds: Array, steps: int) -> object:
    """Return the fraction of starts from which some walk can take all steps."""
    return float((np.linalg.matrix_power(odds, steps).sum(axis=1) > 0).mean())


def mistake_places_that_survive(odds: Array, steps: int) -> object:
    """Return the fraction of nodes at which some walk can be after all steps."""
    return float((np.linalg.matrix_power(odds, steps).sum(axis=0) > 0).mean())


def mistake_first_start_alone(odds: Array, steps: int) -> object:
    """Return the probability of taking all steps from the first start."""
    return np.linalg.matrix_power(odds, steps)[0].sum()


def mistake_diagonal(odds: Array, steps: int) -> object:
    """Return the mean probability of being at the start again after all steps."""
    return np.trace(np.linalg.matrix_power(odds, steps)) / len(odds)


def mistake_share_of_each_start(odds: Array, steps: int) -> object:
    """Return the probability of taking all steps from each start, shape (N,), without their mean."""
    return np.linalg.matrix_power(odds, steps).sum(axis=1)


def mistake_whole_matrix(odds: Array, steps: int) -> object:
    """Return the matrix power itself, shape (N, N)."""
    return np.linalg.matrix_power(odds, steps)


def mistake_times_steps(odds: Array, steps: int) -> object:
    """Return the mean row sum of the matrix multiplied by the number of steps."""
    return (odds * steps).sum(axis=1).mean()


# ---- added_terms


def draw_added_terms(rng: np.random.Generator) -> Arguments:
    """Draw how far two clips are apart, and weights that fall between frames of ones and of zeros."""
    steps = np.arange(1, int(rng.integers(8, 60)) + 1)
    falling = (1 - steps / len(steps)) ** rng.uniform(1.5, 4)  # it rarely passes 0.5 in the middle
    weights = np.concatenate([np.ones(3), falling, np.zeros(3)])
    return rng.normal(size=(len(weights), int(rng.integers(1, 7)))).cumsum(axis=0), weights


def right_added_terms(gap: Array, alpha: Array) -> tuple[Array, Array]:
    """Return both terms of the product rule by central differences."""
    slope = (alpha[2:] - alpha[:-2]) / 2
    speed = (gap[2:] - gap[:-2]) / 2
    curvature = np.diff(alpha, 2)
    return curvature[:, None] * gap[1:-1], 2 * slope[:, None] * speed


def mistake_mixed_term_once(gap: Array, alpha: Array) -> object:
    """Return the velocity term as α̇ Δv, half of the right one."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term, velocity_term / 2


def mistake_one_difference_not_halved(gap: Array, alpha: Array) -> object:
    """Return the velocity term with one of its two differences over two frames not divided by 2."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term, velocity_term * 2


def mistake_both_not_halved(gap: Array, alpha: Array) -> object:
    """Return the velocity term with both differences over two frames not divided by 2."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term, velocity_term * 4


def mistake_backward_differences(gap: Array, alpha: Array) -> object:
    """Return the velocity term from backward differences of both factors."""
    position_term, _ = right_added_terms(gap, alpha)
    slope = np.diff(alpha)[:-1]
    return position_term, 2 * slope[:, None] * np.diff(gap, axis=0)[:-1]


def mistake_forward_differences(gap: Array, alpha: Array) -> object:
    """Return the velocity term from forward differences of both factors."""
    position_term, _ = right_added_terms(gap, alpha)
    slope = np.diff(alpha)[1:]
    return position_term, 2 * slope[:, None] * np.diff(gap, axis=0)[1:]


def mistake_gap_early(gap: Array, alpha: Array) -> object:
    """Return the position term with Δx of the frame before."""
    _, velocity_term = right_added_terms(gap, alpha)
    return np.diff(alpha, 2)[:, None] * gap[:-2], velocity_term


def mistake_gap_late(gap: Array, alpha: Array) -> object:
    """Return the position term with Δx of the frame after."""
    _, velocity_term = right_added_terms(gap, alpha)
    return np.diff(alpha, 2)[:, None] * gap[2:], velocity_term


def mistake_velocity_first(gap: Array, alpha: Array) -> object:
    """Return the velocity term before the position term."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return velocity_term, position_term


def mistake_sum_of_terms(gap: Array, alpha: Array) -> object:
    """Return the sum of both terms as one array."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term + velocity_term


def mistake_clips_jolt(gap: Array, alpha: Array) -> object:
    """Add α Δa, the third term of the second derivative of α Δx, to the velocity term."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term, velocity_term + alpha[1:-1, None] * np.diff(gap, 2, axis=0)


def by_gradients(gap: Array, alpha: Array) -> tuple[Array, Array]:
    """Return both terms by np.gradient, in all frames."""
    slope = np.gradient(alpha)
    position_term = np.gradient(slope)[:, None] * gap
    return position_term, 2 * slope[:, None] * np.gradient(gap, axis=0)


def mistake_np_gradients(gap: Array, alpha: Array) -> object:
    """Return both terms by np.gradient, α̈ by applying it twice, in all F frames."""
    return by_gradients(gap, alpha)


def mistake_np_gradients_cut(gap: Array, alpha: Array) -> object:
    """Return both terms by np.gradient, α̈ by applying it twice, in the F - 2 inner frames."""
    position_term, velocity_term = by_gradients(gap, alpha)
    return position_term[1:-1], velocity_term[1:-1]


def mistake_gap_for_velocity(gap: Array, alpha: Array) -> object:
    """Return 2 α̇ Δx as the velocity term."""
    position_term, _ = right_added_terms(gap, alpha)
    return position_term, ((alpha[2:] - alpha[:-2])[:, None] * gap[1:-1])


def mistake_slope_for_curvature(gap: Array, alpha: Array) -> object:
    """Return α̇ Δx as the position term."""
    _, velocity_term = right_added_terms(gap, alpha)
    slope = (alpha[2:] - alpha[:-2]) / 2
    return slope[:, None] * gap[1:-1], velocity_term


def mistake_curvature_negated(gap: Array, alpha: Array) -> object:
    """Return the position term with the opposite sign."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return -position_term, velocity_term


def mistake_velocity_negated(gap: Array, alpha: Array) -> object:
    """Return the velocity term with the opposite sign."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term, -velocity_term


def mistake_place_halved(gap: Array, alpha: Array) -> object:
    """Return half of the position term."""
    position_term, velocity_term = right_added_terms(gap, alpha)
    return position_term / 2, velocity_term
