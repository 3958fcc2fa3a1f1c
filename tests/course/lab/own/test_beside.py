"""Three students walk a path: one has solved all, one every second exercise, one is wrong everywhere."""

import numpy as np
import pytest

import mocap
from mocap import body, datasets
from mocap.course import checks, lab
from mocap.course.lab import own
from mocap.course.lab.own.building import NAMES
from tests.course.lab.conftest import new_kernel
from tests.course.lab.students import solutions, written, wrong

PATH = body.s_curve(2).points


@pytest.fixture(scope="module")
def clips():
    return [mocap.resample(datasets.sample("walk_circle"), 30)[450:590]]


@pytest.fixture(scope="module")
def plain(clips):
    return own.walk_beside(clips, PATH)


def hand_in(names, right):
    """Adopt what a student wrote, in the order of the course; each uses those before it."""
    for name in names:
        others = {other: lab.mine(other) for other in NAMES}
        lab.mine(written(name, None, others) if right(name) else wrong(name))


def test_who_solves_all_walks_by_own_code_alone_and_saves_it(clips, plain, capsys, fresh, tmp_path):
    hand_in(NAMES, lambda name: True)
    new_kernel()  # the file is enough
    beside = own.walk_beside(clips, PATH)
    said = capsys.readouterr().out
    assert [line for line in said.splitlines() if "from here on" in line] == []
    assert all(line.yours for line in beside.lines)
    unused = {line.name for line in beside.lines if not line.calls}
    assert unused <= {"edge_cost", "short_way"}  # those that only others of one's own call
    assert beside.apart < 1e-9
    assert np.allclose(beside.motion.root_positions, plain.motion.root_positions, atol=1e-9)
    assert 120 <= sum(bool(line.strip()) for line in fresh.read_text().splitlines()) <= 260
    mocap.save(beside.motion, tmp_path / "mine.bvh")
    assert len(mocap.load(tmp_path / "mine.bvh")) == len(beside.motion)
    shown = beside._repr_mimebundle_()[0]["text/html"]
    assert "seconds, mine" in shown
    assert f"{len(NAMES) - 1} of {len(NAMES) - 1} functions are yours" in shown


def test_who_solves_every_second_walks_by_own_code_where_there_is_some(clips, plain, capsys):
    half = set(NAMES[::2])
    hand_in(NAMES, half.__contains__)
    beside = own.walk_beside(clips, PATH)
    assert "stands in from here on" not in capsys.readouterr().out
    assert {line.name for line in beside.lines if line.yours} == half - {"next_edge"}
    assert beside.apart < 1e-9
    assert np.allclose(beside.motion.root_positions, plain.motion.root_positions, atol=1e-9)


def test_who_is_wrong_everywhere_gets_the_packages_walk_and_is_told_so(clips, plain, capsys, fresh):
    hand_in(NAMES, lambda name: False)
    beside = own.walk_beside(clips, PATH)
    said = capsys.readouterr().out
    assert not any(line.yours for line in beside.lines)
    assert said.count("stands in until yours passes its check.") >= len(NAMES)
    assert np.array_equal(beside.motion.root_positions, plain.motion.root_positions)
    assert not fresh.exists()


def test_a_function_that_passes_and_then_fails_on_a_real_clip_is_replaced(clips, plain, capsys):
    source = """
def best_angle(points, others):
    if len(points) > 200:
        raise ValueError("too many")
    x, _, z = (points - points.mean(axis=0)).T
    other_x, _, other_z = (others - others.mean(axis=0)).T
    return np.arctan2((x * other_z - other_x * z).sum(), (x * other_x + z * other_z).sum())
"""
    lab.mine(written("best_angle", source))
    beside = own.walk_beside(clips, PATH)
    said = capsys.readouterr().out
    assert "best_angle: yours raised ValueError: too many; the package's stands in from here on.\n" in said
    assert np.array_equal(beside.motion.root_positions, plain.motion.root_positions)


def test_without_a_function_of_ones_own_the_page_has_no_times(plain):
    bundle, metadata = plain._repr_mimebundle_()
    assert "seconds" not in bundle["text/html"]
    assert bundle["text/html"].count("<tr>") == len(NAMES)
    assert bundle["text/plain"].startswith(
        f"0 of {len(NAMES) - 1} functions are yours, the others the package's.\nmy walk:  "
    )
    assert metadata["image/png"]["alt"].startswith("Bodies walk along a black path")
    assert plain.stand_ins is plain.own
    assert "<code>lengthen</code> (08)</td><td>made of <code>edge_cost</code></td>" in bundle["text/html"]


def test_walks_of_other_lengths_are_no_number_of_centimetres_apart(plain):
    from dataclasses import replace

    other = replace(plain, stand_ins=plain.stand_ins._replace(motion=plain.motion[1:]))
    assert other.apart == np.inf
    assert "another walk apart" in other.report()


def test_every_exercise_of_01_to_08_can_be_kept_and_comes_back_in_a_new_kernel(capsys, fresh):
    names = [name for name in solutions() if name in checks.all_checks()]
    others = {name: lab.mine(name) for name in NAMES}
    for name in names:
        assert lab.mine(written(name, None, others)).kept, name
    new_kernel()
    capsys.readouterr()
    assert all(lab.mine(name).yours for name in names)
    assert capsys.readouterr().out.count(": yours, kept in my_graph.py.\n") == len(names)
    assert len(names) > 40
