"""A changed result is named by joint, frame and direction, and accepted without touching other results."""

import numpy as np
import pytest

from tests.frozen import store
from tests.frozen.quantities import FRAME, Axis, Quantity, contacts, edges, numbers, positions
from tests.strategies import random_motion

MOTION = random_motion(3)
SKELETON = MOTION.skeleton
FRAMES = 4000
LAST_JOINT = SKELETON.names[-1]


def waves(frames=FRAMES):
    """Move the joints up and down, each at a pace of its own."""
    paces = np.arange(1.0, len(SKELETON) * 3 + 1).reshape(-1, 3)
    return np.sin(np.arange(frames)[:, None, None] / 97 * paces)


def changes_between(stored, found, folder):
    store.write(folder / "case.npz", {"it": stored})
    return [str(change) for change in store.compare(store.read(folder / "case.npz"), {"it": found})]


def moved(frame, joint, direction, metres):
    values = waves()
    values[frame, SKELETON.index(joint), direction] += metres
    return positions(values, SKELETON)


def steps_of(quantity):
    return store.summarise(quantity, store.SPACE).steps


def test_the_same_is_the_same_and_so_is_what_other_arithmetic_gives(tmp_path):
    values = waves()
    noise = np.random.default_rng(1).normal(0, 1e-9, values.shape)
    for found in (values, values + noise):
        assert not changes_between(positions(values, SKELETON), positions(found, SKELETON), tmp_path)


def test_a_change_of_a_sample_is_named_by_joint_frame_and_direction(tmp_path):
    step = steps_of(positions(waves(), SKELETON))[0]
    assert step > 1
    frame = 20 * step
    (change,) = changes_between(positions(waves(), SKELETON), moved(frame, LAST_JOINT, 2, 0.0125), tmp_path)
    assert change.startswith(f"it, joint {LAST_JOINT}, frame {frame}, z: expected ")
    assert "difference +12.5 mm; 1 of " in change
    assert f"stored numbers differ, frames {frame} to {frame}" in change


def test_a_change_between_samples_is_named_by_joint_direction_and_a_range_of_frames(tmp_path):
    frame = 20 * steps_of(positions(waves(), SKELETON))[0] + 1
    (change,) = changes_between(positions(waves(), SKELETON), moved(frame, LAST_JOINT, 1, 0.2), tmp_path)
    assert change.startswith(f"it, joint {LAST_JOINT}, y, frames ")
    first, last = (int(word) for word in change.split("frames ")[1].split(",")[0].split(" to "))
    assert first <= frame <= last < first + FRAMES / 50


def test_the_first_edge_that_differs_is_named(tmp_path):
    walk = [((0, frame), (0, frame + 1), 0) for frame in range(500)]
    other = walk[:37] + [((1, frame), (1, frame + 1), 0) for frame in range(450)]
    (change,) = changes_between(edges(walk), edges(other), tmp_path)
    assert change.startswith("it, edge 37, clip of the start: expected 0, found 1, difference +1; ")
    assert change.endswith("edges 37 to 486; 487 x 5 instead of 500 x 5 numbers")


def test_a_contact_between_samples_is_noticed(tmp_path):
    touching = np.random.default_rng(2).random((40_000, 2)) < 0.5
    stored = contacts({"lfoot": touching[:, 0], "rfoot": touching[:, 1]})
    assert steps_of(stored)[0] > 1
    touching[1] = ~touching[1]
    (change,) = changes_between(
        stored, contacts({"lfoot": touching[:, 0], "rfoot": touching[:, 1]}), tmp_path
    )
    assert change.startswith("it, frames 0 to ")


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_none_are_stored(number, tmp_path):
    row = numbers([1.0, number, 2.0], "item", unit="m")
    assert not changes_between(row, row, tmp_path)
    (change,) = changes_between(row, numbers([1.0, 1.5, 2.0], "item", unit="m"), tmp_path)
    assert change.startswith(f"it, item 1: expected {number} m, found 1.5 m")


def test_other_shapes_names_and_kinds_are_changes(tmp_path):
    row = numbers([1.0, 2.0], "item")
    (shorter,) = changes_between(row, numbers([1.0], "item"), tmp_path)
    assert shorter.startswith("it, shape: expected 2, found 1")
    (table,) = changes_between(row, numbers([[1.0, 2.0]], "row", "item"), tmp_path)
    assert "expected (2,), found (1, 2)" in table
    (whole,) = changes_between(row, numbers([1, 2], "item"), tmp_path)
    assert "other numbers" in whole
    store.write(tmp_path / "a.npz", {"a": row})
    gone, new = store.compare(store.read(tmp_path / "a.npz"), {"b": row})
    assert (gone.quantity, new.quantity) == ("a", "b")


def test_a_single_number_and_labelled_rows_have_places(tmp_path):
    (change,) = changes_between(numbers(1.5, unit="s"), numbers(1.6, unit="s"), tmp_path)
    assert change.startswith("it, the number: expected 1.5 s, found 1.6 s, difference +0.1 s")
    sizes = (Axis("", ("nodes", "edges")),)
    (change,) = changes_between(
        Quantity(np.array([5, 7]), sizes), Quantity(np.array([5, 8]), sizes), tmp_path
    )
    assert change.startswith("it, edges: expected 7, found 8")


def test_complex_numbers_are_positions_on_the_ground():
    ground = numbers([[1 + 2j]], FRAME, "member", unit="m")
    assert ground.values.tolist() == [[[1.0, 2.0]]]
    assert ground.axes[-1].labels == ("z", "x")


def test_what_is_accepted_passes_and_what_has_not_changed_keeps_its_bytes(tmp_path):
    cases = {
        "seam": {"it": positions(waves(), SKELETON)},
        "jog, slow": {"it": positions(waves(50), SKELETON)},
    }
    assert all(store.accept(name, found, tmp_path)[0].extent == "new" for name, found in cases.items())
    files = [store.path_of(name, tmp_path) for name in cases]
    assert [file.name for file in files] == ["seam.npz", "jog-slow.npz"]
    before = [file.read_bytes() for file in files]
    cases["seam"] = {"it": moved(0, LAST_JOINT, 0, 0.001)}
    rounding = np.random.default_rng(4).uniform(-1e-6, 1e-6, waves(50).shape)
    cases["jog, slow"] = {"it": positions(waves(50) + rounding, SKELETON)}  # other arithmetic is no change
    assert [len(store.accept(name, found, tmp_path)) for name, found in cases.items()] == [1, 0]
    assert [file.read_bytes() == old for file, old in zip(files, before, strict=True)] == [False, True]
    for name, found in cases.items():
        assert not store.compare(store.read(store.path_of(name, tmp_path)), found)


def test_a_case_takes_little_space(tmp_path):
    noise = np.random.default_rng(0).normal(size=(3000, len(SKELETON), 3))
    quantities = {f"part {number}": positions(noise + number, SKELETON) for number in range(3)}
    store.write(tmp_path / "case.npz", quantities | {"one": numbers(1.0)})
    assert (tmp_path / "case.npz").stat().st_size < 2 * store.SPACE
    assert sum(file.stat().st_size for file in store.FOLDER.glob("*.npz")) < 400_000


def test_a_table_shows_each_change():
    change = store.Change("displacements", "joint lfoot, frame 3, y", "1 m", "2 m", "+1e+03 mm", "1 of 9")
    heads, line, row = store.show_table([("a seam", change)])
    assert heads.startswith("case    quantity       largest difference")
    assert set(line) == {"-", " "}
    assert row.split("  ")[0] == "a seam"
    assert "joint lfoot, frame 3, y" in row
