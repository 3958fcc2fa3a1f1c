"""A graph that was saved walks as it walked."""

import numpy as np
import pytest

from mocap.errors import FormatError
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from mocap.methods.parametric_graphs.parametric_files import load_parametric, save_parametric
from tests.methods.parametric_graphs.built import stepping, walking
from tests.refusals import refused


@pytest.mark.parametrize("built", [walking, stepping])
def test_it_comes_back_and_walks_the_same(tmp_path, built):
    save_parametric(built(), tmp_path / "graph.npz")
    back = load_parametric(tmp_path / "graph.npz")
    assert back.report() == built().report()
    one, other = (ParametricController(graph) for graph in (built(), back))
    for frame in range(90):
        ours, theirs = one.step(frame / 30, 0.8), other.step(frame / 30, 0.8)
        np.testing.assert_array_equal(ours.root_position, theirs.root_position)
        np.testing.assert_array_equal(ours.rotations, theirs.rotations)


def damaged(path, **changes):
    with np.load(path) as archive:
        arrays = {**archive, **changes}
    np.savez(path, **arrays)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"targets": np.array([7])}, "edges between its nodes"),
        ({"parameters_of_0": np.array(["turn"] * 2)}, "to fit the other arrays"),
        ({"low_of_0": np.zeros(3)}, "to fit the other arrays"),
    ],
)
def test_files_that_contradict_themselves_are_refused(tmp_path, changes, sentence):
    save_parametric(walking(), tmp_path / "graph.npz")
    damaged(tmp_path / "graph.npz", **changes)
    refused(sentence, load_parametric, tmp_path / "graph.npz", kind=FormatError)


def test_missing_files_are_refused(tmp_path):
    refused("Cannot read", load_parametric, tmp_path / "no.npz")
