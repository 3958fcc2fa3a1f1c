"""Measure how group motion graphs grow with their members: `OMP_NUM_THREADS=1 python figures/grow_groups.py`.

Writes the table `groups.md` beside this script. Times are CPU time of one run, on one core.
"""

import time
import warnings
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_array
from scipy.sparse.csgraph import min_weight_full_bipartite_matching
from scipy.spatial import KDTree
from scipy.spatial.distance import cdist

from mocap.body import PlanarTransform
from mocap.errors import MocapError, MocapWarning
from mocap.methods import groups
from mocap.methods.groups.planning import GroupWalk

FOLDER = Path(__file__).parent
SECONDS = 120.0  # simulated
MEMBERS = (12, 24, 48, 96)
NEAREST = (5, 10, 20)  # candidates for each of a thousand

HEAD = """# How a group motion graph grows

`OMP_NUM_THREADS=1 python figures/grow_groups.py` writes this page, with CPU times of one run. It
simulates a flock for two minutes, clusters the simulation into at most six nodes with a radius of 0.5 m,
and connects the nodes by clips. Then it plans a path of 24 m through two waypoints between two obstacles,
and plays it. "Covered" is the fraction of the simulation near a node. A clip is kept if all members stay
at least 0.60 m apart and need at most 2.2 m/s².

"""
COLUMNS = (
    "members",
    "nodes",
    "covered",
    "clips kept",
    "simulating, ms per s",
    "clustering, s",
    "clips, s",
    "planning, ms",
    "playing, ms per s",
    "one assignment, µs",
)

TAIL = """
Simulation and comparison consider all pairs of members. The assignment alone takes {0:.0f} times as long
for eight times as many members, so it grows with the power {1:.1f} of their number. Its worst case is
cubic. The times of planning and playing hardly depend on the number of members, because the bounding
discs of clips avoid most tests, and because a clip is played by one matrix product.

## A thousand members

Two groups of a thousand members, 1.3 m apart, differ by 0.35 m and 0.3 m/s at random. In the first row
all members are candidates for all others (`scipy.optimize.linear_sum_assignment`). In the other rows only
the {2} nearest are candidates: `scipy.spatial.KDTree` finds them, and
`scipy.sparse.csgraph.min_weight_full_bipartite_matching` assigns them.

| candidates | costs, ms | assignment, ms | sum of squares, relative to the minimum |
|---|---|---|---|
{3}
The Hungarian method is therefore fast enough for a thousand members, although clustering two minutes
requires 14 280 such comparisons. With five candidates a comparison is several times as fast and hardly
worse. With more candidates it takes longer than with all, and for less similar groups an assignment among
five candidates need not exist. The same k-d tree could be used in the simulation, which considers all
pairs of members in each frame.

## Two groups that pass each other

Two groups of {4} walk towards each other over 24 m, and the second group plans around the first, frame by
frame. Without this, the smallest distance between members is {5:.2f} m. With it, the distance is {6:.2f}
m. The search takes {7:.0f} ms for {8}, instead of {9:.0f} ms for {10}, and the bounds avoid {11:.0%} of
the tests. A few groups can therefore be planned one after the other, where the first one does not avoid
the others.

## Scenes without a path

A group of {12} starts 5 m in front of an area of 10 m by 10 m with eight discs of 1.3 m at random, and
its goal is 5 m behind the area. The search finds a path in {14} of {13} scenes. Steering without a plan
and without random drift reaches the goal without touching a disc in {15} scenes, and faster than the plan
in {16}. A search takes {17:.1f} times as long as simulating the same duration.
"""


def cpu(work: object, *args: object, **settings: object) -> tuple[object, float]:
    """Run something, and return its result and CPU time, seconds."""
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
    clusters, clustered = cpu(groups.cluster, flock, nodes=6, reach=0.5)
    graph, joined = cpu(groups.make_clips, clusters.nodes)
    room = 0.25 * np.sqrt(members)  # a larger group takes more room
    first_disc = (7 - 2j - 1j * room, 0.6)
    second_disc = (18 + 3j + 1j * room, 0.6)
    scene = groups.Scene((12 + 3j, 24 + 0j), (first_disc, second_disc), radius=1.5)
    try:
        plan, planned = cpu(groups.plan_group, graph, scene)
        walk = plan.clips
        milliseconds = f"{1e3 * planned:.0f}"
    except MocapError as error:
        print(error)
        walk = groups.random_group_walk(graph, 8)
        milliseconds = "–"
    played, took = cpu(groups.play_group, graph, walk)
    cells = [
        members,
        len(clusters.nodes),
        f"{clusters.covered:.0%}",
        f"{len(graph.clips)} of {graph.tried}",
    ]
    cells += [f"{1e3 * simulated / (SECONDS + 20):.2f}", f"{clustered:.2f}", f"{joined:.2f}", milliseconds]
    cells += [f"{1e3 * took / (len(played.positions) / groups.RATE):.3f}", f"{assignment(members):.0f}"]
    return "| " + " | ".join(map(str, cells)) + " |\n"


def thousand() -> str:
    """Compare assignments among all and among the nearest, for a thousand members."""
    random = np.random.default_rng(0)
    grid = 1.3 * np.stack(np.divmod(np.arange(1000), 32), axis=-1)
    spread = np.array([0.35, 0.35, 0.7 * 0.3, 0.7 * 0.3])
    still = np.pad(grid, ((0, 0), (0, 2)))
    first = still + spread * random.normal(size=(1000, 4))
    second = still + spread * random.normal(size=(1000, 4))
    second = random.permutation(second)
    costs, took = cpu(cdist, first, second, "sqeuclidean")
    best, assigned = cpu(linear_sum_assignment, costs)
    lines = f"| all | {1e3 * took:.1f} | {1e3 * assigned:.1f} | 1 |\n"
    for count in NEAREST:
        (distances, members), searched = cpu(lambda k: KDTree(second).query(first, k), count)
        starts = np.arange(0, distances.size + 1, count)
        table = csr_array((distances.ravel() ** 2, members.ravel(), starts), shape=(1000, 1000))
        order, matched = cpu(min_weight_full_bipartite_matching, table)
        ratio = costs[order].sum() / costs[best].sum()
        lines += f"| {count} | {1e3 * searched:.1f} | {1e3 * matched:.1f} | {ratio:.4f} |\n"
    return lines


def passing(graph: groups.GroupGraph) -> tuple[object, ...]:
    """Plan a group around another one that comes towards it, and without regard to it."""
    first = groups.play_group(graph, groups.plan_group(graph, groups.Scene((24 + 0j,))).clips).positions
    back = PlanarTransform(np.pi, 0.0, 24.0)

    def distance(plan: GroupWalk) -> float:
        frames = round(plan.seconds * groups.RATE) + 1
        positions = groups.play_group(graph, plan.clips, back).positions[:frames]
        others = first[np.minimum(np.arange(len(positions)), len(first) - 1)]  # reads: name: of `Scene`
        return float(np.abs(positions[:, :, None] - others[:, None]).min())

    alone, quick = cpu(groups.plan_group, graph, groups.Scene((0j,)), start=back)
    careful, slow = cpu(groups.plan_group, graph, groups.Scene((0j,), others=(first,)), start=back)
    spared = careful.spared / (careful.spared + careful.tested)
    searches = (
        f"{careful.seconds:.0f} s of walking",
        1e3 * quick,
        f"{alone.seconds:.0f} s of walking",
        spared,
    )
    return graph.members, distance(alone), distance(careful), 1e3 * slow, *searches


def crowded(graph: groups.GroupGraph) -> tuple[object, ...]:
    """Count in how many scenes a path is found, and a steered one; compare CPU times."""
    scenes = range(60)
    counts = np.zeros(3, int)
    searching = 0.0
    simulating = 0.0
    for seed in scenes:
        draw = np.random.default_rng(seed)
        discs = draw.uniform(5, 15, 8) + 1j * draw.uniform(-5, 5, 8)
        scene = groups.Scene((20 + 0j,), tuple((complex(disc), 1.3) for disc in discs))
        flock, passed = groups.steer_group(graph.nodes[0], scene, rules=groups.Flock(whim=0.0))
        clear = passed == 1 and groups.clearances(flock, scene).min() >= scene.body
        try:
            plan, took = cpu(groups.plan_group, graph, scene)
        except MocapError:
            counts += [False, clear, clear]
            continue
        counts += [True, clear, clear and len(flock.positions) / groups.RATE < plan.seconds]
        searching += took
        simulating += cpu(groups.simulate, graph.members, plan.seconds)[1]
    return len(scenes), *counts, searching / simulating


def main() -> None:
    """Write the table."""
    warnings.simplefilter("ignore", MocapWarning)
    rows = []
    for members in MEMBERS:
        rows.append(row(members))
        print(rows[-1], end="")
    assigned_12, assigned_96 = (assignment(members) for members in (12, 96))
    ratio = assigned_96 / assigned_12
    power = np.log(ratio) / np.log(8)
    table = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|\n" + "".join(rows)
    twelve = groups.build_group(12)
    numbers = (*passing(twelve), 12, *crowded(twelve))
    tail = TAIL.format(ratio, power, "5, 10 or 20", thousand(), *numbers)
    (FOLDER / "groups.md").write_text(HEAD + table + tail, "utf-8")


if __name__ == "__main__":
    main()
