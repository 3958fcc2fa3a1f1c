"""A motion graph drawn on the timelines of two clips: what its nodes and its edges are."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap.course.diagrams.pens import arrow
from mocap.plotting.style import COLOURS, MARK, PATH, QUIET, SOURCES

Leap = tuple[int, float, int, float]

LENGTHS = (6.0, 5.0)  # seconds
LEAPS: tuple[Leap, ...] = ((0, 3.6, 1, 1.4), (1, 3.2, 0, 1.8), (0, 4.8, 0, 1.0))
"""Transitions: which clip they leave, when, which clip they enter, when."""

STEPS = (
    "Two clips: each can only be played from its start to its end.",
    "A match: in these two windows both clips do nearly the same.",
    "A transition joins them. Where it leaves and enters, a node cuts the clip.",
    "More matches: every piece of clip is an edge, every transition is an edge.",
    "Pruned: the grey pieces lead to an end, or nothing leads to them.",
    "A walk: any sequence of edges in which each begins where the last one ends.",
)
WALK = ((0, 1.0, 3.6), (1, 1.4, 3.2), (0, 1.8, 4.8), (0, 1.0, 3.6))  # clip, from, to


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

    Notebook: 00-quickstart
    """
    figure, ax = plt.subplots(figsize=(7, 3), layout="constrained")
    leaps = LEAPS[: (0, 0, 1, 3, 3, 3)[step]]
    for clip, times in enumerate(_cuts(leaps)):
        for start, end in pairwise(times):
            kept = step < 4 or _kept(clip, start, end)
            colour = SOURCES[clip] if kept else "#DDDDDD"
            ax.plot([start, end], [-clip] * 2, color=colour, linewidth=9, solid_capstyle="butt", zorder=1)
    if step == 1:
        _draw_match(ax)
    if step == 5:
        _draw_walk(ax)
    for number, leap in enumerate(leaps):
        _draw_leap(ax, leap, number=3 * (step == 5) + number)
    _draw_nodes(ax, leaps, pruned=step >= 4)
    ax.set_title(f"{step}. {STEPS[step]}", fontsize=10, loc="left")
    ax.set(xlabel="time in the clip (s)", xlim=(-0.2, 6.2), ylim=(-1.75, 0.95))
    ax.set_yticks([0, -1], ["clip A", "clip B"])
    ax.tick_params(left=False)
    ax.spines[["top", "right", "left"]].set_visible(False)
    return figure


def _cuts(leaps: Sequence[Leap]) -> list[list[float]]:
    """List the times of each clip's nodes: its ends, and where transitions leave and enter."""
    times: list[set[float]] = [{0.0, length} for length in LENGTHS]
    for source, leaves, target, enters in leaps:
        times[source].add(leaves)
        times[target].add(enters)
    return [sorted(found) for found in times]


def _kept(clip: int, start: float, end: float) -> bool:
    """Say whether a piece lies between the first node that is entered and the last that is left."""
    first = min(enters for _, _, target, enters in LEAPS if target == clip)
    last = max(leaves for source, leaves, _, _ in LEAPS if source == clip)
    return first <= start and end <= last


def _draw_match(ax: Axes) -> None:
    """Shade the windows of the first transition."""
    source, leaves, target, enters = LEAPS[0]
    for clip, at in ((source, leaves), (target, enters - 0.33)):
        ax.plot([at, at + 0.33], [-clip] * 2, color=MARK, linewidth=17, solid_capstyle="butt", zorder=2)
        below = -clip - 0.42 if clip else 0.32
        ax.text(at + 0.16, below, "window", ha="center", color=COLOURS["middle"], fontsize=9)


def _draw_walk(ax: Axes) -> None:
    """Draw the pieces of clip that the walk plays, numbered in their order."""
    for number, (clip, start, end) in enumerate(WALK, 1):
        lift = -clip - (0.18, 0.18, 0.32, 0.46)[number - 1]
        arrow(ax, start + 1j * lift, end + 1j * lift, PATH, 2.2, shrinkA=2, shrinkB=2)
        ax.text(start - 0.12, lift, str(number), ha="center", va="center", fontsize=9)


def _draw_leap(ax: Axes, leap: Leap, number: int) -> None:
    """Draw a transition as an arrow: bent above its clip, or straight to the other one."""
    source, leaves, target, enters = leap
    bend = "arc3,rad=0.28" if source == target else "arc3,rad=0"
    colour = PATH if number >= 3 else MARK
    look: dict[str, Any] = {"connectionstyle": bend, "shrinkA": 6, "shrinkB": 6}
    arrow(ax, leaves - 1j * source, enters - 1j * target, colour, **look).set_zorder(3)


def _draw_nodes(ax: Axes, leaps: Sequence[Leap], *, pruned: bool) -> None:
    """Draw the nodes as discs; those that pruning removes are pale."""
    for clip, times in enumerate(_cuts(leaps)):
        for time in times:
            inside = not pruned or time not in (0.0, LENGTHS[clip])
            edge = COLOURS["middle"] if inside else QUIET
            ax.plot(time, -clip, "o", color="white", markeredgecolor=edge, markersize=9, zorder=4)
