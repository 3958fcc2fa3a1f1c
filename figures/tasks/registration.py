"""Which moment of another clip belongs to each moment of one: foot strikes must fall on foot strikes.

`strikes` is the median of how far a strike of the one clip is from the other's, where the answer puts it;
`late` counts those that are off by more than 100 ms; `wobble` is the standard deviation of the pace over its
mean, where both walk evenly. An answer has rows of two seconds: one in either clip, both rising.
"""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap.blending import register
from mocap.blending.timewarps import fit_curve
from mocap.body import Motion
from mocap.body.limbs import find_legs
from mocap.matching import distance_grid, point_cloud, time_path
from tasks import Case

SPEEDS = (0.8, 1.1, 1.4)  # m/s
TURNS = (-120, 0, 120)  # degrees
CMU_WALKS = (11, 13, 15, 17, 19, 21, 22, 31, 47, 58)
CMU_RUNS = (35, 36, 37, 38, 39, 40, 45, 46)
BUNDLED = tuple(f"walk_5m_{speed}_{turn}" for speed in SPEEDS for turn in TURNS)
CLIPS = {
    "bundled walks": BUNDLED,
    "CMU 16, walks": tuple(f"16/16_{trial}" for trial in CMU_WALKS),
    "CMU 16, runs": tuple(f"16/16_{trial}" for trial in CMU_RUNS),
}
MEASURES = {"strikes (ms)": True, "late (%)": True, "wobble (%)": True}
DECIDED = {"wobble (%)": "a line does not wobble"}
BASELINES = ("fitted line", "even stretch")
LATE = 100  # milliseconds
SLACK = 36  # frames
WINDOW = 5  # frames


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield all pairs, the second clip as it is and played at 0.7 to 1.3 times its pace."""
    for first, even in combinations(clips, 2):
        wave = even.duration / (4 * np.pi)
        t = np.arange(len(even)) / even.fps
        seconds = np.clip(t + 0.3 * wave * np.sin(t / wave), 0, even.duration)
        uneven = even.at(even.fps * seconds)
        for pace, second in (("even", even), ("uneven", uneven)):
            data = {"one": first, "other": second}
            truth = (strikes(first), strikes(second), pace)
            yield Case(f"{collection}, {pace} pace", f"{first.name}-{even.name}-{pace}", data, truth)


def strikes(motion: Motion) -> list[Array]:
    """Give the seconds at which the left and the right foot come down."""
    names = motion.skeleton.names
    seconds = []
    for leg in find_legs(motion.skeleton):
        stands = motion.contacts[names[leg.ankle]] | motion.contacts[names[leg.ball]]
        seconds.append(np.array([start for start, _ in runs(stands) if start > 0]) / motion.fps)
    return seconds


def registered(case: Case) -> Array:
    """Register the clips."""
    registration = register([case.given["one"], case.given["other"]])
    u = np.linspace(*registration.span, 200)
    return np.stack([u, registration.times[1](u)], axis=1)


def line(case: Case) -> Array:
    """Fit a straight line through the path of least mean distance."""
    clouds = [point_cloud(case.given[name]) for name in ("one", "other")]
    grid = np.sqrt(distance_grid(*clouds, window=WINDOW))
    cells = time_path(grid, slack=min(SLACK, min(grid.shape) // 2)) + (WINDOW - 1) / 2
    u, second_times = cells.T / case.given["one"].fps
    curve = fit_curve(u, second_times, spacing=np.inf, least=1 / 3, most=3.0)
    return np.stack([u, curve(u)], axis=1)


def stretch(case: Case) -> Array:
    """Lay the first frames on one another, and the last ones."""
    shares = np.linspace(0, 1, 200)
    return np.stack([shares * case.given[name].duration for name in ("one", "other")], axis=1)


METHODS = {"register": registered, "fitted line": line, "even stretch": stretch}


def score(case: Case, answer: Array) -> tuple[float, float, float]:
    """Measure strikes, those that are late, and how the pace wobbles."""
    u, second_times = np.unique(answer, axis=0).T
    first_strikes, second_strikes, pace = case.truth
    errors = []
    for ours, theirs in zip(first_strikes, second_strikes, strict=True):
        moments = np.interp(ours[(ours >= u[0]) & (ours <= u[-1])], u, second_times)
        errors += [1000 * np.abs(theirs - moment).min() for moment in moments if len(theirs)]
    late = 100 * float(np.mean(np.array(errors) > LATE)) if errors else np.nan
    steps = np.diff(np.interp(np.linspace(u[0], u[-1], 100), u, second_times))
    wobble = 100 * float(steps.std() / steps.mean()) if pace == "even" else np.nan
    return float(np.median(errors)) if errors else np.nan, late, wobble
