"""Lead twelve through walls with one gap, through corridors and random discs, and to points all around.

There: 100 when the middle of the group comes within a metre of it. Takes: seconds until then. Nearest two:
how near members come to each other, metres. Rim: how near to a disc's rim. `steered` has no plan; it has 24
goes with other figures and whims, of which the quickest counts that keeps clear, 0.60 and 0.30 m, or if none
does, the quickest. `the quicker` is the plan or, if that is as clear, steered without whims.
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
MEMBERS, WIDTHS, SPOTS, SEEDS, LIMIT = 12, (4.0, 3.0, 2.5, 2.0), (12, 16), range(24), 90.0
MEASURES = {"there, %": False, "takes, s": True, "nearest two, m": False, "rim, m": False}
BASELINES = ("steered",)
GOES = [  # rules and seeds of whims
    (Flock(avoid=avoid, gather=gather, whim=whim), seed)
    for avoid in (0.8, 1.2, 2.0)
    for gather in (0.35, 1.0)
    for whim, seed in ((0.0, 0), (0.5, 0), (0.5, 1), (0.5, 2))
]


def scenes(collection: str) -> Iterator[tuple[str, Scene]]:
    """Yield walls with a gap, and with a corridor behind it, or discs at random and a goal."""
    if collection in ("gaps", "corridors of 10 m"):
        length = 10 if collection.startswith("corridors") else 0
        for width in WIDTHS[: 3 if length else 4]:
            for spot in SPOTS:
                wall = [spot + 1j * side * (width / 2 + 0.6 + 1.1 * n) for side in (-1, 1) for n in range(12)]
                wall += [
                    spot + 1j * side * (width / 2 + 0.6) + z for side in (-1, 1) for z in range(1, length + 1)
                ]
                goal = spot + 14 + length + 0j
                yield f"{collection[:3]}-{width}-{spot}", Scene((goal,), tuple((disc, 0.6) for disc in wall))
        return
    for seed in SEEDS:
        draw, goal = np.random.default_rng(seed), 24 + 0j
        if collection == "random discs":
            discs = draw.uniform(6, 18, 7) + 1j * draw.uniform(-6, 6, 7)
        else:
            goal = complex(draw.uniform(8, 24) * np.exp(1j * draw.uniform(-np.pi, np.pi)))
            discs = draw.uniform(-18, 18, 9) + 1j * draw.uniform(-18, 18, 9)
            discs = discs[(np.abs(discs) > 5) & (np.abs(discs - goal) > 4)]
        yield f"discs-{seed}", Scene((goal,), tuple((complex(disc), 1.0) for disc in discs))


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield scenes: points (z, x) to pass, discs (z, x, radius), and where members start (z, x)."""
    start = group().nodes[0].places
    for name, scene in scenes(collection):
        discs = [[disc.real, disc.imag, radius] for disc, radius in scene.discs]
        points = [[point.real, point.imag] for point in scene.points]
        given = {"points": points, "discs": discs, "start": np.stack([start.real, start.imag], axis=1)}
        yield Case(collection, name, given, scene)


@cache
def group() -> GroupGraph:
    """Build the graph of the group."""
    return build_group(MEMBERS)


def flat(places: Array) -> Array:
    """Give places (F, N) as rows of z and x, (F, 2 N)."""
    return np.concatenate([places.real, places.imag], axis=1)


def steered(case: Case) -> Array:
    """Steer 24 times, and take the quickest that comes there; one that keeps clear, if any does."""
    ways: list[tuple[bool, int, Array]] = []
    for rules, seed in GOES:
        flock, points = steer_group(group().nodes[0], case.truth, rules=rules, seed=seed, limit=LIMIT)
        if points == len(case.truth.points):
            apart, rim = nearest_two(flock.places).min(), clearances(flock, case.truth).min()
            ways.append((apart < APART or rim < case.truth.body, len(flock.places), flat(flock.places)))
    if not ways:
        raise NoWalk("Steered, the group does not come there.")
    return min(ways, key=lambda way: way[:2])[2]


def planned(case: Case) -> Array:
    """Plan a way and walk it."""
    plan = plan_group(group(), case.truth)
    return flat(play_group(group(), plan.clips).places[: round(plan.seconds * RATE) + 1])


def quicker(case: Case) -> Array:
    """Take the plan, or a steered way that is quicker and as clear."""
    return flat(lead_group(group(), case.truth)[0].places)


METHODS = {"steered": steered, "planned": planned, "the quicker": quicker}


def score(case: Case, answer: Array) -> tuple[float, float, float, float]:
    """Measure a way: rows of ten per second, all z before all x."""
    if answer.shape[1] != 2 * MEMBERS:
        raise MocapError(f"{case.name} asks for rows of {2 * MEMBERS} numbers, got {answer.shape}.")
    places = answer[:, :MEMBERS] + 1j * answer[:, MEMBERS:]
    near = np.abs(places.mean(axis=1) - case.truth.points[-1]) <= case.truth.near + 1e-6
    apart = np.abs(places[:, :, None] - places[:, None]) + 9 * np.eye(MEMBERS)
    rim = clearances(Configuration(places, np.zeros_like(places)), case.truth).min()
    soon = near.argmax() / RATE if near.any() else np.nan
    return 100.0 * near.any(), float(soon), float(apart.min()), float(rim)
