"""Footplants and cleaned feet."""

from dataclasses import replace

import numpy as np

from mocap import blending, body, datasets, feet
from tests.feet.quiet_clips import slowed, unbent
from tests.frozen.quantities import case, contacts, positions

WALK = datasets.sample("walk_straight")
SHAKEN = 0.0005  # metres, the standard deviation of noise on a root
CART = 0.003  # metres a frame
ALL_THE_TIME = np.arange(0, 1, 0.01)


def displacements(motion, base):
    """Return how far joints are from where they were."""
    return positions(body.joint_positions(motion) - body.joint_positions(base), motion.skeleton)


def cleaned(motion, **held):
    return {"displacements": displacements(feet.clean_up(motion, **held), motion)}


def held_in_first_plant(joint, fractions, offset):
    """Hold a joint, at fractions of its first plant, where it was but for some metres."""
    number = WALK.skeleton.index(joint)
    start, stop = feet.runs(WALK.contacts[joint])[1]
    frames = start + ((stop - start) * np.array(fractions)).astype(int)
    targets = np.full((len(WALK), 3), np.nan)
    targets[frames] = body.joint_positions(WALK)[frames, number] + np.array(offset)
    return cleaned(WALK, held={number: targets})


@case("plants under noise")
def plants_under_noise():
    noise = np.random.default_rng(1).normal(0, SHAKEN, WALK.root_positions.shape)
    shaken = feet.mark_plants(replace(WALK, root_positions=WALK.root_positions + noise))
    slow = slowed(datasets.sample("sneak")[:600], 3)
    return {"contacts of a shaken walk": contacts(shaken.contacts), "when slow": contacts(slow.contacts)}


@case("plants on a cart")
def plants_on_a_cart():
    roots = WALK.root_positions + np.arange(len(WALK))[:, None] * [0, 0, CART]
    return {"contacts": contacts(feet.mark_plants(replace(WALK, root_positions=roots)).contacts)}


@case("a seam")
def seam():
    return cleaned(blending.join(WALK, 500, WALK, 242, 40))


@case("straight legs")
def straight_legs():
    return cleaned(unbent(datasets.sample("walk_curve_1")[:300], 1))


@case("straighter legs, slow")
def straighter_legs():
    return cleaned(unbent(slowed(datasets.sample("sneak")[100:250], 2), 4))


@case("straight stop")
def straight_stop():
    return cleaned(unbent(datasets.sample("stop_and_go")[:300], 3))


@case("straight jog")
def straight_jog():
    return cleaned(unbent(datasets.sample("jog")[:200], 8))


@case("ankle held")
def ankle_held():
    return held_in_first_plant("lfoot", [0.2, 0.6], [[0.01, 0, 0], [0, 0, 0.02]])


@case("ball held")
def ball_held():
    return held_in_first_plant("ltoes", ALL_THE_TIME, [0, 0.01, 0.01])
