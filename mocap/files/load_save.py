"""Reading and writing of motions. The suffix of a file determines its format."""

import math
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path

from mocap._shared.arrays import Array
from mocap._shared.atomic import write_file
from mocap._shared.quantities import check_number, described
from mocap.body.limbs import with_roles
from mocap.body.motion import Motion, require_motion, require_motions, rotating_joints
from mocap.errors import MocapError, warn
from mocap.files import bvh, formats, gltf, motion_archives, position_tables, spaces
from mocap.files.read_options import ReadOptions
from mocap.files.recordings import Recording
from mocap.files.role_maps import read_roles
from mocap.files.text import check_above_0, read_text
from mocap.files.tuned import TUNED

PARAMETERS = {name: f"{name}=" for name in ("scale", "up", "root_offset", "body")}  # of `load`, in notices


def load(  # noqa: PLR0913 (each by its name)
    path: str | Path,
    *,
    skeleton: str | Path | None = None,
    fps: float | None = None,
    scale: float | None = None,
    stretch: float = TUNED.stretch,
    up: str | None = None,
    root_offset: str | None = None,
    body: int | None = None,
    roles: Mapping[str, str] | str | Path | None = None,
) -> Motion:
    """Read a motion from a file, in one of the formats of `files.formats.READ`.

    Parameters
    ----------
    path : the file. Upper and lower case in its suffix are equivalent.
    skeleton : for `.amc`, the `.asf` file of its skeleton. By default a matching one in the same folder: that
        of the same name, else of the name up to the first `_` (`16.asf` for `16_15.amc`), else the only one.
    fps : frames per second, which replace those of the file. An `.amc` file has none, and the default is
        120, as in most of the CMU database.
    scale : metres in one unit of the file. By default that of the skeleton for `.amc`, 1 for `.npz`, and for
        `.bvh` the one that the frames show, from the size and the pace of the body: 0.01 if they do not.
    stretch : the largest change of the lengths of bones in a `.bvh` file, by default 0.02 metres. Up to this,
        rigid bones are fitted, with a warning that reports the error of joint positions. `math.inf` accepts
        any change.
    up : the axis of the file that points up: "y", "z", "-y", "-z", "x" or "-x". By default the one that the
        frames show, from the standing feet: y for `.bvh` and z for AMASS if they do not. An `.amc` always has
        y up. The motion is rotated so that y is up.
    root_offset : "add" if the positions of the root in a `.bvh` file are relative to its OFFSET, as some
        programs write them, or "ignore" if they replace it. By default it is added if the body is on the
        floor only then.
    body : the number of the body in a `.bvh` file of several bodies, from 1. By default the first, with a
        warning.
    roles : names of joints by role, such as {"left hip": "thigh_l"}, or a TOML file of them, as printed by
        `mocap info FILE --joints`. By default limbs are identified by their names, or by their motion.

    Returns
    -------
    The motion, named after the file. One that `save` wrote to an `.npz` file is as it was saved, with its
    name, labels, contacts and roles.

    Raises
    ------
    MocapError : for a file that is missing or has another format, if no skeleton matches, and for an option
        that does not apply to the format, such as `up` to `.amc`.
    FormatError : for a file that breaks its format, with the line.

    Warns
    -----
    MocapWarning : if the file is read in another unit or with another axis up than most of its format are, or
        if these are in doubt. Also if the legs have unknown names, and the motion leaves them in doubt.

    Examples
    --------
    >>> load("walk.fbx")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot read walk.fbx: in Blender, import it and export Motion Capture ...

    Notebook: 01b-motion-files
    """
    require_path(path)
    if Path(path).is_dir():
        loop = "[mocap.load(file) for file in Path(folder).glob('*.bvh')]"
        raise MocapError(f"Cannot read {path}: Is a directory; its files are loaded by {loop}.")
    for name, number in {"fps": fps, "scale": scale, "stretch": stretch, "body": body}.items():
        if number is not None:
            check_number(number, name)
    recording = read(path, skeleton, fps, scale, stretch, up, root_offset, body)
    for notice in recording.notices(PARAMETERS):
        warn(f"{path}: {notice}")
    by_role = read_roles(roles) if isinstance(roles, str | Path) else roles
    if recording.has_roles and by_role is None:
        return recording.motion
    return with_roles(recording.motion, by_role)


def read(  # noqa: PLR0913 (the options of `load`)
    path: str | Path,
    skeleton: str | Path | None,
    fps: float | None,
    scale: float | None,
    stretch: float,
    up: str | None = None,
    root_offset: str | None = None,
    body: int | None = None,
) -> Recording:
    """Read a motion as `load` does, with the angles and the bone stretch of its file."""
    path = Path(path)
    check_above_0(fps=fps, scale=scale)
    if not stretch >= 0:
        raise MocapError(f"stretch must be 0 or more metres, got {stretch}.")
    spaces.require_axis(up)
    spaces.require_root_offset(root_offset)
    suffix = path.suffix.lower()
    if suffix in formats.READ:
        skeleton_file = None if skeleton is None else Path(skeleton)
        options = ReadOptions(skeleton_file, fps, scale, stretch, up, root_offset, body)
        return formats.READ[suffix].read(path, options)
    if suffix == ".asf":
        raise MocapError(f"{path} is a skeleton without a motion: files.asf.read_skeleton reads it.")
    if suffix in formats.OTHERS:
        raise MocapError(f"Cannot read {path}: {formats.OTHERS[suffix]}.")
    if suffix == "":
        read_text(path, most=1)  # raises for a missing file and for a folder
    raise MocapError(f"Cannot read {path}: mocap reads {formats.listed()}.")


def require_path(path: object) -> None:
    """Raise unless a value is the path of a single file.

    Examples
    --------
    >>> require_path(["a.bvh", "b.bvh"])
    Traceback (most recent call last):
    mocap.errors.MocapError: This takes one file's path, got a list of 2: [mocap.load(f) for f in paths].
    """
    needs = f"This takes one file's path, got {described(path)}"
    if isinstance(path, list | tuple):
        raise MocapError(f"{needs}: [mocap.load(f) for f in paths].")
    if not isinstance(path, str | PathLike):
        raise MocapError(f"{needs}: write it as text, such as 'walk.bvh'.")


def read_angles(path: str | Path, *, skeleton: str | Path | None = None) -> dict[str, Array]:
    """Read the angles of each joint as stored in a file, shape (F, number of axes), degrees.

    `load` converts them to rotations, which are continuous even if an angle jumps from 180° to -180°. An
    `.npz` file has no angles.

    Parameters
    ----------
    path, skeleton : as for `load`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from mocap.body import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> rotated = Motion(bone, [[0, 0, 0]], [[[0, 0, 1, 0], [1, 0, 0, 0]]], 30.0)
    >>> with TemporaryDirectory() as folder:
    ...     save(rotated, f"{folder}/rotated.bvh")
    ...     read_angles(f"{folder}/rotated.bvh")["root"]  # z, x, y
    array([[  0.,   0., 180.]])

    Notebook: 01b-motion-files
    """
    return read(path, skeleton, None, None, math.inf).angles


def save(motion: Motion, path: str | Path, *, precision: int = 6) -> None:
    """Write a motion to a file. An existing file is replaced once the new one is complete.

    Labels, contacts and roles are written to `.npz` only, because the other formats cannot represent them.

    Parameters
    ----------
    motion : F frames.
    path : the file, `.bvh`, `.glb`, `.npz` or `.csv`. A `.glb` file is for engines and viewers: it is in
        metres and includes a body of capsules. Its bones point along the y axes of their joints, and its rest
        pose stands on the floor. An `.npz` file keeps all fields of the motion exactly, see
        `files.motion_archives`. If the body is SMPL's, it has the layout of AMASS instead, with z up, and
        positions are kept within rounding, 1e-12 m. A `.csv` file is a table of the positions of joints in
        metres: a column `time` in seconds, and `<joint>_x`, `<joint>_y` and `<joint>_z` for each joint.
        `load` reads `.bvh` and `.npz`.
    precision : the number of decimals in a `.bvh` file, which is in centimetres, or in a `.csv` file, which
        is in metres. With 6, the error of joint positions is at most 1e-7 m in `.bvh` and 5e-7 m in `.csv`.
        With 9, it is at most 1e-10 m in `.bvh`.

    Raises
    ------
    MocapError : for another format, a missing folder, or a motion that the format cannot represent.

    Warns
    -----
    MocapWarning : if the rest pose of the skeleton does not stand. A `.glb` gets the mean pose of the motion.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from mocap.body import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> still = Motion(bone, [[0, 0, 0]], [[[1, 0, 0, 0], [1, 0, 0, 0]]], 30.0)
    >>> with TemporaryDirectory() as folder:
    ...     save(still, f"{folder}/still.bvh", precision=9)
    ...     load(f"{folder}/still.bvh")
    Motion('still', 1 frame at 30 Hz, 0 s, 2 joints)

    Notebook: 01b-motion-files
    """
    if isinstance(motion, str | PathLike) and isinstance(path, Motion):
        raise MocapError(f"The motion comes first: mocap.save(motion, {str(motion)!r}).")
    require_motion(motion)
    require_path(path)
    path = Path(path)
    if not 0 <= precision <= 15:
        raise MocapError(f"precision must be 0 to 15 digits, got {precision}.")
    match path.suffix.lower():
        case ".bvh":
            bvh.write(
                [motion], path, frames=len(motion), rotates=rotating_joints(motion), precision=precision
            )
        case ".glb":
            write_file(path, gltf.glb(motion))
        case ".npz":
            motion_archives.write(motion, path)
        case ".csv":
            position_tables.write(motion, path, precision=precision)
        case _:
            written = formats.enumerated(formats.WRITTEN, "and")
            raise MocapError(f"Cannot write {path}: mocap writes {written}.")


def save_clips(motions: Sequence[Motion], path: str | Path, *, root: bool = False) -> None:
    """Write motions of one body to one `.glb` file, each as an animation with its name.

    Parameters
    ----------
    motions : one or more, with different names. Their frame rates may differ.
    path : the file. A single motion may also be written in another format of `save`, without `root`.
    root : whether to add a joint on the floor below the hips, with their heading, which moves a character in
        engines. It is called "root", or "floor_root" if the skeleton has that name.

    Raises
    ------
    MocapError, SkeletonMismatch : as for `save`, and for equal names, different skeletons, or several motions
        or `root` in another format.

    Warns
    -----
    MocapWarning : as for `save`. All motions of a file share one rest pose.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from mocap.datasets import sample
    >>> with TemporaryDirectory() as folder:
    ...     save_clips([sample("walk_straight"), sample("walk_circle")], f"{folder}/walks.glb")
    ...     Path(f"{folder}/walks.glb").read_bytes()[:4]
    b'glTF'
    """
    clips = require_motions(motions)
    require_path(path)
    if len(clips) == 1 and not root:
        save(clips[0], path)
        return
    path = Path(path)
    if path.suffix.lower() != ".glb":
        raise MocapError(f"Several clips in one file, and a joint on the floor, need .glb, got '{path}'.")
    write_file(path, gltf.glb(clips, root=root))
