"""All rooms give what they gave: graphs and walks the same numbers, motions the same to six digits.

What is expected stands in `same_results.toml`: of walks whole numbers, so that the last digits of another
processor do not matter; of motions a sum, in which each number has another weight.
"""

import hashlib
import tomllib
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

import mocap
from mocap import blending, body, datasets, editing, feet, graphs, steering, synthesis
from mocap.body.kinematics import hinge_of
from mocap.editing.line_rounding import round_line
from mocap.editing.turning import places_on
from mocap.editing.warp_plans import load_plan, warp
from mocap.graphs.motion_graph import merge_choice_points
from mocap.matching.transitions import join_clouds
from mocap.methods import groups, match_webs, motion_matching, parametric_graphs
from mocap.methods.match_webs.local_alignment import apart
from mocap.methods.parametric_graphs.made_motions import make_motion, near_end
from mocap.methods.parametric_graphs.strides import changing_strides
from tests.bundled import clips, walking, walks_of_16
from tests.feet.quiet_clips import slowed, unbent
from tests.refusals import quietly

EXPECTED = tomllib.loads(Path(__file__).with_name("same_results.toml").read_text("utf-8"))


def fingerprint(walk: list) -> list:
    """Count a walk's edges, and sum them up as the start of a SHA-256."""
    numbers = np.array([(*start, *end, key) for start, end, key in walk], np.int64)
    return [len(walk), hashlib.sha256(numbers.tobytes()).hexdigest()[:16]]


@pytest.fixture(params=["bundled", "CMU 16"])
def results(request):
    """Give the graphs of some clips, and what is expected of them."""
    if request.param == "bundled":
        motions = [datasets.sample(name) for name in datasets.SAMPLES]
    else:
        motions = walks_of_16(request.getfixturevalue("real_data"))
    whole = graphs.build([mocap.resample(clip, 30) for clip in motions], window=10, threshold=0.04)
    return whole, graphs.prune(whole), EXPECTED[request.param]


def sizes(graph):
    return [graph.graph.number_of_nodes(), graph.graph.number_of_edges()]


def test_results_are_the_same(results):
    whole, pruned, expected = results
    assert whole.count("transition") == expected["transitions"]
    assert sizes(whole) == expected["whole"]
    assert sizes(pruned) == expected["pruned"]
    assert fingerprint(synthesis.random_walk(pruned, seconds=60, seed=1)) == expected["random"]
    for shape in ("S-curve", "square"):
        followed = quietly(steering.follow_path, pruned, body.SHAPES[shape]())
        assert fingerprint(followed.walk) == expected[shape], shape


WALK = datasets.sample("walk_straight")
SEAM = blending.join(WALK, 500, WALK, 233, 40)
LESS = [datasets.sample("sneak")[:1300], datasets.sample("jog")[:700]]
NOISE = np.random.default_rng(1).normal(0, 0.0005, WALK.root_positions.shape)


def moved(motion, base):
    """Give how far joints are from where they were."""
    return body.joint_positions(motion) - body.joint_positions(base)


def cleaned(motion, **held):
    return moved(feet.clean_up(motion, **held), motion)


def laid(clip, *points):
    """Lay a walk on a line, and measure it there."""
    bent = editing.bend(clip, body.GroundPath(points))
    return [body.joint_positions(bent.motion), bent.off, bent.along, bent.turned, bent.rounded]


def stood(joint, shares, by):
    """Hold a joint, at shares of its first plant, where it was but for some metres."""
    number, (start, stop) = WALK.skeleton.index(joint), feet.runs(WALK.contacts[joint])[1]
    places, frames = np.full((len(WALK), 3), np.nan), start + ((stop - start) * np.array(shares)).astype(int)
    places[frames] = body.joint_positions(WALK)[frames, number] + np.array(by)
    return cleaned(WALK, held={number: places})


def reached(frames=240):
    walk = WALK[:frames]
    hand = body.joint_positions(walk)[100, walk.skeleton.index("lwrist")]
    below = editing.pin(walk, "head", range(50, 80), [-np.inf] * 3, [np.inf, 1.45, np.inf])
    held = editing.pin(walk, "lwrist", range(95, 105), np.add(hand, [0.1, 0.4, 0.2]))
    return walk, editing.join_pins(held, below)


def planned():
    with TemporaryDirectory() as folder:
        file = Path(folder, "keys.txt")
        file.write_text("at 100 lhand 0.1 0.2 0\nat 1.5s level\ntime 0 0\ntime 1 1.5\ntime 2 2.4")
        return load_plan(file, WALK[:300])


def played(character, orders):
    """Steer a character, and lay its poses in a row."""
    poses = [character.step(*order) for order in orders for _ in range(25)]
    return [pose.root_position for pose in poses], [pose.rotations for pose in poses]


@cache
def strides(name="walk_curve_2", **how):
    return parametric_graphs.cut_strides(clips(name), **how)


def parts(strides):
    return [part for part in vars(strides).values() if isinstance(part, int | float | np.ndarray)]


@cache
def space():
    return parametric_graphs.make_space(strides(), 0.4, -0.8, 0.8)


def hands(examples, count):
    reach = partial(match_webs.hand_target, at=0.5)
    return match_webs.sample_space(examples, reach, count=count, parameters=("left", "up", "ahead"))


def acted():
    """Reach for a place, then walk as told by turn and speed, and by turn alone."""
    spaces = {"walk": space(), "hand": hands(strides(), 20)}
    spaces["any"] = match_webs.sample_space(
        strides("walk_curve_1"),
        lambda blend: [match_webs.turn(blend), match_webs.mean_speed(blend)],
        count=30,
        parameters=("turn", "speed"),
    )
    graph = parametric_graphs.build_parametric(spaces, good=0.06, sampling=(6, 50))
    character = parametric_graphs.ParametricController(graph, start="any")
    first = played(character, [(0.0, 1.0, "hand")] * 2)  # nobody aims
    character.aim(character.end.apply_points(spaces["hand"].reached.mean(axis=0)))
    orders = [(-5.9, 0.7, label) for label in ("hand", "hand", "any", "any", "walk", "walk")] + ORDERS
    then, blending = played(character, orders), [character.step(1.0, 0.7).blending for _ in range(60)]
    return [*first, *then, blending, *(part for chosen in character.chosen for part in chosen[1:])]


@cache
def group():
    return groups.build_group(3, nodes=1, corridors=(1.5,), simulated=40.0, reach=0.4)


SHORTLY = [editing.Basis(0.125, 0.1, passes=4, lead=0.2), editing.REACH._replace(passes=2)]
MET = np.linspace(20, 14, 7)[:, None] + [0.6j, -0.6j]
WALL = groups.Scene((4 - 3j, 18 + 0j, 14 - 3j), [(9 + 1.5j * k, 0.6) for k in range(-2, 3)], 0.6, 0.3, [MET])
HERE = body.PlanarTransform(0.4, 0.5, -1.0)
BEHIND = groups.Scene((-9 + 0j,), ((-4 + 0.4j, 0.5),), others=(np.array([[9j], [-7 + 0.5j]]),))
ORDERS = [(0.0, 1.0), (1.2, 0.7), (-0.8, 1.3)]
CASES = {
    "plants under noise": lambda: [
        *feet.mark_plants(replace(WALK, root_positions=WALK.root_positions + NOISE)).contacts.values(),
        *slowed(datasets.sample("sneak")[:600], 3).contacts.values(),
    ],
    "a seam": lambda: cleaned(SEAM),
    "straight legs": lambda: cleaned(unbent(datasets.sample("walk_curve_1")[:300], 1)),
    "straighter legs, slow": lambda: cleaned(unbent(slowed(datasets.sample("sneak")[100:250], 2), 4)),
    "straight stop": lambda: cleaned(unbent(datasets.sample("stop_and_go")[:300], 3)),
    "straight jog": lambda: cleaned(unbent(datasets.sample("jog")[:200], 8)),
    "held out of reach": lambda: stood("rfoot", np.arange(0, 1, 0.01), [0, 0, 0.2]),
    "ankle held": lambda: stood("lfoot", [0.2, 0.6], [[0.01, 0, 0], [0, 0, 0.02]]),
    "ball held": lambda: stood("ltoes", np.arange(0, 1, 0.01), [0, 0.01, 0.01]),
    "edited": lambda: moved(editing.edit(*reached()), WALK[:240]),
    "in levels": lambda: moved(editing.hierarchy(*reached(160))[0], WALK[:160]),
    "posed": lambda: moved(editing.posed(WALK, 100, {"lwrist": reached()[1].low[100, 0]}), WALK[100:101]),
    "keys": lambda: [
        part
        for start in (0, 1)
        for part in editing.offsets(WALK[:60], [editing.Key(start, WALK[90:91]), editing.Key(40)])
    ],
    "warped": lambda: moved(warp(WALK[:300], planned()), WALK[:241]),
    "slower": lambda: editing.retime(WALK, [(0, 0), (0.5, 1), (3, 2)]).root_positions,
    "loop": lambda: moved(editing.loop(WALK), editing.loop(WALK, straight=True, clean=True)),
    "ride": lambda: editing.ride_of(WALK[:300]).handles,
    "bent": lambda: laid(WALK, [0, 0], [0, 3], [3, 4]),
    "bent back": lambda: laid(clips("walk_curve_1")[0][:300], [0, 0], [0, 3], [2, 1]),
    "rounded": lambda: [
        part
        for x in (0.1, 1.5, 2.5)
        for part in round_line(
            body.GroundPath([[0, 0], [0, 3], [x, 1.5], [2, 3]]), editing.ride_of(WALK), 120, 1.0
        )[1:]
    ],
    "slowed": lambda: places_on(
        body.GroundPath([[0, 0], [0, 2], [1, 0]]), editing.ride_of(datasets.sample("stop_and_go")), 120, 1.5
    ),
    "mirrored": lambda: editing.mirror(WALK).rotations,
    "worn": lambda: body.joint_positions(
        editing.retarget(
            WALK[:120],
            editing.proportioned(editing.stance_of(WALK), legs=0.6, arms=0.7, trunk=0.8),
            editing.stance_of(WALK[:120]),
        )
    ),
    "plants on a cart": lambda: list(
        feet.mark_plants(
            replace(WALK, root_positions=WALK.root_positions + np.arange(len(WALK))[:, None] * [0, 0, 0.003])
        ).contacts.values()
    ),
    "mean turns": lambda: body.rotations.mean(WALK.rotations[:60].reshape(-1, 4, 4)),
    "no turns": lambda: np.shape(body.rotations.to_matrix(np.zeros((0, 4)))),
    "solved": lambda: [*editing.solve(*reached(160), SHORTLY)[1:]],
    "stance": lambda: editing.stance_of(WALK, mean=True).turns,
    "hinges": lambda: [hinge_of(WALK[:frames], 3) for frames in (4, 5, 40)],
    "limits": lambda: editing.limit_turns(WALK, ["ltibia", "lowerneck"]).high,
    "mixed": lambda: body.joint_positions(
        blending.mix(blending.register([WALK[100:500], WALK[233:640]]), [0.3, 0.7])
    ),
    "flock": lambda: groups.simulate(5, 10, seed=1),
    "flock between walls": lambda: groups.simulate(5, 10, corridor=6.0, seed=2),
    "group": lambda: [getattr(clip, name) for clip in group().clips for name in clip.__dataclass_fields__],
    "planned group": lambda: (
        groups.play_group(group(), (plan := groups.plan_group(group(), WALL, weight=1.3)).clips) + plan[1:]
    ),
    "led group": lambda: [groups.lead_group(group(), to, start=HERE)[0] for to in (WALL, BEHIND)],
    "steered group": lambda: groups.steer_group(group().nodes[0], WALL, limit=30.0)[0],
    "walked group": lambda: [
        (walked := groups.walk_group(walking(), groups.simulate(2, 3, seed=2))).tracks,
        walked.wanted,
    ],
    "clusters": lambda: groups.cluster(groups.simulate(5, 30), nodes=3, reach=0.4)[1:],
    "matched groups": lambda: groups.compare(
        *(groups.Configuration(*half) for half in np.split(np.array(groups.simulate(8, 10)), 2, axis=1))
    ),
    "group that bends": lambda: groups.bend_to(
        run := groups.simulate(3, 4),
        groups.Configuration(run.places[-1] + [1, 2j, -1], run.velocities[-1] * 1j),
    ),
    "strides": lambda: [*parts(strides()), *parts(strides(by="curves"))],
    "steps": lambda: [part for feet in ("lr", "rl") for part in parts(strides("sneak", feet=feet))],
    "sneaking strides": lambda: parts(strides("sneak", label="sneak", margin=0.5)),
    "stride": lambda: body.joint_positions(strides().blend(np.eye(len(strides()))[0])),
    "mixed strides": lambda: strides().mixed(np.eye(len(strides()))[:2] - 0.01, np.array([[0, 106.0]] * 2)),
    "joined clouds": lambda: join_clouds(clips("sneak", "jog"), None, 10, 1, np.float64).sizes < np.inf,
    "changing strides": lambda: [
        getattr(made, part)
        for made in [changing_strides(strides("jog"), strides(), stands=at) for at in ("", "first", "second")]
        for part in ("values", "poses", "seconds", "contacts", "offset")
    ],
    "made stride": lambda: list(vars(make_motion(space(), np.array([0.3]))).values())[1:],
    "windows": lambda: near_end(space(), np.array([[0.3], [-0.2]]), 1.0),
    "parameters": acted,
    "matcher": lambda: played(
        motion_matching.MotionMatcher(motion_matching.tabulate(clips("walk_curve_1", "walk_circle"))), ORDERS
    ),
    "pose table": lambda: [
        getattr(motion_matching.tabulate([clip[:60] for clip in clips("walk_curve_1", "jog")]), part)
        for part in ("values", "mean", "scale", "usable", "ground", "heading", "drift", "spin", "speeds")
    ],
    "controller": lambda: played(steering.Controller(walking()), ORDERS),
    "apart": lambda: apart([np.stack([np.arange(20) + start] * 2, axis=1) for start in (0, 12, 14)], near=1),
    "web": lambda: [
        (web := match_webs.build_web([WALK[:20], *LESS, WALK[:700]], below=0.05)).cells,
        *(np.hstack([match.rows, match.frames]) for match in match_webs.search(web, 3, slice(240, 370))),
    ],
    "space of walks": lambda: [
        part
        for made in [hands(blending.register([WALK[start : start + 400] for start in (0, 90, 233, 370)]), 10)]
        for how in ("convex", "neighbours")
        for part in (
            match_webs.weights_for(made, made.values[5:9] + 0.001, method=how),
            made.values,
            made.scale,
        )
    ],
    "merged": lambda: [
        [
            edge.get("cost", 0)
            for *_, edge in merge_choice_points(
                graphs.build(clips("walk_curve_1", "sneak"), window=10, threshold=0.04),
                within=3,
                threshold=0.04,
            ).graph.edges(data=True)
        ]
    ],
    "past others": lambda: (
        steering.follow_path(
            walking(),
            body.s_curve(),
            steering.Wishes(others=[body.s_curve().points[::9] + 0.5, np.ones((3, 2))]),
        ).track
    ),
    "crowd": lambda: [
        walked.motion().root_positions
        for walked in steering.walk_crowd(
            walking(), [body.GroundPath([[x, 0], [0.6 - x, 3 + 3 * x]]) for x in (0.0, 0.6, -0.7)]
        ).walks
    ],
}


def summed(result):
    """Say how many numbers there are, and sum up their sizes, and the numbers with other weights each."""
    parts = result if isinstance(result, list | tuple) else [result]
    numbers = np.nan_to_num(
        np.hstack([np.ravel(np.array(part, complex)) for part in parts]), posinf=0, neginf=0
    )
    weights = np.exp(1j * np.arange(len(numbers)) ** 2)
    return [len(numbers), float(np.abs(numbers).sum()), float((numbers * weights).real.sum())]


@pytest.mark.parametrize("name", CASES)
def test_motions_are_the_same(name):
    numbers, size, total = EXPECTED["motions"][name]
    found = summed(quietly(CASES[name]))
    assert found[0] == numbers
    assert found[1:] == pytest.approx([size, total], rel=1e-6, abs=1e-7 * size)
