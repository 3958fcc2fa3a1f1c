"""What does a blend change? The jolt that it adds to those of its two clips, sliding feet, turning knees.

A jolt is the change of velocity from one frame to the next, |x_{f+1} - 2 x_f + x_{f-1}| · fps in metres per
second, the RMS over the joints. Clips have jolts of their own: a foot that touches the ground stops. So the
jolts of a result, as `seam_measures.jumps` gives them, do not say what the blend did. `blend_jolts` compares
each frame of the result with the same frames of both clips.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, legs_of
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud
from mocap.quality.standing_feet import feet_of, plant_marks


class BlendJolts(NamedTuple):
    """Jolts at a seam, frame by frame from the one before the window to the one after it, m/s.

    result : of the blend.
    first, second : of the two clips at these frames.
    added : |ẍ_result - (α ẍ_first + (1 - α) ẍ_second)| / fps, with the weights α: what the blend itself adds.

    Examples
    --------
    >>> quiet = BlendJolts(*np.array([[0.1, 0.4], [0.3, 0.5], [0.2, 0.2], [0.0, 0.1]]))
    >>> quiet.own, quiet.stands_out
    (0.5, False)
    """

    result: Array
    first: Array
    second: Array
    added: Array

    @property
    def own(self) -> float:
        """The largest jolt that either clip has at these frames by itself."""
        return float(max(self.first.max(), self.second.max()))

    @property
    def stands_out(self) -> bool:
        """Whether the result has a larger jolt than both clips have at these frames."""
        return bool(self.result.max() > self.own)


def blend_jolts(result: Motion, first: Motion, second: Motion, start: int, weights: ArrayLike) -> BlendJolts:
    """Compare the jolts of a blend with those of its two clips, all on one clock.

    Parameters
    ----------
    result, first, second : F frames each; frame f of the result was made of frame f of both clips. The second
        is aligned with the first, as `blending.lay_window_on` does.
    start : the first frame of the window.
    weights : those of the first clip in the window, shape (window,); before it they are 1, after it 0. For
        `blending.inertialize`, which plays only the second clip from the first frame on, give zeros.

    Returns
    -------
    Jolts at window + 2 frames; fewer where the window starts or ends with the motion.

    Raises
    ------
    SkeletonMismatch, MocapError : for motions that do not go together, and a window that runs off them.

    Examples
    --------
    >>> from mocap.blending import cubic_weights, join, lay_window_on
    >>> from mocap.datasets.generated import generate
    >>> walk = generate("walk_straight")
    >>> for window in (10, 40):
    ...     first, second = walk[490:560], lay_window_on(walk, 500, walk, 233, window)[223:293]
    ...     result = join(walk, 500, walk, 233, window)[490:560]
    ...     print(round(blend_jolts(result, first, second, 10, cubic_weights(window)).added.max(), 2))
    0.28
    0.03

    Notebook: 04-blending
    """
    inside = np.asarray(weights, float)
    _check(result, first, second, start, len(inside))
    alpha = np.concatenate([np.ones(start), inside, np.zeros(len(result) - start - len(inside))])
    frames = slice(max(start - 2, 0), start + len(inside) + 2)
    changes = [np.diff(point_cloud(motion[frames]), 2, axis=0) for motion in (result, first, second)]
    share = alpha[frames][1:-1, None, None]
    added = changes[0] - share * changes[1] - (1 - share) * changes[2]
    return BlendJolts(*(_rms(change) * result.fps for change in (*changes, added)))


def _check(result: Motion, first: Motion, second: Motion, start: int, window: int) -> None:
    """Raise unless the motions have one length and the window is in them."""
    require_alike([result, first, second])
    if not len(result) == len(first) == len(second):
        lengths = f"{len(first)}, {len(second)} and {len(result)}"
        raise MocapError(f"Two clips and their blend must have as many frames; these have {lengths}.")
    if len(result) < 3 or window < 1 or start < 0 or start + window > len(result):
        raise MocapError(
            f"'{result.name}' has {len(result)} frames, and no window of {window} from frame {start}."
        )


def _rms(vectors: Array) -> Array:
    """Take the RMS length of vectors (F, P, 3) in each frame, shape (F,)."""
    return np.asarray(np.sqrt((vectors**2).sum(axis=-1).mean(axis=-1)))


def added_jolt(result: Motion, first: Motion, second: Motion, start: int, weights: ArrayLike) -> float:
    """Measure the largest jolt that a blend adds to those of its clips, m/s.

    Parameters
    ----------
    result, first, second, start, weights : as for `blend_jolts`.

    Examples
    --------
    A blend of a clip with itself adds nothing:

    >>> from mocap.datasets.generated import generate
    >>> walk = generate("walk_straight")[:60]
    >>> added_jolt(walk, walk, walk, 20, np.linspace(1, 0, 10)) < 1e-12
    True
    """
    return float(blend_jolts(result, first, second, start, weights).added.max())


def ground_slides(motion: Motion, legs: Sequence[Leg] | None = None) -> Array:
    """Measure how far planted joints slide over the ground, cm.

    Parameters
    ----------
    motion : F frames; its `contacts` say when the legs' ankles and balls stand.
    legs : found by name by default.

    Returns
    -------
    Shape (F - 1, joints): the step of each ankle and ball from each frame to the next where the joint is
    planted in both, else 0. Its sum is how far all of them slide.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> bool(ground_slides(walk).sum() < 1e-6)  # in the bundled clips planted feet stand still
    True

    Notebook: 09b-blend-window
    """
    feet = feet_of(legs_of(motion.skeleton, legs))
    stands = np.stack(list(plant_marks(motion, feet).values()), axis=-1)
    steps = np.linalg.norm(np.diff(joint_positions(motion)[:, feet][..., [0, 2]], axis=0), axis=-1)
    return np.asarray(100 * steps * (stands[1:] & stands[:-1]))


def knee_turns(motion: Motion, legs: Sequence[Leg] | None = None) -> Array:
    """Measure how far each knee turns from one frame to the next, degrees, shape (F - 1, legs).

    A leg's bones are rigid, so its length says nothing about a knee that snaps; how fast the knee turns does.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> knee_turns(walk).shape, bool(knee_turns(walk).max() < 5)  # at 120 Hz
    ((1200, 2), True)

    Notebook: 09b-blend-window
    """
    knees = [leg.knee for leg in legs_of(motion.skeleton, legs)]
    turned = motion.rotations[:, knees]
    return np.asarray(np.degrees(rotations.angle_between(turned[1:], turned[:-1])))
