"""Trials of the constants of groups: `python figures/tune/groups.py [--quick] [--clips FOLDER ...]`.

Six members and three nodes; the clips matter only to the characters that walk in the end.

- A flock, simulated for two minutes in the open, and twelve in a corridor of 2.5 m. Nearest: the least
  distance of two members, which should be 60 cm. Turns: the standard deviation of the members' directions
  within the group. Spread: that of their places. Pace: that of their speeds, over the mean. Weaves: the mean
  angle of the group's way to the corridor. Wall: the percentage of members who are nearer to a wall than
  35 cm. Width: from the left member to the right one.
- Configurations. Covered: the percentage of the simulation near a node. Distance: the mean distance of pairs
  of configurations; more starts and rounds find smaller ones, and take longer.
- Clips from node to node. Kept: the percentage of those that were tried. Peak: the 95th percentile of the
  kept clips' largest accelerations.
- Plans through a wall with a gap, and around random discs. Refused: those without a plan. States: how many
  were expanded. From `disc_force` on, flocks are steered as well, and the quicker one is taken.
- Characters who walk a plan. Off: the mean distance from the member they follow; kept: frames of plants.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np
from _trials import BUNDLED_WALKS, CAPTURED_WALKS, Clips, Row, Study, Trial
from _walks import graph_of

from mocap.errors import NoWalk
from mocap.methods.groups import (
    RATE,
    Configuration,
    GroupGraph,
    Scene,
    build_group,
    cluster,
    compare,
    lead_group,
    make_clips,
    nearest_two,
    plan_group,
    play_group,
    random_group_walk,
    seen_from_itself,
    simulate,
    tuned,
    walk_group,
)
from mocap.methods.groups.flocking import BODY

MEMBERS = 6
NODES = 3
SECONDS = 120.0
CORRIDOR = 2.5  # metres
GAP = 2.0  # metres
ROUNDING = 1e-9  # metres
SEEDS = range(2)


def open_ground(clips: Clips) -> Row:
    """Simulate a flock in the open."""
    flock = simulate(MEMBERS, SECONDS)
    directions = np.angle(flock.velocities / flock.velocities.mean(axis=1, keepdims=True))
    speeds = np.abs(flock.velocities)
    row = {"nearest, cm": 100 * float(nearest_two(flock.positions).min())}
    row |= {"turns, °": float(np.degrees(directions.std()))}
    row |= {"spread, m": float(flock.positions.std(axis=1).mean())}
    return row | {"pace, %": 100 * float(speeds.std() / speeds.mean())}


def corridor(clips: Clips) -> Row:
    """Simulate a flock between walls."""
    flock = simulate(2 * MEMBERS, SECONDS, corridor=CORRIDOR)
    lateral = flock.positions.imag
    steps = np.diff(flock.positions.mean(axis=1))
    row = {"nearest, cm": 100 * float(nearest_two(flock.positions).min())}
    row |= {"weaves, °": float(np.degrees(np.abs(np.angle(steps)).mean()))}
    row |= {"wall, %": 100 * float((np.abs(lateral) > CORRIDOR / 2 - BODY + ROUNDING).mean())}
    return row | {"width, m": float(np.ptp(lateral, axis=1).mean())}


@cache
def flock_in_the_open() -> Configuration:
    """Simulate a flock, once."""
    return simulate(MEMBERS, SECONDS)


def configurations(clips: Clips) -> Row:
    """Choose nodes."""
    clusters = cluster(flock_in_the_open(), nodes=NODES)
    return {"covered, %": 100 * clusters.covered, "compared": len(clusters.distances)}


def distances(clips: Clips) -> Row:
    """Compare configurations two seconds apart with all later ones."""
    flock = flock_in_the_open()
    seen, _, _ = seen_from_itself(Configuration(*(field[:: round(2 * RATE)] for field in flock)))
    rows = list(map(Configuration, *seen))
    constants = tuned.TUNED
    means = []
    for number, row in enumerate(rows[1:], start=1):
        earlier = Configuration(*(field[:number] for field in seen))
        match = compare(row, earlier, starts=constants.starts, rounds=constants.rounds)
        means.append(match.rms.mean())
    return {"distance, cm": 100 * float(np.mean(means))}


def built() -> GroupGraph:
    """Build a graph, with the corridors that are tried."""
    return build_group(MEMBERS, nodes=NODES, corridors=tuned.TUNED.corridors, simulated=SECONDS)


@cache
def built_once() -> GroupGraph:
    """Build a graph with the chosen constants."""
    return built()


def group_clips(clips: Clips) -> Row:
    """Join the nodes of the chosen constants by clips."""
    return measured(make_clips(built_once().nodes))


def whole(clips: Clips) -> Row:
    """Build a graph, and measure its clips and the plans that it allows."""
    graph = built()
    return measured(graph) | planned(graph)


def measured(graph: GroupGraph) -> Row:
    """Measure the clips of a graph."""
    peaks = [np.abs(np.diff(clip.positions, 2, axis=0)).max() * RATE**2 for clip in graph.clips]
    row = {"kept, %": 100 * len(graph.clips) / graph.tried, "clips": len(graph.clips)}
    return row | {"peak, m/s²": float(np.percentile(peaks, 95))}


def scenes() -> Iterator[Scene]:
    """Yield a wall with a gap, and random discs."""
    rim = GAP / 2 + 0.6
    wall = [12 + 1j * side * (rim + 1.1 * number) for side in (-1, 1) for number in range(12)]
    yield Scene((26 + 0j,), tuple((disc, 0.6) for disc in wall))
    for seed in SEEDS:
        draw = np.random.default_rng(seed)
        discs = draw.uniform(6, 18, 7) + 1j * draw.uniform(-6, 6, 7)
        yield Scene((24 + 0j,), tuple((complex(disc), 1.0) for disc in discs))


def planned(graph: GroupGraph) -> Row:
    """Plan through the scenes."""
    plans = []
    refused = 0
    for scene in scenes():
        try:
            plans.append(plan_group(graph, scene, most=tuned.TUNED.states))
        except NoWalk:
            refused += 1
    seconds = [plan.seconds for plan in plans] or [np.nan]
    states = [plan.expanded for plan in plans] or [0]
    return {"refused": refused, "takes, s": float(np.mean(seconds)), "states": int(np.mean(states))}


def plans(clips: Clips) -> Row:
    """Plan with the graph of the chosen constants."""
    return planned(built_once())


def led(clips: Clips) -> Row:
    """Lead a group without states to plan with, so that it is steered where that is possible."""
    seconds = []
    refused = 0
    for scene in scenes():
        try:
            flock, _ = lead_group(built_once(), scene)
            seconds.append((len(flock.positions) - 1) / RATE)
        except NoWalk:
            refused += 1
    return {"refused": refused, "takes, s": float(np.mean(seconds or [np.nan]))}


def walkers(clips: Clips) -> Row:
    """Let characters walk a random walk of the group."""
    graph = built_once()
    flock = play_group(graph, random_group_walk(graph, 2))
    walking = walk_group(graph_of(clips), flock)
    if len({len(motion) for motion in walking.motions}) > 1:
        return {"result": "some end early"}
    row = {"off, cm": 100 * float(walking.errors.mean()), "nearest, cm": 100 * float(walking.nearest)}
    return row | {"kept, %": 100 * walking.kept}


# reads: statement: a table
TRIALS = {
    "settle": Trial(open_ground, (0.0, 5.0, 60.0)),
    "spare": Trial(corridor, (0.0, 0.01, 0.1)),
    "separations": Trial(corridor, (0, 1, 2, 6)),
    "direction_time": Trial(open_ground, (0.5, 1.0, 4.0)),
    "pace_time": Trial(open_ground, (1.0, 2.0, 8.0)),
    "pace_whim": Trial(open_ground, (1.0, 0.0, 0.7)),
    "paces": Trial(open_ground, ((0.9, 1.1), (0.8, 1.2), (0.2, 1.8))),
    "rate_time": Trial(open_ground, (1.0, 2.0, 6.0)),
    "rate_drift": Trial(open_ground, (1.0, 0.0, 0.5)),
    "fastest_turn": Trial(open_ground, (2.0, 0.25, 1.0)),
    "wall_force": Trial(corridor, (0.0, 1.0, 6.0, 12.0)),
    "wall_push": Trial(corridor, (0.0, 0.005, 0.05, 0.2)),
    "free_width": Trial(corridor, (1.0, 0.4, 0.9)),
    "line_pull": Trial(corridor, (2.0, 0.0, 0.1, 1.0)),
    "velocity_seconds": Trial(configurations, (2.0, 0.0, 0.35, 1.4)),
    "node_interval": Trial(configurations, (4.0, 0.5, 2.0)),
    "starts": Trial(distances, ((0.0,), (0.0, 0.25, -0.25), (0.0, 0.5, -0.5, 1.0, -1.0))),
    "rounds": Trial(distances, (1, 2, 3, 10)),
    "corridors": Trial(whole, ((), (2.0,), (3.0, 2.5, 2.0, 1.7))),
    "column": Trial(whole, (20.0, 120.0)),
    "bends": Trial(whole, ((0.0,), (-1.2, 0.0, 1.2), (-1.2, -0.8, -0.4, 0.0, 0.4, 0.8, 1.2))),
    "shifts": Trial(whole, ((0.0,), (-0.6, 0.0, 0.6))),
    "seconds": Trial(group_clips, (2.0, 3.0, 6.0)),
    "pull": Trial(group_clips, (0.5, 1.0, 4.0)),
    "hardest": Trial(group_clips, (1.5, 1.8, 3.0)),
    "parting_rounds": Trial(group_clips, (5, 20, 200)),
    "held_frames": Trial(group_clips, (1, 4)),
    "ease": Trial(group_clips, (1.0, 2.0, 8.0)),
    "parting_spare": Trial(group_clips, (0.0, 0.05)),
    "overshoot": Trial(group_clips, (1.0, 2.0)),
    "smoothings": Trial(group_clips, (0, 2, 8)),
    "bend_pace": Trial(group_clips, (1.0, 3.0)),
    "pull_pace": Trial(group_clips, (1.0, 4.0)),
    "pace": Trial(plans, (2.0, 0.9, 1.2)),
    "turning": Trial(plans, (0.0, 0.6, 2.5)),
    "cell": Trial(plans, (2.0, 0.3, 1.4)),
    "sector": Trial(plans, (1.0, 0.15, 0.6)),
    "states": Trial(plans, (20, 100, 500, 20_000)),
    "disc_force": Trial(led, (0.5, 1.5, 6.0)),
    "avoidances": Trial(led, ((2.0,), (0.8, 2.0), (0.4, 0.8, 1.2, 1.6, 2.0, 3.0))),
    "cohesions": Trial(led, ((0.35,), (0.0, 1.0), (0.0, 0.2, 0.35, 0.6, 1.0, 2.0, 4.0))),
    "late": Trial(walkers, (0.1, 0.3, 3.0)),
    "time_every": Trial(walkers, (4.0, 0.5, 2.0)),
    "narrow": Trial(walkers, (10, 20, 100)),
    "extension": Trial(walkers, (0.5, 1.5, 6.0)),
}
FIXED = {
    "covered": "a warning; the percentage that is covered is printed with `velocity_seconds`",
    "slowest": "below it a group's mean velocity has no direction, by its definition",
    "kept": "a warning; the percentage that is kept is printed with `late`",
    "least_step": "below it a member has no direction, by its definition",
}
WALKED = {name for name, trial in TRIALS.items() if trial.measure is walkers}
TRIALS = {name: trial._replace(needs_clips=name in WALKED) for name, trial in TRIALS.items()}
STUDY = Study(tuned, TRIALS, FIXED, (BUNDLED_WALKS, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
