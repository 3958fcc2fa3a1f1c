"""Graphs, the walks through them, and walks along paths."""

import numpy as np

import mocap
from mocap import body, datasets, graphs, steering, synthesis
from mocap.graphs.motion_graph import merge_choice_points
from tests.bundled import clips, walking, walks_of_16
from tests.frozen.quantities import FRAME, Axis, case, edges, numbers, roots
from tests.refusals import quietly

SIZES = Axis("", ("nodes", "edges"))


def sizes(graph):
    return numbers([graph.graph.number_of_nodes(), graph.graph.number_of_edges()], SIZES)


def graph_and_walks(motions):
    """Build a graph, prune it, and walk through it at random and along two shapes."""
    whole = graphs.build([mocap.resample(clip, 30) for clip in motions], window=10, threshold=0.04)
    pruned = graphs.prune(whole)
    quantities = {
        "transitions": numbers(whole.count("transition")),
        "whole graph": sizes(whole),
        "pruned graph": sizes(pruned),
        "random walk": edges(synthesis.random_walk(pruned, seconds=60, seed=1)),
    }
    for shape in ("S-curve", "square"):
        followed = quietly(steering.follow_path, pruned, body.SHAPES[shape]())
        quantities[f"walk along {shape}"] = edges(followed.walk)
    return quantities


@case("bundled")
def bundled():
    return graph_and_walks([datasets.sample(name) for name in datasets.SAMPLES])


@case("CMU 16", captured=True)
def walks_of_cmu_16(folder):
    return graph_and_walks(walks_of_16(folder))


@case("merged")
def merged():
    graph = graphs.build(clips("walk_curve_1", "sneak"), window=10, threshold=0.04)
    merged = merge_choice_points(graph, within=3, threshold=0.04)
    costs = [edge.get("cost", 0) for *_, edge in merged.graph.edges(data=True)]
    return {"costs": numbers(costs, "edge")}


@case("past others")
def past_others():
    line = body.s_curve()
    others = [line.points[::9] + 0.5, np.ones((3, 2))]
    followed = steering.follow_path(walking(), body.s_curve(), steering.PathRequest(others=others))
    return {"track": numbers(followed.track, FRAME, Axis("", ("x", "z")), unit="m")}


@case("crowd")
def crowd():
    paths = [body.GroundPath([[x, 0], [0.6 - x, 3 + 3 * x]]) for x in (0.0, 0.6, -0.7)]
    walks = steering.walk_crowd(walking(), paths).walks
    return {
        f"root of walker {number}": roots(walk.motion().root_positions) for number, walk in enumerate(walks)
    }
