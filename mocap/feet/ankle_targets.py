"""Where ankles must be, and how they come there and leave: steps 1, 2 and 5 of [KSG02].

Step 5 is taken with step 2, as one curve that bends least, instead of by fades: the sum that it makes least
is a matrix of five diagonals. While only the ball stands, the foot may turn about it: how far, is found
together with the knees.
"""

from collections.abc import Mapping

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import binary_propagation

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.feet.leg_track import BACK, BENT, ROUNDING, LegTrack, dot

# Seconds in which a correction dies away where no other plant is near. With 0.02 the ankles of captured
# runs accelerate by 12 % more (99.9 % of the frames). With 0.1 as many frames are held. And frames, at least:
# without them 22 of 552 turns at 30 Hz, each on another's way, accelerate by more than 1.15 times as much as
# they did; with 2.5, as many as before the clean-up: 5.
FADE, LEAST = 0.06, 2.5

# Of the leg's length, 1.4 cm of 0.85 m: how far the root shall fall at most so that an upright leg reaches.
# Beyond it the plant comes nearer instead. With half as much, where plants are hard to hold 2 % fewer frames
# are held.
FALL = 0.0167

# At most: pulls of a plant to where its leg reaches. With 8 as many frames are held.
PULLS = 4

# Metres: a leg that must become shorter by more, to stand in its place, is bent by `BENT`; and no triangle of
# hip, ankle and ball is flatter, so that it shows on which side of the line from hip to ball the ankle is.
SHORTER, FLAT = 1e-4, 1e-6


class FootTarget(NamedTuple):
    """Where a leg's ankle must be in each of F frames, and how its foot turns.

    Parameters
    ----------
    track : whose ankle it is.
    ankle : shape (F, 3), metres.
    turn : shape (F, 3), rotation vectors in the world's frame, radians.
    places, marks : where ankle and ball stand, (2, F, 3), metres, and when, (2, F).
    least_bend : the least angle of the knee while the foot stands, (F,), radians.
    """

    track: LegTrack
    ankle: Array
    turn: Array
    places: Array
    marks: Mask
    least_bend: Array

    @property
    def planted(self) -> Mask:
        """When the ankle or the ball stands, (F,)."""
        return np.asarray(self.marks.any(axis=0))

    @property
    def rolls(self) -> Mask:
        """When only the ball stands, (F,): the foot may turn about it."""
        return np.asarray(self.marks[1] & ~self.marks[0])

    def rolled(self, hip: Array, distance: Array) -> Array:
        """Turn the foot about its ball until its ankle is a distance (..., R) from a hip (..., R, 3), metres.

        Both are of the R frames in which it rolls. Returns the way from hip to ankle, (..., R, 3): a side of
        the triangle whose third corner is the ball, at a distance that makes it one. The ankle stays on its
        side of the line from hip to ball.
        """
        ball, ankle = self.places[1, self.rolls], self.ankle[self.rolls]
        way, foot = ball - hip, np.linalg.norm(ball - ankle, axis=1)
        far = np.sqrt(dot(way, way))
        distance = np.clip(distance, np.abs(far - foot) + FLAT, far + foot - FLAT)
        along = (far**2 + distance**2 - foot**2) / (2 * far)
        ahead, across = way / far[..., None], ankle - hip
        across = across - dot(across, ahead)[..., None] * ahead
        across *= np.sqrt((distance**2 - along**2) / dot(across, across))[..., None]
        return np.asarray(along[..., None] * ahead + across)

    def led(self, ankle: Array) -> "FootTarget":
        """Lead ankle and foot from plant to plant, in each of which the ankle is where given [step 5]."""
        own, fps = self.track.ankle, self.track.motion.fps
        turn = 0 * ankle
        if self.track.leg.has_ball:
            turn = rotations.to_rotvec(rotations.between(self.track.ball - own, self.places[1] - ankle))
        ankle = own + smooth_fill(ankle - own, self.planted, fps)
        return self._replace(ankle=ankle, turn=smooth_fill(turn, self.marks[1], fps))


def foot_target(
    track: LegTrack, marks: Mask, held: Mapping[int, Array], moved: Array | float = 0.0
) -> FootTarget:
    """Place a foot's plants, and lead its ankle from one to the next [KSG02, step 2].

    Parameters
    ----------
    track : the leg in F frames.
    marks : shape (2, F): when its ankle and its ball stand.
    held : where joints shall stand, as for `clean_up`, if not where they are on average.
    moved : how far plants are moved from there, (F, 3), metres.
    """
    ankle, ball, fps = track.ankle, track.ball, track.motion.fps
    flat, down = marks
    length = float(track.leg.lengths(track.motion.skeleton)[2])
    places = _pull_in(place_plants((ankle, ball), (flat, down), length) + moved, marks, track)
    for place, own, joint in zip(places, marks, track.leg[2:], strict=True):
        for start, stop in runs(own) if joint in held else ():
            known = np.flatnonzero(np.isfinite(held[joint][start:stop, 0])) + start
            if known.size:  # a plant that is held for a part of its time stands where the nearest frame does
                nearest = np.abs(np.arange(start, stop)[:, None] - known).argmin(axis=1)
                place[start:stop] = held[joint][known[nearest]]
    # Where only the ball stands, the foot's length holds the ankle. At first it stays as near as that allows
    # to its own way from plant to plant.
    away = ankle + smooth_fill(places[0] - ankle, flat, fps) - places[1]
    behind = places[1]
    if track.leg.has_ball:
        behind = places[1] + length * away / np.linalg.norm(away, axis=1, keepdims=True)
    goal = np.where(flat[:, None], places[0], behind)
    # A leg that must become shorter stays bent while its foot stands: the knee of a straight one jolts as
    # soon as the hip moves. A knee that is bent backwards stays as straight as it is.
    shorter = flat & (np.linalg.norm(goal - track.hip, axis=1) > track.limit + SHORTER)
    backwards = binary_propagation(flat & (track.own < -BACK), mask=flat)
    stays_bent = binary_propagation(shorter & ~backwards, mask=flat)
    least_bend = np.where(stays_bent, BENT, np.minimum(track.own, BENT))
    return FootTarget(track, goal, 0 * goal, places, marks, least_bend).led(goal)


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
        before = start if placed[1 - kind, start] else max(start - 1, 0)
        if placed[1 - kind, before]:
            together = np.flatnonzero(placed[1 - kind, before:stop]) + before
            away = (own - other)[together].mean(axis=0)
            place = places[1 - kind, before] + length * away / np.linalg.norm(away)
        places[kind, start:stop], placed[kind, start:stop] = place, True
    return places


def _pull_in(places: Array, marks: Mask, track: LegTrack) -> Array:
    """Pull plants towards the hip until the leg reaches them in each frame, or leg and foot the ball.

    The root may fall, the less the more the leg lies: to lower the root would not help a leg that lies.
    """
    foot = track.leg.lengths(track.motion.skeleton)[2] * ~marks[0]
    # A pull for the frame that is furthest out of reach may leave another one: the hip moves.
    for _ in range(PULLS):
        apart = np.where(marks[0][:, None], *places) - track.hip
        distance = np.linalg.norm(apart, axis=1)
        fall = FALL * track.length * np.minimum(apart[:, 1] / distance, 0.0) ** 2
        excess = distance - track.limit - foot - fall
        beyond = apart * (np.where(excess > 0, excess + ROUNDING, 0.0) / distance)[:, None]
        for start, stop in runs(marks[0] | marks[1]):
            places[:, start:stop] -= beyond[start + excess[start:stop].argmax()]
    return places


def smooth_fill(values: Array, known: Mask, fps: float, fade: float = FADE) -> Array:
    """Fill in the frames that are not known with the curve that bends least and stays near 0 [KSG02, step 5].

    It minimises Σ |c_{f-1} - 2 c_f + c_{f+1}|² + κ⁴ Σ |c_f|² with the known frames held. Value and slope are
    continuous at both ends of a plant, and die away within `fade` = 1 / (κ · fps), but no less than 2.5
    frames, where the next plant is far.

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
    bands = bending_bands(np.ones(len(values)), max(fade * fps, LEAST) ** -4.0)
    target = np.where(known[:, None], filled, -band_product(bands, filled.T).T)
    for later in range(3):  # a known frame's row becomes that of the identity: it stays
        apart = slice(len(values) - later)
        bands[later, apart] *= ~(known[later:] | known[apart])
    bands[0] += known
    solved = solveh_banded(bands, target, lower=True)
    return np.where(known[:, None], filled, solved)


def bending_bands(weight: Array, near: float | Array, span: int = 1) -> Array:
    """Write Σ w_f |c_{f-s} - 2 c_f + c_{f+s}|² + near Σ |c_f|² as cᵀ B c.

    Parameters
    ----------
    weight : w, shape (F,); within `span` of the curve's ends no w counts.
    near : how much the curve's own size counts, a number or (F,).
    span : s, frames.

    Returns
    -------
    B's diagonal and those s and 2 s below, which are those above, too: shape (3, F); what is beyond their
    ends is 0.

    Examples
    --------
    >>> bending_bands(np.ones(4), 0.5)
    array([[ 1.5,  5.5,  5.5,  1.5],
           [-2. , -4. , -2. ,  0. ],
           [ 1. ,  1. ,  0. ,  0. ]])
    """
    inner = np.array(weight, float)
    inner[:span] = inner[-span:] = 0.0
    before, after = np.roll(inner, span), np.roll(inner, -span)
    return np.array([near + before + 4 * inner + after, 0 - 2 * (inner + after), after])


def band_product(bands: Array, curves: Array) -> Array:
    """Multiply matrices, by their bands (..., 3, F), and curves (..., F)."""
    product = bands[..., 0, :] * curves
    for later in (1, 2):
        below = bands[..., later, :-later]
        product[..., later:] += below * curves[..., :-later]
        product[..., :-later] += below * curves[..., later:]
    return product
