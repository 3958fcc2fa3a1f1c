"""The positions of ankles, and the paths between footplants: steps 1, 2 and 5 of [KSG02].

Step 5 is taken with step 2: between footplants, a correction is the smoothest curve that continues those of
the plants, instead of a fade. The matrix of the sum that it minimises has five diagonals. While only the ball
stands, the foot may rotate about it. That rotation is found together with the knees.
"""

from collections.abc import Mapping

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import binary_propagation

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.feet.leg_track import BACK, ROUNDING, LegTrack, dot
from mocap.feet.tuned import TUNED

# Metres: a leg that must become shorter by more to stand in its place keeps its knee flexed.
SHORTER = 1e-4

# Metres: no triangle of hip, ankle and ball is flatter, so that it shows on which side of the line from hip
# to ball the ankle is.
FLAT = 1e-6


class FootTarget(NamedTuple):
    """The target of a leg's ankle and the rotation of its foot in each of F frames.

    Parameters
    ----------
    track : the leg.
    ankle : shape (F, 3), metres.
    turn : the additional rotation of the foot, shape (F, 3), rotation vectors in the world's frame, radians.
    places, marks : positions of ankle and ball while they stand, (2, F, 3), metres, and when, (2, F).
    least_bend : the smallest flexion of the knee while the foot stands, (F,), radians.
    """

    track: LegTrack
    ankle: Array
    turn: Array
    places: Array
    marks: Mask
    least_bend: Array

    @property
    def planted(self) -> Mask:
        """Return the frames in which the ankle or the ball stands, (F,)."""
        return np.asarray(self.marks.any(axis=0))

    @property
    def rolls(self) -> Mask:
        """Return the frames in which only the ball stands, (F,): the foot may rotate about it."""
        return np.asarray(self.marks[1] & ~self.marks[0])

    def rolled(self, hip: Array, distance: Array) -> Array:
        """Rotate the foot about its ball until its ankle is at a distance from the hip.

        Hip, ankle and ball form a triangle. Its angle at the hip follows from the law of cosines. The ankle
        stays on its side of the line from hip to ball.

        Parameters
        ----------
        hip : positions in the R frames in which the foot rolls, (..., R, 3), metres.
        distance : from hip to ankle, (..., R), metres; the nearest one for which there is a triangle is used.

        Returns
        -------
        The vectors from hip to ankle, (..., R, 3), metres.
        """
        ball = self.places[1, self.rolls]
        ankle = self.ankle[self.rolls]
        foot = np.linalg.norm(ball - ankle, axis=1)
        to_ball = ball - hip
        reach = np.sqrt(dot(to_ball, to_ball))
        distance = np.clip(distance, np.abs(reach - foot) + FLAT, reach + foot - FLAT)
        parallel = (reach**2 + distance**2 - foot**2) / (2 * reach)
        direction = to_ball / reach[..., None]
        normal = ankle - hip
        normal = normal - dot(normal, direction)[..., None] * direction
        height = np.sqrt((distance**2 - parallel**2) / dot(normal, normal))
        return np.asarray(parallel[..., None] * direction + height[..., None] * normal)

    def led(self, ankle: Array) -> "FootTarget":
        """Interpolate corrections of ankle and foot between footplants [KSG02, step 5].

        Parameters
        ----------
        ankle : positions while the foot stands, (F, 3), metres; those in other frames do not matter.
        """
        track = self.track
        fps = track.motion.fps
        turn = np.zeros_like(ankle)
        if track.leg.has_ball:
            foot = track.ball - track.ankle
            turn = rotations.to_rotvec(rotations.between(foot, self.places[1] - ankle))
        correction = smooth_fill(ankle - track.ankle, self.planted, fps)
        return self._replace(ankle=track.ankle + correction, turn=smooth_fill(turn, self.marks[1], fps))


def foot_target(
    track: LegTrack, marks: Mask, held: Mapping[int, Array], moved: Array | float = 0.0
) -> FootTarget:
    """Place the footplants of a leg, and interpolate the path of its ankle between them [KSG02, step 2].

    Parameters
    ----------
    track : the leg in F frames.
    marks : shape (2, F), when its ankle and its ball stand.
    held : positions of joints, as for `clean_up`, used instead of their means.
    moved : displacements of the plants from there, (F, 3), metres.
    """
    flat, down = marks
    length = float(track.leg.lengths(track.motion.skeleton)[2])
    places = place_plants((track.ankle, track.ball), (flat, down), length) + moved
    places = _held_places(_pull_in(places, marks, track), marks, track, held)
    goal = _ankle_goal(track, marks, places, length)
    return FootTarget(track, goal, 0 * goal, places, marks, _least_bend(track, flat, goal)).led(goal)


def _held_places(places: Array, marks: Mask, track: LegTrack, held: Mapping[int, Array]) -> Array:
    """Replace places by those of `held`, (2, F, 3), metres.

    A plant that is held in a part of its frames is elsewhere at the held position of the nearest frame.
    """
    for place, mark, joint in zip(places, marks, track.leg[2:], strict=True):
        for start, stop in runs(mark) if joint in held else ():
            frames = np.flatnonzero(np.isfinite(held[joint][start:stop, 0])) + start
            if frames.size:
                nearest = np.abs(np.arange(start, stop)[:, None] - frames).argmin(axis=1)
                place[start:stop] = held[joint][frames[nearest]]
    return places


def _ankle_goal(track: LegTrack, marks: Mask, places: Array, length: float) -> Array:
    """Return the position of the ankle while the foot stands, (F, 3), metres.

    While only the ball stands, the ankle is a foot's length from it, at first in the direction of the ankle's
    interpolated path.
    """
    flat = marks[0]
    if not track.leg.has_ball:
        return np.asarray(np.where(flat[:, None], places[0], places[1]))
    path = track.ankle + smooth_fill(places[0] - track.ankle, flat, track.motion.fps)
    foot = path - places[1]
    rolled = places[1] + length * foot / np.linalg.norm(foot, axis=1, keepdims=True)
    return np.asarray(np.where(flat[:, None], places[0], rolled))


def _least_bend(track: LegTrack, flat: Mask, goal: Array) -> Array:
    """Return the smallest flexion of the knee while the foot stands, (F,), radians.

    A leg that must become shorter stays flexed throughout the plant: the knee of a straight leg jolts as soon
    as the hip moves. A knee that is bent backwards stays as straight as it is.
    """
    flexion = np.radians(TUNED.flexion)
    shorter = flat & (np.linalg.norm(goal - track.hip, axis=1) > track.limit + SHORTER)
    backwards = binary_propagation(flat & (track.flexion < -BACK), mask=flat)
    stays_bent = binary_propagation(shorter & ~backwards, mask=flat)
    return np.where(stays_bent, flexion, np.minimum(track.flexion, flexion))


def place_plants(joints: tuple[Array, Array], marks: tuple[Mask, Mask], length: float) -> Array:
    """Compute one position for each footplant of an ankle and its ball: the joint's mean [KSG02, step 1].

    A plant that starts while the other joint stands is a foot's length from that joint's position, in the
    mean direction, so that the rigid foot fits both.

    Parameters
    ----------
    joints : positions of the ankle and the ball, (F, 3) each, metres.
    marks : when they stand, (F,) each.
    length : from ankle to ball, metres.

    Returns
    -------
    The positions while a joint stands, and the joints' own in other frames, shape (2, F, 3), metres.

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
        partner = 1 - kind
        place = joints[kind][start:stop].mean(axis=0)
        first = start if placed[partner, start] else max(start - 1, 0)
        if placed[partner, first]:
            together = np.flatnonzero(placed[partner, first:stop]) + first
            foot = (joints[kind] - joints[partner])[together].mean(axis=0)
            place = places[partner, first] + length * foot / np.linalg.norm(foot)
        places[kind, start:stop] = place
        placed[kind, start:stop] = True
    return places


def places_at_heights(
    joints: tuple[Array, Array], marks: tuple[Mask, Mask], length: float, heights: Array
) -> Array:
    """Compute positions of footplants as `place_plants` does, at given heights of ankle and ball.

    An ankle and a ball that stand together are as far apart as the flat foot is long.

    Parameters
    ----------
    joints, marks, length : as for `place_plants`.
    heights : of ankle and ball while they stand, (2,), metres.

    Examples
    --------
    >>> ankle = np.array([[0.0, 0.3, 0.0], [0.0, 0.3, 0.0]])
    >>> ball = ankle + [0.0, -0.1, 0.1]
    >>> stands = np.array([True, True])
    >>> places_at_heights((ankle, ball), (stands, stands), 0.1, np.array([0.06, 0.0])).round(3)[:, 0]
    array([[0.  , 0.06, 0.  ],
           [0.  , 0.  , 0.08]])
    """
    ankle, ball = heights
    on_ground = (joints[0] * [1, 0, 1], joints[1] * [1, 0, 1])
    flat_length = np.sqrt(length**2 - (ankle - ball) ** 2)
    places = place_plants(on_ground, marks, flat_length)
    places[..., 1] = heights[:, None]
    return places


def _pull_in(places: Array, marks: Mask, track: LegTrack) -> Array:
    """Pull footplants towards the hip until the leg, or leg and foot, reach them in each frame.

    The root may fall, but the less, the more the leg is horizontal: to lower the root would not help a leg
    that lies.
    """
    flat = marks[0]
    foot = np.where(flat, 0.0, track.leg.lengths(track.motion.skeleton)[2])
    # A pull for the frame that is furthest out of reach may leave another one: the hip moves.
    for _ in range(TUNED.pulls):
        offset = np.where(flat[:, None], *places) - track.hip
        distance = np.linalg.norm(offset, axis=1)
        fall = TUNED.fall * track.length * np.minimum(offset[:, 1] / distance, 0.0) ** 2
        excess = distance - track.limit - foot - fall
        pull = offset * (np.where(excess > 0, excess + ROUNDING, 0.0) / distance)[:, None]
        for start, stop in runs(marks[0] | marks[1]):
            places[:, start:stop] -= pull[start + excess[start:stop].argmax()]
    return places


def smooth_fill(values: Array, is_known: Mask, fps: float, fade: float | None = None) -> Array:
    """Interpolate between known frames by the smoothest curve that stays near 0 [KSG02, step 5].

    It minimises Σ |c_{f-1} - 2 c_f + c_{f+1}|² + κ⁴ Σ |c_f|² for the given values of the known frames. Value
    and slope are continuous at both ends of a plant, and decay within `fade` = 1 / (κ · fps), but no less
    than `TUNED.fade_frames`, if the next plant is far.

    Parameters
    ----------
    values : shape (F, C); values of frames that are not known do not matter.
    is_known : shape (F,).
    fps : frames per second.
    fade : seconds, by default `TUNED.swing_fade`.

    Returns
    -------
    Shape (F, C); 0 in all frames if none is known.

    Examples
    --------
    >>> smooth_fill(np.array([[0.0], [9], [1]]), np.array([True, False, True]), 120.0).round(3)[:, 0]
    array([0. , 0.5, 1. ])
    """
    seconds = TUNED.swing_fade if fade is None else fade
    filled = np.where(is_known[:, None], values, 0.0)
    bands = bending_bands(np.ones(len(values)), max(seconds * fps, TUNED.fade_frames) ** -4.0)
    target = np.where(is_known[:, None], filled, -band_product(bands, filled.T).T)
    # The row of a known frame becomes that of the identity.
    for later in range(3):
        first = slice(len(values) - later)
        is_left_out = is_known[later:] | is_known[first]
        bands[later, first] = np.where(is_left_out, 0.0, bands[later, first])
    bands[0] += np.where(is_known, 1.0, 0.0)
    solved = solveh_banded(bands, target, lower=True)
    return np.where(is_known[:, None], filled, solved)


def bending_bands(weight: Array, size: float | Array, span: int = 1) -> Array:
    """Return the bands of the matrix B of a sum cᵀ B c that is small for smooth and small curves.

    The sum is Σ w_f |c_{f-s} - 2 c_f + c_{f+s}|² + size Σ |c_f|².

    Parameters
    ----------
    weight : w, shape (F,); those within `span` of the curve's ends are not used.
    size : weight of the curve's values, a number or (F,).
    span : s, frames.

    Returns
    -------
    The diagonal of B, and those s and 2 s below it, shape (3, F). B is symmetric. Entries beyond the ends of
    a diagonal are 0.

    Examples
    --------
    >>> bending_bands(np.ones(4), 0.5)
    array([[ 1.5,  5.5,  5.5,  1.5],
           [-2. , -4. , -2. ,  0. ],
           [ 1. ,  1. ,  0. ,  0. ]])
    """
    inner = np.array(weight, float)
    inner[:span] = 0.0
    inner[-span:] = 0.0
    earlier = np.roll(inner, span)
    later = np.roll(inner, -span)
    diagonal = size + earlier + 4 * inner + later
    return np.array([diagonal, 0 - 2 * (inner + later), later])


def band_product(bands: Array, curves: Array) -> Array:
    """Multiply symmetric matrices, by their bands (..., 3, F), and curves (..., F)."""
    product = bands[..., 0, :] * curves
    for later in (1, 2):
        below = bands[..., later, :-later]
        product[..., later:] += below * curves[..., :-later]
        product[..., :-later] += below * curves[..., later:]
    return product
