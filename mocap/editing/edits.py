"""Say where joints shall be, and get a motion that does it: to the last digit, in one pose, or by levels."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from mocap._shared.arrays import Array, Indices, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, body_of, require_reachable, warn_of_gaps
from mocap.editing.displacements import displaced, spline_basis
from mocap.editing.pins import Pins, join_pins, pin, pin_errors, plant_pins
from mocap.editing.solver import EVERY_FRAME, REACH, Stage, closing_stages, solve, with_frames_of
from mocap.editing.toes import SLACK, bend_toes, lowest_allowed
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError
from mocap.feet.footskate import clean_up

UP = np.array([0.0, 1.0, 0.0])

CLOSED = 1e-4  # metres: of pins that are missed by more a warning tells, and plants among them are let go


def edit_stages() -> tuple[Stage, ...]:
    """Return the stages of an edit: splines make the change, then each frame closes what they leave."""
    splines = Stage(knots=TUNED.knots, decay=TUNED.decay, weight=TUNED.weight, lead=TUNED.lead)
    return splines, *closing_stages()


def edit(motion: Motion, pins: Pins, *, body: Body | None = None, frames: slice | None = None) -> Motion:
    """Change a motion so that its joints are where pins ask, and its planted feet still stand.

    No joint is farther under the floor than it was, unless the pins ask for it.

    Parameters
    ----------
    motion : F frames; its `contacts` say when feet stand.
    pins : what is asked. Plants stand where they stood, unless the pins hold them elsewhere.
    body : which joints turn, at what price; by default those above pinned ones, with root and trunk at 16 and
        the neck at 32 times the prices of `body_of`: a hand that reaches tips the trunk by some 10°, about as
        people do. A trunk that must not tip is pinned by `keep_turned`.
    frames : those that may change, in a row, such as `slice(100, 200)`; by default those up to a second from
        a frame for which the pins ask. All others stay the same to the last bit, and a plant that is not
        completely inside stays where it was in each frame. With `slice(None)` all frames may change.

    Returns
    -------
    The edited motion; the motion as it is if the pins ask for nothing.

    Raises
    ------
    MocapError : for pins of another motion, pins that no pose can meet, contacts or legs that are missing.

    Warns
    -----
    MocapWarning : for pins that are missed by more than 0.1 mm; plants among them are let go.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import pin, pin_errors
    >>> walk = sample("walk_straight")[:240]
    >>> hand = joint_positions(walk)[120, walk.skeleton.index("lwrist")]
    >>> post = pin(walk, "lwrist", range(110, 130), hand + [0.05, 0.2, 0])
    >>> bool(pin_errors(edit(walk, post), post).max() < 1e-9)
    True

    Notebook: 14-levels
    """
    if len(pins) == len(motion) and not pins.asked.any():
        return motion
    edited = motion
    for window in [frames] if frames is not None else _windows(pins, motion.fps):
        in_window = pins if frames is not None else pins.only(window)
        edited = brought(edited, motion, in_window, body, window)
    return edited


def _windows(pins: Pins, fps: float) -> list[slice]:
    """List the stretches of frames up to `TUNED.margin` from a frame for which pins ask."""
    margin = round(TUNED.margin * fps)
    is_near = np.zeros(len(pins), bool)
    for start, stop in runs(np.asarray(pins.asked.any(axis=1))):
        is_near[max(0, start - margin) : stop + margin] = True
    return [slice(start, stop) for start, stop in runs(is_near)]


def _with_margin(frames: slice, count: int, fps: float) -> slice:
    """Return frames that may change, with those beside them on which the change depends."""
    start, stop, _ = frames.indices(count)
    margin = round(TUNED.margin * fps)
    return slice(max(0, start - margin), min(count, stop + margin))


def brought(
    motion: Motion, source: Motion, pins: Pins, body: Body | None = None, frames: slice = EVERY_FRAME
) -> Motion:
    """Bring a motion to pins, as `edit` does, with the plants and the floor of a source that it was made of.

    If joints would sink, the pins are solved for again, together with a floor.
    """
    plants = plant_pins(source)
    stays = np.ones(len(motion), bool)
    stays[frames] = False
    wishes = join_pins(plants_within(plants, with_frames_of(source, motion, stays), frames), pins)
    allowed = allowed_by(pins, source)
    nearby = _with_margin(frames, len(motion), motion.fps)
    first, stop, _ = frames.indices(len(motion))
    inside = slice(first - nearby.start, stop - nearby.start)

    def solved_for(constraints: Pins) -> Motion:
        turning = body or priced(
            motion, constraints, TUNED.trunk, TUNED.neck
        )  # the whole motion shows which joints are hinges
        return solve(motion[nearby], constraints, edit_stages(), turning, quiet=True, frames=inside).motion

    solved = solved_for(wishes.at(nearby))
    floor = floor_for(bend_toes(solved, allowed[nearby]), plants.joints, allowed[nearby])
    if pin_errors(solved, floor).max() > SLACK:
        solved = solved_for(join_pins(floor, wishes.at(nearby)))
    bent = mark_met(bend_toes(solved, allowed[nearby]), wishes.at(nearby), plants.at(nearby))
    return _with_piece(motion, bent, nearby, stays)


def _with_piece(motion: Motion, piece: Motion, nearby: slice, stays: Mask) -> Motion:
    """Put a changed piece of a motion in its place, but for frames that stay, (F,)."""
    if len(piece) == len(motion):
        return with_frames_of(piece, motion, stays)
    changes = np.flatnonzero(~stays)
    roots = motion.root_positions.copy()
    turned = motion.rotations.copy()
    roots[changes] = piece.root_positions[changes - nearby.start]
    turned[changes] = piece.rotations[changes - nearby.start]
    contacts = {name: mark.copy() for name, mark in motion.contacts.items()}
    for name, mark in piece.contacts.items():
        contacts.setdefault(name, np.zeros(len(motion), bool))[changes] = mark[changes - nearby.start]
    return replace(motion, root_positions=roots, rotations=turned, contacts=contacts)


def plants_within(plants: Pins, motion: Motion, frames: slice) -> Pins:
    """Let feet stay where they were in all other frames, and in plants that reach from these into them.

    Parameters
    ----------
    plants : of F frames, as from `plant_pins`.
    motion : F frames.
    frames : those that may change, in a row.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> plants = plant_pins(walk := sample("walk_straight")[:240])
    >>> plants_within(plants, walk, slice(None)) is plants
    True
    >>> bool(plants_within(plants, walk, slice(100, 140)).held[:100].all())
    True
    """
    changes = np.zeros(len(motion), bool)
    changes[frames] = True
    if changes.all():
        return plants
    positions = joint_positions(motion)[:, list(plants.joints)]
    stays = np.repeat(~changes[:, None], len(plants.joints), axis=1)
    planted = np.asarray(plants.held.all(axis=-1))
    for leg in find_legs(motion.skeleton):  # a rigid foot: both of its joints stay, or neither
        foot = np.isin(plants.joints, leg)
        for start, stop in runs(np.asarray(planted[:, foot].any(axis=1))):
            if not changes[start:stop].all():
                stays[start:stop, foot] |= planted[start:stop, foot]
    low = np.where(stays[..., None], positions, plants.low)
    high = np.where(stays[..., None], positions, plants.high)
    return Pins(plants.joints, low, high)


def allowed_by(pins: Pins, motion: Motion) -> Array:
    """Compute how low each joint may be, (F, J), metres: as `lowest_allowed`, or lower if pins ask for it.

    Where pins ask that a part of a limb be lower, all of the limb may be as low as it must.
    """
    allowed = lowest_allowed(motion)
    skeleton = motion.skeleton
    for column, joint in enumerate(pins.joints):
        if (pins.high[:, column, 1] < allowed[:, joint] - SLACK).any():
            below = [end for end in range(len(skeleton)) if joint in skeleton.path_to_root(end)]
            allowed[:, [*below, *skeleton.path_to_root(joint)]] = -np.inf
    return allowed


def floor_for(motion: Motion, feet: Sequence[int], allowed: Array) -> Pins:
    """Keep feet, and the other joints that are too low, above the heights allowed (F, J), metres."""
    sinks = (joint_positions(motion)[..., 1] < allowed - 2 * SLACK).any(axis=0)
    joints = sorted({*feet, *np.flatnonzero(sinks).tolist()})
    low = np.full((len(motion), len(joints), 3), -np.inf)
    low[..., 1] = allowed[:, joints]
    return Pins(joints, low, np.full_like(low, np.inf))


def mark_met(motion: Motion, pins: Pins, plants: Pins) -> Motion:
    """Warn of pins that are missed, and mark of the `plants` only those that are where `pins` hold them.

    Examples
    --------
    >>> import warnings
    >>> from mocap.datasets import sample
    >>> plants = plant_pins(walk := sample("walk_straight")[:240])
    >>> with warnings.catch_warnings(action="ignore"):
    ...     for up in ([0, 0.00009, 0], [0, 0.00015, 0]):  # metres
    ...         higher = Pins(plants.joints, plants.low + up, plants.high + up)
    ...         print(mark_met(walk, higher, plants).contacts["lfoot"].sum())
    52
    0
    """
    warn_of_gaps(motion, pins, CLOSED)
    met = pin_errors(motion, pins) <= CLOSED
    stands = plants.held.all(axis=-1) & met[:, [pins.joints.index(joint) for joint in plants.joints]]
    marks = {motion.skeleton.names[joint]: mark for joint, mark in zip(plants.joints, stands.T, strict=True)}
    return replace(motion, contacts={**motion.contacts, **marks})


def clean_feet(motion: Motion, lowest: Array | None = None) -> Motion:
    """Remove foot sliding by `feet.clean_up`, and keep all joints above the floor.

    Parameters
    ----------
    motion : F frames of J joints; its `contacts` say when feet stand.
    lowest : as for `lowest_allowed`.

    Raises
    ------
    MocapError : as for `feet.clean_up`.

    Warns
    -----
    MocapWarning : for plants that are let go, as by `feet.clean_up`.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:120]
    >>> heights = joint_positions(clean_feet(walk))[walk.contacts["rtoes"], walk.skeleton.index("rtoes"), 1]
    >>> bool(np.ptp(heights) < 1e-9)
    True
    """
    return raised(clean_up(motion), lowest_allowed(motion, lowest))


def raised(motion: Motion, allowed: Array) -> Motion:
    """Raise the tips of toes that are lower than allowed, and other joints under the floor, y = 0.

    Toes bend. If other joints are lower than allowed under the floor, by more than 3 mm, the smallest smooth
    change raises them.

    Parameters
    ----------
    motion : F frames of J joints, with clean feet. Plants stay where they are, or rise to the floor.
    allowed : the lowest height of each joint, (F, J), metres.
    """
    bent = bend_toes(motion, allowed)
    plants = plant_pins(motion)
    under_floor = np.minimum(allowed, 0.0)
    floor = floor_for(bent, plants.joints, under_floor)
    if pin_errors(bent, floor).max() <= TUNED.sunk:
        return bent
    rise = np.zeros((*plants.low.shape[:2], 1))
    floor_of_plants = under_floor[:, list(plants.joints)]
    short = np.where(plants.held[..., 1], floor_of_plants - plants.low[..., 1], 0.0)
    for leg in find_legs(motion.skeleton):  # a rigid foot: both of its joints rise by as much
        foot = np.isin(plants.joints, leg)
        rise[:, foot, 0] = np.maximum(short[:, foot].max(axis=1, keepdims=True), 0.0)
    wishes = join_pins(floor, Pins(plants.joints, plants.low + rise * UP, plants.high + rise * UP))
    solved = solve(
        motion, wishes, edit_stages(), priced(motion, wishes, TUNED.trunk, TUNED.neck), quiet=True
    ).motion
    return bend_toes(solved, allowed)


def posed(motion: Motion, frame: int, places: Mapping[str, ArrayLike], *, feet: bool = True) -> Motion:
    """Drag joints to places in one frame, and let the rest of the body follow as little as it can.

    [WP95] let an animator set a pose's angles. Here joints are put to places, and the solver turns the joints
    above them [ours].

    Parameters
    ----------
    motion : F frames; the whole clip shows which joints turn, and which are hinges.
    frame : which one.
    places : {joint: (x, y, z)}, metres; NaN leaves an axis free.
    feet : keep the feet that stand in this frame where they stand; asks for the motion's `contacts`.

    Returns
    -------
    The pose: a motion of one frame, for a `Key`.

    Raises
    ------
    MocapError : for a frame or joints that are not there, places out of reach, and missing contacts.

    Warns
    -----
    MocapWarning : for places that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> hand = joint_positions(walk[100:101])[0, walk.skeleton.index("lhand")]
    >>> pose = posed(walk, 100, {"lhand": hand + [0, 0.2, 0]})
    >>> float((joint_positions(pose)[0, walk.skeleton.index("lhand")] - hand).round(4)[1])
    0.2

    Notebook: 11-warping
    """
    plants = plant_pins(motion) if feet else Pins((), *np.zeros((2, len(motion), 0, 3)))
    return posed_with(motion, frame, places, plants)


def posed_with(motion: Motion, frame: int, places: Mapping[str, ArrayLike], plants: Pins) -> Motion:
    """Drag joints to places in one frame, as `posed`, with feet where `plants` hold them."""
    if not 0 <= frame < len(motion):
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, none with number {frame}.")
    pins = plants.only([frame])
    for joint, place in places.items():
        free = np.isnan(place)
        box = (np.where(free, end, place) for end in (-np.inf, np.inf))
        pins = join_pins(pins, pin(motion, joint, [frame], *box))
    require_reachable(motion, pins)
    body = priced(motion, pins, TUNED.pose_trunk, TUNED.pose_neck)
    stage = Stage(weight=TUNED.pose_weight, damping=TUNED.pose_damping, passes=TUNED.pose_passes)
    pose = replace(motion[frame : frame + 1], name=f"{motion.name}[{frame}]")
    return replace(solve(pose, pins.at([frame]), [stage], body).motion, name=motion.name)


def priced(motion: Motion, pins: Pins, trunk: float, neck: float) -> Body:
    """Choose the joints that turn, at so many times the prices of `body_of`; the root's way costs more, too.

    The trunk is joints that have a third of the body below them, the neck the other ones up to the head.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> head = pin(walk, "head", [0], [0, 0, 0])
    >>> (priced(walk, head, 4, 8).price / body_of(walk, head).price).tolist()[::3]  # metres, then joints
    [4.0, 4.0, 4.0, 4.0, 4.0, 8.0, 8.0]
    """
    skeleton = motion.skeleton
    paths = [skeleton.path_to_root(joint) for joint in range(len(skeleton))]
    below = np.bincount(np.concatenate(paths))
    heads = {joint for path in paths if skeleton.names[path[0]].lower().endswith("head") for joint in path}
    above_heads = np.isin(range(len(paths)), [*heads])
    factors = np.where(below > len(skeleton) / 3, trunk, np.where(above_heads, neck, 1)).tolist()
    body = body_of(motion, pins, prices=dict(zip(skeleton.names, factors, strict=True)))
    return body._replace(price=np.append(trunk * body.price[:3], body.price[3:]))


TOLERANCE = 1e-3  # metres: a level is the last if no pin is missed by more


class Level(NamedTuple):
    """A level of `hierarchy`: seconds between `knots`, frames `asked`, and what was left of the gaps, metres.

    `worst` is over all pins, `rms` over those of frames in which something was asked.

    Examples
    --------
    >>> Level(knots=0.5, asked=80, worst=0.104, rms=0.025).worst
    0.104
    """

    knots: float
    asked: int  # reads: name: public, and in notebook 14
    worst: float
    rms: float


def scattered_fit(
    basis: sparse.csr_array, data: Array, at: Indices
) -> Array:  # reads: name: public, and in notebook 14
    """Fit control points to data at some frames, each by itself [LWS97], as [LS99, scattered data].

    Alone, a datum u_j with the weights w_ij = B_i(t_j) would ask for β_ij = w_ij u_j / Σ_i w_ij² of control
    point i: the least change that meets it. A control point takes the mean of what its data ask for,

        c_i = Σ_j w_ij² β_ij / Σ_j w_ij²,

    and 0 where no datum is near. So the curve is bounded by its data, where least squares runs wild between
    them; it comes near them, and the next level goes on.

    Parameters
    ----------
    basis : B, shape (F, K), as from `spline_basis`.
    data : u, shape (N, n).
    at : shape (N,), their frames.

    Returns
    -------
    c, shape (K, n); the curve is B c.

    Examples
    --------
    >>> control = scattered_fit(spline_basis(11, 5), np.array([[1.0]]), np.array([5]))
    >>> control.round(3)[:, 0]
    array([0.   , 0.333, 1.333, 0.333, 0.   ])

    Notebook: 14-levels
    """
    weights = basis[at]
    squared = weights.power(2)
    above = (squared * weights).T @ (np.asarray(data, float) / squared.sum(axis=1)[:, None])
    below = squared.sum(axis=0)[:, None]
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


def hierarchy(
    base: Motion, pins: Pins, *, knots: Sequence[float] = (0.5, 0.25, 0.125, 0.06, 0.03)
) -> tuple[Motion, list[Level]]:
    """Bring joints to their pins level by level, and end when they are met to a millimetre [LS99, levels].

    At each level the pinned frames are brought to their pins, each by itself; a spline with the level's knots
    is fitted to what that takes, and added: m_k = m_{k-1} ⊕ d_k. The fit is that of [LWS97]: local, without a
    system to solve. `solve` on splines is quicker, comes nearer, and undoes what it overshot; levels win
    where an editor drags and wants a coarse answer at once.

    A number listens to a frame only if a joint that it moves is pinned there: a foot that stands says nothing
    about the arm. This is ours, and needed: else a hand that is asked for in three frames stays 28 cm off.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    knots : seconds between knots, level by level, each smaller than the one before.

    Returns
    -------
    The motion, and one `Level` for each level that was needed; the motion as it is where none was.

    Raises
    ------
    MocapError : as for `solve`, and for knots that do not fall.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import pin
    >>> walk = sample("walk_straight")[:120]
    >>> hand = joint_positions(walk)[60, walk.skeleton.index("lwrist")]
    >>> _, levels = hierarchy(walk, pin(walk, "lwrist", [60], hand + [0, 0.2, 0]))
    >>> levels[-1].worst < 0.001
    True

    Notebook: 14-levels
    """
    from_coarse = [np.inf, *knots]
    if not len(knots) or not all(0 < fine < coarse for coarse, fine in pairwise(from_coarse)):
        raise MocapError(f"From level to level the knots come nearer, above 0 s; got {tuple(knots)[:8]}.")
    motion = base
    levels: list[Level] = []
    errors = pin_errors(base, pins)
    body = priced(base, pins, TUNED.level_trunk, TUNED.level_neck)
    for seconds in knots:
        if errors.max(initial=0.0) <= TOLERANCE:
            break
        requested = np.asarray(pins.held.any(axis=-1) | (errors > 0))  # (F, P + T)
        frames = np.asarray(requested.any(axis=1))
        missed = errors.max(axis=1) > TOLERANCE  # in all other frames the spline shall stay where it is
        change = solve(
            motion, pins.only(missed), [REACH._replace(passes=TUNED.level_passes)], body, quiet=True
        ).change
        # The root's place listens to all frames, a joint's turns to those in which a joint below is pinned.
        below = [np.isin(body.joints, movers) for movers in pins.movers(base.skeleton)]
        listening = np.hstack([np.repeat(frames[:, None], 3, axis=1), requested @ np.array(below)])  # (F, n)
        basis = spline_basis(len(base), seconds * base.fps)
        fits = []
        for number, chosen in enumerate(listening.T):
            fits.append(scattered_fit(basis, change[chosen, number, None], np.flatnonzero(chosen)))
        motion = displaced(motion, body.displacement(basis @ np.hstack(fits), len(base.skeleton)))
        errors = pin_errors(motion, pins)
        rms = float(np.sqrt((errors[frames] ** 2).mean()))
        levels.append(Level(seconds, int(frames.sum()), float(errors.max()), rms))
    return motion, levels
