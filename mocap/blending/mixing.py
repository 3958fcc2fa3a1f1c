"""Any number of registered clips blended by any weights.

Poses are averaged as they are, but the way over the ground is not: a walk to the left and one to the right
lead to places whose mean is nowhere, so a blend of places stands still and turns around. What is averaged is
how the clips *move*: their velocities, each turned as its clip is laid on the blend at that moment.
"""

from dataclasses import replace

import numpy as np

from mocap._shared.arguments import checked_by
from mocap._shared.arrays import Array, Mask, Points
from mocap._shared.records import NamedTuple
from mocap.blending.clocks import Registration, Weights, frame_times, require_registration
from mocap.body import rotations
from mocap.body.motion import Motion, gather_marks, turning
from mocap.body.planar import from_ground, on_ground
from mocap.errors import MocapError


class Course(NamedTuple):
    """How a blend goes over the ground, frame by frame.

    angles : shape (C, F), θ + φ: what turns each clip on the blend, radians.
    centres : shape (F,), z + ix, metres: the centroid of the blend's points.
    """

    angles: Array
    centres: Points


def _require_weights(registration: object = None, weights: object = None, **_options: object) -> None:
    """Raise unless there are a registration and weights."""
    require_registration(registration)
    if weights is None:
        raise MocapError("A blend takes a weight for each clip: blending.mix(registration, [0.5, 0.5]).")


@checked_by(_require_weights)
def mix(
    registration: Registration,
    weights: Weights,
    *,
    fps: float | None = None,
    pace: str = "durations",
    rounds: int = 1,
) -> Motion:
    """Blend registered clips by constant weights, or by weights that move [KG03, blend].

    In the paper: [KG03, blend; blended plants; continuous control].

    With φ for how the blend is turned against the reference and c for a clip's centroid, from one frame to
    the next φ falls by Σ w Δθ and the blend's centroid moves by Σ w R(θ + φ) Δc, with w, θ and φ half-way
    between the frames. The root stands at the mean of the clips' roots as they lie around that centroid;
    rotations are averaged by `body.rotations.mean`. (That the transforms' *increments* are averaged is
    [KG03]'s idea; that they are averaged about the centroid that all clips share is ours. About the world's
    origin a blend would depend on where its clips were captured.)

    Parameters
    ----------
    registration : of C clips.
    weights : shape (C,), adding up to one; or a function of the common clock u and the blend's own time t,
        both in seconds, that gives them. A little outside of 0 … 1, say by 0.1, they exaggerate.
    fps : frames per second; the clips' own by default.
    pace : as for `frame_times`.
    rounds : as for `body.rotations.mean`; 0 is quicker.

    Returns
    -------
    A motion that starts where the reference does. Its plants are those that all clips have, from the mean of
    their starts to the mean of their stops; its labels are those of the clip with the largest weight.

    Raises
    ------
    MocapError : for what is no registration, missing weights, and as by `frame_times`.

    Examples
    --------
    >>> from mocap.blending.registering import register
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> walking = register(walks)
    >>> walking.durations.round(2), round(mix(walking, [0.5, 0.5]).duration, 2)
    (array([4.97, 4.14]), 4.55)

    Notebook: 15-registration
    """
    fps = registration.clips[0].fps if fps is None else fps
    times, shares = frame_times(registration, weights, fps=fps, pace=pace)
    centres = np.stack([registration.centre(clip, times) for clip in range(len(registration.clips))])
    start = 0.0, complex(centres[registration.reference, 0])
    course = ground_course(np.stack([curve(times) for curve in registration.angles]), centres, shares, start)
    roots, turns = poses(registration, times, shares, course, rounds=rounds)
    clips = registration.clips
    nearest = [np.rint(c(times) * clip.fps) for c, clip in zip(registration.times, clips, strict=True)]
    heaviest = shares.argmax(axis=1)
    contacts = {joint: np.zeros(len(times), bool) for joint, _ in registration.contacts}
    for joint, (starts, stops) in registration.contacts:  # the start and the stop are blended, too
        contacts[joint] |= (times >= shares @ starts - 1e-9) & (times < shares @ stops)
    frames = np.array(nearest)[heaviest, np.arange(len(times))].astype(np.intp)
    return Motion(
        clips[0].skeleton,
        roots,
        turns,
        fps,
        " + ".join(clip.name for clip in clips) if len(clips) < 4 else f"{len(clips)} clips",
        labels=gather_marks([clip.labels for clip in clips], np.stack([heaviest, frames], axis=1)),
        contacts=contacts,
    )


def ground_course(
    turns: Array, centres: Points, shares: Array, start: tuple[float, complex] | None = None
) -> Course:
    """Go over the ground with the mean of the clips' velocities, each as its clip lies on the blend.

    In the paper: [KG03, blend].

    Parameters
    ----------
    turns : shape (C, F), the angles θ that turn each clip on the reference.
    centres : shape (C, F), the clips' centroids z + ix, where they were captured.
    shares : shape (F, C), the weights.
    start : φ and the centroid in the first frame; by default 0, and the first clip's.

    Examples
    --------
    Quarters of circles to the left and the right, half and half: straight on for as long as they are.

    >>> angle = np.linspace(0, np.pi / 2, 91)
    >>> left, right = 1j * (np.exp(-1j * angle) - 1), 1j * (1 - np.exp(1j * angle))
    >>> course = ground_course(np.stack([angle, -angle]), np.stack([left, right]), np.full((91, 2), 0.5))
    >>> complex(course.centres[-1].round(3))
    (1.571+0j)

    Notebook: 15-registration
    """
    heading, place = start or (0.0, complex(centres[0, 0]))
    halfway = (shares[1:] + shares[:-1]).T / 2
    falls = (halfway * np.diff(turns)).sum(axis=0)
    angles = turns + heading - np.append(0, np.cumsum(falls))
    moves = (halfway * np.exp(0.5j * (angles[:, 1:] + angles[:, :-1])) * np.diff(centres)).sum(axis=0)
    return Course(angles, place + np.append(0, np.cumsum(moves)))


def poses(
    registration: Registration, times: Array, shares: Array, course: Course, *, rounds: int = 1
) -> tuple[Array, Array]:
    """Average the clips' poses as they lie on a course: root positions (F, 3) and rotations (F, J, 4).

    Parameters
    ----------
    registration, times, shares : as for `mix`.
    course : as from `ground_course`.
    rounds : as for `body.rotations.mean`.
    """
    root, height, laid = 0j * course.centres, np.zeros(len(times)), []
    for number, (clip, curve) in enumerate(zip(registration.clips, registration.times, strict=True)):
        posed = clip.at(curve(times) * clip.fps)
        roots, turns = posed.root_positions, posed.rotations.copy()
        angle, share = course.angles[number], shares[:, number]
        away = on_ground(roots) - registration.centre(number, times)
        root += share * np.exp(1j * angle) * away
        height += share * roots[:, 1]
        turns[:, 0] = rotations.multiply(rotations.about_y(angle), turns[:, 0])
        laid.append(turns)
    every = np.stack(laid, axis=-2)  # (F, J, C, 4)
    turned = np.any([turning(clip) for clip in registration.clips], axis=0)
    turned[0] = True
    mean = every[:, :, 0]
    mean[:, turned] = rotations.mean(every[:, turned], shares[:, None], rounds=rounds)
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    x, z = from_ground(course.centres + root).T
    return np.stack([x, height, z], axis=-1), mean


def crossfade(registration: Registration, *, seconds: float = 1.0) -> Motion:
    """Pass from the reference to the other clip, from the first frame of the one to the last of the other.

    In the paper: [KG03, transition].

    A transition by registration curves [KG03]: while `mix` plays, the weight of the other clip rises as
    3 s² - 2 s³ [KGP02, Eq. 7]. `join` mixes frame i with frame i, which is right for a third of a second
    around two moments that match. Here both clips stay in step and on one course, so the fade may be long. It
    lies in the middle of the span.

    Parameters
    ----------
    registration : of two clips.
    seconds : how long the fade takes on the common clock, which is the reference's.

    Returns
    -------
    The reference as it is, the fade, and the other clip, turned and moved to where the fade leads. Marks are
    those of the clip that plays; within the fade the plants are those that both clips have.

    Raises
    ------
    MocapError : for more than two clips, a fade that does not last, and one that is not within the span.

    Examples
    --------
    >>> from mocap.blending.registering import register
    >>> from mocap.datasets.samples import sample
    >>> slow, brisk = (sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.4_0"))
    >>> faster = crossfade(register([slow, brisk]), seconds=2.0)
    >>> faster.name, bool(brisk.duration < faster.duration < slow.duration)
    ('walk to walk', True)

    Notebook: 15-registration
    """
    require_registration(registration)
    if len(registration.clips) != 2:
        raise MocapError(f"A crossfade needs two registered clips, got {len(registration.clips)}.")
    first, last = registration.span
    middle = (first + last) / 2
    if not (np.isfinite(seconds) and seconds > 0):
        raise MocapError(f"A fade must last longer than 0 s, got {seconds} s.")
    start, stop = middle - seconds / 2, middle + seconds / 2
    if not first - 1e-9 <= start < stop <= last + 1e-9:
        both = f"the {first:.2f} to {last:.2f} s that both clips have"
        raise MocapError(f"A fade from {start:.2f} to {stop:.2f} s does not lie within {both}.")
    own, other = registration.reference, 1 - registration.reference

    def weights(u: float, t: float) -> Array:
        s = np.clip((u - start) / seconds, 0, 1)
        return np.asarray(np.eye(2)[own] + (np.eye(2)[other] - np.eye(2)[own]) * s * s * (3 - 2 * s))

    # A clip that plays alone plays as it is, whatever the curves say: so they may go on to its end.
    entered = registration.clips[other]
    whole = replace(registration, span=(0.0, float(registration.times[other].inverse(entered.duration))))
    made = mix(whole, weights)
    times, _ = frame_times(whole, weights, fps=made.fps)
    alone = np.where(times <= start, own, np.where(times >= stop, other, -1))
    name = f"{registration.clips[own].name} to {entered.name}"
    return replace(made, name=name, contacts=_own_contacts(whole, made, times, alone))


def _own_contacts(registration: Registration, made: Motion, times: Array, alone: Array) -> dict[str, Mask]:
    """Take the marks of the clip that plays alone, `alone` being its number or -1, and the matched ones."""
    clips = zip(registration.clips, registration.times, strict=True)
    played = [clip.at(curve(times) * clip.fps).contacts for clip, curve in clips]
    contacts, never = {}, np.zeros(len(made), bool)
    for joint in dict.fromkeys([*played[0], *played[1]]):
        marks = [each.get(joint, never) for each in played]
        contacts[joint] = np.select([alone == 0, alone == 1], marks, made.contacts.get(joint, never))
    return contacts
