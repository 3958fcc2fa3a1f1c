"""How far does a foot that stands slide over the ground? One measure for seams, motions and characters."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, find_legs
from mocap.body.motion import Motion
from mocap.errors import MocapError


class PlantSlide(NamedTuple):
    """How far a joint is from its mean place over the ground in one plant, at most, in centimetres.

    The plant is from frame `start` to just before frame `stop`.
    """

    joint: str
    start: int
    stop: int
    far: float


def plant_slides(
    motion: Motion, joints: Sequence[int] | None = None, *, positions: Array | None = None
) -> list[PlantSlide]:
    """Measure how far each planted joint strays from its mean place on the ground, once per plant.

    Parameters
    ----------
    motion : F frames, with contacts for the joints.
    joints : which joints; by default all that have contacts.
    positions : those of all joints, shape (F, J, 3), metres, if they are known already.

    Raises
    ------
    MocapError : for a joint of which the motion does not say when it stands.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> slides = plant_slides(sample("walk_straight"))
    >>> len(slides) > 20, max(slide.far for slide in slides) < 1e-6
    (True, True)

    Notebook: 18-motion-matching
    """
    places = (joint_positions(motion) if positions is None else positions)[..., [0, 2]]
    slides = []
    for name, stands in _plant_marks(motion, joints).items():
        for start, stop in runs(stands):
            stood = places[start:stop, motion.skeleton.index(name)]
            far = np.linalg.norm(stood - stood.mean(axis=0), axis=-1).max()
            slides.append(PlantSlide(name, start, stop, 100 * float(far)))
    return slides


def mean_slide(slides: Iterable[PlantSlide]) -> float:
    """Average how far plants slide, cm; 0 if there are none.

    Examples
    --------
    >>> mean_slide([PlantSlide("lfoot", 3, 9, 1.5), PlantSlide("lfoot", 30, 39, 0.5)]), mean_slide([])
    (1.0, 0.0)
    """
    far = [slide.far for slide in slides]
    return float(np.mean(far)) if far else 0.0


def ground_slides(motion: Motion) -> Array:
    """Measure how far planted joints slide over the ground, cm.

    Parameters
    ----------
    motion : F frames; its `contacts` say when the legs' ankles and balls stand.

    Returns
    -------
    Shape (F - 1, joints): the step of each ankle and ball from each frame to the next where the joint is
    planted in both, else 0. Its sum is how far all of them slide.

    Raises
    ------
    MocapError : for legs that cannot be found, and feet without contacts.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> bool(ground_slides(walk).max() < 1e-6)  # in the bundled clips planted feet stand still
    True
    """
    feet = feet_of(find_legs(motion.skeleton))
    stands = np.stack(list(_plant_marks(motion, feet).values()), axis=-1)
    steps = np.linalg.norm(np.diff(joint_positions(motion)[:, feet][..., [0, 2]], axis=0), axis=-1)
    return np.asarray(100 * steps * (stands[1:] & stands[:-1]))


def _plant_marks(motion: Motion, joints: Sequence[int] | None) -> dict[str, Mask]:
    """Give the marks (F,) of when joints stand, by name; of all that have marks by default."""
    names = motion.contacts if joints is None else [motion.skeleton.names[joint] for joint in joints]
    if missing := [name for name in names if name not in motion.contacts]:
        raise MocapError(f"'{motion.name}' does not say when '{missing[0]}' stands; mark_plants finds out.")
    return {name: motion.contacts[name] for name in names}


def feet_of(legs: Sequence[Leg]) -> list[int]:
    """List the legs' ankles and balls."""
    return [joint for leg in legs for joint in leg[2:]]
