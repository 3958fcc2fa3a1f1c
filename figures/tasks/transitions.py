"""Where can one clip pass into another? Ten places for each pair of clips, ten frames apart and long.

Each is made: the windows are aligned and blended. Jump: how far velocity jumps there at most, 1 as in all but
0.1 % of the clips' windows. Slide: how far planted feet stray there. Other foot: how often a foot stands in
one window and not in the other. Means over the places.

On dance, poses or angles find better places: the RMS distance of all points hides a foot that slides by as
much as the rest is alike, and dancers stand on one foot, with the other anywhere.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import combinations

import numpy as np

from mocap._shared.arrays import Array
from mocap.blending import join
from mocap.body import Motion
from mocap.errors import MocapError
from mocap.matching import distance_grid, local_minima
from mocap.matching.other_metrics import Metric, euler_grid, root_grid
from mocap.matching.window_sums import diagonal_sum
from mocap.quality import seam_quality, spread
from tasks import BANDAI, HOMEWORK, WALKS, Case

WALKS_AND_RUNS = tuple(f"16/16_{n}" for n in (15, 17, 20, 26, 33, 36, 44))
CLIPS = {
    "bundled clips": (*WALKS, "sneak", "jog", "stop_and_go"),
    "homework's clips": HOMEWORK,
    "CMU 16, walks and runs": WALKS_AND_RUNS,
    "CMU 49, dance": ("49/49_10", "49/49_12", "49/49_14", "49/49_17", "49/49_22"),
    "Bandai-Namco": BANDAI,
}
MEASURES = {"jump": True, "slide, cm": True, "other foot, %": True}
BASELINES = ("roots", "Euler angles", "poses")
PLACES = 10  # for a pair of clips
WINDOW = 10  # frames
MARGIN = 20  # frames before and after a window
LONGEST = 300  # frames of a clip


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield all pairs of clips."""
    usual = spread(clips)
    for a, b in combinations(clips, 2):
        yield Case(collection, f"{a.name}-{b.name}", {"a": a[:LONGEST], "b": b[:LONGEST]}, usual)


def lowest(metric: Metric, case: Case) -> Array:
    """Give the lowest local minima of a metric's grid, the lowest first, no two of them side by side."""
    grid = metric(case.given["a"], case.given["b"], window=WINDOW)
    minima = local_minima(np.asarray(grid, float))
    order = np.argsort(grid[tuple(minima.T)], kind="stable")
    return separated(minima[order].astype(float))


def separated(rows: Array) -> Array:
    """Take the first places, and none that is within a window of one before it in both clips."""
    chosen: list[Array] = []
    for row in rows:
        if len(chosen) < PLACES and all(np.abs(row - earlier).max() >= WINDOW for earlier in chosen):
            chosen.append(row)
    return np.reshape(chosen, (-1, 2))


def pose_grid(a: Motion, b: Motion, *, window: int) -> Array:
    """Average over the window √(Σ over joints ‖Δq‖²), without the root; of q and -q the nearer one counts."""
    p, q = (np.swapaxes(clip.rotations[:, 1:], 0, 1) for clip in (a, b))
    cosines = (np.abs(of_a @ of_b.T) for of_a, of_b in zip(p, q, strict=True))  # of each joint
    squares = sum(2 - 2 * np.minimum(cosine, 1.0) for cosine in cosines)
    return np.asarray(diagonal_sum(np.sqrt(squares), window) / window)


METRICS = {
    "roots": root_grid,
    "Euler angles": euler_grid,
    "poses": pose_grid,
    "point clouds": distance_grid,
}
Method = Callable[[Case], Array]
METHODS: dict[str, Method] = {name: partial(lowest, metric) for name, metric in METRICS.items()}


def score(case: Case, answer: Array) -> Array:
    """Join the clips at each place; rows are the first frames of both windows."""
    a = case.given["a"]
    b = case.given["b"]
    if answer.shape[1] != 2 or not 0 < len(separated(answer)) == len(answer):
        raise MocapError(f"{case.name} asks for up to {PLACES} rows of two frames, none side by side.")
    rows = []
    for i, j in answer.astype(int).tolist():
        start = max(0, i - MARGIN)
        leave = i - start
        later = b[j : j + WINDOW + MARGIN]
        joined = join(a[start : i + WINDOW], leave, later, 0, WINDOW)
        seam = seam_quality(joined, (leave, leave + WINDOW), case.truth)
        stands_in_a = np.array([contact[i : i + WINDOW] for contact in a.contacts.values()])
        stands_in_b = np.array([b.contacts[foot][j : j + WINDOW] for foot in a.contacts])
        rows.append([seam.velocity_jump, seam.foot_sliding, 100 * np.mean(stands_in_a != stands_in_b)])
    return np.mean(rows, axis=0)
