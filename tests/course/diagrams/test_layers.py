"""The layered search in pictures finds the best walk, crosses out what stands alike, and looks ahead."""

from itertools import product

import numpy as np
import pytest

from mocap.body import GroundPath
from mocap.course.diagrams.layers import PROGRAM, STRIDE, TURNS, Steps, layer_states, layer_steps, lengthened

LINE = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]]).at(STRIDE * np.arange(8)) @ [1j, 1]


def every_walk(line, count):
    for turns in product(TURNS, repeat=count):
        walk = Steps((0j,), 0.0, 0.0)
        for turn in turns:
            walk = lengthened(walk, turn, line)
        yield walk


@pytest.mark.parametrize("seed", range(5))
def test_a_beam_that_holds_all_walks_finds_the_best_of_all(seed):
    line = np.cumsum(0.7 * np.exp(1j * np.random.default_rng(seed).normal(size=6).cumsum()))
    best = min(walk.cost for walk in every_walk(line, 4))
    for look in (False, True):
        assert [*layer_states(line, 4, width=99, look=look)][-1].best.cost == pytest.approx(best)


def test_the_look_ahead_needs_a_narrower_beam():
    def narrowest(look):
        costs = [[*layer_states(LINE, 5, width=width, look=look)][-1].best.cost for width in range(1, 10)]
        return 1 + costs.index(min(costs))

    assert (narrowest(True), narrowest(False)) == (2, 6)


def test_of_walks_that_stand_alike_the_best_stays_and_no_more_than_the_beam_go_on():
    for state in layer_states(LINE, 5, width=4):
        ends = [(np.round(walk.places[-1], 6), round(walk.heading, 6)) for walk in state.kept]
        if state.line in (5, 6):
            assert len(set(ends)) == len(ends)
            assert all(
                any(
                    abs(walk.places[-1] - other.places[-1]) < 1e-6 and state.score[other] <= state.score[walk]
                    for other in state.kept
                )
                for walk in (state.crossed if state.line == 5 else ())
            )
        assert state.line != 6 or len(state.kept) <= 4


def test_the_line_that_ran_is_marked_and_crossed_walks_are_drawn():
    figure = layer_steps(LINE, 5)(18, 4, True)[0].figure
    ground, code = figure.axes
    assert [text.get_text() for text in code.texts] == PROGRAM
    marked = code.patches[0].get_extents().transformed(code.transData.inverted())
    assert (marked.y0 + marked.y1) / 2 == pytest.approx(
        PROGRAM.index("    kept = the K best of apart, by score")
    )
    (crosses,) = (line for line in ground.lines if line.get_marker() == "x")
    ends = [walk.places[-1] for walk in [*layer_states(LINE, 5)][18].crossed]
    assert crosses.get_xydata()[crosses.get_markevery()] @ [1j, 1] == pytest.approx(ends)
    assert len(ends) > 0
