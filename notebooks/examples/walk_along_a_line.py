"""Synthesize a walk along a path: build a motion graph, prune it, search it, save the walk and a film."""

import mocap
from mocap import body, datasets, graphs, steering, widgets

clips = [mocap.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]

# A transition is possible where two windows of ten frames differ by less than 4 cm.
whole = graphs.build(clips, window=10, threshold=0.04)
graph = graphs.prune(whole)  # without dead ends
print(f"{graph.count('transition')} of {whole.count('transition')} transitions are left")

path = body.GroundPath([[0, 0], [0, 2], [1, 4], [3, 5]])  # x and z on the ground, metres
followed = steering.follow_path(graph, path)
print(followed.report())

walk = followed.motion(clean=True)  # without footskate
mocap.save(walk, "walk.bvh")
widgets.save_animation(walk, "walk.gif", fps=10)
