"""A motion graph of one's own: with the package's functions it is the package's, and with students', too."""

import ast
import copy
import runpy
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import mocap
from mocap import body, datasets, graphs, matching, synthesis
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.course import checks, lab
from mocap.course.lab import kept_functions, own
from mocap.course.lab.adopting import NAMES
from mocap.course.lab.own import pages_of
from tests.course.lab.conftest import new_kernel
from tests.course.lab.students import solutions, written, wrong
from tests.refusals import refused

WINDOW, BELOW = 10, 0.05
CURVE = body.s_curve(2).points
PATH = body.arcs((0, 0), heading=0.0, pieces=[(2.0, 1.0), (2.0, -1.0)])


def changed(some, **by):
    vars(other := copy.copy(some)).update(by)
    return other


@pytest.fixture(scope="module")
def clips():
    names = "walk_straight", "walk_circle"
    straight, circle = (mocap.resample(datasets.sample(name), 30) for name in names)
    return [straight[:100], circle[200:500]]


@pytest.fixture(scope="module")
def by():
    return SimpleNamespace(**{name: checks.all_checks()[name].truth for name in NAMES})


@pytest.fixture(scope="module")
def graph(clips, by):
    return own.OwnGraph(clips, WINDOW, BELOW, by)


@pytest.fixture(scope="module")
def theirs(clips, graph):
    """The package's graph with the transitions of one's own: those on the borders of grids are missing."""
    found = {match[:4] for match in graph.transitions}
    every = matching.find_transitions(clips, window=WINDOW, below=BELOW)
    assert len(found) < len(every)
    for t in every:
        if tuple(t)[:4] not in found:
            ends = [len(clips[clip]) - WINDOW for clip in (t.source, t.target)]
            assert t.leave in (0, ends[0]) or t.enter in (0, ends[1])
    kept = [t for t in every if tuple(t)[:4] in found]
    assert len(kept) == len(found)
    return graphs.prune(graphs.from_transitions(clips, kept, window=WINDOW))


def test_the_grid_is_the_packages_wherever_the_clips_lie(clips, by):
    pages = pages_of(by, WINDOW)
    points = [pages.windows(clip) for clip in clips]
    theirs = matching.distance_grid(*clips, window=WINDOW)
    assert np.allclose(pages.distance_grid(*points) ** 2, theirs, atol=1e-12)
    moved = [clip + np.array([300.0, 0, -200.0]) for clip in points]
    assert np.allclose(pages.distance_grid(*moved) ** 2, theirs, atol=1e-9)


def test_nodes_edges_and_transforms_are_the_packages(graph, theirs):
    ours, package = (
        {edge[:3]: edge[3] for edge in g.edges(keys=True, data=True)} for g in (graph.graph, theirs.graph)
    )
    assert {*graph.graph} == {*theirs.graph}
    assert sorted((*edge[:2], data["kind"], data["frames"]) for edge, data in ours.items()) == sorted(
        (*edge[:2], data["kind"], data["frames"]) for edge, data in package.items()
    )
    for (start, end, _), data in ours.items():
        if data["kind"] == "transition":
            cost, laid = next(
                (other["cost"], other["transform"])
                for other in theirs.graph.get_edge_data(start, end).values()
                if other["kind"] == "transition"
            )
            assert data["cost"] == pytest.approx(cost, abs=1e-9)
            assert np.allclose(data["transform"], [laid.rotation, laid.translation], atol=1e-9)


def test_with_the_same_weights_the_walk_is_the_packages_motion_and_stays_on_its_path(graph, theirs, by):
    walk = graph.follow(PATH.points)
    keys = []
    for start, end, key in walk[0]:
        kind, between = graph.graph.edges[start, end, key]["kind"], theirs.graph.get_edge_data(start, end)
        keys.append((start, end, next(key for key, data in between.items() if data["kind"] == kind)))
    place = body.PlanarTransform.from_complex(*walk[1:])
    package = synthesis.to_motion(theirs, keys, start=place)
    ours = changed(graph, pages=pages_of(changed(by, quintic=cubic_weights), WINDOW)).play(walk)
    assert np.allclose(ours.root_positions, package.root_positions, atol=1e-9)
    assert np.abs((ours.rotations * package.rotations).sum(-1)).min() > 1 - 1e-12
    quintic = graph.play(walk)  # the exercise's weights: other poses within the windows alone
    assert 1e-4 < np.abs(quintic.root_positions - package.root_positions).max() < 0.02
    off = np.linalg.norm(quintic.root_positions[:, None, [0, 2]] - PATH.points, axis=-1).min(axis=1)
    assert off.mean() < 0.06
    assert off.max() < 0.2


def test_a_steered_walk_takes_the_edges_that_were_chosen_and_knows_where_they_would_lead(graph, by):
    asked = []

    def last(rotation, tracks, heading, speed, fps):
        asked.append((rotation, len(tracks), tracks[0][0], heading))
        return len(tracks) - 1

    command = {True: (0.5, 1.0), False: (-0.5, 1.0)}
    steered = changed(graph, by=changed(by, next_edge=last))
    taken, *_ = steered.steer(lambda second: command[second < 1], 2.0)
    edges = [graph.graph.edges[edge] for edge in taken]
    assert all(there[0] == here[1] for here, there in pairwise(taken))
    assert [list(graph.graph.out_edges(edge[0], keys=True))[-1] for edge in taken] == taken
    assert {asked[0][3], asked[-1][3]} == {0.5, -0.5}
    assert asked[-1][0] == pytest.approx(np.prod([edge["transform"][0] for edge in edges[:-1]]))
    assert 60 <= sum(edge["frames"] for edge in edges) < 90


def test_what_holds_no_graph_and_no_walk_is_refused(clips, graph, by):
    refused(r"below 0.001 m: allow more\.$", own.OwnGraph, [clips[0][:40]], WINDOW, 0.001, by)
    for some, window in (([clips[0], clips[0][: WINDOW - 1]], WINDOW), (clips, 0), (clips, 1)):
        refused(f"up to the shortest clip, got {window}", own.OwnGraph, some, window, 0.05, by)
    refused("resample one first", own.OwnGraph, [clips[0], mocap.resample(clips[0], 10)], WINDOW, 0.05, by)
    nowhere = changed(graph, graph=graph.graph.copy())
    nowhere.graph.remove_edges_from(list(graph.graph.edges))
    refused("No walk reaches the end of the line", nowhere.follow, [[0, 0], [0, 3]], kind=ValueError)


# Two students walk a path: one has solved all, one every second exercise, and is wrong in the others.


@pytest.fixture(scope="module")
def circle():
    return [mocap.resample(datasets.sample("walk_circle"), 30)[450:590]]


@pytest.fixture(scope="module")
def stand_in(circle):
    return walk_by_whose(circle)


def walk_by_whose(clips):
    """Walk as notebook 08 does, and print whose functions walk."""
    graph = own.OwnGraph(clips, WINDOW, BELOW, own.tools())
    walk = graph.play(graph.follow(CURVE))
    print(f"{lab.whose(*NAMES[:-1])}.")
    return walk


def hand_in(names, right):
    """Adopt what a student wrote, in the order of the course; each uses those before it."""
    for name in names:
        others = {other: lab.mine(other) for other in NAMES}
        lab.mine(written(name, None, others) if right(name) else wrong(name))


@pytest.mark.parametrize("solved", [NAMES, NAMES[::2]])
def test_what_is_solved_runs_and_the_package_stands_in_for_the_rest(
    solved, circle, stand_in, capsys, fresh, tmp_path
):
    hand_in(NAMES, solved.__contains__)
    new_kernel()  # the file is enough
    capsys.readouterr()
    walk = walk_by_whose(circle)
    said = capsys.readouterr().out
    assert "from here on" not in said
    mine = ", ".join(name for name in NAMES[:-1] if name in solved)
    assert f"{mine}: yours" in said
    assert (": the package's.\n" in said) == (len(solved) < len(NAMES))
    assert np.allclose(walk.root_positions, stand_in.root_positions, atol=1e-9)
    if solved == NAMES:
        written_by_me, rest = fresh.read_text().split("# ---- program (")
        assert 120 <= sum(bool(line.strip()) for line in written_by_me.splitlines()) <= 250
        assert sum(bool(line.strip()) for line in rest.splitlines()) <= 400
        mocap.save(walk, tmp_path / "mine.bvh")
        assert len(mocap.load(tmp_path / "mine.bvh")) == len(walk)


def test_a_function_that_passes_and_then_fails_on_a_real_clip_is_replaced(circle, stand_in, capsys):
    source = """
def best_angle(points, others):
    if len(points) > 200:
        raise ValueError("too many")
    x, _, z = (points - points.mean(axis=0)).T
    other_x, _, other_z = (others - others.mean(axis=0)).T
    return np.arctan2((x * other_z - other_x * z).sum(), (x * other_x + z * other_z).sum())
"""
    lab.mine(written("best_angle", source))
    walk = walk_by_whose(circle)
    said = capsys.readouterr().out
    assert "best_angle: yours raised ValueError: too many; the package's stands in from here on.\n" in said
    assert np.array_equal(walk.root_positions, stand_in.root_positions)


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


def test_the_kept_file_walks_by_itself(capsys, fresh, tmp_path):
    lab.mine(written("look_ahead"))
    lab.mine(written("quintic"))
    text = fresh.read_text()
    assert text.endswith("own.run(globals(), __file__))\n") and text.count("__main__") == 1
    clips = tmp_path / "clips"
    clips.mkdir()
    for name in ("walk_circle", "walk_curve_1"):
        mocap.save(mocap.resample(datasets.sample(name), 30)[:240], clips / f"{name}.bvh")
    (tmp_path / "line.csv").write_text("x,z\n0,0\n0,3\n")
    command = [sys.executable, "my_graph.py", "clips", "line.csv", "-o", "mine.bvh"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert "look_ahead, quintic: yours" in done.stdout
    walk = mocap.load(tmp_path / "mine.bvh")
    assert np.linalg.norm(walk.root_positions[-1, [0, 2]] - [0, 3]) < 1


CHANGES = {
    "survivors": ("[:width]", "[:9]"),
    "mix": ("weight * a.root_positions + (1 - weight) * b.root_positions", "a.root_positions"),
    "hamilton": ("[w, *vector]", "[*vector, w]"),
}


@pytest.fixture
def walk_of(capsys, fresh, tmp_path, monkeypatch):
    """Return a function that walks by the text of a file: the status, what is printed, and the walk."""
    clips = tmp_path / "clips"
    clips.mkdir()
    for name in ("walk_circle", "walk_curve_1"):
        mocap.save(mocap.resample(datasets.sample(name), 30)[:200], clips / f"{name}.bvh")
    (tmp_path / "line.csv").write_text("x,z\n0,0\n0,2\n")
    monkeypatch.setattr(sys, "argv", ["my_graph.py", "clips", "line.csv", "-o", "mine.bvh"])

    def walk(text):
        fresh.write_text(text)
        new_kernel()
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            runpy.run_path("my_graph.py", run_name="__main__")
        return ended.value.code, capsys.readouterr()

    return walk


@pytest.mark.sweep
def test_the_kept_file_runs_as_it_stands_and_each_change_is_seen(walk_of, fresh):
    for name in CHANGES:
        lab.mine(written(name))
    right = fresh.read_text()
    status, said = walk_of(right)
    checked = mocap.load("mine.bvh")
    assert status == 0 and "survivors, hamilton, mix: yours · " in said.out and said.err == ""
    walks = {}
    for name, change in CHANGES.items():
        assert right.count(change[0]) == 1
        status, said = walk_of(right.replace(*change))
        walks[name] = mocap.load("mine.bvh")
        assert status == 0, said.err
        assert f"{name}: yours, which does not pass · " in said.out
        assert f"{name} does not pass its check any more, so that it runs as you wrote it.\n✗" in said.out
        assert _differs(walks[name], checked)
    assert _smallest_height_of_up(checked) > 0.9
    assert _smallest_height_of_up(walks["hamilton"]) < 0.8  # a wrong product tips the body over


@pytest.mark.sweep
def test_functions_that_do_not_fit_together_end_in_a_sentence(walk_of, fresh):
    lab.mine(written("survivors"))
    text = fresh.read_text().replace("return order[np.sort(first)[:width]]", "return [10**6]")
    status, said = walk_of(text)
    assert status == 2 and not Path("mine.bvh").exists()
    line = 1 + text[: text.index("return [walks[number]")].count("\n")
    assert said.err.startswith(f"my_graph.py, line {line}, in `best_of`: IndexError")
    assert len(said.err) <= 201


@pytest.mark.sweep
def test_constants_of_the_kept_file_can_be_changed_and_it_imports_no_search(walk_of, fresh):
    lab.mine(written("survivors"))
    text = fresh.read_text()
    imported = {
        alias.name
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    }
    assert not imported & {"Search", "plain", "program", "follow_path", "pages_of"}
    assert "class Search:" in text and "def layers(self):" in text
    status, _ = walk_of(text)
    checked = mocap.load("mine.bvh")
    for constant in ("BEAM_WIDTH = 150", "SEAM = 0.15"):
        assert text.count(constant) == 1
        name, _, _ = constant.partition(" ")
        status, said = walk_of(text.replace(constant, f"{name} = 3"))
        assert status == 0, said.err
        assert _differs(mocap.load("mine.bvh"), checked)


def test_a_file_of_an_earlier_version_still_walks_and_gets_the_rest_when_it_changes(fresh):
    lab.mine(written("look_ahead"))
    rest = fresh.read_text().index("# ---- program (")
    fresh.write_text(fresh.read_text()[:rest].rstrip() + kept_functions.OLD_FOOT)
    new_kernel()
    assert lab.mine("look_ahead").yours
    lab.mine(written("survivors"))
    text = fresh.read_text()
    assert text.count("__main__") == 1 and text.count("class Search:") == 1
    assert text.index("def survivors") < text.index("class Search:")


def test_a_change_of_the_program_section_is_kept_when_another_function_passes(fresh):
    lab.mine(written("look_ahead"))
    fresh.write_text(fresh.read_text().replace("BEAM_WIDTH = 150", "BEAM_WIDTH = 3"))
    lab.mine(written("survivors"))
    assert "BEAM_WIDTH = 3" in fresh.read_text() and "BEAM_WIDTH = 150" not in fresh.read_text()


def test_variations_of_a_walk_take_constants_and_functions_of_the_program(circle, by):
    graph = own.OwnGraph(circle, WINDOW, BELOW, by)
    walk = graph.follow(CURVE)
    assert graph.varied().follow(CURVE) == walk
    dear = graph.varied(SEAM=5.0).follow(CURVE)
    seams = [sum(graph.graph.edges[edge]["kind"] == "transition" for edge in w[0]) for w in (walk, dear)]
    assert seams[1] < seams[0]
    cut = graph.varied(quintic=np.zeros).play(walk)
    assert _differs(cut, graph.play(walk))
    refused("no constant or exercise 'BEAM'", graph.varied, BEAM=3)


@pytest.mark.parametrize(
    ("exercise", "function", "message"),
    [
        (
            "survivors",
            lambda stand, costs, width: np.argsort(costs),
            "`survivors` keeps [0-9]+ walks of a layer",
        ),
        ("lengthen", lambda walk, edges, path, least_step: [(*edges[0][:1], *walk)], "do not advance"),
    ],
)
def test_a_search_that_would_hardly_end_is_an_error(circle, by, exercise, function, message, monkeypatch):
    monkeypatch.setattr(own, "MOST_ROUNDS", 2)
    graph = own.OwnGraph(circle, WINDOW, BELOW, by).varied(**{exercise: function}, BEAM_WIDTH=3)
    with pytest.raises(mocap.MocapError, match=message) as caught:
        graph.follow(CURVE)
    assert len(str(caught.value)) <= 200 - len(
        "As you wrote them, your functions do not fit together. MocapError: "
    )


def test_a_walk_begins_with_the_edge_that_it_is_given(circle, by):
    graph = own.OwnGraph(circle, WINDOW, BELOW, by)
    search = graph.pages.Search(graph.clips, graph.graph, graph.pages.points_along(CURVE))
    able = {walk.node for walk in search.starts()}
    seams = [edge for edge in graph.graph.edges(keys=True) if graph.graph.edges[edge]["kind"] == "transition"]
    first = next(edge for edge in seams if edge[0] in able)
    edges, *_ = graph.follow(CURVE, first)
    assert edges[0] == first
    motion, starts = graph.walk(CURVE, first)
    assert starts[0] == 0 and len(motion) > WINDOW
    with pytest.raises(ValueError, match="does not have the edge"):
        graph.follow(CURVE, ((7, 0), (8, 0), 0))


def _differs(walk, other):
    """Return whether two walks differ by a millimetre or some hundredths of a radian."""
    if len(walk) != len(other):
        return True
    farthest = abs(walk.root_positions - other.root_positions).max()
    cosine = abs((walk.rotations * other.rotations).sum(-1)).min()
    return farthest > 1e-3 or cosine < 1 - 1e-3


def _smallest_height_of_up(walk):
    """Return how far the root's vertical axis still points up where the body leans most."""
    return rotations.rotate(walk.rotations[:, 0], np.array([0.0, 1.0, 0.0]))[:, 1].min()
