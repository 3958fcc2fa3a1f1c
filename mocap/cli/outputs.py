"""Results of a command: its rows of text, and the files that it writes, which are checked before any work."""

import os
import re
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import body, files
from mocap._shared.atomic import require_writable
from mocap.cli.messages import print_message
from mocap.cli.stages import timed_stage
from mocap.errors import MocapError, MocapWarning, printable, warn
from mocap.files.formats import WRITTEN, enumerated

if TYPE_CHECKING:
    from mocap.body.motion import Motion


def print_rows(**rows: object) -> None:
    """Print results, each in a line with its name.

    Examples
    --------
    >>> print_rows(wrote="walk.bvh")
    wrote        walk.bvh
    """
    print("\n".join(f"{name:<12} {printable(text)}" for name, text in rows.items()))


def check_out(thing: str, out: Path, read: Iterable[Path] = (), formats: Sequence[str] = WRITTEN) -> None:
    """Raise, before any work is done, if a file cannot be written or is one of the input files.

    Examples
    --------
    >>> check_out("walk", Path("walk.fbx"))
    Traceback (most recent call last):
    mocap.errors.MocapError: A walk is written as .bvh, .glb, .npz or .csv, got 'walk.fbx'.
    """
    if out.suffix.lower() not in formats:
        raise MocapError(f"A {thing} is written as {enumerated(formats)}, got '{out}'.")
    require_other(out, read)
    require_output(out)


def require_output(out: Path) -> None:
    """Raise, before any work is done, if a file cannot be written.

    Examples
    --------
    >>> require_output(Path("nowhere/walk.bvh"))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot write nowhere/walk.bvh: there is no folder nowhere.
    """
    if not out.parent.is_dir():
        raise MocapError(f"Cannot write {out}: there is no folder {out.parent}.")
    require_writable(out)


def require_other(out: Path, read: Iterable[Path]) -> None:
    """Raise if the output file is one of the input files.

    Examples
    --------
    >>> require_other(Path("clips/walk.bvh"), [Path("clips/run.bvh"), Path("./clips/walk.bvh")])
    Traceback (most recent call last):
    mocap.errors.MocapError: clips/walk.bvh is one of the files to read: choose another name with -o.
    """
    if os.path.realpath(out) in map(os.path.realpath, read):
        raise MocapError(f"{out} is one of the files to read: choose another name with -o.")


def write_out(motion: "Motion", out: Path, *, details: str = "") -> None:
    """Write a motion, and print the name of its file with `details`."""
    with timed_stage("writing"):
        files.save(motion, out)
    print_rows(wrote=f"{out}{details}")
    warn_of_lost_roles(motion, out)


def warn_of_lost_roles(motion: "Motion", out: Path) -> None:
    """Warn if a motion has roles that are not found in its file, which cannot store them.

    A .glb file cannot be read by a command, so that no role is missed.
    """
    if out.suffix.lower() != ".bvh" or not motion.skeleton.roles:
        return
    stripped = replace(motion, skeleton=replace(motion.skeleton, roles={}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)  # they are shown when the file is read
        is_found = _roles_of(body.with_roles(stripped)) == _roles_of(motion)
    if not is_found:
        warn(f"{out}: a .bvh cannot store the roles of joints: commands that read it need --joints again.")


def _roles_of(motion: "Motion") -> dict[str, int]:
    """Return the roles of a motion's joints, {} without legs."""
    from mocap.body.limbs import roles  # the help needs no NumPy

    try:
        return roles(motion.skeleton)
    except MocapError:
        return {}


def require_address(address: str, example: str) -> None:
    """Raise unless an address is empty or a URL.

    Examples
    --------
    >>> require_address("example.org", "https://example.org/walk.html")
    Traceback (most recent call last):
    mocap.errors.MocapError: --address is a URL such as https://example.org/walk.html, got 'example.org'.
    """
    if address and not re.match("https?://[^/]", address):
        raise MocapError(f"--address is a URL such as {example}, got '{address[:40]}'.")


def open_page(page: Path) -> None:
    """Open a page in the browser, or say that none opened."""
    import webbrowser  # imported here, because it takes a while

    if not webbrowser.open(page.resolve().as_uri()):
        print_message("no browser opened; open that page yourself.")


def report_failures(verb: str, count: int, problems: Sequence[str], where_to: str = "") -> int:
    """Print the number of files that succeeded, and each problem on the standard error; return the status."""
    print_rows(**{verb: f"{count - len(problems)} of {count}{where_to}"})
    for problem in problems:
        print_message(problem)
    return 2 if problems else 0
