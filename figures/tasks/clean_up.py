"""Make feet stand: walks through a graph, whose seams slide, and captured clips, quiet ones too.

Held: the planted frames in which a joint is within 1 mm of where it stands in its plant, percent. Slide: how
far planted joints stray over the ground at most, on average over the plants. Knees: by how much a knee jumps
further from frame to frame than before at most. Shake: accelerations beside those before.

Feet that are held must change something, so knees and shake are least of the motion as it is.
"""

from collections.abc import Iterator

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap.body import Motion, find_legs, joint_positions
from mocap.editing import body_of, plant_pins, solve
from mocap.editing.stages import REACH
from mocap.errors import MocapError
from mocap.feet import clean_up
from mocap.synthesis import random_walk, to_motion
from tasks import BANDAI, WALKS, Case, graph
from tasks._measures import shaking

CLIPS = {
    "bundled clips, random walks": WALKS,
    "CMU 16, walks and runs": tuple(f"16/16_{n}" for n in (15, 16, 17, 20, 24, 26, 31, 33, 36, 44)),
    "CMU 49 and 02, quiet": ("49/49_15", "49/49_18", "49/49_19", "49/49_20", "02/02_06", "02/02_10"),
    "Bandai-Namco": BANDAI,
    "CMU 16, at 120 Hz": tuple(f"16/16_{n}" for n in (15, 17, 24, 36)),
}
RATES = {"CMU 16, at 120 Hz": 120.0}  # frames per second
SEEDS = range(10)  # of walks
SECONDS = 8.0  # of a walk
LONGEST = 13.3  # seconds of a clip
STANDS = 0.001  # metres from its position in a plant: so near, a joint is held
MEASURES = {"held, %": False, "slide, mm": True, "knees, mm": True, "shake": True}
BASELINES = ("as it is", "inverse kinematics")


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield walks or clips, with the marks of their plants: a column for each foot joint of `contacts`."""
    motions = {clip.name: clip[: round(LONGEST * clip.fps)] for clip in clips}
    if "random" in collection:
        source = graph(tuple(clips)).source
        motions = {
            f"seed-{n}": to_motion(source, random_walk(source, seconds=SECONDS, seed=n)) for n in SEEDS
        }
    for name, motion in motions.items():
        plants = np.stack(list(motion.contacts.values()), axis=1)
        yield Case(collection, name, {"motion": motion, "plants": plants})


def frame_by_frame(case: Case) -> Motion:
    """Bring planted joints to the mean places of their plants, in each frame by itself."""
    motion = case.given["motion"]
    pins = plant_pins(motion, find_legs(motion.skeleton))
    return solve(motion, pins, [REACH], body_of(motion, pins)).motion


METHODS = {
    "as it is": lambda case: case.given["motion"],
    "inverse kinematics": frame_by_frame,
    "clean up": lambda case: clean_up(case.given["motion"]),
}


DECIDED = {
    "knees, mm": "the motion as it is has none of its own jumps",
    "shake": "the motion as it is shakes as itself",
}


def score(case: Case, answer: Motion) -> tuple[float, float, float, float]:
    """Measure feet in the plants that were given."""
    motion = case.given["motion"]
    if len(answer) != len(motion) or answer.skeleton.names != motion.skeleton.names:
        raise MocapError(f"{case.name} asks for {len(motion)} frames of the same body.")
    positions = joint_positions(answer)
    slides = []
    held = 0
    count = 0
    for name, mark in motion.contacts.items():
        for start, stop in runs(mark):
            planted = positions[start:stop, answer.skeleton.index(name)][:, [0, 2]]
            slides.append(np.linalg.norm(planted - planted.mean(axis=0), axis=-1).max())
            held += (np.linalg.norm(planted - np.median(planted, axis=0), axis=-1) < STANDS).sum()
            count += stop - start
    pops = 1000 * float((knee_jumps(answer) - knee_jumps(motion)).max())
    return 100 * held / count, 1000 * float(np.mean(slides)), max(pops, 0.0), shaking(answer, motion)


def knee_jumps(motion: Motion) -> Array:
    """Measure how far the knees jump from frame to frame, (F - 2, 2), metres."""
    knees = [leg.knee for leg in find_legs(motion.skeleton)]
    return np.asarray(np.linalg.norm(np.diff(joint_positions(motion)[:, knees], 2, axis=0), axis=-1))
