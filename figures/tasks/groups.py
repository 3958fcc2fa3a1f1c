"""Lead twelve through walls with one gap, through corridors and random discs, and to points all around.

There: 100 if the middle of the group comes within a metre of the goal. Takes: seconds until then. Nearest
two: least distance of two members, metres. Rim: least distance from a disc's rim. `steered` has no plan. Of
its 24 runs with other parameters and whims, the fastest one counts that keeps 0.60 m between members and
0.30 m from discs, or if none does, the fastest. `the quicker` is the plan or, if that is as clear, a flock
without whims.

Through corridors and to points all around, the fastest of 24 steered runs is as quick as a plan or quicker:
there is one way, and a flock that flows needs none of the plan's waiting. `lead_group` therefore is
`the quicker` of both.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion
from mocap.errors import MocapError, NoWalk
from mocap.methods.groups import (
    RATE,
    Flock,
    GroupGraph,
    Scene,
    build_group,
    clearances,
    lead_group,
    nearest_two,
    plan_group,
    play_group,
    steer_group,
)
from mocap.methods.groups.flocking import APART, Configuration
from tasks import Case

CLIPS: dict[str, tuple[str, ...]] = {
    "gaps": (),
    "corridors of 10 m": (),
    "random discs": (),
    "all around": (),
}
MEMBERS = 12
WIDTHS = (4.0, 3.0, 2.5, 2.0)  # of gaps, metres
CORRIDOR_WIDTHS = WIDTHS[:3]
CORRIDOR = 10  # length, metres
SPOTS = (12, 16)  # distance of a gap, metres
SEEDS = range(24)
LIMIT = 90.0  # seconds of steering
MEASURES = {"there, %": False, "takes, s": True, "nearest two, m": False, "rim, m": False}
DECIDED = {
    "nearest two, m": "a distance to keep, of 0.60 m, not one to widen",
    "rim, m": "a distance to keep, of 0.30 m, not one to widen",
}
BASELINES = ("steered",)
RUNS = [  # rules and seeds of whims
    (Flock(avoid=avoid, gather=gather, whim=whim), seed)
    for avoid in (0.8, 1.2, 2.0)
    for gather in (0.35, 1.0)
    for whim, seed in ((0.0, 0), (0.5, 0), (0.5, 1), (0.5, 2))
]


def scenes(collection: str) -> Iterator[tuple[str, Scene]]:
    """Yield walls with a gap, and with a corridor behind it, or random discs and a goal."""
    if collection == "gaps":
        yield from walls("gap", WIDTHS, 0)
    elif collection == "corridors of 10 m":
        yield from walls("cor", CORRIDOR_WIDTHS, CORRIDOR)
    else:
        yield from random_scenes(in_front=collection == "random discs")


def walls(name: str, widths: tuple[float, ...], length: int) -> Iterator[tuple[str, Scene]]:
    """Yield walls of discs with a gap, and a corridor of this length behind it."""
    for width in widths:
        rim = width / 2 + 0.6
        for spot in SPOTS:
            wall = [spot + 1j * side * (rim + 1.1 * n) for side in (-1, 1) for n in range(12)]
            wall += [spot + 1j * side * rim + z for side in (-1, 1) for z in range(1, length + 1)]
            goal = spot + 14 + length + 0j
            yield f"{name}-{width}-{spot}", Scene((goal,), tuple((disc, 0.6) for disc in wall))


def random_scenes(*, in_front: bool) -> Iterator[tuple[str, Scene]]:
    """Yield random discs: in front of a goal straight ahead, or all around with a goal anywhere."""
    for seed in SEEDS:
        draw = np.random.default_rng(seed)
        goal = 24 + 0j
        if in_front:
            discs = draw.uniform(6, 18, 7) + 1j * draw.uniform(-6, 6, 7)
        else:
            goal = complex(draw.uniform(8, 24) * np.exp(1j * draw.uniform(-np.pi, np.pi)))
            discs = draw.uniform(-18, 18, 9) + 1j * draw.uniform(-18, 18, 9)
            is_free = (np.abs(discs) > 5) & (np.abs(discs - goal) > 4)
            discs = discs[is_free]
        yield f"discs-{seed}", Scene((goal,), tuple((complex(disc), 1.0) for disc in discs))


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield scenes: points (z, x) to pass, discs (z, x, radius), and where members start (z, x)."""
    start = group().nodes[0].positions
    for name, scene in scenes(collection):
        discs = [[disc.real, disc.imag, radius] for disc, radius in scene.discs]
        points = [[point.real, point.imag] for point in scene.points]
        members = np.stack([start.real, start.imag], axis=1)
        yield Case(collection, name, {"points": points, "discs": discs, "start": members}, scene)


@cache
def group() -> GroupGraph:
    """Build the graph of the group."""
    return build_group(MEMBERS)


def flat(positions: Array) -> Array:
    """Write complex positions (F, N) as rows of z and x, (F, 2 N)."""
    return np.concatenate([positions.real, positions.imag], axis=1)


def steered(case: Case) -> Array:
    """Steer 24 times, and return the fastest run that arrives; one without collisions, if there is any."""
    runs: list[tuple[bool, int, Array]] = []
    for rules, seed in RUNS:
        flock, points = steer_group(group().nodes[0], case.truth, rules=rules, seed=seed, limit=LIMIT)
        if points == len(case.truth.points):
            distance = nearest_two(flock.positions).min()
            clearance = clearances(flock, case.truth).min()
            collides = distance < APART or clearance < case.truth.body
            runs.append((collides, len(flock.positions), flat(flock.positions)))
    if not runs:
        raise NoWalk("Steered, the group does not come there.")
    return min(runs, key=lambda run: run[:2])[2]


def planned(case: Case) -> Array:
    """Plan a path and walk it."""
    plan = plan_group(group(), case.truth)
    frames = round(plan.seconds * RATE) + 1
    return flat(play_group(group(), plan.clips).positions[:frames])


def quicker(case: Case) -> Array:
    """Return the plan, or a steered flock that is faster and as clear."""
    return flat(lead_group(group(), case.truth)[0].positions)


METHODS = {"steered": steered, "planned": planned, "the quicker": quicker}


def score(case: Case, answer: Array) -> tuple[float, float, float, float]:
    """Measure trajectories: rows of ten per second, all z before all x."""
    if answer.shape[1] != 2 * MEMBERS:
        raise MocapError(f"{case.name} asks for rows of {2 * MEMBERS} numbers, got {answer.shape}.")
    positions = answer[:, :MEMBERS] + 1j * answer[:, MEMBERS:]
    is_at_goal = np.abs(positions.mean(axis=1) - case.truth.points[-1]) <= case.truth.radius + 1e-6
    arrives = bool(is_at_goal.any())
    seconds = is_at_goal.argmax() / RATE if arrives else np.nan
    distance = nearest_two(positions).min()
    clearance = clearances(Configuration(positions, np.zeros_like(positions)), case.truth).min()
    return 100.0 if arrives else 0.0, float(seconds), float(distance), float(clearance)
