"""Give the paper's search its best conditions: `python figures/search_of_2002.py` writes the table beside it.

Eight random lines of 10 m are followed by the paper's branch and bound, over n and m, its budget, and three
graphs of the bundled clips, and by the search in layers: as it is, and with Eq. 9 as its only cost. All of
them begin a line at the same node. It takes about a quarter of an hour.
"""

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
from follow_paths import random_line

import mocap
from mocap import datasets, graphs
from mocap.body import GroundPath
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.motion_graph import merge_choice_points
from mocap.steering import PathRequest, Settings, follow_as_2002, follow_path
from mocap.steering.followed import Followed

LOOKS = [(10, 3), (20, 7), (30, 10), (45, 15), (60, 20), (90, 28)]
MOST = (45, 15)  # tried with the largest budget, too, on the first graph
HEAD = [
    "| search | nearest, cm | equal arc length, cm | seams/s | expanded | searched to the end |",
    "|---|---|---|---|---|---|",
]


def dense_and_sparse() -> dict[str, CompiledGraph]:
    """Build the graph of notebook 08, one with merged choice points, and one with fewer transitions."""
    clips = [mocap.resample(datasets.sample(name), 30) for name in datasets.SAMPLES]
    whole = graphs.build(clips, window=10, threshold=0.04)
    built = {
        "threshold 4 cm": whole,
        "threshold 4 cm, choice points merged": merge_choice_points(whole, within=5, threshold=0.04),
        "threshold 2.5 cm": graphs.build(clips, window=10, threshold=0.025),
    }
    return {name: graphs.compile_graph(graphs.prune(graph)) for name, graph in built.items()}


def ten_metres(seed: int) -> GroundPath:
    """Cut a random line after 10 m."""
    return GroundPath(random_line(seed).at(np.linspace(0, 10, 201)))


def quartiles(values: list[float]) -> str:
    """Write a median and its quartiles."""
    low, middle, high = np.percentile(values, [25, 50, 75])
    return f"{middle:.1f} [{low:.1f}, {high:.1f}]"


def row(name: str, walks: list[Followed]) -> str:
    """Write a row of the table: medians and quartiles over the lines."""
    complete = sum(not walk.found.stopped for walk in walks)
    nearest = quartiles([100 * walk.off.mean() for walk in walks])
    at_length = quartiles([100 * walk.off_at_length.mean() for walk in walks])
    seams = np.median([walk.seams_per_second for walk in walks])
    expanded = np.median([walk.found.expanded for walk in walks])
    counts = f"{expanded:.0f} | {complete} of {len(walks)}"
    return f"| {name} | {nearest} | {at_length} | {seams:.2f} | {counts} |"


def table(graph: CompiledGraph, paths: list[GroundPath], *, with_largest_budget: bool) -> list[str]:
    """Follow all lines by each search."""
    layered = [follow_path(graph, path) for path in paths]
    starts = [walk.walk[0][0] for walk in layered]

    def along_all(search: Callable[[GroundPath, PathRequest], Followed]) -> list[Followed]:
        requests = [PathRequest(start=start, correction=0) for start in starts]
        return [search(path, request) for path, request in zip(paths, requests, strict=True)]

    lines = [*HEAD, row("layers, all terms", layered)]
    for width in (50, 300):
        eq9 = {"settings": Settings(seam=0, match=0, stray=0, width=width, rescue=0, tries=1)}
        walks = along_all(lambda path, start, eq9=eq9: follow_path(graph, path, start, **eq9))
        lines.append(row(f"layers, Eq. 9 alone, width {width}", walks))
    for nodes in (300, 3000, 30000)[: 3 if with_largest_budget else 2]:
        for look in [MOST] if nodes == 30000 else LOOKS:
            walks = along_all(
                lambda path, start, look=look, nodes=nodes: follow_as_2002(
                    graph, path, start, look=look, budget=nodes
                )
            )
            lines.append(row(f"n, m = {look[0]}, {look[1]}; budget {nodes}", walks))
            print(lines[-1], flush=True)
    return [*lines, ""]


def main() -> None:
    """Measure and write."""
    warnings.simplefilter("ignore", mocap.MocapWarning)
    paths = [ten_metres(seed) for seed in range(500, 508)]
    lines = [
        "# The paper's search under many conditions",
        "",
        "Written by `python figures/search_of_2002.py`. Medians [quartiles] over eight random lines of 10 m.",
        "The budget is the number of walks that each stretch of the search may expand; the last column",
        "counts the lines on which every stretch was searched to its end. Only the layers with all terms pay",
        "for seams.",
        "",
    ]
    for name, graph in dense_and_sparse().items():
        transitions = int(graph.blended.sum())
        lines += [f"## {name}: {len(graph.nodes)} nodes, {transitions} transitions", ""]
        lines += table(graph, paths, with_largest_budget=name == "threshold 4 cm")
    Path(Path(__file__).parent / "search_of_2002.md").write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
