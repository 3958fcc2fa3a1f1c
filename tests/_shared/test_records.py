"""Records print in one line, and motions, skeletons and paths are equal if their values are."""

import copy
import importlib
import inspect
import pickle
import pkgutil
from dataclasses import is_dataclass, replace

import numpy as np
import pytest

import mocap
from mocap import blending, body, datasets, editing, graphs, matching, quality, steering
from mocap._shared.records import LONGEST, NamedTuple, dataclass, one_line
from mocap.body import Motion, Skeleton
from mocap.methods import groups, match_webs, motion_matching

WALK = mocap.resample(datasets.sample("walk_straight"), 30)

# Records of the package that hold a few numbers and words each, and print as the standard library does.
SHORT_RECORDS = {
    "Answer",
    "Block",
    "Deprecation",
    "Format",
    "Joint",
    "Kind",
    "Leg",
    "Listing",
    "NamedSet",
    "Origin",
    "Part",
    "PlanarTransform",
    "ReadOptions",
    "Record",
    "Remedy",
    "Segment",
    "Trial",
    "_Pen",
}


def records() -> list[type]:
    """List the dataclasses and named tuples of the rooms."""
    names = [module.name for module in pkgutil.walk_packages(mocap.__path__, "mocap.")]
    rooms = {name for name in names if not name.startswith(("mocap.course", "mocap.cli", "mocap.__main__"))}
    rooms.remove("mocap.plain")  # which needs nothing but NumPy
    kinds: set[type] = set()
    for name in rooms:
        kinds.update(filter(inspect.isclass, vars(importlib.import_module(name)).values()))
    mine = [kind for kind in kinds if kind.__module__ in rooms]
    fielded = [kind for kind in mine if is_dataclass(kind) or hasattr(kind, "_fields")]
    return sorted(fielded, key=lambda kind: kind.__name__)


def test_all_records_with_arrays_print_in_one_line():
    """`__repr__` is `one_line`, or a method that the class defines."""
    standard = {
        kind.__name__
        for kind in records()
        if hasattr(kind.__repr__, "__wrapped__") or "collections" in kind.__repr__.__code__.co_filename
    }
    named = {kind.__name__ for kind in records() if kind.__repr__.__qualname__.startswith("namedtuple")}
    assert (standard | named) - SHORT_RECORDS == set()
    assert len(records()) >= 60


def results():
    """Yield what public functions return, of many kinds."""
    graph = graphs.prune(graphs.build([WALK], window=10, threshold=0.04))
    line = [[0, 0], [0, 2]]
    pins = editing.plant_pins(WALK)
    yield from (WALK, WALK.skeleton, body.GroundPath(line), body.spline([[0, 0], [1, 1], [0, 2]]), graph)
    yield editing.bend(WALK[:60], line)
    yield pins
    yield editing.ride_of(WALK)
    yield editing.difference(WALK, WALK)
    yield editing.stance_of(WALK)
    yield editing.body_of(WALK, pins)
    yield editing.find_loop(WALK)
    yield blending.register([WALK, WALK])
    yield body.forward_kinematics(WALK)
    yield matching.find_transitions([WALK], window=10, below=0.04)
    yield graphs.compile_graph(graph)
    yield graphs.prune_graph(graph.graph)
    yield graphs.summary(graph.graph, fps=graph.fps)
    yield steering.follow_path(graph, line)
    yield steering.steer(steering.Controller(graph), 60 * [0.0])
    yield quality.judge(WALK)
    yield motion_matching.tabulate([WALK])
    yield match_webs.build_web([WALK])
    yield groups.Scene((0j, 8 + 0j))
    yield groups.simulate(3, 1.0)


def test_results_of_public_functions_print_in_one_short_line():
    for result in results():
        line = repr(result)
        assert "\n" not in line and len(line) <= LONGEST, line
        assert line.startswith(type(result).__name__), line


def test_the_longest_fields_are_abbreviated_first_and_short_ones_never():
    @dataclass
    class Found:
        name: str
        rows: np.ndarray
        words: list[str]

    found = Found("walk", np.zeros((400, 3)), ["a word of some length"] * 7)
    assert repr(found) == "Found(name='walk', rows=<array (400, 3)>, words=<list of 7>)"
    many = dataclass(type("Many", (), {"__annotations__": {f"field_{n}": int for n in range(40)}}))
    assert len(one_line(many(*range(40)))) == LONGEST


def test_a_long_value_without_a_length_is_abbreviated_to_its_type():
    @dataclass
    class Found:
        error: Exception

    assert repr(Found(ValueError("a" * 99))) == "Found(error=<ValueError>)"


def test_a_named_tuple_is_one_of_the_standard_library_but_for_its_line():
    class Pair(NamedTuple):
        """Two numbers."""

        first: int
        second: float = 2.0

        @property
        def sum(self) -> float:
            return self.first + self.second

    assert Pair(1) == (1, 2.0) and Pair(1).sum == 3.0 and Pair(1)._replace(first=3).first == 3
    assert repr(Pair(1)) == "Pair(first=1, second=2.0)" and Pair.__doc__ == "Two numbers."
    assert Pair._field_defaults == {"second": 2.0} and Pair.__mro__[1] is tuple


def pickled(thing: object) -> object:
    return pickle.loads(pickle.dumps(thing))


# Equality ---------------------------------------------------------------------------------------------------


def changed_motions() -> dict[str, Motion]:
    """Return motions that differ from `WALK` in one field each."""
    taller = replace(WALK.skeleton, offsets=1.001 * WALK.skeleton.offsets)
    roots = WALK.root_positions.copy()
    roots[-1, 0] += 1e-12
    labels = {**WALK.labels, "new": np.ones(len(WALK), bool)}
    contacts = {name: ~mark for name, mark in WALK.contacts.items()}
    return {
        "skeleton": replace(WALK, skeleton=taller),
        "root_positions": replace(WALK, root_positions=roots),
        "rotations": replace(WALK, rotations=-WALK.rotations),
        "fps": replace(WALK, fps=31),
        "name": replace(WALK, name="other"),
        "labels": replace(WALK, labels=labels),
        "contacts": replace(WALK, contacts=contacts),
        "frames": WALK[:-1],
    }


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, pickled])
@pytest.mark.parametrize("thing", [WALK, WALK.skeleton, body.GroundPath([[0, 0], [0, 6]])], ids=repr)
def test_a_copy_is_equal_has_the_same_hash_and_stays_read_only(thing, copied):
    same = copied(thing)
    assert same is not thing and same == thing
    assert hash(same) == hash(thing) and len({same, thing}) == 1
    arrays = [value for value in vars(same).values() if isinstance(value, np.ndarray)]
    assert arrays and not any(array.flags.writeable for array in arrays)


@pytest.mark.parametrize("field", changed_motions())
def test_motions_that_differ_in_one_field_are_not_equal(field):
    assert changed_motions()[field] != WALK


def test_a_motion_equals_nothing_else():
    assert WALK.skeleton != WALK and WALK != "walk" and WALK.skeleton != 3
    assert (WALK == None) is False  # noqa: E711
    assert body.GroundPath([[0, 0], [0, 6]]) != body.GroundPath([[0, 0], [0, 3], [0, 6]])
    assert Skeleton(["a"], [-1], [[0, 0, 0]]) != Skeleton(["b"], [-1], [[0, 0, 0]])


def test_computed_positions_are_not_pickled():
    fresh = WALK[:]
    size = len(pickle.dumps(fresh))
    assert fresh.positions.shape == (len(WALK), len(WALK.skeleton), 3)
    assert len(pickle.dumps(fresh)) == size
