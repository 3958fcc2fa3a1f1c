"""Walks that are bent to another end: they arrive, they change smoothly, and limits are limits."""

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mocap.body.planar import on_ground
from mocap.datasets import samples
from mocap.methods.in_betweening import end_bending
from mocap.methods.in_betweening.end_bending import bend_to
from tests.tuning import tune


@settings(max_examples=15)
@given(x=st.floats(-0.8, 0.8), z=st.floats(-0.4, 0.4), turn=st.floats(-0.8, 0.8))
@example(x=0.0, z=0.0, turn=0.0)
def test_a_walk_is_bent_to_any_end_near_its_own(x, z, turn):
    walk = samples.sample("walk_straight")[:481:4]
    bent = bend_to(walk, len(walk), on_ground(walk.root_positions[-1]) + z + 1j * x, turn)
    assert bent.lack < 1e-4 and (bent.pace == 1).all()
    assert abs(bent.turned.sum() / walk.fps - turn) < 1e-6
    assert np.abs(bent.turned[[0, -1]]).max() < 0.05  # radians per second: level at both ends
    assert np.abs(bent.steps[[0, -1]] - 1).max() < 0.02
    if x == z == turn == 0:
        np.testing.assert_allclose(bent.motion.root_positions, walk.root_positions, atol=1e-6)


def test_turning_is_held_to_its_limit_where_there_is_a_way(monkeypatch):
    walk = samples.sample("walk_straight")[:481:4]
    end = on_ground(walk.root_positions[-1]) + 1.2j
    tune(monkeypatch, end_bending, most_turn=10.0)
    free = bend_to(walk, len(walk), end, 0.0)
    limit = 0.9 * np.abs(free.turned).max()
    tune(monkeypatch, end_bending, most_turn=limit)
    held = bend_to(walk, len(walk), end, 0.0)
    assert held.lack < 1e-3 and np.abs(held.turned).max() <= limit
