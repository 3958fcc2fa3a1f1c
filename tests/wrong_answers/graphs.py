import numpy as np


def homework_odds(costs, left):
    return [left * cost / sum(costs) for cost in costs]


def odds_of_one(costs, left):
    odds = 1 / costs
    return odds / odds.sum()


def raw_odds(costs, left):
    return left * costs**-1.0


def complement(costs, left):
    return (1 - costs / costs.sum()) * left


def not_normed(costs, probabilities):
    return costs @ probabilities


def even_die(costs, probabilities):
    return costs.sum() / len(costs)


def mean_of_products(costs, probabilities):
    return (probabilities * costs).mean()


def likeliest(costs, probabilities):
    return max(zip(probabilities, costs, strict=True))[1]


def enter_at_window(frames, leaves, enters, window):
    return sorted(set(leaves) | set(enters) | {0, frames})


def without_ends(frames, leaves, enters, window):
    return np.unique([*leaves, *(np.array(enters) + window)])


def leave_after_window(frames, leaves, enters, window):
    return np.unique([0, *(np.array(leaves) + window), *(np.array(enters) + window), frames])


def last_frame(frames, leaves, enters, window):
    return np.unique([0, *leaves, *(np.array(enters) + window), frames - 1])


def repeated(frames, leaves, enters, window):
    return np.sort([0, frames] + leaves + [enter + window for enter in enters])


def unordered(frames, leaves, enters, window):
    return set(leaves) | {enter + window for enter in enters} | {0, frames}


def all_of_it(thresholds, frames, keep):
    return thresholds[frames == frames.max()].min()


def share_as_number(thresholds, frames, keep):
    return min(t for t, f in zip(thresholds, frames, strict=True) if f >= keep)


def kept_frames(thresholds, frames, keep):
    return frames[frames >= keep * max(frames)][0]


def place(thresholds, frames, keep):
    return np.flatnonzero(frames / frames.max() >= keep)[0]


WRONG = {
    "inverse_shares": [
        (homework_odds, "the slip to fix"),
        (odds_of_one, "share only `left`"),
        (raw_odds, "divide by their sum"),
        (complement, "n - 1"),
    ],
    "expected_seam": [
        (not_normed, "add up to ½"),
        (even_die, "equally likely"),
        (mean_of_products, "already replace 1 / n"),
        (likeliest, "the others are taken too"),
    ],
    "choice_points": [
        (enter_at_window, "*after* the window"),
        (without_ends, "start and end"),
        (leave_after_window, "where its window starts"),
        (last_frame, "after the last frame"),
        (repeated, "one node, not two"),
        (unordered, "a set has no order"),
    ],
    "suggested_threshold": [
        (all_of_it, "a share of it is enough"),
        (share_as_number, "of what?"),
        (kept_frames, "those are frames"),
        (place, "that is an index"),
    ],
}
