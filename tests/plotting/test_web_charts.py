"""Pictures of match webs show the numbers that they are given."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba

from mocap import datasets
from mocap.methods.match_webs import Match, minima_1d
from mocap.plotting import match_tree, space_image, target_poses, web_image
from mocap.plotting.style import ASTRAY, COLOURS, SOURCES

AT = np.arange(3.0)
FOUND = [
    Match(0, 0, 9, 0.0, -1, 0, AT, AT),
    Match(1, 0, 9, 0.01, 0, 1, AT, AT),
    Match(1, 20, 29, 0.02, 0, 1, AT, AT),
    Match(2, 0, 9, 0.01, 2, 2, AT, AT),
    Match(2, 30, 39, 0.01, 1, 2, AT, AT),
]


def test_paths_and_minima_lie_on_the_middles_of_their_cells():
    grid = np.abs(np.subtract.outer(np.arange(6.0), np.arange(8.0))) / 100
    path = np.stack([np.arange(6), np.arange(6)], axis=1)
    drawn = web_image(grid, marks=minima_1d(grid), paths=[path], rate=10)
    assert drawn.paths.get_segments()[0] == pytest.approx((path + 0.5) / 10)
    marked = np.round(drawn.cells.get_xydata() * 10 - 0.5).astype(int).tolist()
    assert all([n, n] in marked for n in range(6))
    assert drawn.grid.get_array().max() == pytest.approx(7)
    assert not len(web_image(grid).cells.get_xydata())


def test_each_match_stands_at_its_step_linked_with_what_found_it():
    drawn = match_tree(FOUND, ["walk", "walk", "run", "run", "walk"], wrong=[False] * 3 + [True, False])
    places = np.asarray(drawn.matches.get_offsets())
    assert places[:, 0].tolist() == [0, 1, 1, 2, 2]
    assert places[3, 1] > places[4, 1]  # no two links cross
    assert len({tuple(place) for place in places.tolist()}) == len(FOUND)
    ends = [segment.tolist() for segment in drawn.links.get_segments()]
    assert ends[2] == [places[2].tolist(), places[3].tolist()]
    assert np.asarray(drawn.wrong.get_offsets()).tolist() == [places[3].tolist()]
    assert tuple(drawn.wrong.get_edgecolor()[0]) == to_rgba(ASTRAY)
    assert [tuple(c) for c in drawn.matches.get_facecolors()[[0, 2]]] == [to_rgba(c) for c in SOURCES[:2]]


def test_a_kind_keeps_its_colour_when_another_is_missing():
    few = match_tree(FOUND[:2], ["run", "run"], order=["walk", "run"])
    assert tuple(few.matches.get_facecolors()[0]) == to_rgba(SOURCES[1])


def test_a_query_alone_is_a_tree():
    assert len(match_tree(FOUND[:1], ["walk"]).links.get_segments()) == 0


def test_arrows_go_from_wishes_to_what_was_got():
    drawn = space_image([[0, 1], [2, 3], [1, 2]], 2, wishes=[[1, 1], [0, 0]], got=[[1, 2], [1, 0]])
    assert (drawn.arrows.U.tolist(), drawn.arrows.V.tolist()) == ([0, 1], [1, 0])
    assert np.asarray(drawn.wishes.get_offsets()).tolist() == [[1, 1], [0, 0]]
    assert len(space_image([[0, 1], [2, 3]], 2).samples.get_offsets()) == 0


def test_poses_stand_in_rows_with_their_targets():
    walk = datasets.sample("walk_straight")
    axes = target_poses([walk] * 3, [0, 60, 120], targets=[[0, 1], [0.1, 1], [0.2, 1]], columns=2)
    assert [ax.get_lines()[0].get_xydata()[0].tolist() for ax in axes[:3]] == [[0, 1], [0.1, 1], [0.2, 1]]
    assert all(len(ax.collections) == 1 for ax in axes[:3])
    assert axes[0].xaxis_inverted()


def test_the_body_is_seen_from_behind_with_its_left_at_the_left():
    walk = datasets.sample("walk_straight")
    [ax] = target_poses([walk], [0], targets=[[0, 1]], columns=1)
    lines = ax.collections[0]
    left = [
        line[:, 0].mean()
        for line, colour in zip(lines.get_segments(), lines.get_colors(), strict=True)
        if tuple(colour) == to_rgba(COLOURS["left"])
    ]
    assert np.mean(left) > 0
