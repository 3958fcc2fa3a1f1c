"""The roles of a clip's joints as a TOML file, which people correct, and as a text in the files of graphs.

`mocap info --joints` prints the TOML file.
"""

import json
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

from mocap.body.limbs import LEG, ROLES, SIDES, TIPS, roles
from mocap.body.motion import Motion
from mocap.errors import FormatError, MocapError, printable, shortened, warn
from mocap.files.text import read_text

LONGEST = 100_000  # bytes of a file of roles
MISSPELT = 2  # names of a body's roles that may be wrong; with more, they are another body's roles
HEAD = '# The roles of joints. Correct the names; an empty name, "", says that the body has no such joint.'


def read_roles(path: str | Path) -> dict[str, str]:
    """Read the names of joints by role.

    Parameters
    ----------
    path : a TOML file with lines such as `"left hip" = "thigh_l"`.

    Raises
    ------
    FormatError : for what is no TOML, or holds other values than names.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "map.toml")
    ...     _ = file.write_text('"left hip" = "thigh_l"')
    ...     read_roles(file)
    {'left hip': 'thigh_l'}
    """
    try:
        content = tomllib.loads(read_text(path, most=LONGEST))
    except tomllib.TOMLDecodeError as error:
        raise FormatError(path, None, "TOML", shortened(str(error), 60)) from None
    for role, name in content.items():
        if not isinstance(name, str):
            got = shortened(f"{role} = {name}", 60)
            raise FormatError(path, None, 'lines such as "left hip" = "thigh_l"', got)
    return content


def format_roles(motion: Motion) -> str:
    """Write the roles of a motion's joints as TOML, and all its joints as comments.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> print(format_roles(sample("walk_straight"))[:170])
    # The roles of joints. Correct the names; an empty name, "", says that the body has no such joint.
    pelvis = "root"
    waist = "lowerback"
    chest = "thorax"
    neck = "lowerneck"
    """
    return "\n".join([HEAD, *_role_lines(motion), "", *_joint_lines(motion)])


def _role_lines(motion: Motion) -> Iterator[str]:
    """Yield a line for each role; those that the body lacks, or that are unknown, have an empty name."""
    skeleton = motion.skeleton
    try:
        joints = roles(skeleton)
    except MocapError as error:
        yield f"# {error.problem()}"
        joints = {}
    names = {role: skeleton.names[joint] for role, joint in joints.items()}
    for side in SIDES:
        if names.get(f"{side} ball") == names.get(f"{side} {LEG[2]}"):
            names.pop(f"{side} ball", None)  # a foot without toes
    names = {role: skeleton.roles[role] for role in TIPS if role in skeleton.roles} | names
    for role in (*ROLES, *TIPS):
        key = f'"{role}"' if " " in role else role
        yield f"{key} = {_quoted(names.get(role, ''))}"


def _joint_lines(motion: Motion) -> Iterator[str]:
    """Yield the tree of joints as comments."""
    yield "# All joints:"
    for joint, name in enumerate(motion.skeleton.names):
        depth = len(motion.skeleton.path_to_root(joint)) - 1
        yield f"# {'  ' * depth}{printable(name)}"


def _quoted(name: str) -> str:
    r"""Quote a name as TOML does.

    Examples
    --------
    >>> print(_quoted('left "hip"\x9b'))
    "left \"hip\"\U0000009b"
    """
    quoted = json.dumps(name, ensure_ascii=False)  # JSON's escapes are those of TOML
    return "".join(sign if sign.isprintable() else f"\\U{ord(sign):08x}" for sign in quoted)


def choose_roles(names: tuple[str, ...], maps: Mapping[Path, Mapping[str, str]]) -> Mapping[str, str]:
    """Choose among the roles of several bodies those for a body with joints of these names; {} for none.

    Roles with more than `MISSPELT` unknown joints are those of another body.

    Raises
    ------
    MocapError : for roles of which the body has all joints but one or two.

    Warns
    -----
    MocapWarning : for roles of another body that shares some joints.

    Examples
    --------
    >>> maps = {Path("hero.toml"): {"left hip": "thigh_l"}, Path("cmu.toml"): {"left hip": "lfemur"}}
    >>> choose_roles(("root", "lfemur"), maps)
    {'left hip': 'lfemur'}
    """
    for path, roles_of_map in maps.items():
        joints = {name for name in roles_of_map.values() if name}
        missing = sorted(joints.difference(names))
        if not missing:
            return roles_of_map
        problem = f"{path}: the clip has no joint '{shortened(missing[0], 40)}'"
        if len(missing) <= MISSPELT and len(missing) < len(joints):
            raise MocapError(f"{problem}.")
        if len(missing) < len(joints):
            warn(f"{problem} and {len(missing) - 1} others, so the roles are not used for it.")
    return {}


def packed_roles(roles: Mapping[str, str]) -> str:
    """Return the names of joints by role as a JSON text, for the files of graphs.

    Examples
    --------
    >>> packed_roles({"left hip": "thigh_l"})
    '{"left hip": "thigh_l"}'
    """
    return json.dumps(dict(roles))


def unpacked_roles(text: str) -> dict[str, str]:
    """Return the roles in a text from `packed_roles`.

    Examples
    --------
    >>> unpacked_roles('{"left hip": "thigh_l"}')
    {'left hip': 'thigh_l'}
    """
    return dict(json.loads(text))


def are_packed_roles(text: str) -> bool:
    """Return whether a text is valid output of `packed_roles`.

    Examples
    --------
    >>> are_packed_roles('{"left hip": "thigh_l"}'), are_packed_roles('{"left": 3}')
    (True, False)
    """
    with suppress(ValueError):
        content = json.loads(text)
        if isinstance(content, dict):
            return all(role in (*ROLES, *TIPS) and isinstance(name, str) for role, name in content.items())
    return False
