"""What work takes beside the bare work that it cannot do without, or its motion lasts; and what memory.

See the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_ratios.py
Both sides take turns in one run, in CPU seconds; of each the fastest turn counts.
"""

import os
import subprocess
import sys
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest
from asked_lines import heart, sine, spiral
from walking import generate_walk

from mocap import datasets, editing, load, save
from mocap.blending import blend, inertialize, join, mix, register
from mocap.body import SHAPES, GroundPath, Motion, PlanarTransform, circle, resample, s_curve
from mocap.body.kinematics import forward_kinematics
from mocap.body.rotations import to_matrix
from mocap.datasets import sample
from mocap.feet import clean_up, mark_plants
from mocap.files.path_files import load_path
from mocap.graphs import build, from_transitions, prune, prune_graph, threshold_curve
from mocap.matching import distance_grid, point_cloud, time_path
from mocap.matching.transitions import Transitions, find_transitions
from mocap.methods.match_webs import blend_of, build_web, search, weights_for
from mocap.steering import Controller, FootTurner, follow_path, measure_delay
from mocap.synthesis import random_walk, to_motion
from tests.benchmarks.timing import fastest, held, least
from tests.blending.registered import walks
from tests.bundled import walking, walks_of_16
from tests.editing.bodies import adult, child, without
from tests.editing.bodies import walk as person
from tests.editing.test_edits import post
from tests.editing.wishes import hand_at, stone, walk
from tests.methods.match_webs.spaces_of_walks import gait, space
from tests.refusals import quietly
from tests.steering.test_bent_following import straight_walker
from tests.strategies import wave

pytestmark = pytest.mark.benchmark

CORNER = GroundPath([[0, 0], [0, 4], [4, 4]])
ANSWER = 22  # 60 ms for 4 s of motion, whose forward kinematics takes 2.7 ms


def each(rows):
    return pytest.mark.parametrize(("what", "most", "make"), rows, ids=[row[0] for row in rows])


def kinematics(*motions):
    return lambda: [forward_kinematics(motion) for motion in motions]


# How many forward kinematics of the same motion: (what, at most, what gives the work and the motions).


def handle_of_a_path():
    ride = editing.ride_of(walk())
    path = s_curve(3 * ride.path.length)  # as sharp as a person turns
    return lambda: clean_up(editing.on_path(walk(), path, ride)), walk()


def put_on_a_circle():
    clip = sample("walk_straight")
    return partial(editing.on_path, clip, circle(3.0), editing.ride_of(clip)), clip


def bent(name, path):
    clip = sample(name) if name == "walk_straight" else resample(sample(name), 30)
    frames = len(editing.bend(clip, path).motion)
    return partial(editing.bend, clip, path), clip[:frames]


def dragged_key():
    clip = sample("walk_straight")[:480]
    place = {"rhand": post(clip, 238)}
    return lambda: editing.displaced(
        clip,
        editing.offsets(clip, editing.keys_around(clip, [editing.Key(238, editing.posed(clip, 238, place))])),
    ), clip


BODIES = {
    "a child": child,
    "fewer joints": lambda: editing.stance_of(
        without(person(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck")
    ),
}


def worn(name, steps):
    body = BODIES[name]()
    scale = steps * body.leg / adult().leg
    return lambda: editing.retarget(person(), body, adult(), scale=scale), person()


def three():
    return [walks()[speed, 0] for speed in (0.8, 1.1, 1.4)]


HAND = partial(editing.hierarchy, knots=(0.5,))
BESIDE_KINEMATICS = [
    ("edit", 80, lambda: (partial(editing.edit, walk(), stone(walk(), 0.15)), walk())),
    ("a handle of a path", ANSWER, handle_of_a_path),
    ("a hand", ANSWER, lambda: (partial(HAND, walk(), hand_at(walk(), (180, 240, 300))), walk())),
    ("a key", 10, dragged_key),
    ("retime", 15, lambda: (partial(editing.retime, person(), [(0, 0), (2, 1), (4.9, 3.9)]), person())),
    *(
        (f"bend {name}", 50 if path is CORNER else 36, partial(bent, name, path))  # to round takes 10 ms
        for name in ("walk_straight", "walk_circle")
        for path in (circle(3.0), s_curve(20), CORNER)
    ),
    ("on_path", 2, put_on_a_circle),
    *((f"retarget, {body}", 90, partial(worn, body, steps)) for body in BODIES for steps in (1.0, 1.4)),
    ("a copy alone", 20, lambda: (partial(editing.copied, person(), adult(), child()), person())),
    ("register three", 10, lambda: (partial(register, three()), *three())),
    ("mix three", 10, lambda: (partial(mix, register(three()), np.full(3, 1 / 3)), *three())),
]


@each(BESIDE_KINEMATICS)
def test_edits_take_a_few_forward_kinematics(what, most, make):
    work, *motions = make()
    held(what, np.divide(*fastest(work, kinematics(*motions), turns=7)), most)


# What share of the motion's own duration: (what, at most, what gives the work and the seconds).


@cache
def minute():
    motion = generate_walk([[0, 0], [0, 55]], speed=0.85)[: 60 * 120]
    push = 0.01 * np.sin(np.arange(len(motion)) / 40)[:, None]
    return motion, replace(motion, root_positions=motion.root_positions + push)


def joined(way):
    return partial(way, sample("walk_circle"), 3600, sample("walk_circle"), 1000, 40), 60


def played():
    walk = random_walk(walking().source, seconds=600, seed=1)
    return partial(to_motion, walking().source, walk), to_motion(walking().source, walk).duration


def followed(graph, path, **how):
    work = partial(quietly, follow_path, graph(), path(), **how)
    return work, work().seconds


BESIDE_DURATION = [
    ("join", 0.1, lambda: joined(join)),
    ("inertialize", 0.1, lambda: joined(inertialize)),
    ("blend", 0.1, lambda: (partial(blend, *minute(), np.linspace(1, 0, len(minute()[0]))), 60)),
    ("mark_plants", 0.1, lambda: (partial(mark_plants, minute()[1]), 60)),
    ("clean_up", 0.1, lambda: (partial(clean_up, minute()[1]), 60)),
    ("to_motion", 1 / 100, played),
    *((f"follow a {name}", 1 / 50, partial(followed, walking, line)) for name, line in SHAPES.items()),
    *(
        (f"bend to a {line.__name__}", 1 / 60, partial(followed, graph, line, bend=editing.LIMIT))
        for line in (sine, spiral, heart)
        for graph in (walking, straight_walker)
    ),
]


@each(BESIDE_DURATION)
def test_work_takes_a_small_share_of_the_motion(what, most, make):
    work, seconds = make()
    held(what, least(work, 3) / seconds, most)


# How much longer a larger input takes: (what, at most, what gives the work and both inputs).


def at_speeds(folder, count):
    """Play every walk at so many speeds: `count` times the frames, and no two clips the same."""
    speeds = np.linspace(0.9, 1.1, count) if count > 1 else [1.0]
    return [
        replace(resample(replace(take, fps=120 * speed), 30.0), name=f"{take.name} at {speed:.2f}")
        for take in walks_of_16(folder)
        for speed in speeds
    ]


def made(clips):
    return prune(build(clips, window=10, threshold=0.03))


def random_transitions(count):
    random = np.random.default_rng(0)
    leave, enter = random.integers(0, count - 10, (2, count))
    zero = np.zeros(count, int)
    costs = random.uniform(0.01, 0.1, count)
    return Transitions(zero, leave, zero, enter, costs, PlanarTransform(zero, zero, zero))


def curve(count_and_found):
    count, found = count_and_found
    threshold_curve([wave(count)], found, window=10, thresholds=np.linspace(0.02, 0.1, 20))


def edges(count):
    return from_transitions([wave(count)], random_transitions(count), window=10).graph


def raised(name):
    pins, up = editing.plant_pins(sample(name)), np.array([0, 0.03, 0])
    return sample(name), editing.Pins(pins.joints, pins.low + up, pins.high + up)


SPLINES = [editing.Basis(knots=0.125)]
GROWTH = [
    ("the square, in pairs of frames", 16, lambda data: (made, at_speeds(data, 1), at_speeds(data, 4))),
    ("pruning 4 times the edges", 8, lambda data: (prune_graph, edges(10_000), edges(40_000))),
    (
        "a curve of 4 times the edges",
        8,
        lambda data: (curve, *((count, random_transitions(count)) for count in (10_000, 40_000))),
    ),
    (
        "spacetime of 4 times the frames",
        1.5 * len(sample("walk_circle")) / len(sample("walk_straight")),
        lambda data: (
            lambda both: editing.solve(*both, SPLINES),
            raised("walk_straight"),
            raised("walk_circle"),
        ),
    ),
    (
        "retargeting 4 times the frames",
        6,
        lambda data: (lambda clip: editing.retarget(clip, child(), adult()), person(2.5), person(10.0)),
    ),
    (
        "playing 8 times the seconds",
        14,
        lambda data: (
            partial(to_motion, walking().source),
            *(random_walk(walking().source, seconds=seconds, seed=1) for seconds in (100, 800)),
        ),
    ),
    (
        "following 8 times the line",
        12,
        lambda data: (lambda line: quietly(follow_path, walking(), line), s_curve(10), s_curve(80)),
    ),
]


@each(GROWTH)
def test_time_grows_no_faster_than_the_work(real_data, what, most, make):
    work, small, large = make(real_data)
    held(what, np.divide(*fastest(lambda: work(large), lambda: work(small), turns=3)), most)


# How many times the bare work that it cannot do without: (what, at most, what gives the work and that work).


def homework(data):
    return [load(data / "hw3" / f"walk_fwd_{name}.AMC") for name in ("circle", "curve1", "curve2")]


def reading(data, folder, suffix):
    path = data / "hw3/walk_fwd_circle.AMC"
    if suffix == ".bvh":
        save(load(path), path := folder / "a.bvh")
    return partial(load, path), partial(np.array, numbers_of(path).split(), float)


def numbers_of(path):
    """Return the numbers alone of a file's frames, as text."""
    text = path.read_text()
    text = text.partition("Frame Time")[2].partition("\n")[2] or text.partition(":DEGREES")[2]
    return " ".join(word for word in text.split() if not word[0].isalpha())


def writing(data, folder):
    motion, path = homework(data)[0], folder / "a.bvh"
    save(motion, path)
    values = np.array(numbers_of(path).split(), float)
    return partial(save, motion, path), lambda: "%.6f " * len(values) % tuple(values.tolist())


def placing(data, folder):
    """Kinematics of 15 000 frames, beside the products of matrices down the tree."""
    motion = homework(data)[0]
    local = np.tile(motion.rotations, (3, 1, 1))[:15000]
    turns, parents = to_matrix(np.swapaxes(local, 0, 1)), motion.skeleton.parents  # (J, F, 3, 3)

    def chain():
        whole = np.empty_like(turns)
        whole[0] = turns[0]
        for joint in range(1, len(parents)):
            whole[joint] = whole[parents[joint]] @ turns[joint]

    return kinematics(Motion(motion.skeleton, np.zeros((15000, 3)), local, 120.0)), chain


def drawing(data, folder, step):
    for name, count in (("half", 30_000 // len(step)), ("whole", 60_000 // len(step))):
        (folder / f"{name}.svg").write_text(f'<svg><path d="M 0 0 {step * count}"/></svg>')
    return (partial(load_path, folder / f"{name}.svg") for name in ("whole", "half"))


def pairs(data, folder, dtype=np.float64):
    """All pairs of the homework's windows, beside one product of matrices of that size."""
    clips = [resample(clip, 30) for clip in homework(data)]
    cloud = np.concatenate([point_cloud(clip) for clip in clips]).astype(dtype)
    assert cloud.shape == (3798, 31, 3)
    flat = np.tile(cloud.reshape(len(cloud), -1), 2)[:, : 5 * 31]  # (n, 5 P)
    return cloud, clips, lambda: flat @ flat.T


def of_pairs(data, folder, dtype):
    cloud, _, product = pairs(data, folder, dtype)
    return partial(distance_grid, cloud, cloud, window=10), product


def of_windows(data, folder):
    cloud = pairs(data, folder, np.float32)[0]
    return (partial(distance_grid, cloud, cloud, window=window) for window in (40, 10))


def of_minima(data, folder):
    _, clips, product = pairs(data, folder)
    return partial(find_transitions, clips, window=10, below=0.04), product


BESIDE_BARE = [
    *((f"read {s}", 3, partial(reading, suffix=s)) for s in (".amc", ".bvh")),
    ("write .bvh", 3, writing),
    ("forward kinematics", 3, placing),
    *(
        (f"a drawing of twice as many {step}", 3, partial(drawing, step=step))
        for step in ("L 12.3 45.6 L 22.1 17.9 ", "12.3 45.6 22.1 17.9 ", "c 1 2 3 4 5 6 l 7 8 ")
    ),
    *((f"all pairs, {kind.__name__}", 6, partial(of_pairs, dtype=kind)) for kind in (np.float32, np.float64)),
    ("a window of 40 beside 10", 1.5, of_windows),
    ("minima and candidates", 12, of_minima),
]


@each(BESIDE_BARE)
def test_work_takes_a_few_times_the_bare_work(real_data, tmp_path, what, most, make):
    held(what, np.divide(*fastest(*make(real_data, tmp_path), turns=9)), most)


def test_importing_is_light():
    code = "import time, mocap, sys; assert 'matplotlib' not in sys.modules; print(time.process_time())"
    runs = [subprocess.check_output([sys.executable, "-c", code], text=True) for _ in range(5)]
    held("importing", min(map(float, runs)), 0.25)


def test_the_walks_of_cmu_16_take_less_than_a_second(real_data):
    clips = at_speeds(real_data, 1)
    assert sum(map(len, clips)) == 2521
    held("build and prune", least(lambda: made(clips)), 1)


# Searches beside distance grids.


def clouds(frames):
    return [point_cloud(sample(name)[: 4 * frames : 4]) for name in ("walk_circle", "walk_curve_1")]


@pytest.mark.parametrize("frames", [118, 471])
def test_a_time_path_takes_at_most_one_and_a_half_of_its_grid(frames):
    grid = np.sqrt(distance_grid(*clouds(frames), window=5))
    whole = partial(distance_grid, *clouds(frames), window=5)
    held("a time path", np.divide(*fastest(lambda: time_path(grid), whole, turns=9)), 1.5)


def test_a_web_takes_at_most_ten_distance_grids_and_grows_as_its_square(real_data):
    """The grid is all against all of the same frames, above the diagonal alone, as the web's is."""
    clips = [datasets.cmu(trial.name) for trial in datasets.trials(16)]
    points = np.concatenate([point_cloud(resample(clip, 30)) for clip in clips]).astype(np.float32)
    web = build_web(clips)
    grid, whole, half, step = fastest(
        lambda: distance_grid(points, points, window=5),
        lambda: build_web(clips),
        lambda: build_web(clips[::2]),
        lambda: search(web, 14, slice(120, 260), steps=1),
        turns=3,
    )
    held("a web in grids", whole / grid, 10)
    held("a step of the search in webs", step / whole, 1 / 20)
    held(
        "a web of half the frames",
        whole / half,
        1.5 * (sum(map(len, clips)) / sum(map(len, clips[::2]))) ** 2,
    )


@pytest.mark.parametrize("method", ["convex", "neighbours"])
def test_to_answer_a_wish_takes_at_most_a_twentieth_of_the_blend(method):
    made = space(400)
    rows = made.weights[-40:]
    wishes = made.values[-40:] + np.random.default_rng(0).normal(size=(40, 2)) * made.scale / 10
    asked, blends = fastest(
        lambda: [weights_for(made, wish, method=method) for wish in wishes],
        lambda: [gait(blend_of(made.examples, row, fps=30)) for row in rows],
    )
    held(f"weights by {method}", asked / blends, 0.05)


# Steps of a character, milliseconds.


def test_a_step_takes_a_millisecond_and_to_turn_about_the_standing_foot_a_third_more():
    delay = measure_delay(Controller(walking()), turns=20)
    held("a step", delay.step, 1.0)
    held("the worst step", delay.worst, 5.0)
    alone, turned = (
        min(measure_delay(make(), turns=20, seed=seed).step for seed in range(3))
        for make in (lambda: Controller(walking()), lambda: FootTurner(Controller(walking())))
    )
    held("a turned step", turned / alone, 1.3)


SEARCH = """
import sys, time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from mocap import load, resample
from mocap.matching import find_transitions

folder, names, frames, below = Path(sys.argv[1]), sys.argv[2].split(","), int(sys.argv[3]), float(sys.argv[4])
short = [resample(load(folder / name), 30) for name in names]
clips = []
while sum(map(len, clips)) < frames:
    clips.append(short[len(clips) % len(short)])
def peak():
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1000

Path("/proc/self/clear_refs").write_text("5")  # forget the peak of reading the clips
before = peak()
start, busy = time.perf_counter(), time.process_time()
with ThreadPoolExecutor(2) as pool:
    found = find_transitions(clips, window=10, below=below, executor=pool)
seconds, busy = time.perf_counter() - start, time.process_time() - busy
print(len(found), seconds, busy, peak() - before, peak())
"""


def searched(folder, names, frames, below):
    """Search in a process of its own: transitions, seconds, CPU seconds, megabytes more, megabytes at all."""
    command = [sys.executable, "-c", SEARCH, str(folder), ",".join(names), str(frames), str(below)]
    alone = os.environ | {"OMP_NUM_THREADS": "1"}  # the executor's threads share the cores
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=alone)
    return [float(word) for word in done.stdout.split()]


def test_the_homeworks_clips_take_less_than_200_megabytes(real_data):
    names = [f"walk_fwd_{name}.AMC" for name in ("circle", "curve1", "curve2")]
    *_, more, whole = searched(real_data / "hw3", names, 3798, 0.04)
    print(f"\n{whole:.0f} MB, clips, Python and all; {more:.0f} MB of it in the search")
    assert whole < 200


def test_eighty_thousand_frames_in_a_minute_and_500_megabytes(real_data):
    names = sorted(path.name for path in (real_data / "cmu" / "16").glob("*.amc"))
    found, seconds, busy, _, whole = searched(real_data / "cmu" / "16", names, 80_000, 0.02)
    print(f"\n{found:.0f} transitions in {seconds:.0f} s ({busy:.0f} CPU seconds), {whole:.0f} MB")
    assert whole < 500
    assert busy < 120, "two cores have 120 seconds in a minute, whoever else uses them"
