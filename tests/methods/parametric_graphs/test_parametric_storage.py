"""A parametric motion graph comes back from its file bit for bit, and walks as it walked."""

import dataclasses

import numpy as np
import pytest

from mocap.errors import FormatError, MocapError
from mocap.methods.match_webs import weights_for
from mocap.methods.parametric_graphs import ParametricController, load_parametric, save_parametric
from tests.methods.parametric_graphs.built import acting, stepping, walk_and_jog, walking
from tests.refusals import refused


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("parametric") / "walk.npz"
    save_parametric(walking(), path)
    return path


def assert_same(ours, theirs, *excepted):
    """Compare two dataclasses field by field, arrays bit for bit and in memory order."""
    for field in dataclasses.fields(ours):
        one, other = getattr(ours, field.name), getattr(theirs, field.name)
        if field.name in excepted:
            continue
        assert type(one) is type(other), field.name
        assert np.array_equal(one, other), field.name
        if isinstance(one, np.ndarray):
            assert one.flags.c_contiguous and other.flags.c_contiguous, field.name


LONG = [pytest.param(built, marks=pytest.mark.sweep) for built in (acting, walk_and_jog)]  # 30 s each


@pytest.mark.parametrize("built", [walking, stepping, *LONG])
def test_a_graph_comes_back_bit_for_bit_and_walks_the_same(tmp_path, built):
    graph = built()
    save_parametric(graph, tmp_path / "graph.npz")
    back = load_parametric(tmp_path / "graph.npz")
    assert list(back) == list(graph) and list(back.edges) == list(graph.edges)
    for name, space in graph.nodes(data="space"):
        other = back.nodes[name]["space"]
        assert_same(space, other, "examples")
        assert_same(space.examples, other.examples, "skeleton")
        assert_same(space.examples.skeleton, other.examples.skeleton)
        middle = (space.low + space.high) / 2
        ours, theirs = (some.examples.blend(weights_for(some, middle)) for some in (space, other))
        assert np.array_equal(ours.rotations, theirs.rotations)
        assert np.array_equal(ours.root_positions, theirs.root_positions)
    for source, target, edge in graph.edges(data="edge"):
        assert_same(edge, back.edges[source, target]["edge"])
    walk_alike(graph, back)


def walk_alike(graph, back):
    """Steer through all nodes that obey, and aim, with both graphs."""
    characters = [ParametricController(some) for some in (graph, back)]
    names = [name for name in graph if "guard" not in name and " to " not in name]
    for frame in range(240):
        for character in characters:
            if frame % 60 == 0:
                character.aim([0.2, 1.0 + frame / 600, 0.5])
        label = names[frame // 60 % len(names)]
        ours, theirs = (character.step(frame / 30, 0.8, label) for character in characters)
        assert np.array_equal(ours.root_position, theirs.root_position)
        assert np.array_equal(ours.rotations, theirs.rotations)
    assert len(characters[0].chosen) > 2
    assert repr(characters[0].chosen) == repr(characters[1].chosen)


def test_a_graph_saved_again_is_the_same_file(saved, tmp_path):
    save_parametric(load_parametric(saved), tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == saved.read_bytes()


def double(key):
    return lambda arrays: {key: 2 * arrays[key]}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda arrays: {"node_0_poses": None}, "one without node_0_poses"),
        (lambda arrays: {"targets": np.array([7])}, "that edges join nodes"),
        (lambda arrays: {"sources": np.array([-1])}, "that edges join nodes"),
        (lambda arrays: {"node_0_parameters": np.array(["turn"] * 2)}, "'node_0_.*' to fit the other arrays"),
        (lambda arrays: {"node_0_low": np.zeros(3)}, "'node_0_low' to fit the other arrays"),
        (lambda arrays: {"node_0_parents": arrays["node_0_parents"][::-1]}, "a tree of joints, got 'Joint 0"),
        (lambda arrays: {"node_0_heights": np.nan * arrays["node_0_heights"]}, "that numbers are finite"),
        (lambda arrays: {"node_0_contact_names": np.array(["tail"] * 4)}, "that contacts are of joints"),
        (lambda arrays: {"node_0_fps": np.array(0.1)}, "that rates are 1 to 1000 Hz"),
        (lambda arrays: {"node_0_grid": arrays["node_0_grid"] + 9}, "that phases grow from below 0"),
        (lambda arrays: {"node_0_grid": arrays["node_0_grid"] ** 3}, "that phases"),
        (lambda arrays: {"node_0_seconds": -arrays["node_0_seconds"]}, "that time goes on"),
        (lambda arrays: {"node_0_seconds": arrays["node_0_seconds"] + 1}, "that time counts from phase 0"),
        (double("node_0_poses"), "that rotations have length 1"),
        (double("node_0_sampled_weights"), "that samples are mixes"),
        (lambda arrays: {"node_0_low": arrays["node_0_high"] + 1}, "that a range has ends"),
        (lambda arrays: {"node_0_scale": 0 * arrays["node_0_scale"]}, "that units are above 0"),
        (lambda arrays: {"edge_0_scale": 0 * arrays["edge_0_scale"]}, "that units are above 0"),
        (double("edge_0_leave"), "that motions are left late"),
        (lambda arrays: {"edge_0_enter": arrays["edge_0_leave"]}, "that motions are entered early"),
    ],
)
def test_a_damaged_file_is_refused_with_what_is_wrong(saved, tmp_path, change, words):
    with np.load(saved) as archive:
        arrays = dict(archive)
    new = arrays | change(arrays)
    np.savez(tmp_path / "bad.npz", **{key: array for key, array in new.items() if array is not None})
    refused(words, load_parametric, tmp_path / "bad.npz", kind=FormatError)


def test_roles_come_back_and_files_without_them_open(saved, tmp_path):
    graph = walking().copy()
    examples = graph.nodes["walk"]["space"].examples
    skeleton = dataclasses.replace(examples.skeleton, roles={"left ball": "ltoes_end"})
    examples = dataclasses.replace(examples, skeleton=skeleton)
    graph.nodes["walk"]["space"] = dataclasses.replace(graph.nodes["walk"]["space"], examples=examples)
    save_parametric(graph, tmp_path / "graph.npz")
    back = load_parametric(tmp_path / "graph.npz")
    assert back.nodes["walk"]["space"].examples.skeleton == skeleton
    with np.load(saved) as archive:
        older = {key: array for key, array in archive.items() if not key.endswith("_roles")}
    np.savez(tmp_path / "older.npz", **older | {"version": np.array(1)})
    assert load_parametric(tmp_path / "older.npz").nodes["walk"]["space"].examples.skeleton.roles == {}


def test_missing_and_cut_files_are_refused(saved, tmp_path):
    refused("Cannot read", load_parametric, tmp_path / "no.npz")
    (tmp_path / "cut.npz").write_bytes(saved.read_bytes()[:-100])
    refused("a damaged one", load_parametric, tmp_path / "cut.npz", kind=MocapError)
