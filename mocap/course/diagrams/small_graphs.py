"""What a motion graph is: nodes and edges on two clips' timelines, and the homework's segments."""

from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from mocap.course.diagrams.pens import arrow, say
from mocap.plotting.style import COLOURS, MARK, PATH, QUIET, SOURCES

LENGTHS = (6.0, 5.0)  # seconds
LEAPS = ((0, 3.6, 1, 1.4), (1, 3.2, 0, 1.8), (0, 4.8, 0, 1.0))
"""Transitions: which clip they leave, when, which clip they enter, when."""

STEPS = (
    "Two clips: each can only be played from its start to its end.",
    "A match: in these two windows both clips do nearly the same.",
    "A transition joins them. Where it leaves and enters, a node cuts the clip.",
    "More matches: every piece of clip is an edge, every transition is an edge.",
    "Pruned: the grey pieces lead to an end, or nothing leads to them.",
    "A walk: any sequence of edges in which each begins where the last one ends.",
)
MATCH = ((0, 3.6, 0.32), (1, 1.07, -1.42))  # its windows: clip, from, height of the word
WALK = ((-0.18, 1.0, 3.6), (-1.18, 1.4, 3.2), (-0.32, 1.8, 4.8), (-0.46, 1.0, 3.6))  # height, from, to


def nodes_and_edges(step: int = 5) -> Figure:
    """Draw how two clips become a motion graph, with as many of six steps as are asked for.

    Parameters
    ----------
    step : 0 to 5: the clips, a match, its transition, all transitions, the pruned graph, a walk.

    Returns
    -------
    The figure; its title says what the step is.

    Examples
    --------
    >>> from mocap import plotting
    >>> plotting.show(nodes_and_edges(step=2), alt="Two bars, and an arrow from a node to a node.")
    Picture('Two bars, and an arrow from a node to a node.')

    Notebook: 05-motion-graph
    """
    figure, ax = plt.subplots(figsize=(7, 3), layout="constrained")
    leaps = LEAPS[: (0, 0, 1, 3, 3, 3)[step]]
    for clip, length in enumerate(LENGTHS):
        nodes = {leaves for source, leaves, _, _ in leaps if source == clip}
        nodes |= {enters for _, _, target, enters in leaps if target == clip}
        times = sorted({0.0, length} | nodes)
        for start, end in pairwise(times):
            colour = SOURCES[clip] if step < 4 or 0 < start < end < length else "#DDDDDD"
            ax.plot([start, end], [-clip] * 2, color=colour, linewidth=9, solid_capstyle="butt", zorder=1)
        for time in times:
            edge = COLOURS["middle"] if step < 4 or time in nodes else QUIET
            ax.plot(time, -clip, "o", color="white", markeredgecolor=edge, markersize=9, zorder=4)
    for clip, at, below in MATCH if step == 1 else ():
        ax.plot([at, at + 0.33], [-clip] * 2, color=MARK, linewidth=17, solid_capstyle="butt", zorder=2)
        ax.text(at + 0.16, below, "window", ha="center", color=COLOURS["middle"])
    for number, (lift, start, end) in enumerate(WALK if step == 5 else (), 1):
        arrow(ax, start + 1j * lift, end + 1j * lift, PATH, 2.2, shrinkA=2, shrinkB=2)
        say(ax, start - 0.12 + 1j * lift, str(number))
    for source, leaves, target, enters in leaps:
        bend, colour = f"arc3,rad={0.28 * (source == target)}", PATH if step == 5 else MARK
        look: dict[str, Any] = {"connectionstyle": bend, "shrinkA": 6, "shrinkB": 6}
        arrow(ax, leaves - 1j * source, enters - 1j * target, colour, **look).set_zorder(3)
    ax.set_title(STEPS[step], fontsize=10, loc="left")
    ax.set(xlabel="time in the clip (s)", xlim=(-0.2, 6.2), ylim=(-1.75, 0.95))
    ax.set_yticks([0, -1], ["clip A", "clip B"])
    ax.tick_params(left=False)
    ax.spines[["top", "right", "left"]].set_visible(False)
    return figure
