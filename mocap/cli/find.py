"""The command `mocap find`: all motions like an example."""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import files, quality
from mocap._shared.atomic import make_folder, require_folder
from mocap.cli.options import CM, LENGTH, SKELETON, bar, whole
from mocap.errors import MocapError
from mocap.methods import match_webs

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands
    from mocap.methods.match_webs.match_search import Match


# A path of the web ends where frames are no longer as near as asked, although on average they still are.
ROOM = 4 / 3  # with it CMU 02_05's punch finds two more below 6 cm; with 2 no others


def add_find(commands: "Commands") -> None:
    """Add `mocap find`."""
    find = commands.add_parser(
        "find",
        help="find all motions like an example, and cut them out",
        description="Find what is like some frames of a clip, then what is like that, in all clips. "
        "Print the matches as a table, from the nearest on, and with --out write each as a file.",
        epilog="Example: mocap find punch.bvh:40-90 clips/ -o punches/",
    )
    add = find.add_argument
    frames = "a clip and its frames, as in walk.amc:120-250 (the last one not included)"
    add("query", metavar="QUERY[:FROM-TO]", help=frames)
    add("clips", nargs="+", type=Path, help=".amc, .bvh or AMASS .npz files, or folders of them")
    add("-o", "--out", type=Path, help="folder to write the matches into, as files (default: write none)")
    add("--to", choices=["amc", "bvh"], default="bvh", help="format of these files (default: %(default)s)")
    add("--below", type=CM, default=6.0, help="largest distance of a match, cm (default: %(default)g)")
    add("--steps", type=whole(1, 10_000), help="how often to search (default: until nothing new turns up)")
    add("--any-length", action="store_true", help="matches may last half as long as the query, or twice")
    add("--skeleton", type=Path, help=SKELETON)
    add("--scale", type=LENGTH, help="metres per unit of length in .bvh clips (default: 0.01)")
    find.set_defaults(run=_find)


def _find(options: argparse.Namespace) -> int:
    if options.out:
        require_folder(options.out)
    query, frames = _query(options.query)
    found = files.find_files(options.clips)
    asked = _position(query, found)
    paths = [*found, query] if asked is None else found
    clips = files.load_all(paths, skeleton=options.skeleton, scale=options.scale, progress=bar("reading"))
    quality.warn_of_size(clips)
    below = options.below / 100
    web = match_webs.build_web(clips, below=ROOM * below, progress=bar("comparing"))
    lengths = (1 / 2, 2) if options.any_length else (3 / 4, 4 / 3)
    number = len(found) if asked is None else asked
    matches = match_webs.search(web, number, frames, below=below, steps=options.steps, lengths=lengths)
    shown = [match for match in matches[1:] if match.clip < len(found)]
    _print(shown, clips)
    if options.out:
        _write(shown, web, options)
    return 0


def _query(text: str) -> tuple[Path, slice]:
    """Read a clip and its frames.

    Examples
    --------
    >>> _query("walk.amc:120-250")
    (PosixPath('walk.amc'), slice(120, 250, None))
    >>> _query("walk.amc")[1]
    slice(None, None, None)
    """
    parts = re.fullmatch(r"(.+?)(?::(\d{1,9})-(\d{1,9}))?", text, re.DOTALL)
    if not parts or (parts[2] is None and ":" in Path(text).name):
        raise MocapError(f"Which frames are '{text[-60:]}'? Write CLIP:FROM-TO, as in walk.amc:120-250.")
    first, last = (None if part is None else int(part) for part in parts.groups()[1:])
    return Path(parts[1]), slice(first, last)


def _position(query: Path, found: Sequence[Path]) -> int | None:
    """Say which of some files a file is, if any."""
    places = [path.resolve() for path in found]
    return places.index(query.resolve()) if query.resolve() in places else None


def _print(matches: "Sequence[Match]", clips: "Sequence[Motion]") -> None:
    print(f"{'clip':<20} {'frames':>13} {'seconds':>8} {'cm':>5} {'step':>5}")
    for match in matches:
        clip = clips[match.clip]
        seconds = (match.stop - match.start) / clip.fps
        frames = f"{match.start}-{match.stop}"
        print(f"{clip.name:<20} {frames:>13} {seconds:>8.2f} {100 * match.cost:>5.1f} {match.generation:>5}")
    print(f"{'found':<12} {len(matches)} in {len({match.clip for match in matches})} clips")


def _write(matches: "Sequence[Match]", web: "match_webs.MatchWeb", options: argparse.Namespace) -> None:
    make_folder(options.out)
    for match in bar("writing")(matches):
        clip = web.clips[match.clip]
        target = options.out / f"{clip.name}_{match.start}-{match.stop}.{options.to}"
        files.save(match_webs.cut_out(web, match), target)
    print(f"{'wrote':<12} {len(matches)} files to {options.out}")
