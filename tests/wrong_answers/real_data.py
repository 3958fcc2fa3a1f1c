import numpy as np


def the_strict_one(speeds, enter, leave):
    return [bool(speed < enter) for speed in speeds]


def the_loose_one(speeds, enter, leave):
    return [bool(speed < leave) for speed in speeds]


def going_through(speeds, enter, leave):
    marks, on = [], False
    for speed in speeds:
        on = speed < leave if on else speed < enter
        marks.append(on)
    return np.array(marks)


def the_swings(speeds, enter, leave):
    slow = speeds < leave
    numbers = np.cumsum(np.diff(slow, prepend=False))
    plants = {number for number, speed in zip(numbers, speeds, strict=True) if speed < enter}
    return np.array([number not in plants for number in numbers])


def frame_by_frame(speeds, span, fastest_walk):
    return np.array([speed > fastest_walk for speed in speeds])


def divided_by_span(speeds, span, fastest_walk):
    half = span // 2
    sums = [speeds[max(0, f - half) : f + half + 1].sum() for f in range(len(speeds))]
    return np.array(sums) / span > fastest_walk


def without_ends(speeds, span, fastest_walk):
    return np.array([speeds[f : f + span].mean() for f in range(len(speeds) - span + 1)]) > fastest_walk


def looking_back(speeds, span, fastest_walk):
    return np.array([speeds[max(0, f - span + 1) : f + 1].mean() for f in range(len(speeds))]) > fastest_walk


def walking(speeds, span, fastest_walk):
    half = span // 2
    means = [speeds[max(0, f - half) : f + half + 1].mean() for f in range(len(speeds))]
    return np.array(means) <= fastest_walk


def below_zero(lengths, window):
    return 1 - 2 * window * len(lengths) / sum(lengths)


def at_one_end(lengths, window):
    return sum(max(0, length - window) for length in lengths) / sum(lengths)


def frames_kept(lengths, window):
    return sum(max(0, length - 2 * window) for length in lengths)


def mean_of_shares(lengths, window):
    return np.mean([max(0, 1 - 2 * window / length) for length in lengths])


def share_lost(lengths, window):
    return sum(min(length, 2 * window) for length in lengths) / sum(lengths)


WRONG = {
    "standing": [
        (the_strict_one, "the strict one"),
        (the_loose_one, "the loose one"),
        (going_through, "at its first frame"),
        (the_swings, "marks the swings"),
    ],
    "running": [
        (frame_by_frame, "flickers"),
        (divided_by_span, "still divide by all"),
        (without_ends, "the ends are missing"),
        (looking_back, "half a span late"),
        (walking, "marks walking"),
    ],
    "most_kept": [
        (below_zero, "shorter than two windows"),
        (at_one_end, "*both* ends"),
        (frames_kept, "a number of frames"),
        (mean_of_shares, "a mean of shares"),
        (share_lost, "that is lost"),
    ],
}
