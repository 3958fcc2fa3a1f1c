"""Write motions as Acclaim files, and refuse what these would lose.

An Acclaim bone has one end, where all its children start, and turns only about the axes that its skeleton
file lists. A joint whose children start at different places becomes a bone of no length with a fixed bone to
each child. Reading makes a joint of each fixed bone; these joints add no new place.
"""

from collections import defaultdict
from dataclasses import replace
from operator import itemgetter

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion, turning
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.files.acclaim import conjugation, turned
from mocap.files.asf import INCH, MOVES, TURNS, AcclaimSkeleton, Bone, grown
from mocap.files.text import rounded

UNIT = INCH / 0.45  # metres: the unit of most Acclaim files
LOST = 1e-7  # degrees that count as none
STILL = 1e-9  # metres: rounding
FIXED = Bone(np.zeros(3), rotations.IDENTITY, ())


def widened(motion: Motion) -> Skeleton:
    """Give three axes to every joint that has children or turns.

    Examples
    --------
    >>> finger = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]], dofs=["x", ""])
    >>> widened(Motion(finger, [[0, 0, 0]], [[[1, 0, 0, 0], [1, 0, 0, 0]]], 30.0)).dofs
    ('xyz', '')
    """
    skeleton = motion.skeleton
    turns = turning(motion)
    wide = [
        dofs + "".join(sorted(set("xyz") - set(dofs))) if turns[joint] or skeleton.children(joint) else ""
        for joint, dofs in enumerate(skeleton.dofs)
    ]
    return replace(skeleton, dofs=wide)


def to_acclaim(skeleton: Skeleton, *, scale: float = UNIT) -> AcclaimSkeleton:
    """Build the bones that carry a skeleton's joints; the root is "root" there, whatever its name was.

    Parameters
    ----------
    skeleton : the joints; the bones have the same axes and dofs.
    scale : metres in one unit of the files.

    Returns
    -------
    The bones, and the skeleton that reading will give, with one more joint for each fixed bone.

    Raises
    ------
    MocapError : for a name that the format cannot hold, or a root without other joints.

    Examples
    --------
    >>> body = Skeleton(["hips", "left", "right"], [-1, 0, 0], [[0, 0, 0], [1, 0, 0], [-1, 0, 0]])
    >>> to_acclaim(body).skeleton.names
    ('root', 'root_to_left', 'left', 'root_to_right', 'right')
    """
    names = ["root", *skeleton.names[1:]]
    for name in names[1:]:
        _check_name(name)
    if len(names) == 1:
        raise MocapError("An Acclaim file needs a joint below the root.")
    ends = _ends(skeleton)
    bones: dict[str, Bone] = {}
    children: dict[str, list[str]] = defaultdict(list)
    for joint in sorted(set(range(len(names))) - ends):
        name, starts = names[joint], skeleton.offsets[skeleton.children(joint)]
        together = joint > 0 and len(starts) > 0 and np.all(starts == starts[0])
        end = starts[0] if together else np.zeros(3)  # where all children start
        axis = skeleton.axes[joint] if joint else rotations.IDENTITY
        turns = tuple(f"r{letter}" for letter in skeleton.dofs[joint])
        bones[name] = Bone(end, axis, turns if joint else MOVES + turns)
        for child in [child for child in skeleton.children(joint) if child not in ends]:
            start, fixed = name, f"{name}_to_{names[child]}"
            if np.any(skeleton.offsets[child] != end):
                children[name].append(fixed)
                bones[fixed] = Bone(skeleton.offsets[child], rotations.IDENTITY, ())
                start = fixed
            children[start].append(names[child])
    return AcclaimSkeleton(grown(children, bones), bones, scale, degrees=True)


def _check_name(name: str) -> None:
    broken = name.split() != [name] or not name.isprintable() or set(name) & set("#(),")
    if broken or name.startswith(":") or name.isdecimal() or name.lower() in ("begin", "end", "root"):
        raise MocapError(
            f"An Acclaim file cannot hold a joint called {shortened(repr(name))}: rename it, or save as .bvh."
        )


def _ends(skeleton: Skeleton) -> set[int]:
    """Find the leaves that need no bone of their own, because reading adds them with the same names."""
    ends = set()
    for joint, parent in enumerate(skeleton.parents.tolist()):
        alone = parent > 0 and skeleton.children(parent) == [joint] and not skeleton.children(joint)
        named = skeleton.names[joint] == f"{skeleton.names[parent]}_end" and not skeleton.dofs[joint]
        if alone and named and skeleton.offsets[joint].any():
            ends.add(joint)
    return ends


def to_asf(asf: AcclaimSkeleton, name: str) -> str:
    """Write the text of an ASF file, with all digits.

    Examples
    --------
    >>> body = Skeleton(["root", "tail"], [-1, 0], [[0, 0, 0], [0, 0, 0]], dofs=["xyz", "x"])
    >>> print(to_asf(to_acclaim(body), "dog").partition(":bonedata")[2])
    <BLANKLINE>
      begin
        id 1
        name tail
        direction 0.0 0.0 1.0
        length 0.0
        axis 0.0 0.0 0.0 XYZ
        dof rx
        limits (-inf inf)
      end
    :hierarchy
      begin
        root tail
      end
    <BLANKLINE>
    """
    rows = [":version 1.10", f":name {name}", ":units", "  mass 1.0"]
    rows += [f"  length {INCH / asf.unit!r}", "  angle deg", ":documentation", "  written by mocap"]
    rows += [":root", f"  order {' '.join(asf.bones['root'].dofs).upper()}", "  axis XYZ"]
    rows += ["  position 0 0 0", "  orientation 0 0 0", ":bonedata"]
    children: dict[str, list[str]] = defaultdict(list)
    for joint, bone in enumerate(asf.skeleton.names):
        if joint and bone in asf.bones:
            rows += _bone(joint, bone, asf)
            children[asf.skeleton.names[asf.skeleton.parents[joint]]].append(bone)
    rows += [":hierarchy", "  begin"]
    rows += [f"    {' '.join([parent, *names])}" for parent, names in children.items()]
    return "\n".join([*rows, "  end", ""])


def _bone(number: int, name: str, asf: AcclaimSkeleton) -> list[str]:
    vector, axis, dofs = asf.bones[name]
    length = float(np.linalg.norm(vector))
    direction = vector / length if length else np.array([0.0, 0.0, 1.0])
    angles = np.degrees(euler.to_euler("xyz", axis))
    rows = [f"id {number}", f"name {name}", f"direction {_digits(direction)}"]
    rows += [f"length {length / asf.unit!r}", f"axis {_digits(angles)} XYZ"]
    if dofs:
        rows += [f"dof {' '.join(dofs)}", "limits (-inf inf)", *["       (-inf inf)"] * (len(dofs) - 1)]
    return ["  begin", *(f"    {row}" for row in rows), "  end"]


def _digits(numbers: Array) -> str:
    return " ".join(repr(number) for number in (numbers + 0.0).tolist())  # no -0.0


def to_amc(motion: Motion, asf: AcclaimSkeleton, *, precision: int = 6) -> str:
    r"""Write the text of an AMC file: every number in degrees or units, every curve continuous.

    Parameters
    ----------
    motion : F frames.
    asf : a skeleton with the motion's joints.
    precision : digits after the point; 6 keep joints to 1e-7 m, 9 to 1e-10 m.

    Returns
    -------
    The text; its first line is a comment with the frame rate.

    Raises
    ------
    MocapError : when a bone cannot turn as the motion does, or the root cannot move as it does.

    Examples
    --------
    >>> dog = Skeleton(["root", "tail"], [-1, 0], [[0, 0, 0], [0, 0, 0]], dofs=["xyz", "x"])
    >>> wag = Motion(dog, [[0, 0, 0]], [[[1, 0, 0, 0], rotations.about_y(0.1)]], 30.0, "wag")
    >>> to_amc(wag, to_acclaim(dog))
    Traceback (most recent call last):
    mocap.errors.MocapError: 'wag' does not fit its bones: 'tail', which turns about rx, would lose 5.7° ...
    >>> wide = to_acclaim(widened(wag))
    >>> to_amc(wag, wide, precision=2).split("\n")[-3:]
    ['root 0.00 0.00 0.00 0.00 0.00 0.00', 'tail 0.00 5.73 0.00', '']
    """
    tolerance = max(LOST, 2 * 10.0**-precision)  # degrees; rounding loses the second anyway
    numbers, losses = {}, []
    for joint, name in enumerate(["root", *motion.skeleton.names[1:]]):
        bone = asf.bones.get(name, FIXED)
        numbers[name] = _numbers(name, bone, motion.rotations[:, joint])
        if not set(TURNS) <= set(bone.dofs):
            kept = turned(name, bone, numbers[name], degrees=True)
            lost = np.degrees(rotations.angle_between(kept, motion.rotations[:, joint]))
            if lost.max() > tolerance:
                losses.append((float(lost.max()), name, int(lost.argmax())))
    if losses:
        degrees, name, frame = max(losses, key=itemgetter(0))
        axes = " ".join(dof for dof in asf.bones.get(name, FIXED).dofs if dof in TURNS) or "no axis"
        more = f", and {len(losses) - 1} more bones less" if len(losses) > 1 else ""
        raise MocapError(
            f"'{shortened(motion.name, 32)}' does not fit its bones: '{shortened(name, 32)}', which turns "
            f"about {axes}, would lose {degrees:.2g}° in frame {frame}{more}. Use widen=True without "
            "skeleton=, or a .bvh file."
        )
    _add_moves(motion, asf, numbers["root"])
    values = rounded(np.hstack([numbers[name] for name in asf.needed()]), precision, motion.name)
    rows = [" ".join([name, *[f"%.{precision}f"] * len(asf.bones[name].dofs)]) for name in asf.needed()]
    frames = "\n".join(["%d", *rows, ""]) * len(motion)
    counted = np.hstack([np.arange(1.0, len(motion) + 1)[:, None], values])
    return f"# fps {motion.fps!r}\n:FULLY-SPECIFIED\n:DEGREES\n{frames % tuple(counted.ravel().tolist())}"


def _numbers(name: str, bone: Bone, local: Array) -> Array:
    """Turn rotations (F, 4) into a bone's numbers (F, dofs), in degrees; its moves are 0."""
    numbers = np.zeros((len(local), len(bone.dofs)))
    if name == "root":
        own = rotations.multiply(local, rotations.inverse(bone.axis))
    else:
        own = local @ conjugation(rotations.inverse(bone.axis))  # C⁻¹ L C
    if bone.turns:
        numbers[:, bone.turns] = np.degrees(_angles(bone.order, own))
    return numbers


def _angles(order: str, own: Array) -> Array:
    """Find continuous angles (F, axes in `order`) of rotations (F, 4); turns about other axes are lost."""
    # The axes that a bone lacks come last, so that what fits the bone has angle 0 about them.
    angles = euler.to_euler(order + "".join(sorted(set("xyz") - set(order))), own)
    if len(order) == 3:
        return euler.continuous(order, angles)
    back = np.cos(angles[:, 2:]) < 0  # the twin (a + π, π - b, c + π) has the smaller c
    return np.unwrap(np.where(back, angles * [1, -1, 1] + np.pi, angles)[:, : len(order)], axis=0)


def _add_moves(motion: Motion, asf: AcclaimSkeleton, numbers: Array) -> None:
    """Put the root's moves into its numbers (F, dofs)."""
    root = asf.bones["root"]
    moves = (motion.root_positions - root.vector) / asf.unit
    for column, move in enumerate(MOVES):
        if move in root.dofs:
            numbers[:, root.dofs.index(move)] = moves[:, column]
        elif (lost := np.abs(moves[:, column]) * asf.unit).max() > STILL:
            raise MocapError(
                f"The skeleton file gives its root no {move}: '{shortened(motion.name, 40)}' would lose "
                f"{lost.max():.2g} m in frame {lost.argmax()}. Leave skeleton= out to write a new one."
            )
