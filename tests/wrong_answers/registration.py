import numpy as np


def left_of(row):
    return np.concatenate([[np.inf], row[:-1]])


def counted_once(diagonal, best, costs):
    now = costs + left_of(best)
    return np.array([now, np.min([now, costs + diagonal, costs + left_of(now)], axis=0)])


def around_the_corner(diagonal, best, costs):
    now = 2 * costs + np.roll(best, 1)
    return np.array([now, np.min([now, costs + diagonal, costs + left_of(now)], axis=0)])


def diagonals_only(diagonal, best, costs):
    now = 2 * costs + left_of(diagonal)
    return np.array([now, np.min([now, costs + diagonal, costs + left_of(now)], axis=0)])


def down_and_down(diagonal, best, costs):
    now = 2 * costs + left_of(best)
    return np.array([now, np.min([now, costs + best, costs + left_of(now)], axis=0)])


def on_and_on(diagonal, best, costs):
    now = 2 * costs + left_of(best)
    rows = []
    for j, cost in enumerate(costs):
        ways = [now[j], cost + diagonal[j]] + ([cost + rows[-1]] if rows else [])
        rows.append(min(ways))
    return np.array([now, rows])


def from_the_row_above(diagonal, best, costs):
    now = 2 * costs + left_of(best)
    return np.array([now, np.min([now, costs + diagonal, costs + left_of(diagonal)], axis=0)])


def two_ways(diagonal, best, costs):
    now = 2 * costs + left_of(best)
    return np.array([now, np.minimum(now, costs + diagonal)])


def grown(heading, place, turns, moves, weights):
    after = heading + weights @ (turns[1] - turns[0])
    angle = (turns.sum(axis=0) + heading + after) / 2
    return after, place + weights @ (np.exp(1j * angle) * moves)


def fallen(heading, turns, weights):
    return heading - weights @ (turns[1] - turns[0])


def without_heading(heading, place, turns, moves, weights):
    return fallen(heading, turns, weights), place + weights @ (np.exp(1j * turns.mean(axis=0)) * moves)


def as_captured(heading, place, turns, moves, weights):
    return fallen(heading, turns, weights), place + weights @ moves


def other_side(heading, place, turns, moves, weights):
    after = fallen(heading, turns, weights)
    angle = (turns.sum(axis=0) + heading + after) / 2
    return after, place + weights @ (np.exp(-1j * angle) * moves)


def first_frame(heading, place, turns, moves, weights):
    turned = np.exp(1j * (turns[0] + heading)) * moves
    return fallen(heading, turns, weights), place + weights @ turned


def second_frame(heading, place, turns, moves, weights):
    after = fallen(heading, turns, weights)
    return after, place + weights @ (np.exp(1j * (turns[1] + after)) * moves)


def mean_angle(heading, place, turns, moves, weights):
    after = fallen(heading, turns, weights)
    angle = weights @ (turns.sum(axis=0) + heading + after) / 2
    return after, place + np.exp(1j * angle) * (weights @ moves)


def rates(slopes, weights, seconds):
    return seconds * np.average(1 / slopes, weights=weights)


def multiplied(slopes, weights, seconds):
    return seconds * np.average(slopes, weights=weights)


def heaviest(slopes, weights, seconds):
    return seconds / slopes[np.argmax(weights)]


def undivided(slopes, weights, seconds):
    return seconds / (weights @ slopes)


def per_second(slopes, weights, seconds):
    return 1 / np.average(slopes, weights=weights)


WRONG = {
    "next_row": [
        (counted_once, "counts twice"),
        (around_the_corner, "nothing to its left"),
        (diagonals_only, "may follow any step"),
        (down_and_down, "one step down may not follow another"),
        (on_and_on, "one step to the right may not follow another"),
        (from_the_row_above, "stays in its row"),
        (two_ways, "a third way"),
    ],
    "ground_step": [
        (grown, "the wrong way"),
        (without_heading, "*and* by the φ"),
        (as_captured, "as they were captured"),
        (other_side, "to the wrong side"),
        (first_frame, "of the first frame"),
        (second_frame, "of the second frame"),
        (mean_angle, "turn it first, and average afterwards"),
    ],
    "clock": [
        (rates, "averages the clips' rates"),
        (multiplied, "the wrong way round"),
        (heaviest, "the heaviest clip alone"),
        (undivided, "divide by it"),
        (per_second, "per second"),
    ],
}
