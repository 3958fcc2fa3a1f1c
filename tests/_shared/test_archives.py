"""A file holds what its kind says, and whatever is written can be read again."""

from importlib import import_module

import numpy as np
import pytest

import mocap
from mocap._shared.archives import (
    AMASS,
    LOADERS,
    MOTION,
    Kind,
    Part,
    numbered,
    pack,
    read_archive,
    write_archive,
)
from mocap.errors import FormatError
from mocap.graphs import storage
from mocap.methods.groups import group_storage
from mocap.methods.match_webs import web_storage
from mocap.methods.parametric_graphs import parametric_storage
from tests.refusals import refused

LAYOUT = {"rows": (int, ("N", 2)), "names": (str, ("N",)), "rate": (float, ())}
PARTS = {"node": Part("N", {"grid": (float, ("g",)), "pairs": (bool, ("g", "N"))})}


def rules(arrays):
    yield "rates are above 0", arrays["rate"] > 0
    yield "rows are not negative", arrays["rows"] >= 0


PAIRS = Kind("some pairs", LAYOUT, rules, PARTS, version=2)
PAIR = {"rows": np.arange(6).reshape(3, 2), "names": ["a", "b", "c"], "rate": 30.0}
for row in range(3):
    PAIR |= numbered("node", row, {"grid": np.arange(row), "pairs": np.ones((row, 3))})


@pytest.fixture
def path(tmp_path):
    write_archive(tmp_path / "pairs.npz", PAIRS, PAIR)
    return tmp_path / "pairs.npz"


def changed(path, **arrays):
    """Write the file again with other arrays; None takes one out."""
    with np.load(path) as archive:
        new = {**archive, **arrays}
    pack(path, {key: array for key, array in new.items() if array is not None})
    return path


def test_arrays_come_back_and_those_of_a_part_by_its_number(path):
    arrays = read_archive(path, PAIRS)
    assert set(arrays) == {*PAIR, "version"}
    assert all(np.array_equal(arrays[key], array) for key, array in PAIR.items())
    second = PAIRS.part(arrays, "node", 2)
    assert second["grid"].tolist() == [0.0, 1.0]
    assert second["pairs"].dtype == bool and second["pairs"].shape == (2, 3)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"version": np.array(3)}, "version 1 or 2, got version 3, which a newer mocap wrote"),
        ({"format": np.array("mocap: a cake")}, "some pairs saved by mocap, .* an .npz of another kind"),
        ({"rate": None}, "one without rate"),
        ({"node_2_grid": None}, "one without node_2_grid"),
        ({"names": np.array(["a"])}, "'names' to fit the other arrays, got <U1"),
        ({"rows": np.zeros((3, 2))}, "'rows' to fit the other arrays, got float64"),
        ({"rows": np.zeros((3, 3), int)}, "'rows' to fit the other arrays"),
        ({"rate": np.ones(3)}, r"'rate' to fit the other arrays, got float64\(3,\)"),
        ({"node_1_grid": np.zeros(2)}, "'node_1_pairs' to fit the other arrays"),
        ({"node_1_pairs": np.ones((1, 5), bool)}, "'node_1_pairs' to fit the other arrays"),
        ({"rate": np.array(0.0)}, "that rates are above 0, got a damaged file"),
        ({"rows": np.full((3, 2), -1)}, "that rows are not negative, got a damaged file"),
    ],
)
def test_what_is_not_of_the_kind_is_named(path, arrays, words):
    refused(words, read_archive, changed(path, **arrays), PAIRS, kind=FormatError)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"names": ["a"]}, "Cannot save some pairs: 'names' does not fit its other arrays"),
        ({"rows": np.full((3, 2), 0.5)}, "'rows' holds values that int has not"),
        ({"names": ["a", "\udc80", "c"]}, "'names' holds characters that are not Unicode text"),
        ({"rate": np.nan}, "'rate' holds values that float has not|expected that rates"),
        ({"rate": -1.0}, "Cannot save some pairs: expected that rates are above 0"),
        ({"node_1_pairs": np.full((1, 3), 0.5)}, "'node_1_pairs' holds values that bool has not"),
    ],
)
def test_what_could_not_be_read_again_is_not_written(path, arrays, words):
    content = path.read_bytes()
    refused(words, write_archive, path, PAIRS, PAIR | arrays)
    assert path.read_bytes() == content


KINDS = {
    kind.name: kind
    for kind in (
        storage.GRAPH,
        web_storage.WEB,
        parametric_storage.PARAMETRIC,
        group_storage.GROUP,
    )
}


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_opened_by_the_loader_of_another_names_its_own(tmp_path, name):
    path = tmp_path / "a.npz"
    pack(path, {"format": np.array(f"mocap: {name}"), "version": np.array(1)})
    for other in KINDS:
        words = f"expected {other} saved by mocap, .* got {name}: {LOADERS[name]} reads it$"
        if other == name:
            words = "one without"
        refused(words, function(LOADERS[other]), path, kind=FormatError)


@pytest.mark.parametrize("name", KINDS)
def test_an_amass_archive_is_for_another_loader(tmp_path, name):
    pack(tmp_path / "a.npz", {"poses": np.zeros((2, 156)), "trans": np.zeros((2, 3))})
    words = f"expected {name} saved by mocap, .* got an AMASS archive: mocap.load reads it$"
    refused(words, function(LOADERS[name]), tmp_path / "a.npz", kind=FormatError)
    pack(tmp_path / "a.npz", {"rows": np.zeros(2)})
    refused("got an .npz of another kind$", function(LOADERS[name]), tmp_path / "a.npz", kind=FormatError)


@pytest.mark.parametrize("name", [*KINDS, storage.PACKED.name])
def test_a_file_that_is_no_motion_names_its_loader(tmp_path, name):
    path = tmp_path / "a.npz"
    pack(path, {"format": np.array(f"mocap: {name}"), "version": np.array(1)})
    words = f"expected an AMASS archive with poses and trans, got {name}: {LOADERS[name]} reads it$"
    refused(words, mocap.load, path, kind=FormatError)


def function(loader):
    """Find a loader by its room and name, as errors call it."""
    room, name = loader.rsplit(".", 1)
    rooms = {"mocap": "mocap", "graphs": "mocap.graphs"}
    return getattr(import_module(rooms.get(room, f"mocap.methods.{room}")), name)


def test_every_kind_has_a_loader():
    assert {*KINDS, storage.PACKED.name, AMASS, MOTION} == set(LOADERS)
    assert all(map(callable, map(function, LOADERS.values())))
