import numpy as np


def in_space(positions, start, stop):
    plant = positions[start:stop]
    return max(np.sqrt(((plant - plant.mean(0)) ** 2).sum(1)))


def of_all_frames(positions, start, stop):
    ground = positions[:, ::2]
    return max(np.sqrt(((ground - ground.mean(0)) ** 2).sum(1)))


def from_the_first(positions, start, stop):
    ground = positions[start:stop, ::2]
    return max(np.sqrt(((ground - ground[0]) ** 2).sum(1)))


def on_average(positions, start, stop):
    ground = positions[start:stop, ::2]
    return np.mean(np.sqrt(((ground - ground.mean(0)) ** 2).sum(1)))


def ground_speeds(positions):
    steps = positions[1:] - positions[:-1]
    return np.sqrt(steps[:, 0] ** 2 + steps[:, 2] ** 2)


def frame_before(positions, fps, fastest):
    return [f for f, speed in enumerate(ground_speeds(positions) * fps) if speed > fastest]


def without_fps(positions, fps, fastest):
    return [f + 1 for f, speed in enumerate(ground_speeds(positions)) if speed > fastest]


def upwards_too(positions, fps, fastest):
    speeds = np.sqrt(((positions[1:] - positions[:-1]) ** 2).sum(axis=1)) * fps
    return list(np.nonzero(speeds > fastest)[0] + 1)


def as_a_mask(positions, fps, fastest):
    return ground_speeds(positions) * fps > fastest


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


WRONG = {
    "creep": [
        (in_space, "only x and z count"),
        (of_all_frames, "of all frames"),
        (from_the_first, "from the first frame"),
        (on_average, "take the largest"),
    ],
    "leaps": [
        (frame_before, "the frames before"),
        (without_fps, "metres a frame"),
        (upwards_too, "leave y out"),
        (as_a_mask, "that is a mask"),
    ],
    "running": [
        (frame_by_frame, "flickers"),
        (divided_by_span, "still divide by all"),
        (without_ends, "the ends are missing"),
        (looking_back, "half a span late"),
        (walking, "marks walking"),
    ],
}
