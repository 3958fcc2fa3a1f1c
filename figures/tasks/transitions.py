"""Where can one clip pass into another? Ten places for each pair of clips, ten frames apart and long.

Each is made: the windows are aligned and blended. Jump: how far velocity jumps there at most, 1 as in all but
0.1 % of the clips' windows. Slide: how far planted feet stray there. Other foot: how often a foot stands in
one window and not in the other. Means over the places.
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
from mocap.matching.distance_grids import diagonal_sum
from mocap.matching.other_metrics import Metric, euler_grid, root_grid
from mocap.quality import seam_quality, spread
from tasks import BANDAI, HOMEWORK, WALKS, Case

CLIPS = {
    "bundled clips": (*WALKS, "sneak", "jog", "stop_and_go"),
    "homework's clips": HOMEWORK,
    "CMU 16, walks and runs": tuple(f"16/16_{n}" for n in (15, 17, 20, 26, 33, 36, 44)),
    "CMU 49, dance": tuple(f"49/49_{n:02}" for n in (10, 12, 14, 17, 22)),
    "Bandai-Namco": BANDAI,
}
MEASURES = {"jump": True, "slide, cm": True, "other foot, %": True}
BASELINES = ("roots", "Euler angles", "poses")
PLACES, WINDOW, AROUND, LONGEST = 10, 10, 20, 300  # all but the first in frames


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield all pairs of clips."""
    usual = spread(clips)
    for a, b in combinations(clips, 2):
        yield Case(collection, f"{a.name}-{b.name}", {"a": a[:LONGEST], "b": b[:LONGEST]}, usual)


def lowest(metric: Metric, case: Case) -> Array:
    """Give the lowest local minima of a metric's grid, the lowest first, no two of them side by side."""
    grid = metric(case.given["a"], case.given["b"], window=WINDOW)
    found = local_minima(np.asarray(grid, float))
    return apart(found[np.argsort(grid[tuple(found.T)], kind="stable")].astype(float))


def apart(rows: Array) -> Array:
    """Take the first places, and none that is within a window of one before it in both clips."""
    taken: list[Array] = []
    for row in rows:
        if len(taken) < PLACES and all(np.abs(row - other).max() >= WINDOW for other in taken):
            taken.append(row)
    return np.reshape(taken, (-1, 2))


def pose_grid(a: Motion, b: Motion, *, window: int) -> Array:
    """Average over the window √(Σ over joints ‖Δq‖²), without the root; of q and -q the nearer one counts."""
    p, q = (np.swapaxes(clip.rotations[:, 1:], 0, 1) for clip in (a, b))
    square = sum(2 - 2 * np.minimum(np.abs(one @ other.T), 1.0) for one, other in zip(p, q, strict=True))
    return np.asarray(diagonal_sum(np.sqrt(square), window) / window)


METRICS = {"roots": root_grid, "Euler angles": euler_grid, "poses": pose_grid, "point clouds": distance_grid}
METHODS: dict[str, Callable[[Case], Array]] = {
    name: partial(lowest, metric) for name, metric in METRICS.items()
}


def score(case: Case, answer: Array) -> Array:
    """Join the clips at each place; rows are the first frames of both windows."""
    a, b = case.given["a"], case.given["b"]
    if answer.shape[1] != 2 or not 0 < len(apart(answer)) == len(answer):
        raise MocapError(f"{case.name} asks for up to {PLACES} rows of two frames, none side by side.")
    rows = []
    for i, j in answer.astype(int).tolist():
        start = max(0, i - AROUND)
        joined = join(a[start : i + WINDOW], i - start, b[j : j + WINDOW + AROUND], 0, WINDOW)
        seam = seam_quality(joined, (i - start, i - start + WINDOW), case.truth)
        other = [a.contacts[foot][i : i + WINDOW] != b.contacts[foot][j : j + WINDOW] for foot in a.contacts]
        rows.append([seam.velocity_jump, seam.foot_sliding, 100 * np.mean(other)])
    return np.mean(rows, axis=0)
