"""Motions: the pose of a skeleton in every frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property, wraps
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Mask, VectorsLike, frozen
from mocap._shared.quantities import check_number, described, numbers_of
from mocap._shared.records import dataclass, rebuilding, same_fields
from mocap._shared.suggestions import missing_attribute
from mocap.body import rotations
from mocap.body.joint_trees import place_joints, velocities
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened

Marks = Mapping[str, NDArray[np.bool_]]
STILL = 1e-9  # of a quaternion's numbers: a joint that rotates by less does not rotate, except for rounding
SAMPLED = 100  # frames, at least, that show most of the joints that rotate
EXPRESSIONS = {
    "position": "motion.positions",
    "velocity": "motion.velocities",
    "frames": "len(motion), the number of frames",
    "names": "motion.skeleton.names",
    "joint_names": "motion.skeleton.names",
    "joints": "motion.skeleton.names",
    "save": "mocap.save(motion, 'walk.bvh')",
    "resample": "mocap.resample(motion, 30)",
}
"""Suggestions for unknown attributes of a motion."""

Resampling = TypeVar("Resampling", bound="Callable[..., Motion]")


@dataclass(frozen=True, eq=False)
class Motion:
    """The pose of a skeleton in F frames at a constant rate.

    Parameters
    ----------
    skeleton : the joints.
    root_positions : shape (F, 3), metres, y up.
    rotations : shape (F, J, 4), unit quaternions (w, x, y, z) relative to the parent's frame.
    fps : frames per second.
    name : the name in errors and figures.
    labels : kinds of motion, as {label: (F,) booleans}, one per frame. A single boolean is for all frames.
    contacts : frames in which a joint is in contact with the ground, as {joint: (F,) booleans}.

    Raises
    ------
    MocapError : for wrong shapes, no frames, numbers that are not finite, or quaternions not of length 1.

    Notes
    -----
    A motion is immutable: `motion.fps = 30` and `motion.root_positions[0] = 0` raise. Instead,
    `dataclasses.replace(motion, fps=30)` returns a new motion. To change an array, copy it, change the copy
    and pass that. Two motions are equal, `==`, if all fields are exactly equal, and then have the same hash.
    To compare within rounding, use `numpy.allclose` on `positions`.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> still = Motion(bone, np.zeros((9, 3)), np.tile([1.0, 0, 0, 0], (9, 2, 1)), 30.0, "still")
    >>> still
    Motion('still', 9 frames at 30 Hz, 0.267 s, 2 joints)
    >>> len(still[2:5]), still[::3].fps, still[:] == still, still[:3] == still
    (3, 10.0, True, False)
    >>> still.positions[0, 1], still.velocities.shape
    (array([0., 1., 0.]), (9, 2, 3))

    Notebook: 01b-motion-files
    """

    skeleton: Skeleton
    root_positions: Array
    rotations: Array
    fps: float
    name: str = "motion"
    labels: Marks = field(default_factory=dict)
    contacts: Marks = field(default_factory=dict)

    if TYPE_CHECKING:  # the types that callers may pass: `__post_init__` converts them to arrays

        def __init__(  # noqa: PLR0913 (the fields)
            self,
            skeleton: Skeleton,
            root_positions: VectorsLike,
            rotations: ArrayLike,
            fps: float,
            name: str = ...,
            labels: Mapping[str, ArrayLike] = ...,
            contacts: Mapping[str, ArrayLike] = ...,
        ) -> None: ...

    else:  # type checkers refuse an unknown attribute by themselves

        def __getattr__(self, name: str) -> object:
            raise missing_attribute(self, name, EXPRESSIONS)

    def __post_init__(self) -> None:
        if not isinstance(self.skeleton, Skeleton):
            needs = (
                "a Motion begins with its Skeleton: mocap.Motion(skeleton, root_positions, rotations, fps)"
            )
            raise MocapError(f"{needs}, got {described(self.skeleton)}.")
        for key, example in (("root_positions", "[[0, 1, 0]]"), ("rotations", "[[[1, 0, 0, 0]]]")):
            numbers = numbers_of(getattr(self, key), key, example)
            object.__setattr__(self, key, frozen(numbers, np.float64))
        check_number(self.fps, "fps")
        object.__setattr__(self, "fps", float(self.fps))
        self._check_numbers()
        for key in ("labels", "contacts"):
            marks = {}
            for name, mark in getattr(self, key).items():
                if np.shape(mark) not in ((), (len(self),)):
                    needs = f"mark '{name}' needs {len(self)} booleans, got shape {np.shape(mark)}"
                    raise MocapError(f"Motion '{self.name}': {needs}.")
                marks[str(name)] = frozen(np.broadcast_to(mark, len(self)), np.bool_)
            object.__setattr__(self, key, marks)
        for joint in self.contacts:
            self.skeleton.index(joint)

    def _check_numbers(self) -> None:
        frames = len(self.root_positions)
        joints = len(self.skeleton)
        if frames == 0:
            raise MocapError(f"Motion '{self.name}' has no frames.")
        if self.root_positions.shape != (frames, 3) or self.rotations.shape != (frames, joints, 4):
            needs = f"{joints} joints needs root positions (F, 3) and rotations (F, {joints}, 4)"
            got = f"{self.root_positions.shape} and {self.rotations.shape}"
            raise MocapError(f"Motion '{self.name}' of {needs}, got {got}.")
        if not (np.isfinite(self.fps) and self.fps > 0):
            raise MocapError(f"Motion '{self.name}' needs a frame rate above 0, got {self.fps}.")
        finite = np.isfinite(self.root_positions).all(-1) & np.isfinite(self.rotations).all((-2, -1))
        if not finite.all():
            raise MocapError(f"Motion '{self.name}' is not finite in frame {int(finite.argmin())}.")
        error = np.abs(np.sqrt(np.einsum("fjk,fjk->fj", self.rotations, self.rotations)) - 1)
        if error.max() > 1e-6:
            frame, joint = np.unravel_index(error.argmax(), error.shape)
            place = f"'{self.name}', frame {frame}, joint '{self.skeleton.names[joint]}'"
            raise MocapError(f"Motion {place}: the quaternion does not have length 1.")

    def __len__(self) -> int:
        return len(self.root_positions)

    def __repr__(self) -> str:
        frames = f"{len(self)} {'frame' if len(self) == 1 else 'frames'} at {self.fps:g} Hz"
        joints = f"{len(self.skeleton)} {'joint' if len(self.skeleton) == 1 else 'joints'}"
        return f"Motion('{shortened(self.name)}', {frames}, {self.duration:.3g} s, {joints})"

    def __eq__(self, other: object) -> bool:  # reads: name: Python's word for it
        return same_fields(self, other) if isinstance(other, Motion) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.name, self.fps, len(self), self.skeleton))

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return rebuilding(self)

    def __getitem__(self, frames: slice | Sequence[int] | NDArray[np.integer[Any]] | Mask) -> Motion:
        """Select frames by a slice, by indices or by a mask. A step of n divides the frame rate by n."""
        _check_frames(self, frames)
        step = (frames.step or 1) if isinstance(frames, slice) else 1
        if step < 1:
            raise MocapError(f"Frames run forwards only; got a step of {step}.")
        labels = {name: mark[frames] for name, mark in self.labels.items()}
        contacts = {name: mark[frames] for name, mark in self.contacts.items()}
        return Motion(
            self.skeleton,
            self.root_positions[frames],
            self.rotations[frames],
            self.fps / step,
            self.name,
            labels,
            contacts,
        )

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) / self.fps

    @cached_property
    def positions(self) -> Array:
        """World positions of the joints, shape (F, J, 3), metres (read-only).

        They are computed by `body.forward_kinematics` on first access, and cached. The cache takes three
        quarters of the memory of the rotations.
        """
        places = place_joints(self.skeleton, self.root_positions, self.rotations).positions
        return frozen(places, np.float64)

    @property
    def velocities(self) -> Array:
        """Velocities of the joints in the world, shape (F, J, 3), metres per second.

        Central differences of `positions`, one-sided at both ends, and computed on each access.

        Raises
        ------
        MocapError : for a motion of one frame.
        """
        return velocities(self.positions, self.fps)

    # reads: name: public, and promised to those who call it
    def at(self, frames: ArrayLike) -> Motion:
        """Interpolate the motion at fractional frames (N,): roots linearly, rotations by slerp.

        Frames are clamped to the ends of the motion. Labels and contacts are those of the nearest frame.

        Examples
        --------
        >>> bone = Skeleton(["root"], [-1], [[0, 0, 0]])
        >>> slide = Motion(bone, [[0, 0, 0], [1, 0, 0]], np.tile([1.0, 0, 0, 0], (2, 1, 1)), 1.0)
        >>> slide.at([0, 0.25, 7]).root_positions[:, 0]
        array([0.  , 0.25, 1.  ])
        """
        frames = np.clip(numbers_of(frames, "at", "[0, 2.5]"), 0, len(self) - 1)
        floor = frames.astype(int)
        ceiling = np.minimum(floor + 1, len(self) - 1)
        fraction = (frames - floor)[:, None]
        nearest = np.where(fraction[:, 0] < 0.5, floor, ceiling)
        start = self.root_positions[floor]
        end = self.root_positions[ceiling]
        sampled = rotations.slerp(self.rotations[floor], self.rotations[ceiling], fraction)
        return replace(self[nearest], root_positions=start + fraction * (end - start), rotations=sampled)


def _check_frames(motion: Motion, frames: object) -> None:
    """Raise for indices that are not frames: a single number, a key, or seconds."""
    if isinstance(frames, int | np.integer):
        stretch = f"motion[{frames}:{frames + 1}]" if frames >= 0 else f"motion[{frames}:][:1]"
        raise MocapError(f"One frame is {stretch}, or motion.positions[{frames}] for its joints.")
    if isinstance(frames, str):
        raise MocapError(f"Frames are numbers such as motion[10:20], got {described(frames)}.")
    parts = (frames.start, frames.stop, frames.step) if isinstance(frames, slice) else (frames,)
    for part in parts:
        if isinstance(part, float):
            seconds = f"{part:g} s are frame {round(part * motion.fps)}, round({part:g} * motion.fps)"
            raise MocapError(f"Frames are whole numbers, got {part:g}: {seconds}.")


def require_motion(motion: object) -> Motion:
    """Return a motion as it is. Raise for anything else, with the call that makes a motion of it.

    Raises
    ------
    MocapError : for a path, a list, a skeleton, a result that holds a motion, and other values.

    Examples
    --------
    >>> require_motion("walk.bvh")
    Traceback (most recent call last):
    mocap.errors.MocapError: This takes a motion, got the text 'walk.bvh': write mocap.load('walk.bvh').
    """
    if isinstance(motion, Motion):
        return motion
    needs = f"This takes a motion, got {described(motion)}"
    if isinstance(motion, str | PathLike):
        raise MocapError(f"{needs}: write mocap.load({shortened(repr(str(motion)), 60)}).")
    if isinstance(motion, list | tuple) and any(isinstance(part, Motion) for part in motion):
        raise MocapError(f"{needs}: pass one of them, such as clips[0], or call it for each.")
    if isinstance(getattr(motion, "motion", None), Motion):
        raise MocapError(f"{needs}: pass its motion, result.motion.")
    if isinstance(motion, Skeleton):
        raise MocapError(f"{needs}, which is a body without poses: mocap.load reads motions.")
    raise MocapError(f"{needs}: mocap.load reads one from a file.")


def require_motions(motions: object) -> tuple[Motion, ...]:
    """Return motions as a tuple. Raise for a single one, for paths, and for other values.

    Examples
    --------
    >>> require_motions(["walk.bvh"])
    Traceback (most recent call last):
    mocap.errors.MocapError: This takes a motion, got the text 'walk.bvh': write mocap.load('walk.bvh').
    """
    if isinstance(motions, Motion):
        raise MocapError("This takes a list of motions, got one: write [motion], in brackets.")
    if isinstance(motions, str | PathLike):
        load = f"[mocap.load({shortened(repr(str(motions)), 60)})]"
        raise MocapError(f"This takes a list of motions, got {described(motions)}: write {load}.")
    if not isinstance(motions, Iterable):
        raise MocapError(f"This takes a list of motions, got {described(motions)}: write [first, second].")
    return tuple(require_motion(motion) for motion in motions)


def rotating_joints(motion: Motion) -> NDArray[np.bool_]:
    """Find the joints that rotate relative to their parents in any frame, beyond rounding: booleans (J,).

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> [walk.skeleton.names[joint] for joint in np.flatnonzero(~rotating_joints(walk))][:3]
    ['lhipjoint', 'ltoes_end', 'rhipjoint']
    """
    step = max(1, len(motion) // SAMPLED)
    rotating = _rotate(motion.rotations[::step])
    rest = np.flatnonzero(~rotating)  # of a long clip, only these are looked at in all frames
    rotating[rest] = _rotate(motion.rotations[:, rest])
    return rotating


def _rotate(local: Array) -> Mask:
    """Return whether each joint rotates in any frame, (J,), of local rotations (F, J, 4)."""
    return np.asarray(np.abs(np.abs(local) - rotations.IDENTITY).max(axis=(0, 2)) > STILL)


def _of_motion_and_rate(resampling: Resampling) -> Resampling:
    """Add checks of the arguments, so that `resample`, which a notebook shows, is the method alone."""

    @wraps(resampling)
    def checking(motion: Motion, fps: float) -> Motion:
        require_motion(motion)
        check_number(fps, "fps")
        return resampling(motion, fps)

    return cast(Resampling, checking)  # type checkers see the names of the parameters


@_of_motion_and_rate
def resample(motion: Motion, fps: float) -> Motion:
    """Resample a motion to another frame rate, by `Motion.at`.

    Parameters
    ----------
    motion : F frames.
    fps : the new rate. If the motion already has it, the motion is returned as it is.

    Returns
    -------
    floor(duration · fps) + 1 frames, the first one unchanged.

    Examples
    --------
    >>> bone = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> slide = Motion(bone, [[0, 0, 0], [1, 0, 0]], np.tile([1.0, 0, 0, 0], (2, 1, 1)), 1.0)
    >>> resample(slide, 4.0).root_positions[:, 0]
    array([0.  , 0.25, 0.5 , 0.75, 1.  ])

    Notebook: 01b-motion-files
    """
    if not (np.isfinite(fps) and fps > 0):
        raise MocapError(f"A frame rate must be above 0, got {fps}.")
    if fps == motion.fps:
        return motion
    count = int(motion.duration * fps + 1e-9) + 1
    return replace(motion.at(np.arange(count) * (motion.fps / fps)), fps=fps)
