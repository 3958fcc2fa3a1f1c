"""From one registered clip into another, for as long as one likes: a join whose clips keep in step."""

from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.blending.clocks import frame_times
from mocap.blending.mixing import mix
from mocap.blending.registering import Registration
from mocap.body.motion import Motion
from mocap.errors import MocapError


def crossfade(registration: Registration, *, seconds: float = 1.0, at: float | None = None) -> Motion:
    """Pass from the reference to the other clip, from the first frame of the one to the last of the other.

    In the paper: [KG03, transition].

    A transition by registration curves [KG03]: while `mix` plays, the weight of the other clip rises as
    3 s² - 2 s³ [KGP02, Eq. 7]. `join` mixes frame i with frame i, which is right for a third of a second
    around two moments that match. Here both clips stay in step and on one course, so the fade may be long and
    may lie anywhere in the span.

    Parameters
    ----------
    registration : of two clips.
    seconds : how long the fade takes on the common clock, which is the reference's.
    at : the middle of the fade on this clock, seconds; by default in the middle of the span.

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
    >>> faster.name, bool(3.3 < faster.duration < 5.0)
    ('walk to walk', True)

    Notebook: 15-registration
    """
    if len(registration.clips) != 2:
        raise MocapError(f"A crossfade needs two registered clips, got {len(registration.clips)}.")
    first, last = registration.span
    middle = (first + last) / 2 if at is None else at
    if not (np.isfinite(seconds) and seconds > 0):
        raise MocapError(f"A fade must last longer than 0 s, got {seconds} s.")
    start, stop = middle - seconds / 2, middle + seconds / 2
    if not first - 1e-9 <= start < stop <= last + 1e-9:
        raise MocapError(
            f"A fade from {start:.2f} to {stop:.2f} s does not lie within the {first:.2f} to {last:.2f} s "
            "that both clips have."
        )
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
    return replace(made, name=name, contacts=_contacts(whole, made, times, alone))


def _contacts(registration: Registration, made: Motion, times: Array, alone: Array) -> dict[str, Mask]:
    """Take the marks of the clip that plays alone, `alone` being its number or -1, and the matched ones."""
    clips = zip(registration.clips, registration.times, strict=True)
    played = [clip.at(curve(times) * clip.fps).contacts for clip, curve in clips]
    contacts, never = {}, np.zeros(len(made), bool)
    for joint in dict.fromkeys([*played[0], *played[1]]):
        marks = [each.get(joint, never) for each in played]
        contacts[joint] = np.select([alone == 0, alone == 1], marks, made.contacts.get(joint, never))
    return contacts
