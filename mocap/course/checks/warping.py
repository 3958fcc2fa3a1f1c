"""Checks of notebook 11."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.rotations import from_rotvec, inverse, multiply, to_rotvec
from mocap.course.check import Check, Mistake, close_rotations


def _turning(rng: np.random.Generator) -> tuple[Array, int, Array, Array]:
    """Draw a joint's rotations, a key, the pose asked for there (of either sign), and the shares."""
    q = from_rotvec(rng.normal(size=3) + rng.normal(scale=0.15, size=(20, 3)).cumsum(axis=0))
    key = int(rng.integers(5, 15))
    pose = multiply(q[key], from_rotvec(rng.normal(size=3))) * rng.choice([-1, 1])
    share = np.clip(1 - np.abs(np.arange(20) - key) / 6, 0, 1)
    return q, key, pose, share


def _own(q: Array, key: int, pose: Array) -> Array:
    """Give the offset at the key, in the joint's own frame."""
    return to_rotvec(multiply(inverse(q[key]), pose))


def _long_way(quaternion: Array) -> Array:
    """Give a rotation vector without taking the shorter of the two ways."""
    w, v = quaternion[0], quaternion[1:]
    return np.asarray(2 * np.arctan2(np.linalg.norm(v), w) * v / np.linalg.norm(v))


offset_curve = Check(
    name="offset_curve",
    asks="the rotations (F, 4): each frame of q, turned in the joint's own frame by its share of the offset",
    start="first find the offset b, at the key only: solve q[key] · exp(b) = pose for exp(b), then take the "
    "logarithm. Each frame gets its share of b.",
    draw=_turning,
    truth=lambda q, key, pose, share: multiply(q, from_rotvec(share[:, None] * _own(q, key, pose))),
    same=close_rotations,
    mistakes=[
        Mistake(
            lambda q, key, pose, share: multiply(from_rotvec(share[:, None] * _own(q, key, pose)), q),
            "exp(b) stands on the left of q there, so b's axes are taken for those of the parent: the key is "
            "missed.",
        ),
        Mistake(
            lambda q, key, pose, share: multiply(q, from_rotvec(-share[:, None] * _own(q, key, pose))),
            "that goes the other way, log(pose⁻¹ q): at the key it is twice as far off as before.",
        ),
        Mistake(
            lambda q, key, pose, share: multiply(
                q, from_rotvec(share[:, None] * (to_rotvec(pose) - to_rotvec(q[key])))
            ),
            "you subtract rotation vectors: log(pose) - log(q) is the turn between them for small ones only.",
        ),
        Mistake(
            lambda q, key, pose, share: multiply(
                q, from_rotvec(share[:, None] * _long_way(multiply(inverse(q[key]), pose)))
            ),
            "for some poses you go the long way round: q and -q are one rotation, so take that with w ≥ 0, "
            "as `to_rotvec` does.",
        ),
        Mistake(
            lambda q, key, pose, share: multiply(
                q, from_rotvec(share[:, None] * to_rotvec(multiply(inverse(q), pose)))
            ),
            "that draws every frame towards the one pose, which wipes out the motion around the key; the "
            "offset is taken at the key, once.",
        ),
        Mistake(
            lambda q, key, pose, share: multiply(q, from_rotvec(_own(q, key, pose))),
            "every frame gets the whole offset; multiply b by its share.",
        ),
        Mistake(
            lambda q, key, pose, share: multiply(
                from_rotvec(share[:, None] * to_rotvec(multiply(pose, inverse(q[key])))), q
            ),
            "that turns in the parent's frame. It meets the key, but the offset asked for is the joint's "
            "own: log(q⁻¹ pose), on the right of q.",
        ),
    ],
)


def _keys(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw keys at uneven times, and a tension."""
    count = int(rng.integers(3, 7))
    return rng.uniform(3, 30, count).cumsum(), rng.normal(size=count), float(rng.uniform(0.1, 0.9))


def _slopes(at: Array, values: Array, tension: float) -> Array:
    slopes = np.zeros(len(at))
    slopes[1:-1] = (1 - tension) * (values[2:] - values[:-2]) / (at[2:] - at[:-2])
    return slopes


def _with_ends(at: Array, values: Array, tension: float) -> Array:
    """Give slopes that at both ends are those of the first and the last chord."""
    slopes = _slopes(at, values, tension)
    chords = (1 - tension) * np.diff(values) / np.diff(at)
    slopes[0], slopes[-1] = chords[0], chords[-1]
    return slopes


def _halved(at: Array, values: Array, tension: float) -> Array:
    slopes = np.zeros(len(at))
    slopes[1:-1] = (1 - tension) * (values[2:] - values[:-2]) / 2
    return slopes


def _forward(at: Array, values: Array, tension: float) -> Array:
    slopes = np.zeros(len(at))
    slopes[1:-1] = (1 - tension) * np.diff(values)[1:] / np.diff(at)[1:]
    return slopes


cardinal_slopes = Check(
    name="cardinal_slopes",
    asks="the slopes at all keys, from the line over both neighbours: less steep where there is tension, and "
    "0 at both ends",
    start="begin with zeros. For the inner keys, the keys after them are values[2:]; which are before them?",
    draw=_keys,
    truth=_slopes,
    mistakes=[
        Mistake(_halved, "you divide by the number of keys, 2; keys lie unevenly, so divide by their times."),
        Mistake(
            lambda at, values, tension: _slopes(at, values, 0.0),
            "the factor (1 - tension) is missing.",
        ),
        Mistake(
            lambda at, values, tension: _slopes(at, values, 1 - tension),
            "you multiply by the tension; at tension 1 the curve must be level at every key.",
        ),
        Mistake(_with_ends, "at both ends the curve must be level, for outside the keys it is constant."),
        Mistake(_forward, "that is the chord to the next key only; take the one from the key before."),
    ],
)


flight_time = Check(
    name="flight_time",
    asks="how many times as long the flight must last; 1 where nothing is added",
    start="a body that falls for t seconds falls by g t² / 2, and g is the same in both jumps. Solve for t.",
    draw=lambda rng: (float(rng.uniform(0.1, 0.6)), float(rng.uniform(0.05, 0.5))),
    truth=lambda rise, more: np.sqrt((rise + more) / rise),
    mistakes=[
        Mistake(
            lambda rise, more: (rise + more) / rise,
            "that is the ratio of the heights; the height grows with the square of the time.",
        ),
        Mistake(
            lambda rise, more: more / rise, "that compares what is added with the old rise; use the new rise."
        ),
        Mistake(
            lambda rise, more: np.sqrt(more / rise), "under the root stands the new rise, h + Δ, not Δ alone."
        ),
        Mistake(
            lambda rise, more: np.sqrt(rise / (rise + more)),
            "that is the inverse: a higher jump takes more time.",
        ),
        Mistake(
            lambda rise, more: 2 * np.sqrt(2 * (rise + more) / 9.81),
            "that is the flight's time in seconds; a ratio of the two times is asked for.",
        ),
    ],
)
