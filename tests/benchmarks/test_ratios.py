"""Time of works as ratios to other work within one run, and memory.

See the ratios: pytest -m benchmark -n 0 tests/benchmarks/test_ratios.py

Each table says at its head what its works are compared with. A row holds the name of a work, the bound of its
ratio, and a function that prepares the work.
"""

import os
import subprocess
import sys
import time
from dataclasses import replace
from functools import cache, partial

import many_clips
import numpy as np
import pytest
from asked_lines import heart, sine, spiral
from walking import generate_walk

from mocap import datasets, editing, load, save
from mocap._shared.tasks import blas
from mocap.blending import blend, inertialize, join, mix, register
from mocap.body import SHAPES, GroundPath, Motion, PlanarTransform, circle, resample, s_curve
from mocap.body.kinematics import forward_kinematics
from mocap.body.rotations import to_matrix
from mocap.datasets import sample
from mocap.feet import clean_up, mark_plants
from mocap.files.load_save import read
from mocap.files.path_files import load_path
from mocap.graphs import build, from_transitions, prune, prune_graph, threshold_curve
from mocap.matching import distance_grid, point_cloud, time_path
from mocap.matching import minima as minima_of_grids
from mocap.matching.transitions import Transitions, find_transitions
from mocap.methods.match_webs import blend_of, build_web, search, weights_for
from mocap.steering import Controller, FootTurner, follow_path, measure_delay
from mocap.synthesis import random_walk, to_motion
from tests.benchmarks.timing import add_poses, fastest, hold, ratio, yardstick
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
from tests.tuning import tune

pytestmark = pytest.mark.benchmark

CORNER = GroundPath([[0, 0], [0, 4], [4, 4]])
PUPPY = "puppy0512_motion_graph"
MEREDITH = "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh"
DRAGGED = 22  # forward kinematics while a handle is dragged: 60 ms for 4 s of motion


def rows(table):
    return pytest.mark.parametrize(("name", "bound", "prepare"), table, ids=[row[0] for row in table])


# Works on a motion, compared with forward kinematics of the same motion.


def kinematics(*motions):
    return lambda: [forward_kinematics(motion) for motion in motions]


def drag_path_handle():
    ride = editing.ride_of(walk())
    path = s_curve(3 * ride.path.length)  # bends as sharply as a person can turn
    return lambda: clean_up(editing.on_path(walk(), path, ride)), walk()


def put_on_circle():
    clip = sample("walk_straight")
    return partial(editing.on_path, clip, circle(3.0), editing.ride_of(clip)), clip


def bend_clip(name, path):
    clip = sample(name) if name == "walk_straight" else resample(sample(name), 30)
    frames = len(editing.bend(clip, path).motion)
    return partial(editing.bend, clip, path), clip[:frames]


def drag_key():
    clip = sample("walk_straight")[:480]
    target = {"rhand": post(clip, 238)}

    def work():
        key = editing.Key(238, editing.posed(clip, 238, target))
        editing.displaced(clip, editing.offsets(clip, editing.keys_around(clip, [key])))

    return work, clip


BODIES = {
    "a child": child,
    "fewer joints": lambda: editing.stance_of(
        without(person(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck")
    ),
}


def retarget_person(name, steps):
    body = BODIES[name]()
    scale = steps * body.leg / adult().leg
    return lambda: editing.retarget(person(), body, adult(), scale=scale), person()


def three_walks():
    return [walks()[speed, 0] for speed in (0.8, 1.1, 1.4)]


def drag_hand():
    wish = hand_at(walk(), (180, 240, 300))
    return partial(editing.hierarchy, walk(), wish, knots=(0.5,)), walk()


BENT_PATHS = {
    "a circle": circle(3.0),
    "an S-curve": s_curve(20),
    "a corner": CORNER,
}
BESIDE_KINEMATICS = [
    ("edit a step over a stone", 80, lambda: (partial(editing.edit, walk(), stone(walk(), 0.15)), walk())),
    ("drag a handle of a path", DRAGGED, drag_path_handle),
    ("drag a hand", DRAGGED, drag_hand),
    ("drag a key", 10, drag_key),
    ("retime", 15, lambda: (partial(editing.retime, person(), [(0, 0), (2, 1), (4.9, 3.9)]), person())),
    *(
        # A corner is rounded first, which takes 10 ms.
        (f"bend {clip} to {name}", 50 if path is CORNER else 36, partial(bend_clip, clip, path))
        for clip in ("walk_straight", "walk_circle")
        for name, path in BENT_PATHS.items()
    ),
    ("on_path, a circle", 1, put_on_circle),
    *(
        (f"retarget to {body}, steps of {steps:g}", 90, partial(retarget_person, body, steps))
        for body in BODIES
        for steps in (1.0, 1.4)
    ),
    ("copy rotations", 20, lambda: (partial(editing.copied, person(), adult(), child()), person())),
    ("register three walks", 10, lambda: (partial(register, three_walks()), *three_walks())),
    (
        "mix three walks",
        10,
        lambda: (partial(mix, register(three_walks()), np.full(3, 1 / 3)), *three_walks()),
    ),
]


@rows(BESIDE_KINEMATICS)
def test_edits_take_a_few_forward_kinematics(name, bound, prepare):
    work, *motions = prepare()
    hold(f"{name}, in forward kinematics", ratio(work, kinematics(*motions), repeats=7), bound)


# Works that make or change a motion, in yardsticks for each second of the motion. A yardstick takes some
# 10 ms, therefore two of them for each second are a fiftieth of its duration.


@cache
def minutes():
    """Return a minute of a walk, and the same with its root pushed from side to side."""
    motion = generate_walk([[0, 0], [0, 55]], speed=0.85)[: 60 * 120]
    push = 0.01 * np.sin(np.arange(len(motion)) / 40)[:, None]
    return motion, replace(motion, root_positions=motion.root_positions + push)


def join_clips(method):
    return partial(method, sample("walk_circle"), 3600, sample("walk_circle"), 1000, 40), 60


def play_walk():
    edges = random_walk(walking().source, seconds=600, seed=1)
    return partial(to_motion, walking().source, edges), to_motion(walking().source, edges).duration


# Yardsticks for each second of motion. Few walks turn the corners of a square, so it is searched for again.
FOLLOWING = dict.fromkeys(SHAPES, 3.0) | {"square": 6.0}


def follow(graph, path, **settings):
    work = partial(quietly, follow_path, graph(), path(), **settings)
    return work, work().seconds


def blend_minutes():
    weights = np.linspace(1, 0, len(minutes()[0]))
    return partial(blend, *minutes(), weights), 60


CAPTURES = {"walks that turn": walking, "straight walks": straight_walker}
BESIDE_DURATION = [
    ("join", 0.15, lambda: join_clips(join)),
    ("inertialize", 0.15, lambda: join_clips(inertialize)),
    ("blend", 0.4, blend_minutes),
    ("mark_plants", 0.4, lambda: (partial(mark_plants, minutes()[1]), 60)),
    ("clean_up", 1, lambda: (partial(clean_up, minutes()[1]), 60)),
    ("to_motion", 0.08, play_walk),
    *(
        (f"follow a {name}", bound, partial(follow, walking, SHAPES[name]))
        for name, bound in FOLLOWING.items()
    ),
    *(
        (f"bend {name} to a {line.__name__}", 1.7, partial(follow, graph, line, bend=editing.LIMIT))
        for line in (sine, spiral, heart)
        for name, graph in CAPTURES.items()
    ),
]


@rows(BESIDE_DURATION)
def test_work_takes_a_small_fraction_of_the_duration_of_its_motion(name, bound, prepare):
    work, seconds = prepare()
    hold(f"{name}, yardsticks per second", ratio(work, yardstick, repeats=3) / seconds, bound)


# Works on a large input, compared with the same work on a small one.


def at_speeds(folder, count):
    """Play every walk at `count` speeds: that many times the frames, and no two clips the same."""
    speeds = np.linspace(0.9, 1.1, count) if count > 1 else [1.0]
    return [
        replace(resample(replace(take, fps=120 * speed), 30.0), name=f"{take.name} at {speed:.2f}")
        for take in walks_of_16(folder)
        for speed in speeds
    ]


def build_and_prune(clips):
    return prune(build(clips, window=10, threshold=0.03))


def random_transitions(count):
    random = np.random.default_rng(0)
    leave, enter = random.integers(0, count - 10, (2, count))
    zero = np.zeros(count, int)
    costs = random.uniform(0.01, 0.1, count)
    return Transitions(zero, leave, zero, enter, costs, PlanarTransform(zero, zero, zero))


def draw_curve(count_and_transitions):
    count, transitions = count_and_transitions
    threshold_curve([wave(count)], transitions, window=10, thresholds=np.linspace(0.02, 0.1, 20))


def edges(count):
    return from_transitions([wave(count)], random_transitions(count), window=10).graph


def raised(name):
    pins = editing.plant_pins(sample(name))
    up = np.array([0, 0.03, 0])  # metres
    return sample(name), editing.Pins(pins.joints, pins.low + up, pins.high + up)


def grow_graph(data):
    return build_and_prune, at_speeds(data, 1), at_speeds(data, 4)


def grow_pruning(data):
    return prune_graph, edges(10_000), edges(40_000)


def grow_curve(data):
    small, large = ((count, random_transitions(count)) for count in (10_000, 40_000))
    return draw_curve, small, large


def grow_spacetime(data):
    splines = [editing.Stage(knots=0.125)]
    return lambda pair: editing.solve(*pair, splines), raised("walk_straight"), raised("walk_circle")


def grow_retargeting(data):
    return lambda clip: editing.retarget(clip, child(), adult()), person(2.5), person(10.0)


def grow_playing(data):
    short, long = (random_walk(walking().source, seconds=seconds, seed=1) for seconds in (100, 800))
    return partial(to_motion, walking().source), short, long


def grow_following(data):
    return lambda line: quietly(follow_path, walking(), line), s_curve(10), s_curve(80)


SPACETIME_FRAMES = len(sample("walk_circle")) / len(sample("walk_straight"))  # 3.9
GROWTH = [
    ("a graph of 4 times the frames", 16, grow_graph),  # their pairs grow 16 times
    ("pruning 4 times the edges", 8, grow_pruning),
    ("a curve of 4 times the edges", 8, grow_curve),
    ("spacetime constraints of 4 times the frames", 1.5 * SPACETIME_FRAMES, grow_spacetime),
    ("retargeting 4 times the frames", 6, grow_retargeting),
    ("playing 8 times the seconds", 14, grow_playing),
    ("following 8 times the line", 12, grow_following),
]


@rows(GROWTH)
def test_time_grows_no_faster_than_the_work(real_data, name, bound, prepare):
    work, small, large = prepare(real_data)
    hold(name, ratio(lambda: work(large), lambda: work(small), repeats=3), bound)


# Works compared with the bare work without which they cannot be done.


def homework(data):
    return [load(data / "hw3" / f"walk_fwd_{name}.AMC") for name in ("circle", "curve1", "curve2")]


def read_file(data, folder, suffix):
    """Read a file, compared with parsing its numbers."""
    path = data / "hw3/walk_fwd_circle.AMC"
    if suffix == ".bvh":
        motion = load(path)
        path = folder / "a.bvh"
        save(motion, path)
    return partial(load, path), partial(np.array, numbers_of(path).split(), float)


def read_bvh(data, folder, name):
    """Read a file of given unit and axis, compared with NumPy's `loadtxt`, the base of other readers."""
    path = data / "bvh" / name
    rows = path.read_text().partition("Frame Time")[2].splitlines()[1:]
    return partial(load, path, scale=0.01, up="y", root_offset="ignore"), partial(np.loadtxt, rows)


def find_space(data, folder):
    """Find the unit, the vertical axis and the limbs of a clip, compared with reading it without these."""
    path = data / f"bvh/{PUPPY}/walk_normal_left_45.bvh"
    motion = load(path, scale=0.01, up="y")
    names = [f"joint {number}" for number in range(len(motion.skeleton))]
    renamed = folder / "renamed.bvh"
    save(replace(motion, skeleton=replace(motion.skeleton, names=names, roles={})), renamed)
    return partial(quietly, load, renamed), partial(read, renamed, None, None, 0.01, 0.02, "y")


def numbers_of(path):
    """Return the numbers alone of a file's frames, as text."""
    text = path.read_text()
    text = text.partition("Frame Time")[2].partition("\n")[2] or text.partition(":DEGREES")[2]
    return " ".join(word for word in text.split() if not word[0].isalpha())


def write_bvh(data, folder):
    """Write a file, compared with formatting its numbers."""
    motion = homework(data)[0]
    path = folder / "a.bvh"
    save(motion, path)
    values = np.array(numbers_of(path).split(), float)
    return partial(save, motion, path), lambda: "%.6f " * len(values) % tuple(values.tolist())


def place_joints(data, folder):
    """Forward kinematics of 15 000 frames, compared with the products of matrices down the tree."""
    motion = homework(data)[0]
    local = np.tile(motion.rotations, (3, 1, 1))[:15000]
    matrices = to_matrix(np.swapaxes(local, 0, 1))  # (J, F, 3, 3)
    parents = motion.skeleton.parents

    def chain():
        world = np.empty_like(matrices)
        world[0] = matrices[0]
        for joint in range(1, len(parents)):
            world[joint] = world[parents[joint]] @ matrices[joint]

    return kinematics(Motion(motion.skeleton, np.zeros((15000, 3)), local, 120.0)), chain


def read_drawing(data, folder, step):
    """Read a drawing, compared with one half as long."""
    for name, count in (("half", 30_000 // len(step)), ("whole", 60_000 // len(step))):
        (folder / f"{name}.svg").write_text(f'<svg><path d="M 0 0 {step * count}"/></svg>')
    return (partial(load_path, folder / f"{name}.svg") for name in ("whole", "half"))


def point_clouds(data, dtype=np.float64):
    """Return the point clouds of the homework's frames at 30 Hz, shape (3798, 31, 3), and the clips."""
    clips = [resample(clip, 30) for clip in homework(data)]
    clouds = np.concatenate([point_cloud(clip) for clip in clips]).astype(dtype)
    assert clouds.shape == (3798, 31, 3)
    return clouds, clips


def product_of_pairs(clouds):
    """Return a work: the product of matrices that is in the distances of all pairs of clouds."""
    flat = np.tile(clouds.reshape(len(clouds), -1), 2)[:, : 5 * 31]  # (n, 5 P)
    return lambda: flat @ flat.T


def all_pairs(data, folder, dtype):
    clouds, _ = point_clouds(data, dtype)
    return partial(distance_grid, clouds, clouds, window=10), product_of_pairs(clouds)


def long_windows(data, folder):
    clouds, _ = point_clouds(data, np.float32)
    return (partial(distance_grid, clouds, clouds, window=window) for window in (40, 10))


def minima(data, folder):
    clouds, clips = point_clouds(data)
    return partial(find_transitions, clips, window=10, below=0.04), product_of_pairs(clouds)


STEPS = {
    "lines with commands": "L 12.3 45.6 L 22.1 17.9 ",
    "lines": "12.3 45.6 22.1 17.9 ",
    "curves": "c 1 2 3 4 5 6 l 7 8 ",
}
BESIDE_BARE = [
    ("read .amc, in parsing its numbers", 3, partial(read_file, suffix=".amc")),
    ("read .bvh, in parsing its numbers", 2, partial(read_file, suffix=".bvh")),
    ("read .bvh of decimals, in loadtxt", 1.3, partial(read_bvh, name=MEREDITH)),
    (
        "read .bvh with exponents, in loadtxt",
        1.5,
        partial(read_bvh, name=f"{PUPPY}/walk_normal_left_180.bvh"),
    ),
    ("unit, axis and limbs of a .bvh, in reading it without", 2, find_space),
    ("write .bvh, in formatting its numbers", 3, write_bvh),
    ("forward kinematics, in products of matrices", 3, place_joints),
    *(
        (f"a drawing of twice as many {name}", 3, partial(read_drawing, step=step))
        for name, step in STEPS.items()
    ),
    ("all pairs in 32 bits, in a product of matrices", 6, partial(all_pairs, dtype=np.float32)),
    ("all pairs in 64 bits, in a product of matrices", 6, partial(all_pairs, dtype=np.float64)),
    ("all pairs of windows of 40, in windows of 10", 1.5, long_windows),
    ("transitions, in a product of matrices", 12, minima),
]


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_grid_takes_at_most_four_products_in_wall_time(real_data, jobs, dtype):
    """On one thread and on two, for the product as for the grid; the fastest of nine runs of each."""
    clouds, _ = point_clouds(real_data, dtype)
    grid = partial(distance_grid, clouds, clouds, window=10, jobs=jobs)
    works = {"grid": grid, "product": product_of_pairs(clouds)}
    seconds = {name: [] for name in works}
    with blas().limit(limits=jobs):
        for name in 9 * list(works):
            start = time.perf_counter()
            works[name]()
            seconds[name].append(time.perf_counter() - start)
    name = f"all pairs in {np.dtype(dtype).itemsize * 8} bits on {jobs} threads, in a product of matrices"
    hold(name, min(seconds["grid"]) / min(seconds["product"]), 4)


def test_the_bound_takes_a_sixth_of_all_pairs_of_many_kinds_of_motion(real_data, monkeypatch):
    """Of 20 000 frames, in 64 bits; of 80 000 it takes a seventeenth."""
    clips = many_clips.clips_of(real_data / "cmu", 20_000)
    search = partial(find_transitions, clips, window=10, below=0.04, jobs=1)
    by_bound = fastest(search, repeats=2)[0]
    tune(monkeypatch, minima_of_grids, few_windows=10**9)
    by_products = fastest(search, repeats=1)[0]
    hold("transitions by the bound, in those of all pairs", by_bound / by_products, 1 / 6)


@rows(BESIDE_BARE)
def test_work_takes_a_few_times_the_bare_work(real_data, tmp_path, name, bound, prepare):
    hold(name, ratio(*prepare(real_data, tmp_path), repeats=9), bound)


def test_importing_takes_a_fifth_of_the_time_of_importing_numpy():
    code = "import time, {}, sys; assert 'matplotlib' not in sys.modules; print(time.process_time())"
    seconds = {"mocap": [], "numpy": []}
    for module in 5 * list(seconds):
        command = [sys.executable, "-c", code.format(module)]
        seconds[module].append(float(subprocess.check_output(command, text=True)))
    hold("import mocap, in importing NumPy", min(seconds["mocap"]) / min(seconds["numpy"]), 0.2)


def test_a_graph_of_the_walks_of_cmu_16_takes_a_few_distance_grids(real_data):
    clips = at_speeds(real_data, 1)
    assert sum(map(len, clips)) == 2521
    points = np.concatenate([point_cloud(clip) for clip in clips])
    grid = partial(distance_grid, points, points, window=10)
    hold("build and prune, in distance grids", ratio(lambda: build_and_prune(clips), grid, repeats=3), 3)


# Searches compared with distance grids and blends.


def clouds_of_walks(frames):
    return [point_cloud(sample(name)[: 4 * frames : 4]) for name in ("walk_circle", "walk_curve_1")]


@pytest.mark.parametrize("frames", [118, 471])
def test_a_time_path_takes_at_most_one_and_a_half_of_its_grid(frames):
    clouds = clouds_of_walks(frames)
    grid = np.sqrt(distance_grid(*clouds, window=5))
    whole = partial(distance_grid, *clouds, window=5)
    hold(f"a time path of {frames} frames, in its grid", ratio(lambda: time_path(grid), whole, 9), 1.5)


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
        repeats=3,
    )
    frames = sum(map(len, clips)) / sum(map(len, clips[::2]))
    hold("a match web, in distance grids", whole / grid, 10)
    hold("a step of its search, in match webs", step / whole, 1 / 20)
    hold("a match web of twice the frames", whole / half, 1.5 * frames**2)


@pytest.mark.parametrize("method", ["convex", "neighbours"])
def test_weights_for_a_request_take_at_most_a_twentieth_of_the_blend(method):
    parameters = space(400)
    weights = parameters.weights[-40:]
    noise = np.random.default_rng(0).normal(size=(40, 2))
    requests = parameters.values[-40:] + noise * parameters.scale / 10

    def find_weights():
        for request in requests:
            weights_for(parameters, request, method=method)

    def make_blends():
        for row in weights:
            gait(blend_of(parameters.examples, row, fps=30))

    hold(f"weights by {method}, in blends", ratio(find_weights, make_blends), 0.05)


# Steps of a character.


def test_a_step_takes_a_few_additions_and_to_turn_about_the_standing_foot_a_third_of_it():
    """250 additions of poses take 0.1 ms where 2500 take a millisecond, of the 33 that a frame lasts."""
    additions = 1000 * fastest(add_poses)[0]  # ms
    delay = measure_delay(Controller(walking()), turns=20)
    hold("a step of a path, in 250 additions", delay.step / additions, 8)
    hold("the worst step of a path, in median steps", delay.worst / delay.step, 7)
    plain, turned = (
        min(measure_delay(make(), turns=20, seed=seed).step for seed in range(3))
        for make in (lambda: Controller(walking()), lambda: FootTurner(Controller(walking())))
    )
    hold("a turned step, in steps", turned / plain, 1.3)


# Searches for transitions in a process of their own, for their memory.

SEARCH = """
import sys, time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
import numpy as np
from mocap import load, resample
from mocap.matching import find_transitions, point_cloud

folder, names, frames, below = Path(sys.argv[1]), sys.argv[2].split(","), int(sys.argv[3]), float(sys.argv[4])
short = [resample(load(folder / name), 30) for name in names]
clips = []
while sum(map(len, clips)) < frames:
    clips.append(short[len(clips) % len(short)])

def peak():
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1000

def product_of_pairs():
    cloud = np.concatenate([point_cloud(clip) for clip in short])[:2000].astype(np.float32)
    flat = np.tile(cloud.reshape(len(cloud), -1), 2)[:, : 5 * cloud.shape[1]]
    start = time.process_time()
    flat @ flat.T
    return (time.process_time() - start) / 2 * (sum(map(len, clips)) / len(flat)) ** 2

Path("/proc/self/clear_refs").write_text("5")  # forget the peak of reading the clips
start = time.process_time()
with ThreadPoolExecutor(2) as pool:
    find_transitions(clips, window=10, below=below, executor=pool)
seconds = time.process_time() - start
megabytes = peak()
print(seconds, min(product_of_pairs() for _ in range(5)), megabytes)
"""


def search_transitions(folder, names, frames, below):
    """Search in a new process. Return its CPU seconds, those of a product of matrices, and megabytes."""
    command = [sys.executable, "-c", SEARCH, str(folder), ",".join(names), str(frames), str(below)]
    environment = os.environ | {"OMP_NUM_THREADS": "1"}  # the executor's threads share the cores
    result = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    return [float(word) for word in result.stdout.split()]


def test_the_homeworks_clips_take_less_than_200_megabytes(real_data):
    names = [f"walk_fwd_{name}.AMC" for name in ("circle", "curve1", "curve2")]
    *_, megabytes = search_transitions(real_data / "hw3", names, 3798, 0.04)
    hold("megabytes for transitions of 3 800 frames", megabytes, 200)


def test_eighty_thousand_frames_take_a_few_products_and_500_megabytes(real_data):
    """The product is that of half of all pairs, as of 2 000 frames: the search sees each pair once."""
    names = sorted(path.name for path in (real_data / "cmu" / "16").glob("*.amc"))
    seconds, product, megabytes = search_transitions(real_data / "cmu" / "16", names, 80_000, 0.02)
    hold("transitions of 80 000 frames, in a product of matrices", seconds / product, 12)
    hold("megabytes for transitions of 80 000 frames", megabytes, 500)
