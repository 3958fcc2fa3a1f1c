"""Measure how group motion graphs grow with their members: `python figures/grow_groups.py`.

Writes the table `groups.md` beside this script. Times are CPU time of one run, on one core.
"""

import time
import warnings
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap import groups
from mocap.errors import MocapError, MocapWarning

FOLDER = Path(__file__).parent
SECONDS = 120.0  # simulated
MEMBERS = (12, 24, 48, 96)

HEAD = """# How a group motion graph grows

Written by `python figures/grow_groups.py`; CPU time of one run on one core. Two minutes of a flock are
simulated, clustered into at most six nodes of 0.5 m, and joined by clips. Then a way is planned over 24 m
past two points between two obstacles, and played. Covered is the share of the simulation near a node. Of
clips, those are kept that bring nobody nearer than 0.60 m and need at most 2.2 m/s².

"""
COLUMNS = (
    "members",
    "nodes",
    "covered",
    "clips kept",
    "simulating, ms per s",
    "clustering, s",
    "clips, s",
    "planning, s",
    "playing, ms per s",
    "one assignment, µs",
)

TAIL = """
Simulating and comparing look at all pairs of members. The assignment alone takes {0:.0f} times as long for
eight times the members: it grows with their power {1:.1f}; its worst case is the cube. Planning and playing
hardly notice the members: the clips' discs spare most tests, and a clip is played by one product. One
assignment of a thousand members takes {2:.0f} ms, and clustering two minutes compares 7140 pairs twice. Then
a k-d tree (`scipy.spatial.KDTree`) would serve the simulation, and an assignment among the nearest alone
(`scipy.sparse.csgraph.min_weight_full_bipartite_matching`) the comparison.
"""


def cpu(work: object, *args: object, **settings: object) -> tuple[object, float]:
    """Run something, and say which CPU time it took."""
    begun = time.process_time()
    result = work(*args, **settings)
    return result, time.process_time() - begun


def assignment(members: int) -> float:
    """Measure one assignment, microseconds: the least of five means of ten."""
    costs = np.random.default_rng(0).random((10, members, members))
    times = [cpu(lambda: [linear_sum_assignment(cost) for cost in costs])[1] for _ in range(5)]
    return 1e6 * min(times) / len(costs)


def row(members: int) -> str:
    """Measure one size of a group."""
    flock, simulated = cpu(groups.simulate, members, SECONDS)
    found, clustered = cpu(groups.cluster, flock, nodes=6, reach=0.5)
    graph, joined = cpu(groups.make_clips, found.nodes)
    room = 0.25 * np.sqrt(members)  # a larger group takes more room
    scene = groups.Scene(
        (12 + 3j, 24 + 0j), ((7 - 2j - 1j * room, 0.6), (18 + 3j + 1j * room, 0.6)), near=1.5
    )
    try:
        plan, planned = cpu(groups.plan_group, graph, scene)
        walk, text = plan.clips, f"{planned:.2f}"
    except MocapError as error:
        print(error)
        walk, text = groups.random_group_walk(graph, 8), "–"
    played, took = cpu(groups.play_group, graph, walk)
    cells = [
        members,
        len(found.nodes),
        f"{found.covered:.0%}",
        f"{graph.drawn.kept} of {graph.drawn.tried}",
    ]
    cells += [f"{1e3 * simulated / (SECONDS + 20):.2f}", f"{clustered:.2f}", f"{joined:.2f}", text]
    cells += [f"{1e3 * took / (len(played.places) / groups.RATE):.3f}", f"{assignment(members):.0f}"]
    return "| " + " | ".join(map(str, cells)) + " |\n"


def main() -> None:
    """Write the table."""
    warnings.simplefilter("ignore", MocapWarning)
    rows = []
    for members in MEMBERS:
        rows.append(row(members))
        print(rows[-1], end="")
    few, many, thousand = (assignment(members) for members in (12, 96, 1000))
    power = np.log(many / few) / np.log(8)
    table = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|\n" + "".join(rows)
    tail = TAIL.format(many / few, power, thousand / 1e3)
    (FOLDER / "groups.md").write_text(HEAD + table + tail, "utf-8")


if __name__ == "__main__":
    main()
