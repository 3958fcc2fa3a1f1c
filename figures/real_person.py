"""Draw a real person's walk along an S-curve: `python figures/real_person.py`.

Writes `person.png` beside this script. It needs the walks of CMU subject 16, fetched or in the folder that
`MOCAP_DATA` names, so it is no part of `gallery.py`.
"""

import warnings
from pathlib import Path

import matplotlib

matplotlib.use("agg")

from gallery import TITLE
from matplotlib.figure import Figure

from mocap import datasets, graphs, resample, synthesis
from mocap.body import s_curve
from mocap.plotting.bodies import bodies_along
from mocap.plotting.picture import legible, small_png
from mocap.steering import follow_path

SETTLED = 10  # frames at the start of each take, before the joint angles have settled


def draw_person() -> Figure:
    """Draw bodies along the path, in the colours of their takes."""
    clips = [resample(clip[SETTLED:], 30) for clip in datasets.cmu(subject=16, kind="walk")]
    graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    with warnings.catch_warnings(action="ignore"):
        walk = follow_path(graph, s_curve(16.0))
    sources = synthesis.sources(graph, walk.walk)
    seams = [seam.frame for seam in synthesis.seams(graph, walk.walk)]
    return bodies_along(walk.motion(), sources=sources, seams=seams, path=walk.path.points)


if __name__ == "__main__":
    (Path(__file__).parent / "person.png").write_bytes(small_png(legible(draw_person(), TITLE)))
