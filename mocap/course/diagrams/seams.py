"""Where one clip passes into another: frames, weights, ways between two rotations, a leg, added jolts."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle
from mpl_toolkits.mplot3d import Axes3D

from mocap._shared.arrays import Array
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.course.diagrams.pens import trace
from mocap.course.seam_trials import Passage
from mocap.plotting import COLOURS, CURVES, MARK, QUIET, SOURCES
from mocap.plotting.stick_figures import to_picture

AROUND = 4  # frames of each clip before the window and after it
FIRST = 2.6  # height of the row of the first clip
SECOND = 1.3  # height of the row of the second clip
RESULT = 0.0  # height of the row of the result
BOX = 0.86  # a frame's width and height
WEIGHED = 2  # the step from which the weights are drawn
MIXED = 3  # the step from which mixed frames are drawn
WHOLE = 4  # the step that draws the whole result
TURNED_KNEES = 3  # the step from which other positions of the knee are drawn


def blended_seam(step: int = 4, window: int = 6) -> Figure:
    """Draw how frames of two clips become the frames of a transition, and the share α of the first clip.

    Parameters
    ----------
    step : 1 draws the two clips with their windows, 2 adds the weights, 3 the mixed frames, 4 the rest of
        the result.
    window : frames k of the transition.

    Examples
    --------
    >>> rows, weights = blended_seam(step=2, window=6).axes
    >>> len(rows.patches), len(weights.lines)  # two clips of 14 frames, and their windows
    (30, 1)

    Notebook: 04-blending
    """
    figure = plt.figure(figsize=(7.2, 3.7), layout="constrained")
    rows, weights = figure.subplots(2, 1, height_ratios=[3, 1.3], sharex=True)
    places = range(-AROUND, window + AROUND)
    alpha = np.concatenate([np.ones(AROUND), cubic_weights(window), np.zeros(AROUND)])
    for place, share in zip(places, alpha.tolist(), strict=True):
        is_mixed = 0 <= place < window
        _draw_sources(rows, place, has_threads=is_mixed and step >= MIXED)
        if step >= (MIXED if is_mixed else WHOLE):
            _draw_result(rows, place, share, is_mixed=is_mixed)
    for height in (FIRST, SECOND, RESULT) if step >= MIXED else (FIRST, SECOND):
        corner = (-0.55, height - 0.12)
        rows.add_patch(Rectangle(corner, window + 0.1, BOX + 0.24, fill=False, edgecolor=MARK, lw=2.5))
    rows.set(xlim=(-AROUND - 0.7, window + AROUND - 0.3), ylim=(-0.4, FIRST + 1.4))
    names = ["clip A", "clip B,\naligned", "result"]
    rows.set_yticks(np.array([FIRST, SECOND, RESULT]) + BOX / 2, names)
    rows.tick_params(length=0, labelbottom=False)
    rows.spines[:].set_visible(False)
    weights.set(ylabel="α, share of A", xlabel="frame p of the window", ylim=(-0.1, 1.1))
    if step >= WEIGHED:
        weights.plot(places, alpha, "o-", color=CURVES[0])
        for place, share in enumerate(alpha[AROUND:-AROUND]):
            weights.annotate(f"{share:.2f}", (place, share), (5, 3), textcoords="offset points")
    return figure


def _draw_sources(ax: Axes, place: int, *, has_threads: bool) -> None:
    """Draw a frame of both clips, with threads to the frame that is mixed of them."""
    for letter, height, colour in (("i", FIRST, SOURCES[0]), ("j", SECOND, SOURCES[1])):
        _draw_frame(ax, place, height, {colour: 1.0}, letter)
        if has_threads:
            ax.plot([place] * 2, [height - 0.12, RESULT + BOX], color=QUIET, lw=0.6, zorder=0)


def _draw_result(ax: Axes, place: int, share: float, *, is_mixed: bool) -> None:
    """Draw a frame of the result: one of the first clip, a mixed one, or one of the second clip."""
    clip = "i" if place < 0 else "j"
    shares = {SOURCES[0]: share, SOURCES[1]: 1 - share}
    _draw_frame(ax, place, RESULT, shares, "mix" if is_mixed else clip)


def _draw_frame(ax: Axes, place: int, height: float, shares: Mapping[str, float], name: str) -> None:
    """Draw a frame as a box with a name in it, filled from below with colours, each by its share."""
    low = height
    for colour, share in shares.items():
        ax.add_patch(Rectangle((place - BOX / 2, low), BOX, BOX * share, facecolor=colour, alpha=0.6))
        low += BOX * share
    if name != "mix":
        name = f"${name}{place:+d}$" if place else f"${name}$"  # some steps from frame i or j
    ax.text(place, height + BOX / 2, name, ha="center", va="center")


# reads: name: notebooks use `ways`
def turning_paths(ways: Mapping[str, Array], share: float = 0.25) -> Figure:
    """Draw ways from one rotation to another: a bone's tip on a ball, and how far each way has turned.

    Parameters
    ----------
    ways : a name and rotations (F, 4) each, evenly from the first to the last, which all ways share.
    share : how far along the dots are, from 0 to 1: each is the one marker of its line.

    Examples
    --------
    >>> turn = rotations.about_y(np.linspace(0, 1, 11))
    >>> ball, graph = turning_paths({"slerp": turn}, share=1.0).axes
    >>> graph.lines[0].get_markevery(), graph.lines[0].get_ydata()[10].round(1).item()  # degrees
    ([10], 57.3)

    Notebook: 04-blending
    """
    figure = plt.figure(figsize=(9, 3.8), layout="constrained")
    ball: Axes3D = figure.add_subplot(1, 2, 1, projection="3d")
    graph = figure.add_subplot(1, 2, 2)
    ball.set_box_aspect((1, 1, 1), zoom=1.3)
    ball.set_axis_off()
    u, v = np.mgrid[0 : 2 * np.pi : 25j, 0 : np.pi : 13j]
    radius = np.sin(v)  # of the circle of latitude
    net = np.cos(u) * radius, np.sin(u) * radius, np.cos(v)
    ball.plot_wireframe(*net, color="#DDDDDD", linewidth=0.5)
    for (name, path), colour, width in zip(ways.items(), CURVES, (2, 6, 2, 2), strict=False):
        shown = round(share * (len(path) - 1))
        look = {"color": colour, "zorder": 1 / width, "lw": width, "ms": 6 + width, "markevery": [shown]}
        tips = to_picture(rotations.rotate(path, [0.0, 0.0, 1.0]))
        turned = np.degrees(rotations.angle_between(path[0], path))
        ball.plot(*tips.T, "o-", **look)
        graph.plot(np.linspace(0, 1, len(path)), turned, "o-", label=name, **look)  # type: ignore[arg-type]
    graph.set(xlabel="share of the way", ylabel="turned from the start (degrees)")
    graph.legend(frameon=False)
    return figure


def knee_triangle(step: int = 3, distance: float = 0.74) -> Figure:
    """Draw a leg as a triangle: what is known, what the law of cosines gives, and what is still free.

    Parameters
    ----------
    step : 1 draws hip, ankle and the three lengths, 2 adds the angles at the hip and at the knee, 3 the knee
        turned about the line from hip to ankle, as it may be.
    distance : from hip to ankle, metres; thigh and shank are 0.45 and 0.41 m.

    Examples
    --------
    >>> bend = knee_triangle(step=2).axes[0].texts[-1].get_text()
    >>> bend
    'bend 61°'

    Notebook: 04b-feet
    """
    thigh = 0.45  # metres
    shank = 0.41  # metres
    figure, ax = plt.subplots(figsize=(5.4, 4.4), layout="constrained")
    along = (thigh**2 + distance**2 - shank**2) / (2 * distance)  # from the hip to below the knee
    hip = 0j
    ankle = -1j * distance
    knee = np.sqrt(thigh**2 - along**2) - 1j * along
    for side in (0.4, -0.4, -1.0) if step >= TURNED_KNEES else ():
        turned = np.array([hip, side * knee.real + 1j * knee.imag, ankle])
        trace(ax, turned, marker="o", ls=":", color=QUIET, lw=1.5)
    trace(ax, np.array([hip, knee, ankle]), marker="o", color=CURVES[0], lw=4, ms=9)
    trace(ax, np.array([hip, ankle]), color=CURVES[1], lw=2, ls="--")
    positions = {"hip": -0.09 + 0.03j, "ankle": ankle - 0.13 - 0.05j, "knee": knee + 0.03}
    positions["thigh $u$"] = knee / 2 + 0.03 + 0.03j
    positions["shank $l$"] = (knee + ankle) / 2 + 0.03 - 0.03j
    for text, position in positions.items():
        ax.text(position.real, position.imag, text)
    ax.text(-0.02, -distance / 2, "distance $d$", rotation=90, ha="right", va="center", color=CURVES[1])
    if step >= 2:
        _draw_angles(ax, knee, ankle)
    ax.set(aspect="equal", xlim=(-0.35, 0.55), ylim=(-distance - 0.1, 0.1))
    ax.set_axis_off()
    return figure


def _draw_angles(ax: Axes, knee: complex, ankle: complex) -> None:
    """Draw the thigh's continuation past the knee and name the angle at the hip and the knee's bend."""
    onward = knee / abs(knee)
    trace(ax, np.array([knee, knee + 0.22 * onward]), color=QUIET, ls="--", lw=1.5)
    angles = np.angle([onward / -1j, (ankle - knee) / onward])
    for corner, first, turn in ((0j, -1j, angles[0]), (knee, onward, angles[1])):
        trace(ax, corner + 0.12 * first * np.exp(1j * np.linspace(0, turn, 30)), color="#333333", lw=1.5)
    at_hip, bend = np.abs(np.degrees(angles))
    ax.text(0.02, -0.16, f"{at_hip:.0f}°")
    ax.text(knee.real + 0.1, knee.imag - 0.12, f"bend {bend:.0f}°")


def added_by_blend(terms: Sequence[str] = ()) -> Callable[..., list[Artist]]:
    """Draw how a blend changes velocities, and the jolt that it adds.

    Parameters
    ----------
    terms : names of what explains this jolt.

    Returns
    -------
    A function for `explore`: it takes a blend, as from `seam_trials.passage`, and for each name a term, shape
    (F - 2, 3P), metres per frame, and gives what it moved: the root's velocities above, and the jolts below,
    in the window and a frame on either side.

    Examples
    --------
    >>> from mocap.blending import cubic_weights, join
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")[:80]
    >>> blended = Passage(join(walk, 20, walk, 20, 10), walk, walk, 20, cubic_weights(10))
    >>> moved = added_by_blend(["no gap, no jolt"])(blended, blended.gap[1:-1])
    >>> [len(ax.lines) for ax in moved[0].figure.axes]
    [3, 1]

    Notebook: 09-discussion
    """
    above, below = Figure(figsize=(7.5, 4.4), layout="constrained").subplots(2, 1)
    named = zip(
        ("first clip", "second clip, aligned", "the blend"), (*SOURCES[:2], COLOURS["middle"]), strict=True
    )
    speeds = [above.plot([], color=colour, lw=2.6, label=name)[0] for name, colour in named]
    speeds[-1].set_linewidth(1.3)
    inside = above.axvspan(0, 1, color=MARK, alpha=0.15, linewidth=0)
    (added,) = below.fill([0, 0, 0], [0, 0, 0], color=MARK, alpha=0.4, lw=0, label="added jolt, measured")
    sizes = [below.plot([], color=c, label=name)[0] for name, c in zip(terms, CURVES, strict=False)]
    above.set(ylabel="forward velocity\nof 'root' (m/s)")
    below.set(xlabel="frame, counted from the start of the window", ylabel="jolt, RMS over\npoints (m/s)")
    for ax in (above, below):
        ax.legend(frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
        ax.locator_params(nbins=4)  # ticks take most of the time to draw

    return partial(_move_added, speeds, inside, added, sizes)


def _move_added(
    speeds: list[Line2D],
    inside: Rectangle,
    added: Polygon,
    sizes: list[Line2D],
    blended: Passage,
    *terms: Array,
) -> list[Artist]:
    """Move the curves of `added_by_blend` to another blend, and return all that moved."""
    start = blended.start
    window = len(blended.weights)
    travelled = blended.first.root_positions[-1] - blended.first.root_positions[0]
    ahead = travelled / max(float(np.linalg.norm(travelled)), 1e-9)
    for line, motion in zip(speeds, (blended.first, blended.second, blended.result), strict=True):
        speed = np.diff(motion.root_positions, axis=0) @ ahead * motion.fps
        line.set_data(np.arange(len(speed)) + 0.5 - start, speed)
    inside.set_width(window - 1)
    frames = np.arange(-1, window + 1)
    *_, added_jolts = blended.jolts
    jolts = np.pad(added_jolts, 1)  # down to the ground at both ends
    added.set_xy(np.column_stack([np.pad(frames, 1, mode="edge"), jolts]))
    for line, term in zip(sizes, terms, strict=True):
        line.set_data(frames, blended.size(term)[start - 2 :][: window + 2])
    axes = inside.figure.axes
    for ax in axes:
        ax.relim()
        ax.autoscale_view()
        ax.figure.stale = False  # the sides move too, so all else stays as it was drawn
    return [*speeds, inside, added, *sizes, *(side for ax in axes for side in (ax.xaxis, ax.yaxis))]
