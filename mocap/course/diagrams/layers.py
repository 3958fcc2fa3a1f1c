"""The layered search line by line: lengthen, cross out, keep the best, and look ahead [KGP02, 5.1]."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist

from mocap._shared.arrays import Array
from mocap.course.diagrams.pens import show_program
from mocap.plotting import ASKED, CURVES, PATH, QUIET

STRIDE = 0.7  # metres of a step
TURNS = np.radians([-30, 0, 30])  # radians, of the three edges at each node
PROGRAM = """waiting = {0: [start]}
while waiting:
    layer = min(waiting)
    walks = waiting.pop(layer)
    score = {walk: walk.cost + look_ahead(walk)}
    apart = cross_out_alike(walks, score)
    kept = the K best of apart, by score
    for walk, edge in all_ways_on(kept):
        longer = lengthen(walk, edge)
        if longer is at the end:
            best = the cheaper of best, longer
        else:
            waiting[layer_of(longer)] += [longer]""".splitlines()
"""The loop that the pictures run; `plain.Search.layers` is the same one on clips."""

LOOKS: dict[str, dict[str, Any]] = {}
LOOKS["crossed out"] = {"color": QUIET, "marker": "x", "alpha": 0.5, "linewidth": 1.4}
LOOKS["waiting"] = {"color": CURVES[0], "marker": "o", "linewidth": 1.4}
LOOKS["best"] = {"color": PATH, "marker": "o", "linewidth": 3.5}


class Steps(NamedTuple):
    """A walk of steps: where it has been, complex numbers z + ix, its heading, and what it costs so far."""

    places: tuple[complex, ...]
    heading: float
    cost: float


class LayerState(NamedTuple):
    """What the search knows when it has worked through one line of `PROGRAM`.

    line : the number of this line.
    message : what it has just done.
    kept, crossed : walks that go on, and walks that were crossed out in this layer.
    score : what a layer's walks are compared by, once it is known.
    best : the cheapest walk at the end so far.
    """

    line: int
    message: str
    kept: list[Steps]
    crossed: list[Steps]
    score: dict[Steps, float]
    best: Steps | None = None


def lengthened(walk: Steps, turn: float, line: Array) -> Steps:
    """Let a walk make one more step."""
    heading = walk.heading + turn
    place = walk.places[-1] + STRIDE * np.exp(1j * heading)
    squared_error = abs(place - line[len(walk.places)]) ** 2
    return Steps((*walk.places, place), heading, walk.cost + float(squared_error))


def layer_states(line: Array, count: int, width: int = 4, look: bool = True) -> Iterator[LayerState]:
    """Run the layered search for a walk of some steps along a line, and yield its state after each stage.

    A step is 70 cm long and turns by -30°, 0° or 30°. It costs the squared distance from where the line is at
    equal length. So the steps made are the layer, and walks stand alike at one place with one heading.

    Parameters
    ----------
    line : where the line is after each step, shape (count + 2,), complex numbers z + ix in metres.
    count : the steps of a complete walk.
    width : how many walks of a layer go on.
    look : whether a walk's score includes what one more step straight ahead would cost.

    Examples
    --------
    >>> *_, last = layer_states(STRIDE * np.arange(4), 2)
    >>> last.message, round(last.best.cost, 3)
    ('at the end: the cheapest costs 0.00 m²', 0.0)
    """
    walks = [Steps((0j,), 0.0, 0.0)]
    for layer in range(count):
        yield LayerState(3, f"layer {layer}: {len(walks)} waiting", walks, [], {})
        score = {walk: (lengthened(walk, 0, line) if look else walk).cost for walk in walks}
        ahead = "cost + look-ahead" if look else "cost alone"
        yield LayerState(4, f"layer {layer}: score = {ahead}", walks, [], score)
        ranked = sorted(walks, key=lambda walk: -score[walk])  # of those alike, the last stays: the best one
        distinct = {(np.round(walk.places[-1], 3), round(walk.heading, 3)): walk for walk in ranked}
        crossed = [walk for walk in walks if walk not in distinct.values()]
        yield LayerState(
            5, f"layer {layer}: {len(crossed)} crossed out", [*distinct.values()], crossed, score
        )
        kept = sorted(distinct.values(), key=lambda walk: score[walk])[:width]
        crossed = [walk for walk in walks if walk not in kept]
        yield LayerState(6, f"layer {layer}: the best {len(kept)} go on", kept, crossed, score)
        walks = [lengthened(walk, turn, line) for walk in kept for turn in TURNS]
        ran = 8 if layer == count - 1 else 12
        yield LayerState(ran, f"layer {layer}: {len(walks)} longer walks", walks, [], {})
    best = min(walks, key=lambda walk: walk.cost)
    yield LayerState(10, f"at the end: the cheapest costs {best.cost:.2f} m²", walks, [], {}, best)


def layer_steps(line: Array, count: int) -> Callable[[int, int, bool], list[Artist]]:
    """Draw the layered search stage by stage: walks on the ground, and the line of code that ran.

    Parameters
    ----------
    line, count : as for `layer_states`.

    Returns
    -------
    A function for `explore`: it takes the number of stages, from 0 on, then `width` and `look` of
    `layer_states`, and gives what it moved; the last stage where there are no more.

    Examples
    --------
    >>> layer_steps(STRIDE * np.arange(7), 5)(2, 4, True)[-1].get_text()
    'layer 0: 0 crossed out'

    Notebook: 08-path-synthesis
    """
    figure, (ground, code) = plt.subplots(1, 2, figsize=(10.8, 4.6), width_ratios=(4, 6.6))
    figure.subplots_adjust(left=0.06, right=1, bottom=0.2, top=0.93, wspace=0.06)
    ground.plot(line[:-1].imag, line[:-1].real, color=ASKED, linewidth=3, alpha=0.7, label="asked for")
    pens = [ground.plot([], [], label=name, **look)[0] for name, look in LOOKS.items()]
    raised = {"textcoords": "offset points", "ha": "center"}  # in two rows, so that neighbours are seen
    scores = [ground.annotate("", (0, 0), (0, 7 + 15 * (number % 2)), **raised) for number in range(24)]
    ground.set(aspect="equal", xlabel="x (m)", ylabel="z (m)", xlim=(2.1, -1.4), ylim=(-0.3, 3.1))
    ground.set(xticks=[2, 1, 0, -1], yticks=range(4))
    figure.legend(loc="lower left", ncols=4, frameon=False)
    mark = show_program(code, PROGRAM, 0)

    def draw(step: int, width: int, look: bool) -> list[Artist]:
        state = [*layer_states(line, count, width, look)][: step + 1][-1]
        best = [state.best] if state.best else []
        for pen, walks in zip(pens, (state.crossed, state.kept, best), strict=True):
            places = np.concatenate([[*walk.places, np.nan] for walk in walks] or [[np.nan]])
            pen.set_data(places.imag, places.real)
            pen.set_markevery((np.flatnonzero(np.isnan(places)) - 1)[: len(walks)].tolist())  # at the ends
        going = sorted((w for w in state.kept if w in state.score), key=lambda walk: walk.places[-1].imag)
        for word in scores:
            word.set_text("")
        for word, walk in zip(scores, going, strict=False):
            word.set_text(f"{state.score[walk]:.1f}")
            word.xy = walk.places[-1].imag, walk.places[-1].real
        mark.set_y(state.line - 0.5)
        ground.title.set_text(state.message)
        return [*pens, *scores, mark, ground.title]

    return draw
