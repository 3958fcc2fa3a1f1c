"""Weighted blends of registered clips.

Poses are averaged directly, but trajectories on the ground are not: the mean position of a walk to the left
and a walk to the right would stop and turn around. The *velocities* of the clips are averaged instead, each
rotated by the transform that aligns its clip with the blend at that time.
"""

from dataclasses import replace

import numpy as np

from mocap._shared.arguments import checked_by
from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap.blending.clocks import Registration, Weights, frame_times, require_registration
from mocap.body import rotations
from mocap.body.concatenation import gather_marks
from mocap.body.motion import Motion, rotating_joints
from mocap.body.planar import from_ground, on_ground
from mocap.errors import MocapError


class Course(NamedTuple):
    """The trajectory of a blend on the ground, in each frame.

    Parameters
    ----------
    angles : shape (C, F), θ + φ: the angle that aligns each clip with the blend, radians.
    centres : shape (F,), z + ix, metres: the centroid of the points of the blend.
    """

    angles: Array
    centres: Points


def _require_weights(registration: object = None, weights: object = None, **_options: object) -> None:
    """Raise unless both a registration and weights are passed."""
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
    """Blend registered clips by constant weights, or by weights that vary with time [KG03, blend].

    In the paper: [KG03, blend; blended plants; continuous control].

    Let φ be the heading of the blend relative to the reference, and c the centroid of a clip. From one frame
    to the next, φ decreases by Σ w Δθ and the centroid of the blend moves by Σ w R(θ + φ) Δc, with w, θ and φ
    half-way between the frames. The position of the root relative to that centroid is the weighted mean over
    the clips. Rotations are averaged by `body.rotations.mean`. (Averaging *increments* of transforms is the
    idea of [KG03]. Averaging them about the common centroid of the clips is ours: about the origin of the
    world, a blend would depend on the positions at which its clips were captured.)

    Parameters
    ----------
    registration : of C clips.
    weights : shape (C,), with sum one, or a function of the common clock u and the time t of the blend, both
        in seconds, that returns them. Weights outside [0, 1], by up to about 0.1, extrapolate.
    fps : frames per second, by default those of the clips.
    pace : as for `frame_times`.
    rounds : as for `body.rotations.mean`; 0 is faster.

    Returns
    -------
    A motion that starts at the position of the reference. Its footplants are those that all clips have, from
    the mean of their starts to the mean of their stops. Its labels are those of the clip with the largest
    weight.

    Raises
    ------
    MocapError : for an object that is not a registration, missing weights, and as by `frame_times`.

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
    clips = registration.clips
    fps = clips[0].fps if fps is None else fps
    times, frame_weights = frame_times(registration, weights, fps=fps, pace=pace)
    angles = np.stack([curve(times) for curve in registration.angles])
    centres = np.stack([registration.centre(number, times) for number in range(len(clips))])
    start = (0.0, complex(centres[registration.reference, 0]))
    course = ground_course(angles, centres, frame_weights, start)
    roots, mean_rotations = poses(registration, times, frame_weights, course, rounds=rounds)
    heaviest = _heaviest_frames(registration, times, frame_weights)
    labels = gather_marks([clip.labels for clip in clips], heaviest)
    contacts = _mean_contacts(registration, times, frame_weights)
    name = " + ".join(clip.name for clip in clips) if len(clips) < 4 else f"{len(clips)} clips"
    skeleton = clips[0].skeleton
    return Motion(skeleton, roots, mean_rotations, fps, name, labels=labels, contacts=contacts)


def _heaviest_frames(registration: Registration, times: Array, weights: Array) -> Indices:
    """Return the clip with the largest weight and its nearest frame, at each time, (F, 2)."""
    curves = zip(registration.times, registration.clips, strict=True)
    nearest = np.array([np.rint(curve(times) * clip.fps) for curve, clip in curves])
    heaviest = weights.argmax(axis=1)
    frames = nearest[heaviest, np.arange(len(times))].astype(np.intp)
    return np.stack([heaviest, frames], axis=1)


def _mean_contacts(registration: Registration, times: Array, weights: Array) -> dict[str, Mask]:
    """Return contacts for the matched footplants, from the weighted mean of their starts to that of stops."""
    contacts = {joint: np.zeros(len(times), bool) for joint, _ in registration.contacts}
    for joint, (starts, stops) in registration.contacts:
        contacts[joint] |= (times >= weights @ starts - 1e-9) & (times < weights @ stops)
    return contacts


def ground_course(
    angles: Array, centres: Points, weights: Array, start: tuple[float, complex] | None = None
) -> Course:
    """Integrate the weighted mean velocity of the clips, each aligned with the blend.

    In the paper: [KG03, blend].

    Parameters
    ----------
    angles : shape (C, F), the angles θ that align each clip with the reference, radians.
    centres : shape (C, F), the centroids z + ix of the clips as captured, metres.
    weights : shape (F, C).
    start : φ and the centroid in the first frame, by default 0, and that of the first clip.

    Examples
    --------
    The blend of two quarter circles, to the left and to the right, is a straight line of the same length:

    >>> angle = np.linspace(0, np.pi / 2, 91)
    >>> left, right = 1j * (np.exp(-1j * angle) - 1), 1j * (1 - np.exp(1j * angle))
    >>> course = ground_course(np.stack([angle, -angle]), np.stack([left, right]), np.full((91, 2), 0.5))
    >>> complex(course.centres[-1].round(3))
    (1.571+0j)

    Notebook: 15-registration
    """
    heading, position = start or (0.0, complex(centres[0, 0]))
    halfway_weights = (weights[1:] + weights[:-1]).T / 2
    heading_steps = (halfway_weights * np.diff(angles)).sum(axis=0)
    aligned = angles + heading - np.append(0, np.cumsum(heading_steps))
    halfway_angles = (aligned[:, 1:] + aligned[:, :-1]) / 2
    steps = (halfway_weights * np.exp(1j * halfway_angles) * np.diff(centres)).sum(axis=0)
    return Course(aligned, position + np.append(0, np.cumsum(steps)))


def poses(
    registration: Registration, times: Array, weights: Array, course: Course, *, rounds: int = 1
) -> tuple[Array, Array]:
    """Average the poses of the clips, aligned with a course: root positions (F, 3) and rotations (F, J, 4).

    Parameters
    ----------
    registration : of C clips.
    times : shape (F,), of the common clock, seconds.
    weights : shape (F, C).
    course : from `ground_course`.
    rounds : as for `body.rotations.mean`.
    """
    offset = np.zeros(len(times), complex)  # of the root from the centroid
    height = np.zeros(len(times))
    aligned = []
    for number, (clip, curve) in enumerate(zip(registration.clips, registration.times, strict=True)):
        pose = clip.at(curve(times) * clip.fps)
        angle = course.angles[number]
        weight = weights[:, number]
        clip_offset = on_ground(pose.root_positions) - registration.centre(number, times)
        offset += weight * np.exp(1j * angle) * clip_offset
        height += weight * pose.root_positions[:, 1]
        clip_rotations = pose.rotations.copy()
        clip_rotations[:, 0] = rotations.multiply(rotations.about_y(angle), clip_rotations[:, 0])
        aligned.append(clip_rotations)
    stacked = np.stack(aligned, axis=-2)  # (F, J, C, 4)
    rotating = np.any([rotating_joints(clip) for clip in registration.clips], axis=0)
    rotating[0] = True
    mean = stacked[:, :, 0]
    mean[:, rotating] = rotations.mean(stacked[:, rotating], weights[:, None], rounds=rounds)
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    x, z = from_ground(course.centres + offset).T
    return np.stack([x, height, z], axis=-1), mean


def crossfade(registration: Registration, *, seconds: float = 1.0) -> Motion:
    """Crossfade from the first frame of the reference to the last frame of the other clip.

    In the paper: [KG03, transition].

    This is a transition by registration curves [KG03]: the weight of the other clip in `mix` rises as
    3 s² - 2 s³ [KGP02, Eq. 7]. `join` blends frames in pairs without a timewarp, which is adequate for a
    third of a second in two similar windows. Here the clips remain synchronised and on a common course,
    therefore the fade may be long. It is in the middle of the span.

    Parameters
    ----------
    registration : of two clips.
    seconds : duration of the fade on the common clock, that of the reference.

    Returns
    -------
    The unchanged reference, the fade, and the other clip, transformed to the end of the fade. Labels and
    contacts are those of the clip that is played. In the fade, footplants are those that both clips have.

    Raises
    ------
    MocapError : for more than two clips, a duration that is not above 0, and a fade that exceeds the span.

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
    start = middle - seconds / 2
    stop = middle + seconds / 2
    if not first - 1e-9 <= start < stop <= last + 1e-9:
        overlap = f"the {first:.2f} to {last:.2f} s that both clips have"
        raise MocapError(f"A fade from {start:.2f} to {stop:.2f} s does not lie within {overlap}.")
    reference = registration.reference
    target = 1 - reference
    reference_weights = np.eye(2)[reference]
    change = np.eye(2)[target] - reference_weights

    def weights(u: float, t: float) -> Array:
        s = np.clip((u - start) / seconds, 0, 1)
        return np.asarray(reference_weights + change * s * s * (3 - 2 * s))

    # Outside the fade a clip is played unchanged, independent of the curves, which may extend to its end.
    target_clip = registration.clips[target]
    end = float(registration.times[target].inverse(target_clip.duration))
    extended = replace(registration, span=(0.0, end))
    fade = mix(extended, weights)
    times, _ = frame_times(extended, weights, fps=fade.fps)
    playing = np.where(times <= start, reference, np.where(times >= stop, target, -1))
    name = f"{registration.clips[reference].name} to {target_clip.name}"
    return replace(fade, name=name, contacts=_contacts_by_clip(extended, fade, times, playing))


def _contacts_by_clip(
    registration: Registration, fade: Motion, times: Array, playing: Array
) -> dict[str, Mask]:
    """Return the contacts of the clip `playing` in each frame, or the matched ones if it is -1."""
    clips = zip(registration.clips, registration.times, strict=True)
    clip_contacts = [clip.at(curve(times) * clip.fps).contacts for clip, curve in clips]
    unmarked = np.zeros(len(fade), bool)
    contacts = {}
    for joint in dict.fromkeys([*clip_contacts[0], *clip_contacts[1]]):
        marks = [of_clip.get(joint, unmarked) for of_clip in clip_contacts]
        contacts[joint] = np.select([playing == 0, playing == 1], marks, fade.contacts.get(joint, unmarked))
    return contacts
