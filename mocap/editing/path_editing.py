"""Edit the path of a motion [Gle01].

A displacement of the root's curve alone leaves the heading and the steps as they were. Therefore the motion
is taken relative to a frame that moves along its path, and put into the frame that moves along another path.
The feet slide where the path bends; `feet.clean_up` removes that.
"""

from dataclasses import field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse
from scipy.sparse.linalg import spsolve

from mocap._shared.arrays import Array, Points
from mocap._shared.records import dataclass
from mocap.body.ground_path import CLOSEST, GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, from_ground, on_ground
from mocap.editing.displacements import spline_basis
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError, warn

CHORD_POINTS = np.linspace(-1, 1, 9)  # on the chord of a frame, times half its length
RIDGE = 1e-12  # of the largest diagonal: for clips of fewer frames than control points
SHORTER = 0.5  # times the length of the motion's own path: steps on a shorter path are doubted
LONGER = 2.0  # times that length: steps on a longer path are doubted


@dataclass(frozen=True, eq=False)
class Ride:
    """The path of a motion, and the metres along it in each of F frames; `ride_of` shows an example.

    Parameters
    ----------
    path : the path on the ground.
    along : shape (F,), metres along the path.
    handles : shape (K, 2), the control points of the path, (x, z) in metres; (0, 2) if it has none.

    Examples
    --------
    >>> handles = np.array([[0, -2], [0, 0], [0, 2], [0, 4], [0, 6]])
    >>> ride = Ride(GroundPath([[0, 0], [0, 4]]), np.arange(5.0), handles)
    >>> Ride(ride.path, ride.along).handles.shape
    (0, 2)
    >>> ride.with_handles(handles + [[0, 0], [0, 0], [3, 0], [0, 0], [0, 0]]).points.round(2).T.tolist()
    [[0.5, 1.44, 2.0, 1.44, 0.5], [0.0, 1.0, 2.0, 3.0, 4.0]]
    """

    path: GroundPath
    along: Array
    handles: Array = field(default_factory=lambda: np.zeros((0, 2)))

    def with_handles(self, handles: ArrayLike) -> GroundPath:
        """Return the path with other control points (K, 2); each moves it within two knots on both sides."""
        new = np.asarray(handles, float)
        if new.shape != self.handles.shape or not np.isfinite(new).all():
            raise MocapError(f"The path has {len(self.handles)} handles (x, z), got an array {new.shape}.")
        frames = len(self.along)
        return GroundPath(spline_basis(frames, max(frames - 1, 1) / (len(new) - 3)) @ new)


def ride_of(motion: Motion, *, stride: float = TUNED.path_knots) -> Ride:
    """Fit a path to a motion: a least-squares cubic B-spline through the root's ground track [Gle01, 3].

    P(t) = B(t) c with c = argmin ‖B c - g‖², g the track. The position of a frame on the path is an arc
    length. The time between knots is ours: the paper leaves it to the user.

    Parameters
    ----------
    motion : F frames.
    stride : seconds between the knots of the spline.

    Returns
    -------
    The path, the metres along it in each frame, and its control points, which are handles to drag.

    Raises
    ------
    MocapError : for a motion that does not travel, and a stride that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> ride = ride_of(sample("walk_straight"))
    >>> ride.path, ride.handles.shape
    (GroundPath(1158 points, 12.5 m), (13, 2))

    Notebook: 12-path-editing
    """
    basis = spline_basis(len(motion), stride * motion.fps)
    track = motion.root_positions[:, [0, 2]]
    middle = track.mean(axis=0)
    normal = (basis.T @ basis).tocsc()
    ridge = RIDGE * normal.diagonal().max() * sparse.eye_array(normal.shape[0])
    handles = spsolve(normal + ridge, basis.T @ (track - middle)) + middle
    smooth = basis @ handles
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(smooth, axis=0).T))])
    if along[-1] < TUNED.shortest_path:
        raise MocapError(f"'{motion.name}' goes {along[-1]:.2f} m only: it stands; there is no path to edit.")
    return Ride(GroundPath(smooth), along, handles)


def moving_frames(path: GroundPath, along: ArrayLike, *, chord: float = TUNED.chord) -> PlanarTransform:
    """Compute the frames N(s) that move along a path: their origin is P(s), their heading that of the path.

    The heading is that of the chord from P(s - `chord`) to P(s + `chord`), unwrapped, and the position is a
    mean over the same chord. Both are ours: [Gle01] takes the tangent, which jumps at a corner and spins
    where the body stands. Beyond its ends the path is a straight line.

    Parameters
    ----------
    path : the path.
    along : shape (F,), metres along it.
    chord : metres before and after.

    Returns
    -------
    A transform of arrays (F,), which maps the origin to P(s) and +z to the heading.

    Raises
    ------
    MocapError : for a chord that is not above 0.

    Examples
    --------
    >>> corner = GroundPath([[0, 0], [0, 2], [2, 2]])
    >>> frames = moving_frames(corner, [-1.0, 1.75, 2.0, 2.1, 4.0, 5.0])  # m; 1 m beyond both ends, too
    >>> np.degrees(frames.angle).round().tolist(), frames.x.round(3).tolist()
    ([0.0, 0.0, 45.0, 67.0, 90.0, 90.0], [0.0, 0.0, 0.021, 0.096, 2.0, 3.0])
    >>> back = moving_frames(GroundPath([[0, 0], [0, 2], [0, 0]]), [-1.0, 1.0, 2.0, 3.0])
    >>> np.degrees(back.angle).round().tolist(), back.z.round(3).tolist()
    ([0.0, 0.0, 90.0, 180.0], [-1.0, 1.0, 1.959, 1.0])
    >>> small = GroundPath([[0, 0], [0, 0.1], [0.1, 0], [0, 0]])  # back to where it starts, and on to -x
    >>> beyond = moving_frames(small, [-2.0, 2.34], chord=0.5)
    >>> (beyond.x.round(2) + 0.0).tolist(), (beyond.z.round(2) + 0.0).tolist()
    ([0.0, -2.0], [-2.0, 0.0])

    Notebook: 12-path-editing
    """
    if not (np.isfinite(chord) and chord > 0):
        raise MocapError(f"A chord reaches more than 0 m before and after, got chord={chord}.")
    along = np.asarray(along, float)
    first, last = _end_directions(path, chord)
    metres = along + chord * CHORD_POINTS[:, None]
    before_start = np.minimum(metres, 0)
    after_end = np.maximum(metres - path.length, 0)
    points = on_ground(path.at(metres)) + (before_start * first + after_end * last)
    position = _position_weights() @ points
    across = points[-1] - points[0]
    defined = np.abs(across) > CLOSEST  # not where the path comes back on itself
    angle = np.zeros(len(along))
    if defined.any():
        frames = np.arange(len(along))
        angle = np.interp(frames, frames[defined], np.unwrap(np.angle(across[defined])))
    return PlanarTransform(angle, position.imag, position.real)


def _position_weights() -> Array:
    """Compute the weights of the points on a chord, of which the position of a frame is the mean, (9,).

    Where a body stood, its path curls within a centimetre, which the mean removes. The weights are those of a
    Gaussian, corrected so that the mean of a parabola is on the parabola: bends are not cut.
    """
    weights = np.exp(-0.5 * (CHORD_POINTS / TUNED.chord_blur) ** 2)
    weights *= 1 - CHORD_POINTS**2 * (weights @ CHORD_POINTS**2) / (weights @ CHORD_POINTS**4)
    return np.asarray(weights / weights.sum())


def _end_directions(path: GroundPath, chord: float) -> Points:
    """Compute the directions of a path before its start and beyond its end, on the unit circle (2,).

    They are those of the chords there, or of the first and the last step if a chord has no length.
    """
    chord_ends = np.clip([chord, path.length - chord], 0, path.length)
    after_start, before_end = on_ground(path.at(chord_ends))
    start, second, next_to_last, end = on_ground(path.points[[0, 1, -2, -1]])
    chords = np.array([after_start - start, end - before_end])
    steps = np.array([second - start, end - next_to_last])
    directions = np.where(np.abs(chords) > CLOSEST, chords, steps)
    return np.asarray(directions / np.abs(directions))


def start_at(path: GroundPath, ride: Ride) -> GroundPath:
    """Move a path so that its start has the position and the heading of the start of a motion's own path.

    Parameters
    ----------
    path : the path to move.
    ride : of the motion.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> ride = ride_of(sample("walk_straight"))
    >>> moved = start_at(GroundPath([[5, 5], [5, 9]]), ride)
    >>> bool(abs(moved.points[0] - ride.path.points[0]).max() < 1e-3), moved
    (True, GroundPath(2 points, 4.0 m))

    Notebook: 12-path-editing
    """
    old, new = (moving_frames(line, [0.0]) for line in (ride.path, path))
    moved = old @ new.inverse()
    return GroundPath(from_ground(moved.rotation * on_ground(path.points) + moved.translation))


def on_path(
    motion: Motion, path: GroundPath, ride: Ride | None = None, *, keep: Literal["speed", "ends"] = "speed"
) -> Motion:
    """Put a motion on another path: m'_f = N'(s'_f) N(s_f)⁻¹ m_f [Gle01, 4; arc length].

    N moves along the motion's own path, N' along the new one. The feet slide by about 7 cm divided by the
    radius of the bend in metres; `feet.clean_up` gives each footplant the mean of its positions. Speed and
    lean are not changed; `bend` also slows the walk down and leans it.

    Parameters
    ----------
    motion : F frames; mark and clean its footplants first, because bent feet do not look planted.
    path : the new path; `start_at` moves it to the start of the motion.
    ride : of the motion; `ride_of(motion)` by default.
    keep : "speed" for s' = s: the end of a longer path is not walked, and beyond a shorter one the motion
        continues straight ahead. "ends" for s' = s L'/L: the steps become longer or shorter.

    Returns
    -------
    The same frames, labels and contacts; only the root differs.

    Raises
    ------
    MocapError : for a motion that does not travel, a ride of another motion, and another value of `keep`.

    Warns
    -----
    MocapWarning : with "ends", for a path shorter than half or longer than twice the motion's own.

    Examples
    --------
    >>> from mocap.body import circle
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> ride = ride_of(walk)
    >>> bent = on_path(walk, start_at(circle(2.0), ride), ride)
    >>> bool(np.ptp(bent.root_positions[:, 0]) > 3.8)
    True
    >>> shorter = on_path(walk, GroundPath([[0, 0], [0, 8]]), ride, keep="ends").root_positions
    >>> float((shorter[-1, 2] - shorter[0, 2]).round(1))  # metres, in steps two thirds as long
    8.0

    Notebook: 12-path-editing
    """
    ride = ride or ride_of(motion)
    if len(ride.along) != len(motion):
        raise MocapError(f"The ride has {len(ride.along)} frames, '{motion.name}' has {len(motion)}.")
    if keep not in ("speed", "ends"):
        raise MocapError(f"A motion keeps its 'speed' or the path's 'ends', got keep={keep!r}.")
    scale = path.length / ride.path.length if keep == "ends" else 1.0
    old = moving_frames(ride.path, ride.along)
    new = moving_frames(path, scale * ride.along)
    if not SHORTER <= scale <= LONGER:
        warn(f"'{motion.name}' takes steps {scale:.2f} times as long on this path: plants are let go.")
    return (new @ old.inverse()).apply_motion(motion)


def plants_kept(cleaned: Motion, bent: Motion) -> float:
    """Compute the fraction of planted frames, of all joints, that a clean-up keeps; 1 if there are none.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> plants_kept(walk, walk), plants_kept(replace(walk, contacts={}), walk)
    (1.0, 0.0)
    >>> plants_kept(walk, replace(walk, contacts={}))
    1.0

    Notebook: 12-path-editing
    """
    planted = sum(int(mark.sum()) for mark in bent.contacts.values())
    kept = sum(int(mark.sum()) for mark in cleaned.contacts.values())
    return kept / planted if planted else 1.0
