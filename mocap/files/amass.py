"""AMASS archives (`.npz`): poses of the SMPL body as rotation vectors, in metres, with z up [AMASS19].

An archive holds `poses` (F, 66 or more), `trans` (F, 3), a frame rate, and numbers of the body's shape,
`betas`. The surface that the shape belongs to comes under a licence of its own and is not here: all archives
are read onto one body of 22 joints, the mean one. Fingers, face and soft tissue, the numbers after the first
66 of a pose, are left out.
"""

from __future__ import annotations

import tomllib
import warnings
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mocap._shared.archives import Arrays, open_arrays
from mocap._shared.arrays import Array
from mocap._shared.atomic import replacing
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, MocapWarning, shortened

_JOINTS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("smpl.toml").read_text("utf-8"))
SKELETON = replace(Skeleton.from_table(_JOINTS), dofs=["xyz"] * len(_JOINTS))
PELVIS = np.array([0.0, -0.223, 0.028])  # where `trans` 0 puts the pelvis, in the archive's own axes
UPRIGHT = rotations.from_rotvec([-np.pi / 2, 0, 0])  # from z up to y up

WIDTH = 3 * len(SKELETON)  # numbers of a pose that are read
RATES = ("mocap_framerate", "mocap_frame_rate")
MOST = 2**31  # bytes of one array: a day at 120 Hz has fewer


def is_amass(path: str | Path) -> bool:
    """Check, by the names of its arrays, whether an `.npz` file is such an archive.

    Examples
    --------
    >>> is_amass("graph.npz")
    False
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return {"poses.npy", "trans.npy"} <= set(archive.namelist())
    except (OSError, zipfile.BadZipFile):
        return False


def read(path: str | Path, *, fps: float | None = None) -> Motion:
    """Read an archive.

    Parameters
    ----------
    path : the file. No code in it is run: arrays of objects are refused.
    fps : frames per second, which replace those of the file; needed where it has none.

    Returns
    -------
    A motion of `SKELETON`, named after the file, y up.

    Raises
    ------
    MocapError, FormatError : for a file that cannot be read, and for arrays that are missing, of another
        shape, or not finite.

    Warns
    -----
    MocapWarning : where the file gives the body a shape.
    """
    if zipfile.is_zipfile(path):
        with zipfile.ZipFile(path) as archive:
            large = [entry.filename for entry in archive.infolist() if entry.file_size > MOST]
        if large:
            raise FormatError(path, None, f"arrays below {MOST / 1e9:.1f} GB", f"a larger '{large[0]}'")
    keys = ("poses", "trans", "betas", *RATES)
    arrays = open_arrays(path, "an AMASS archive with poses and trans", keys)
    poses, trans = _checked(path, arrays, "poses", WIDTH), _checked(path, arrays, "trans", 3)
    if len(poses) == 0:
        raise FormatError(path, None, "one frame or more in 'poses'", "none")
    if len(poses) != len(trans):
        raise FormatError(path, None, f"as many rows of trans as of poses, {len(poses)}", str(len(trans)))
    betas = arrays.get("betas", np.zeros(1))
    if betas.dtype.kind in "fiu" and np.any(betas):
        warnings.warn(
            f"{path}: betas, the shape of the body, are ignored: the bones are those of the mean body, so "
            "feet may stand some centimetres above or below the ground.",
            MocapWarning,
            stacklevel=4,
        )
    local = rotations.from_rotvec(poses[:, :WIDTH].reshape(len(poses), -1, 3))
    local[:, 0] = rotations.multiply(UPRIGHT, local[:, 0])
    roots = rotations.rotate(UPRIGHT, PELVIS + trans[:, :3])
    return Motion(SKELETON, roots, local, fps or _rate(path, arrays), Path(path).stem)


def _checked(path: str | Path, arrays: Arrays, key: str, width: int) -> Array:
    """Give an array of rows of at least `width` numbers, all finite."""
    if key not in arrays:
        raise FormatError(path, None, "arrays 'poses' and 'trans', as AMASS archives have", f"no '{key}'")
    values = arrays[key]
    if values.ndim != 2 or values.shape[1] < width or values.dtype.kind not in "fiu":
        raise FormatError(
            path, None, f"{width} numbers for each frame in '{key}'", f"{values.dtype}{values.shape}"
        )
    fine = np.isfinite(values).all(axis=1) & (np.abs(values) < 1e6).all(axis=1)
    if not fine.all():
        frame = int(fine.argmin())
        raise FormatError(path, None, f"finite numbers below 1e6 in '{key}'", f"others in frame {frame}")
    return values.astype(float)


def _rate(path: str | Path, arrays: Arrays) -> float:
    key = next((key for key in RATES if key in arrays), None)
    if key is None:
        raise FormatError(path, None, f"'{RATES[0]}'", "none: give fps=")
    rate = arrays[key]
    if rate.size != 1 or rate.dtype.kind not in "fiu" or not 0 < rate.item() < 1e6:
        got = str(rate.item()) if rate.size == 1 else f"{rate.dtype}{rate.shape}"
        raise FormatError(path, None, f"one number above 0 in '{key}'", got)
    return float(rate.item())


def write(motion: Motion, path: str | Path) -> None:
    """Write an archive, with a body of mean shape and fingers at rest.

    Parameters
    ----------
    motion : F frames of a skeleton with the joints of `SKELETON`, of any size: the archive holds no bones.
    path : the file; one that exists is replaced when the new one is whole.

    Raises
    ------
    MocapError : for another skeleton: retarget the motion first.
    """
    ours = motion.skeleton
    if ours.names != SKELETON.names or not np.array_equal(ours.parents, SKELETON.parents):
        name = shortened(motion.name)
        raise MocapError(
            f"An .npz holds the {len(SKELETON)} joints of SMPL; '{name}' has others: write .bvh."
        )
    back = rotations.inverse(UPRIGHT)
    turned = motion.rotations.copy()
    turned[:, 0] = rotations.multiply(back, turned[:, 0])
    poses = np.zeros((len(motion), 156))
    poses[:, :WIDTH] = rotations.to_rotvec(turned).reshape(len(motion), -1)
    trans = rotations.rotate(back, motion.root_positions) - PELVIS
    with replacing(path) as beside, beside.open("wb") as file:
        np.savez_compressed(
            file, poses=poses, trans=trans, betas=np.zeros(16), gender="neutral", mocap_framerate=motion.fps
        )
