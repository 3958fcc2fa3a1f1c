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

Written by `OMP_NUM_THREADS=1 python figures/grow_groups.py`; CPU time of one run. Two minutes of a flock are
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
    "planning, ms",
    "playing, ms per s",
    "one assignment, µs",
)

TAIL = """
Simulating and comparing look at all pairs of members. The assignment alone takes {0:.0f} times as long for
eight times the members: it grows with their power {1:.1f}; its worst case is the cube. Planning and playing
hardly notice the members: the clips' discs spare most tests, and a clip is played by one product.

## A thousand members

Two groups of a thousand, 1.3 m apart, differ by 0.35 m and 0.3 m/s at random. Once all are candidates for
all (`scipy.optimize.linear_sum_assignment`), and once only the {2} nearest of each member:
`scipy.spatial.KDTree` finds them, `scipy.sparse.csgraph.min_weight_full_bipartite_matching` assigns them.

| candidates | costs, ms | assignment, ms | sum of squares, over the least |
|---|---|---|---|
{3}
So the Hungarian method serves a thousand, too; to cluster two minutes takes 14 280 such comparisons. Among
the five nearest alone a comparison is several times as quick and hardly worse. But with more candidates it
takes longer than among all, and where groups are less alike an order among the five nearest need not exist.
The same k-d tree would serve the simulation, which looks at all pairs of members in each frame.

## Two groups that pass each other

Two groups of {4} come towards each other over 24 m; the second plans around the first, frame by frame.
Without this members come as near as {5:.2f} m. With it they keep {6:.2f} m. The search takes {7:.0f} ms
for {8}, instead of {9:.0f} ms for {10}; the bounds spare {11:.0%} of
the tests. So a few groups are planned one after the other: the first gives way to nobody.

## Where no way is found

A group of {12} stands 5 m before 10 m by 10 m of ground, on which eight discs of 1.3 m lie at random; its
goal is 5 m behind. It finds a way in {14} of {13} scenes; steered, without a plan and without whims, it
comes there clear of all discs in {15}, and sooner than by the plan in {16}. A search takes {17:.1f} times as
long as simulating as many seconds.
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
