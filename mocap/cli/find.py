"""The command `mocap find`: all motions like an example."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

from mocap import files
from mocap._shared.atomic import make_folder, require_folder
from mocap.cli.options import CM, Sources, bar, number, tell
from mocap.errors import MocapError
from mocap.methods import match_webs

# A path of the web ends where frames are no longer as near as asked, although on average they still are.
ROOM = 4 / 3  # with it CMU 02_05's punch finds two more below 6 cm; with 2 no others


def find(
    query: str,
    clips: Sequence[Path],
    *,
    out: Path | None = None,
    to: Literal["amc", "bvh"] = "bvh",
    below: Annotated[float, CM] = 6.0,
    steps: Annotated[int | None, number(1, 10_000, int)] = None,
    any_length: bool = False,
    sources: Sources,
) -> None:
    """Find all motions like an example, and cut them out.

    Find what is like some frames of a clip, then what is like that, in all clips. Print the matches as a
    table, from the nearest on, and with --out write each as a file.

    Parameters
    ----------
    query (QUERY[:FROM-TO]) : a clip and its frames, as in walk.amc:120-250 (the last one not included).
    clips : .amc, .bvh or AMASS .npz files, or folders of them.
    out : folder to write the matches into, as files (default: write none).
    to : format of these files.
    below : largest distance of a match, cm.
    steps : how often to search (default: until nothing new turns up).
    any_length : matches may last half as long as the query, or twice.

    Notes
    -----
    Example: mocap find punch.bvh:40-90 clips/ -o punches/
    """
    if out:
        require_folder(out)
    example, frames = _query(query)
    found = files.find_files(clips)
    places = [path.resolve() for path in found]
    inside = example.resolve() in places
    asked = places.index(example.resolve()) if inside else len(found)
    motions = sources.load(found if inside else [*found, example])
    web = match_webs.build_web(motions, below=ROOM * below / 100, progress=bar("comparing"))
    lengths = (1 / 2, 2) if any_length else (3 / 4, 4 / 3)
    matches = match_webs.search(web, asked, frames, below=below / 100, steps=steps, lengths=lengths)
    shown = [match for match in matches[1:] if match.clip < len(found)]
    print(f"{'clip':<20} {'frames':>13} {'seconds':>8} {'cm':>5} {'step':>5}")
    for one in shown:
        clip, at = motions[one.clip], f"{one.start}-{one.stop}"
        seconds = (one.stop - one.start) / clip.fps
        print(f"{clip.name:<20} {at:>13} {seconds:>8.2f} {100 * one.cost:>5.1f} {one.generation:>5}")
    tell(found=f"{len(shown)} in {len({match.clip for match in shown})} clips")
    if out:
        make_folder(out)
        for one in bar("writing")(shown):
            name = f"{motions[one.clip].name}_{one.start}-{one.stop}.{to}"
            files.save(match_webs.cut_out(web, one), out / name)
        tell(wrote=f"{len(shown)} files to {out}")


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
