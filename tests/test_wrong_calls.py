"""The obvious wrong calls of a newcomer: each ends in one sentence with the right call, and that works.

A row of `CALLS` is a call, a part of the sentence that answers it, and the right call. All are texts and see
the names of `play`.
"""

import copy
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mocap
from mocap import (
    blending,
    body,
    datasets,
    editing,
    feet,
    files,
    graphs,
    matching,
    plotting,
    quality,
    steering,
    synthesis,
    widgets,
)
from mocap.methods import in_betweening, match_webs

LONGEST = 200  # characters of a sentence
ROOMS = (blending, body, datasets, editing, feet, files, graphs, matching, plotting, quality, steering)
ROOMS += (synthesis, widgets, in_betweening, match_webs)

CALLS = {
    # What is passed
    "a path for a list of clips": (
        "graphs.build('walk.bvh', window=10, threshold=0.04)",
        "[mocap.load('walk.bvh')]",
        "graphs.build([mocap.load('walk.bvh')], window=10, threshold=0.04)",
    ),
    "a path among clips": (
        "graphs.build([walk, 'walk.bvh'], window=10, threshold=0.04)",
        "write mocap.load('walk.bvh')",
        "mocap.load('walk.bvh')",
    ),
    "one motion for a list": (
        "graphs.build(walk, window=10, threshold=0.04)",
        "write [motion], in brackets",
        "graphs.build([walk], window=10, threshold=0.04)",
    ),
    "one motion for a list of transitions' clips": (
        "matching.find_transitions(walk, window=10, below=0.04)",
        "write [motion], in brackets",
        "matching.find_transitions([walk], window=10, below=0.04)",
    ),
    "one motion to register": ("blending.register(walk)", "[motion]", "blending.register([walk, walk])"),
    "a graph for clips": (
        "graphs.build(graph, window=10, threshold=0.04)",
        "a list of motions, got a MotionGraph",
        "graphs.build(graph.clips, window=10, threshold=0.04)",
    ),
    "a path to resample": (
        "mocap.resample('walk.bvh', 30)",
        "mocap.load('walk.bvh')",
        "mocap.resample(mocap.load('walk.bvh'), 30)",
    ),
    "a list to resample": (
        "mocap.resample([walk], 30)",
        "a list of 1: pass one of them, such as clips[0]",
        "mocap.resample([walk][0], 30)",
    ),
    "a list to mirror": ("editing.mirror([walk])", "pass one of them", "editing.mirror([walk][0])"),
    "a skeleton for a motion": (
        "editing.wear(walk.skeleton, walk)",
        "a Skeleton, which is a body without poses",
        "editing.wear(walk, walk.skeleton)",
    ),
    "a result for its motion": (
        "mocap.save(bent, 'bent.bvh')",
        "got a Bent: pass its motion, result.motion",
        "mocap.save(bent.motion, 'bent.bvh')",
    ),
    "a graph instead of edges": (
        "synthesis.to_motion(graph, graph)",
        "synthesis.random_walk makes one",
        "synthesis.to_motion(graph, synthesis.random_walk(graph, seconds=1))",
    ),
    "edges before the graph": (
        "synthesis.to_motion(edges, graph)",
        "This takes a MotionGraph, got a list",
        "synthesis.to_motion(graph, edges)",
    ),
    "a path to judge": (
        "quality.judge('walk.bvh')",
        "mocap.load('walk.bvh')",
        "quality.judge(mocap.load('walk.bvh'))",
    ),
    "a list to judge": ("quality.judge([walk])", "pass one of them", "quality.judge([walk][0])"),
    "a motion to judge against": (
        "quality.judge(walk, against=walk)",
        "write [motion], in brackets",
        "quality.judge(walk, against=[walk])",
    ),
    "a file for the path of a judgement": (
        "quality.judge(walk, path='path.csv')",
        "files.load_path('path.csv')",
        "quality.judge(walk, path=[[0, 0], [0, 3]])",
    ),
    "a path to mark footplants": (
        "feet.mark_plants('walk.bvh')",
        "mocap.load('walk.bvh')",
        "feet.mark_plants(mocap.load('walk.bvh'))",
    ),
    "a list to clean up": ("feet.clean_up([walk])", "pass one of them", "feet.clean_up([walk][0])"),
    "a path to play": (
        "widgets.play('walk.bvh')",
        "mocap.load('walk.bvh')",
        "widgets.play(mocap.load('walk.bvh'))",
    ),
    "a list to play": (
        "widgets.play([walk, walk])",
        "got a list of 2: write play(*clips)",
        "widgets.play(*[walk, walk])",
    ),
    "a motion to mix": (
        "blending.mix(walk)",
        "got a Motion: blending.register([first, second])",
        "blending.mix(blending.register([walk, walk]), [0.5, 0.5])",
    ),
    "motions to mix": (
        "blending.mix([walk, walk], [0.5, 0.5])",
        "This takes a Registration, got a list of 2",
        "blending.mix(blending.register([walk, walk]), [0.5, 0.5])",
    ),
    "a blend without weights": (
        "blending.mix(blending.register([walk, walk]))",
        "blending.mix(registration, [0.5, 0.5])",
        "blending.mix(blending.register([walk, walk]), [0.5, 0.5])",
    ),
    "motions for a crossfade": (
        "blending.crossfade([walk, walk])",
        "blending.register([first, second])",
        "blending.crossfade(blending.register([walk, walk]))",
    ),
    "a list for its points": (
        "matching.point_cloud([walk])",
        "pass one of them",
        "matching.point_cloud([walk][0])",
    ),
    "the number of a person for a trial": (
        "datasets.cmu(16)",
        "cmu(subject=16) are all trials of a person",
        "datasets.trials(subject=16)",
    ),
    "a list of trials": (
        "datasets.cmu(['16_15', '16_16'])",
        'A trial is named as in cmu("16_15"), got a list of 2',
        "datasets.trials(subject=16)",
    ),
    "points for waypoints": (
        "steering.through_waypoints(graph, [(0, 0), (0, 2)])",
        "write [Waypoint(x, z) for x, z in points]",
        "steering.through_waypoints(graph, [steering.Waypoint(x, z) for x, z in [(0, 0), (0, 2)]])",
    ),
    "one waypoint": (
        "steering.through_waypoints(graph, steering.Waypoint(0, 2))",
        "[Waypoint(0, 0), Waypoint(0, 4)]",
        "steering.through_waypoints(graph, [steering.Waypoint(0, 0), steering.Waypoint(0, 2)])",
    ),
    "a drawing without frames": (
        "plotting.flat_bodies(walk)",
        "such as flat_bodies(motion, [0, 289])",
        "plotting.flat_bodies(walk, [0, 289])",
    ),
    "a list to draw": (
        "plotting.flat_bodies([walk], [0])",
        "pass one of them",
        "plotting.flat_bodies([walk][0], [0])",
    ),
    "one frame to draw": (
        "plotting.flat_bodies(walk, 10)",
        "This takes a list of frames",
        "plotting.flat_bodies(walk, [10])",
    ),
    "a frame that is not there": (
        "plotting.flat_bodies(walk, [0, 5000])",
        "from 0 to 289",
        "plotting.flat_bodies(walk, [0, 289])",
    ),
    "a view that is not there": (
        "plotting.flat_bodies(walk, [0], 'top')",
        "view is 'side' or 'front', got the text 'top'",
        "plotting.flat_bodies(walk, [0], 'front')",
    ),
    "networkx's graph without a rate": (
        "graphs.summary(graph.graph)",
        "pass the MotionGraph itself, or fps=",
        "graphs.summary(graph)",
    ),
    "clips to summarise": (
        "graphs.summary([walk])",
        "graphs.build(clips, window=10, threshold=0.04)",
        "graphs.summary(graph)",
    ),
    "a file's name before the graph": (
        "graphs.save('graph.npz', graph)",
        "graphs.save(graph, 'graph.npz')",
        "graphs.save(graph, 'graph.npz')",
    ),
    "a motion to save as a graph": (
        "graphs.save(walk, 'graph.npz')",
        "This takes a MotionGraph, got a Motion",
        "graphs.save(graph, 'graph.npz')",
    ),
    "a skeleton to retarget to": (
        "editing.retarget(walk, walk.skeleton)",
        "got a Skeleton: editing.wear(motion, skeleton)",
        "editing.wear(walk, walk.skeleton)",
    ),
    "one stance to retarget to": (
        "editing.retarget(walk, editing.stance_of(walk))",
        "body and source, got None",
        "editing.retarget(walk, editing.stance_of(walk), editing.stance_of(walk))",
    ),
    "a number of rounds for a cycle": (
        "editing.loop(walk, 1)",
        "editing.repeated(editing.loop(motion), times)",
        "editing.repeated(editing.loop(walk), 1)",
    ),
    "a path for a cycle": (
        "editing.loop('walk.bvh')",
        "mocap.load('walk.bvh')",
        "editing.loop(mocap.load('walk.bvh'))",
    ),
    "frame numbers for edges": (
        "synthesis.to_motion(graph, [0, 1, 2])",
        "edges ((clip, frame), (clip, frame), key), got 0 in it",
        "synthesis.to_motion(graph, edges)",
    ),
    "clips for a graph": (
        "synthesis.random_walk([walk], seconds=1)",
        "graphs.build(clips, window=10, threshold=0.04)",
        "graphs.build([walk], window=10, threshold=0.04)",
    ),
    "networkx's graph": (
        "graphs.prune(graph.graph)",
        "pass the MotionGraph itself",
        "graphs.prune(graph)",
    ),
    "clips to follow a path": (
        "steering.follow_path([walk], [[0, 0], [0, 2]])",
        "graphs.build(clips, window=10, threshold=0.04)",
        "steering.follow_path(graph, [[0, 0], [0, 2]])",
    ),
    "clips to fill a gap": (
        "in_betweening.fill_gap([walk], walk[:60], walk[90:], 1)",
        "graphs.build(clips, window=10, threshold=0.04)",
        "in_betweening.fill_gap(graph, walk[:60], walk[90:], 1)",
    ),
    "a path before the graph": (
        "steering.follow_path([[0, 0], [0, 2]], graph)",
        "This takes a MotionGraph",
        "steering.follow_path(graph, [[0, 0], [0, 2]])",
    ),
    "a graph for a character": (
        "steering.steer(graph, 30 * [0.0])",
        "steering.Controller(graph)",
        "steering.steer(steering.Controller(graph), 30 * [0.0])",
    ),
    "the name of a file for a path on the ground": (
        "editing.bend(walk, 'path.csv')",
        "files.load_path('path.csv')",
        "editing.bend(walk, files.load_path('path.csv'))",
    ),
    "the name of a file for points": (
        "body.GroundPath('path.csv')",
        "files.load_path('path.csv')",
        "files.load_path('path.csv')",
    ),
    "numbers for points": (
        "body.GroundPath([0, 6])",
        "two points (x, z)",
        "body.GroundPath([[0, 0], [0, 6]])",
    ),
    "points of two lengths": (
        "body.GroundPath([[0, 0], [0, 1, 2]])",
        "such as [[0, 0], [0, 6]]",
        "body.GroundPath([[0, 0], [0, 6]])",
    ),
    "text among points": (
        "body.GroundPath([[0, 0], [0, 'six']])",
        "not all are numbers",
        "body.GroundPath([[0, 0], [0, 6]])",
    ),
    "a motion without a skeleton": (
        "mocap.Motion('walk', walk.root_positions, walk.rotations, 30)",
        "mocap.Motion(skeleton, root_positions, rotations, fps)",
        "mocap.Motion(walk.skeleton, walk.root_positions, walk.rotations, 30)",
    ),
    "a motion for a stance": (
        "editing.proportioned(walk, legs=0.5)",
        "editing.stance_of(motion) finds one",
        "editing.proportioned(editing.stance_of(walk), legs=0.5)",
    ),
    "a graph without its parameters": (
        "graphs.build([walk])",
        "graphs.build(clips, window=10, threshold=0.04)",
        "graphs.build([walk], window=10, threshold=0.04)",
    ),
    "motions to register without brackets": (
        "blending.register(walk, walk)",
        "blending.register([first, second])",
        "blending.register([walk, walk])",
    ),
    "seconds without their name": (
        "synthesis.random_walk(graph, 5)",
        "synthesis.random_walk(graph, seconds=5)",
        "synthesis.random_walk(graph, seconds=5)",
    ),
    "the file of an animation first": (
        "widgets.save_animation('walk.gif', walk)",
        "widgets.save_animation(motion, 'walk.gif')",
        "widgets.save_animation(walk[:3], 'walk.gif')",
    ),
    "a path to show": (
        "widgets.save_animation('walk.bvh', 'walk.gif')",
        "[mocap.load('walk.bvh')]",
        "widgets.save_animation(walk[:3], 'walk.gif')",
    ),
    "the file of a web first": (
        "match_webs.save_web('web.npz', web)",
        "match_webs.save_web(web, 'web.npz')",
        "match_webs.save_web(web, 'web.npz')",
    ),
    # Units and numbers
    "centimetres for metres": (
        "graphs.build([walk], window=10, threshold=4)",
        "0.04 for 4 cm",
        "graphs.build([walk], window=10, threshold=0.04)",
    ),
    "seconds for frames": (
        "graphs.build([walk], window=0.33, threshold=0.04)",
        "0.33 s at 30 Hz are 10 frames",
        "graphs.build([walk], window=10, threshold=0.04)",
    ),
    "text for frames": (
        "graphs.build([walk], window='10', threshold=0.04)",
        "a whole number of frames",
        "graphs.build([walk], window=int('10'), threshold=0.04)",
    ),
    "text for metres": (
        "graphs.build([walk], window=10, threshold='0.04')",
        "a number such as 0.04",
        "graphs.build([walk], window=10, threshold=0.04)",
    ),
    "degrees for radians": (
        "body.place(walk, 90, [0, 0])",
        "np.radians(90)",
        "body.place(walk, np.radians(90), [0, 0])",
    ),
    "degrees for a heading of arcs": (
        "body.arcs((0, 0), 90, [(2, 0)])",
        "np.radians(90)",
        "body.arcs((0, 0), np.radians(90), [(2, 0)])",
    ),
    "degrees for headings": (
        "steering.steer(steering.Controller(graph), 30 * [90])",
        "np.radians(90)",
        "steering.steer(steering.Controller(graph), 30 * [np.radians(90)])",
    ),
    "degrees per second": (
        "editing.bend(walk, [[0, 0], [0, 2]], limit=100)",
        "np.radians(100)",
        "editing.bend(walk, [[0, 0], [0, 2]], limit=np.radians(100))",
    ),
    "one heading": (
        "steering.steer(steering.Controller(graph), 0)",
        "30 * [0]",
        "steering.steer(steering.Controller(graph), 30 * [0])",
    ),
    "text for a rate": ("mocap.resample(walk, '30')", "a number such as 30", "mocap.resample(walk, 30)"),
    "text for the rate of a file": (
        "mocap.load('walk.bvh', fps='30')",
        "fps must be a number such as 30",
        "mocap.load('walk.bvh', fps=30)",
    ),
    "text for seconds": (
        "synthesis.random_walk(graph, seconds='4')",
        "a number such as 4",
        "synthesis.random_walk(graph, seconds=4)",
    ),
    "seconds for frames of a motion": ("walk[0.5:1.0]", "round(0.5 * motion.fps)", "walk[15:30]"),
    "one frame": ("walk[3]", "motion[3:4]", "walk[3:4]"),
    "one frame for a pin": (
        "editing.pin(walk, 'rhand', 10, [0, 1, 0])",
        "write [10]",
        "editing.pin(walk, 'rhand', [10], [0, 1, 0])",
    ),
    "two rates": (
        "graphs.build([walk, fast], window=10, threshold=0.04)",
        "resample one first",
        "graphs.build([walk, mocap.resample(fast, 30)], window=10, threshold=0.04)",
    ),
    "negative weights": (
        "matching.find_transitions([walk], window=10, below=0.04, joint_weights=-np.ones(31))",
        "not negative",
        "matching.find_transitions([walk], window=10, below=0.04, joint_weights=np.ones(31))",
    ),
    "weights beyond one": (
        "blending.mix(blending.register([walk, walk]), [1, 2])",
        "add up to 1",
        "blending.mix(blending.register([walk, walk]), [1 / 3, 2 / 3])",
    ),
    "a graph that is not pruned": (
        "synthesis.random_walk(whole, seconds=4, start=(0, len(walk)))",
        "prune the graph first",
        "synthesis.random_walk(graphs.prune(whole), seconds=4)",
    ),
    "an unknown kind of edges": (
        "graph.count('transitions')",
        "'clip' and 'transition', got the text 'transitions'",
        "graph.count('transition')",
    ),
    "centimetres for a web": (
        "match_webs.build_web([walk], below=5)",
        "0.05 for 5 cm",
        "match_webs.build_web([walk], below=0.05)",
    ),
    "centimetres for a search": (
        "match_webs.search(web, 0, slice(60, 90), below=5)",
        "0.05 for 5 cm",
        "match_webs.search(web, 0, slice(60, 90), below=0.05)",
    ),
    "a pair of frames for a query": (
        "match_webs.search(web, 0, (60, 90))",
        "a slice such as slice(60, 90), got a tuple of 2",
        "match_webs.search(web, 0, slice(60, 90))",
    ),
    # Files
    "a list of files": (
        "mocap.load(['walk.bvh', 'walk.bvh'])",
        "[mocap.load(f) for f in paths]",
        "[mocap.load(f) for f in ['walk.bvh']]",
    ),
    "a motion to load": ("mocap.load(walk)", "such as 'walk.bvh'", "mocap.load('walk.bvh')"),
    "a file that is missing": ("mocap.load('walks.bvh')", "No such file", "mocap.load('walk.bvh')"),
    "a folder": (
        "mocap.load('clips')",
        "[mocap.load(file) for file in Path(folder).glob('*.bvh')]",
        "[mocap.load(file) for file in Path(folder).glob('*.bvh')]",
    ),
    "a format that is not read": (
        "mocap.load('walk.fbx')",
        "in Blender, import it",
        "mocap.load('walk.bvh')",
    ),
    "a format that is not written": (
        "mocap.save(walk, 'w.fbx')",
        ".bvh, .glb, .npz and .csv",
        "mocap.save(walk, 'w.glb')",
    ),
    "arguments in another order": (
        "mocap.save('w.bvh', walk)",
        "mocap.save(motion, 'w.bvh')",
        "mocap.save(walk, 'w.bvh')",
    ),
    "a list to save": ("mocap.save([walk], 'w.bvh')", "call it for each", "mocap.save([walk][0], 'w.bvh')"),
    "a missing folder": ("mocap.save(walk, 'none/w.bvh')", "No such file", "mocap.save(walk, 'clips/w.bvh')"),
    # Names
    "the velocity of a motion": ("walk.velocity", "do you mean motion.velocities?", "walk.velocities"),
    "a misspelt field of a motion": ("walk.rotation", "do you mean .rotations?", "walk.rotations"),
    "the joints' names of a motion": ("walk.joint_names", "motion.skeleton.names", "walk.skeleton.names"),
    "the frames of a motion": ("walk.frames", "len(motion)", "len(walk)"),
    "a motion that saves itself": ("walk.save", "mocap.save(motion, 'walk.bvh')", "mocap.save"),
    "a motion that resamples itself": ("walk.resample", "mocap.resample(motion, 30)", "mocap.resample"),
    "the nodes of a graph": ("graph.nodes", "graph.graph.nodes", "graph.graph.nodes"),
    "the edges of a graph": ("graph.edges", "graph.graph.edges", "graph.graph.edges"),
    "a joint's name": ("walk.skeleton.index('hand')", "there are: root", "walk.skeleton.index('rhand')"),
    "a name of another room": (
        "graphs.align",
        "from mocap.matching import align",
        "matching.align",
    ),
    "a misspelt name": ("mocap.lod", "do you mean mocap.load?", "mocap.load"),
    "a misspelt name of a room": ("editing.bendd", "do you mean mocap.editing.bend?", "editing.bend"),
    "a name of a room in the package": (
        "mocap.build",
        "from mocap.graphs import build",
        "graphs.build",
    ),
}

IMPORTS = {
    "from mocap.graphs import align": "from mocap.matching import align",
    "from mocap.steering import build": "from mocap.graphs import build",
    "from mocap import random_walk": "from mocap.synthesis import random_walk",
    "from mocap import lod": "do you mean mocap.load?",
}


@pytest.fixture(scope="module")
def names(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Return what the calls see, and make the folder in which they are played."""
    folder = tmp_path_factory.mktemp("calls")
    walk = mocap.resample(datasets.sample("walk_straight"), 30)
    whole = graphs.build([walk], window=10, threshold=0.04)
    mocap.save(walk, folder / "walk.bvh")
    (folder / "walk.fbx").write_text("Kaydara")
    (folder / "path.csv").write_text("0, 0\n0, 3\n")
    (folder / "clips").mkdir()
    graph = graphs.prune(whole)
    return {
        "folder": folder,
        "walk": walk,
        "fast": replace(datasets.sample("walk_straight"), name="fast"),
        "whole": whole,
        "graph": graph,
        "edges": synthesis.random_walk(graph, seconds=1, seed=1),
        "web": match_webs.build_web([walk], below=0.05),
        "bent": editing.bend(walk[:60], [[0, 0], [0, 2]]),
        "mocap": mocap,
        "np": np,
        "Path": Path,
        **{room.__name__.split(".")[-1]: room for room in ROOMS},
    }


def play(call: str, names: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> object:
    monkeypatch.chdir(names["folder"])
    return eval(call, dict(names))


@pytest.mark.filterwarnings("ignore::mocap.MocapWarning")
@pytest.mark.parametrize("mistake", CALLS)
def test_a_wrong_call_is_answered_by_the_right_one_in_a_sentence(mistake, names, monkeypatch):
    call, answer, right_call = CALLS[mistake]
    kind = AttributeError if " " not in call and "(" not in call and "[" not in call else mocap.MocapError
    with pytest.raises(kind) as refused:
        play(call, names, monkeypatch)
    sentence = str(refused.value)
    assert answer in sentence
    assert len(sentence) <= LONGEST and "\n" not in sentence
    play(right_call, names, monkeypatch)


@pytest.mark.parametrize("statement", IMPORTS)
def test_an_import_of_a_name_from_another_room_says_where_it_is(statement):
    with pytest.raises(ImportError) as refused:
        exec(statement)
    assert IMPORTS[statement] in str(refused.value)
    assert len(str(refused.value)) <= LONGEST


def test_a_file_of_a_room_is_imported_although_the_room_does_not_list_it():
    scope: dict[str, Any] = {}
    exec("from mocap.graphs import thresholds, pruning as prunes", scope)
    assert scope["thresholds"].__name__ == "mocap.graphs.thresholds"


def test_a_suggestion_leaves_hasattr_copies_and_pickles_as_they_are(names):
    for thing in (names["walk"], names["graph"]):
        assert not hasattr(thing, "velocity") and not hasattr(thing, "_repr_html_")
        assert repr(copy.copy(thing)) == repr(copy.deepcopy(thing)) == repr(thing)
        assert repr(pickle.loads(pickle.dumps(thing))) == repr(thing)


def test_there_are_thirty_mistakes_or_more():
    assert len(CALLS) >= 30
