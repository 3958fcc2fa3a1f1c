"""Where ankles must be, and how they come there and leave: steps 1, 2 and 5 of [KSG02].

Step 5 is taken with step 2, as one curve that bends least, instead of by fades: the sum that it makes least
is a matrix of five diagonals. While only the ball stands,
the foot may turn about it, so that the ankle need not follow.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array, Mask, runs
from mocap.body import rotations
from mocap.feet.leg_track import BACK, ROUNDING, LegTrack

# Seconds in which a correction dies away where no other plant is near. With 0.02 the ankles of captured
# runs accelerate by 12 % more (99.9 % of the frames). With 0.08 a correction reaches so far that only 78 %
# of the planted frames of runs can be held, not 93 %.
FADE = 0.06

# Of the leg's length, 1.4 cm of 0.85 m: how far the root shall fall at most so that an upright leg reaches.
# Beyond it the plant comes nearer instead. With half as much, where plants are hard to hold 2 % fewer frames
# are held.
FALL = 0.0167

# At most: pulls of a plant to where its leg reaches, and rises of a heel. With 8 as many frames are held.
PULLS = 4


class FootTarget(NamedTuple):
    """Where an ankle must be, `ankle` (F, 3) in metres, and how its foot turns, `turn` (F, 3) in radians.

    Turns are rotation vectors in the world's frame; `planted` (F,) says when the ankle or the ball stands,
    and `side` (F,) on which side the knee bends then: 1 forwards, -1 backwards, as it was.
    """

    ankle: Array
    turn: Array
    planted: Mask
    side: Array


def foot_target(track: LegTrack, marks: Mask, held: Mapping[int, Array]) -> FootTarget:
    """Place a foot's plants, and carry its ankle from one to the next [KSG02, step 2].

    Parameters
    ----------
    track : the leg in F frames.
    marks : shape (2, F): when its ankle and its ball stand.
    held : where joints shall stand, as for `clean_up`, if not where they are on average.
    """
    ankle, ball, fps = track.ankle, track.ball, track.motion.fps
    flat, down = marks
    length = float(track.leg.lengths(track.motion.skeleton)[2])
    places = _pull_in(place_plants((ankle, ball), (flat, down), length), marks, track)
    for place, own, joint in zip(places, marks, track.leg[2:], strict=True):
        for start, stop in runs(own) if joint in held else ():
            known = np.flatnonzero(np.isfinite(held[joint][start:stop, 0])) + start
            if known.size:  # a plant that is held for a part of its time stands where the nearest frame does
                nearest = np.abs(np.arange(start, stop)[:, None] - known).argmin(axis=1)
                place[start:stop] = held[joint][known[nearest]]
    # Where only the ball stands, the foot's length holds the ankle. It stays as near as that allows to its
    # own way from plant to plant: a foot that turns a little is seen less than a leg that stretches. And the
    # heel rises where the leg is too short.
    behind = ankle + smooth_fill(places[0] - ankle, flat, fps)
    for _ in range(PULLS):
        away = behind - _beyond(track, behind) - places[1]
        behind = places[1] + length * away / np.linalg.norm(away, axis=-1, keepdims=True)
    goal = np.where(flat[:, None], places[0], behind)
    turn = rotations.to_rotvec(rotations.between(ball - ankle, places[1] - goal))
    ankle = ankle + smooth_fill(goal - ankle, flat | down, fps)
    side = np.where(track.own < -BACK, -1.0, 1.0)
    return FootTarget(ankle, smooth_fill(turn, down, fps), flat | down, side)


def place_plants(joints: tuple[Array, Array], marks: tuple[Mask, Mask], length: float) -> Array:
    """Give each plant of an ankle and its ball one place: where the joint is on average [KSG02, step 1].

    A plant that starts while the other joint stands is placed a foot's length from that joint's place, in the
    mean direction, so that the rigid foot fits both.

    Parameters
    ----------
    joints : the ankle's and the ball's positions, (F, 3) each, metres.
    marks : when they stand, (F,) each.
    length : from ankle to ball, metres.

    Returns
    -------
    Shape (2, F, 3): the places while a joint stands, and the joints' own positions elsewhere.

    Examples
    --------
    >>> ankle = np.array([[0.0, 0.1, 0.0], [0.0, 0.1, 0.02], [0.0, 0.1, 0.04]])  # it slides by 2 cm per frame
    >>> ball = ankle + [0.0, -0.1, 0.0]
    >>> flat, down = np.array([True, True, False]), np.array([True, True, True])
    >>> place_plants((ankle, ball), (flat, down), 0.1)[:, :, 2]
    array([[0.01, 0.01, 0.04],
           [0.01, 0.01, 0.01]])

    Notebook: 04b-feet
    """
    places = np.array(joints)
    placed = np.zeros((2, len(places[0])), bool)
    plants = sorted((start, stop, kind) for kind in (0, 1) for start, stop in runs(marks[kind]).tolist())
    for start, stop, kind in plants:
        own, other = joints[kind], joints[1 - kind]
        place = own[start:stop].mean(axis=0)
        if placed[1 - kind, start]:
            together = np.flatnonzero(placed[1 - kind, start:stop]) + start
            away = (own - other)[together].mean(axis=0)
            place = places[1 - kind, start] + length * away / np.linalg.norm(away)
        places[kind, start:stop], placed[kind, start:stop] = place, True
    return places


def _pull_in(places: Array, marks: Mask, track: LegTrack) -> Array:
    """Pull plants towards the hip until the leg reaches them in each frame in which the ankle stands."""
    # A pull for the frame that is furthest out of reach may leave another one: the hip moves.
    for _ in range(PULLS):
        beyond = np.where(marks[0][:, None], _beyond(track, places[0]), 0.0)
        far = np.linalg.norm(beyond, axis=-1)
        for start, stop in runs(marks[0] | marks[1]) if far.any() else ():
            places[:, start:stop] -= beyond[start + far[start:stop].argmax()]
    return places


def _beyond(track: LegTrack, ankle: Array) -> Array:
    """Give the way that ankles (F, 3) are beyond the leg's reach, (F, 3), metres.

    The root may fall, the less the more the leg lies: to lower the root would not help a leg that lies.
    """
    apart = ankle - track.hip
    distance = np.linalg.norm(apart, axis=-1)
    fall = FALL * track.length * np.minimum(apart[:, 1] / distance, 0.0) ** 2
    excess = distance - track.limit - fall
    return np.asarray(apart * (np.where(excess > 0, excess + ROUNDING, 0.0) / distance)[:, None])


def smooth_fill(values: Array, known: Mask, fps: float, fade: float = FADE) -> Array:
    """Fill in the frames that are not known with the curve that bends least and stays near 0 [KSG02, step 5].

    It minimises Σ |c_{f-1} - 2 c_f + c_{f+1}|² + κ⁴ Σ |c_f|² with the known frames held. Value and slope are
    continuous at both ends of a plant, and die away within `fade` = 1 / (κ · fps) where the next plant is
    far.

    Parameters
    ----------
    values : shape (F, C); values in frames that are not known do not matter.
    known : shape (F,).
    fps : frames per second.
    fade : seconds.

    Returns
    -------
    Shape (F, C); 0 in all frames if none is known.

    Examples
    --------
    >>> smooth_fill(np.array([[0.0], [9], [1]]), np.array([True, False, True]), 120.0).round(3)[:, 0]
    array([0. , 0.5, 1. ])
    """
    filled = np.where(known[:, None], values, 0.0)
    bands = bending_bands(np.ones(len(values)), (fade * fps) ** -4.0)
    target = np.where(known[:, None], filled, -band_product(bands, filled))
    for later in range(3):  # a known frame's row becomes that of the identity: it stays
        apart = slice(len(values) - later)
        bands[later, apart] *= ~(known[later:] | known[apart])
    bands[0] += known
    solved = solveh_banded(bands, target, lower=True, check_finite=False)
    return np.where(known[:, None], filled, solved)


def bending_bands(weight: Array, near: float | Array) -> Array:
    """Write Σ w_f |c_{f-1} - 2 c_f + c_{f+1}|² + near Σ |c_f|² as cᵀ B c.

    Parameters
    ----------
    weight : w, shape (F,); where the curve starts and ends no w counts.
    near : how much the curve's own size counts, a number or (F,).

    Returns
    -------
    B's diagonal and the two below, which are those above, too: shape (3, F); what is beyond their ends is 0.

    Examples
    --------
    >>> bending_bands(np.ones(4), 0.5)
    array([[ 1.5,  5.5,  5.5,  1.5],
           [-2. , -4. , -2. ,  0. ],
           [ 1. ,  1. ,  0. ,  0. ]])
    """
    inner = np.concatenate([[0.0], weight[1:-1], [0.0]])[: len(weight)]
    before, after = np.roll(inner, 1), np.roll(inner, -1)
    return np.array([near + before + 4 * inner + after, 0 - 2 * (inner + after), after])


def band_product(bands: Array, curves: Array) -> Array:
    """Multiply matrices, by their bands (..., 3, F), and curves (..., F, C)."""
    product = bands[..., 0, :, None] * curves
    for later in (1, 2):
        below = bands[..., later, :-later, None]
        product[..., later:, :] += below * curves[..., :-later, :]
        product[..., :-later, :] += below * curves[..., later:, :]
    return product
