"""Calls as users write them: pyright and mypy accept each, and the program runs."""

import networkx as nx
import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mocap
from mocap import (
    blending,
    body,
    datasets,
    editing,
    feet,
    graphs,
    matching,
    plotting,
    quality,
    steering,
    synthesis,
    widgets,
)
from mocap.methods import groups, match_webs, motion_matching

# Motions and files
walk = mocap.resample(datasets.sample("walk_curve_1"), 30)
other = mocap.resample(datasets.sample("walk_circle"), 30.0)
mocap.save(walk, "walk.bvh", precision=4)
read = mocap.load("walk.bvh", scale=0.01)
seconds: float = read.duration
heights = read.root_positions[:, 1] + 0.5
head = walk.positions[:, walk.skeleton.index("head")]
speeds = np.linalg.norm(walk.velocities, axis=-1).max(axis=0)
same: bool = walk == walk[:]
both = mocap.concatenate([walk, walk], name="twice")
third = walk[::3]
some = walk[[0, 5, 9]]
leg = mocap.Skeleton(["hip", "knee", "ankle"], [-1, 0, 1], [[0, 0, 0], [0, -0.4, 0], [0, -0.4, 0.1]])
still = mocap.Motion(leg, [[0, 1, 0]], [[[1, 0, 0, 0]] * 3], 30, labels={"stand": True})
fast = mocap.Motion(leg, np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 3, 1)), fps=120.0)

# Bodies and the ground
line = body.GroundPath([[0, 0], [0, 6]])
bend = body.GroundPath([(0, 0), (0, 2.5), (1.5, 4)])
mixed_rows = body.GroundPath([(0, 0), [0, 2.5], np.array([1.5, 4])])
scalars = body.GroundPath([[np.float64(0), 0], [np.int64(3), 2.5]])
wave = body.GroundPath(np.stack([np.sin(np.linspace(0, 6)), np.linspace(0, 6)], axis=1))
curve = body.spline([[0, 0], [1, 1.5], [0, 3]])
halfway = line.at(line.length / 2).round(2)
joints = body.joint_positions(walk)
placed = body.place(walk, 0.0, [1.0, 2.5])
moved = body.PlanarTransform(np.pi / 2, 1, 0).apply_motion(walk)
hips = [hip for hip, *_ in body.find_legs(walk.skeleton)]

# Matching, graphs and walks
grid = matching.distance_grid(matching.point_cloud(walk), matching.point_cloud(other), window=10)
found = matching.find_transitions([walk, other], window=10, below={("walk", "walk"): 0.04}, progress=tqdm)
nearest = min(found, key=lambda transition: transition.cost)
graph = graphs.prune(graphs.build([walk, other], window=10, threshold=0.04, progress=tqdm))
count = graph.count("transition") + nx.number_of_nodes(graph.graph)
graphs.save(graph, "graph.npz")
again = graphs.load("graph.npz")
summary = graphs.summary(again)
bare_summary = graphs.summary(again.graph, fps=again.fps)
trials = datasets.trials(subject=16)
edges = synthesis.random_walk(graph, seconds=4, seed=1)
walked = synthesis.to_motion(graph, edges, name="walked", clean=True)
followed = steering.follow_path(graph, line, settings=steering.Settings(width=100))
soon = steering.follow_path(graph, line, settings=steering.Settings(deadline=600))
ahead = steering.follow_path(graph, [[0, 0], [0, 2.5]])
waypoint = steering.Waypoint(1, 2.5, label="walk")
steered = steering.steer(steering.Controller(graph), [0.0] * 30, speed=1.2)
headed = steering.steer(steering.Controller(graph), steering.command_headings(1.0, 30))

# Feet, blends, edits and judgements
cleaned = feet.clean_up(feet.mark_plants(walk))
joined = blending.join(walk, 20, other, 10, 10)
mixed = blending.mix(blending.register([walk[:60], walk[2:62]]), [0.5, 0.5])
mirrored = editing.mirror(walk)
bent: editing.Bent = editing.bend(walk, [[0, 0], [0, 2.5]])
worn = editing.wear(walk, walk.skeleton)
pinned = editing.pin(walk, "rhand", [10, 11], [0.1, 1.2, 0.3])
astray = quality.judge(walk, path=[[0, 0], [0, 2.5]], against=[other]).score
worst = max(quality.judge(walk).measures, key=lambda measure: measure.ratio)
plan = plotting.draw_group_plan(np.arange(5)[:, None] * 1j + [0.0, 1.0], [0j, 4j])
wants = motion_matching.Wants(future=0.5)
scene = groups.Scene((0j, 8 + 0j), radius=1.5)
match_webs.save_web(match_webs.build_web([walk, other], below=0.05), "web.npz")
web = match_webs.load_web("web.npz", [walk, other])
group = groups.build_group(3, nodes=2, corridors=(), simulated=40, reach=0.4)
groups.save_group(group, "group.npz")
three = groups.load_group("group.npz").members

# Pictures
figure = plotting.flat_bodies(walk, [0, 10, 20], view="front").figure
player = widgets.play(walk, other, path=[[0.0, 0.0], [0.0, 6.0]], alt="Two walks.")
canvas = widgets.draw_path(lambda path: walk[: 10 * len(path)], [(0, 0), (0, 3)])
shown: widgets.Player = canvas.player
failure: Exception | None = canvas.error
frame: int = canvas.frame
points = widgets.handles(Figure().add_subplot(xlim=(3, -3), ylim=(0, 6)), [[0, 1], [0, 3]])
count_of_points: int = points.count
walkers = widgets.steered({"graph": steering.Controller(graph)}, speeds=(0.6, 0.9))
delays: dict[str, list[float]] = walkers.delays
film = widgets.save_animation([walk[:10]], "walk.gif")
