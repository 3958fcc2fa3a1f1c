"""The commands for clip files: `mocap info`, `view`, `judge`, `convert` and `find`."""

import math
import re
import sys
import tempfile
from collections.abc import Sequence
from functools import partial
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from mocap import files, quality, widgets
from mocap._shared.atomic import make_folder, require_folder
from mocap.cli.clip_reports import describe_clips
from mocap.cli.clip_sets import Spaces, read_found
from mocap.cli.option_types import CM, PlainNames, number
from mocap.cli.options import READING, FileReading, PathReading, Reading, Sources, require_file
from mocap.cli.outputs import open_page, print_rows, report_failures, require_output
from mocap.cli.stages import bar, timed_stage
from mocap.cli.tuned import TUNED
from mocap.errors import MocapError, printable
from mocap.files import conversion
from mocap.files.conversion import find_files
from mocap.methods import match_webs

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.files.recordings import Recording
    from mocap.quality.clip_flaws import Flaw


FILM_RATE = 25.0  # frames per second
BESIDE = 1.2  # metres between clips that are shown beside each other


def info(file: Path, *, joints: bool = False, json: bool = False, reading: FileReading) -> int:
    """Report the duration, the path and the flaws of a clip.

    Report the duration of a clip, the height of the body, the length of its path, its change of heading, and
    flaws of the data.

    Parameters
    ----------
    file : a motion file, or with --json also a folder.
    joints : print the roles of the joints and their names instead, as .toml, which other commands accept by
        --joints.
    json : print all numbers as JSON, of the clip or of all clips in the folder and its subfolders. Files that
        cannot be read are listed with their errors.

    Notes
    -----
    Example: mocap info walk.bvh --joints > map.toml

    Example: mocap info clips/ --json > clips.json
    """
    from mocap.files.spaces import ROOT_OFFSET, unit_name  # the help needs no NumPy

    if json:
        if joints:
            raise MocapError("--joints prints roles and --json prints numbers: give one of them.")
        clips, failed = describe_clips(find_files([file]), reading)
        print(dumps({"clips": clips, "failed": failed}, indent=1, allow_nan=False))
        for problem in failed:
            print(f"mocap: {printable(problem['error'])}", file=sys.stderr)
        return 2 if failed else 0
    require_file(file, "give one of its files, or --json for all of them")
    reading.require_skeleton_of_use(file)
    recording = reading.read_with_roles(file)
    motion = recording.motion
    if joints:
        from mocap.files.role_maps import format_roles  # the help needs no NumPy

        print(format_roles(motion))
        return 0
    with timed_stage("measuring"):
        report = quality.inspect(motion, recording.angles)
    flaws = [_with_remedy(flaw, len(motion)) for flaw in report.flaws]
    print(report._replace(flaws=flaws).table())
    if recording.space:
        scale, up, root_offset = recording.space.choices()
        offset = f", {ROOT_OFFSET} added" if root_offset == "add" else ""
        print(f"space    {unit_name(scale)} a unit, {up} up{offset}")
    if recording.assumed:
        print(f"assumed  {recording.assumed.worded(READING[recording.assumed.parameter])}")
    return 0


def _with_remedy(flaw: "Flaw", frames: int) -> "Flaw":
    """Add the options of `mocap cut` that remove a flaw to its detail, if it is at an end of the clip."""
    from mocap.quality.clip_flaws import REST_POSE, ZEROS  # the help needs no NumPy

    if flaw.kind not in (REST_POSE, ZEROS) or len(flaw.frames) == frames:
        return flaw
    kept = sorted({*range(frames)} - {*flaw.frames})
    options = [f"--from {kept[0]}"] if kept[0] > 0 else []
    options += [f"--to {kept[-1] + 1}"] if kept[-1] < frames - 1 else []
    return flaw._replace(detail=f"cut it by mocap cut {' '.join(options)}") if options else flaw


def view(
    clips: Sequence[Path],
    *,
    out: Path | None = None,
    layout: Literal["beside", "upon", "as-is"] | None = None,
    camera: Annotated[float | None, number(-360, 360)] = None,
    size: str | None = None,
    rate: Annotated[float | None, number(1, 100)] = None,
    reading: Reading,
) -> None:
    """Play a clip in the browser, or several clips together, with their names.

    The page is one file that works without a network.

    Parameters
    ----------
    clips : motion files.
    out : file to write, .html, .gif, .mp4 or .png, without opening a browser.
    layout : how several clips are shown: beside each other or one upon the other, all walking off in the same
        direction, or as-is, where they are (default: beside).
    camera (DEGREES) : direction from which the camera looks, degrees to the right of the z axis (default:
        40).
    size (WxH) : width and height of a film in pixels, as in 1280x720 (default: 640x360 for .gif, 848x480 for
        .mp4).
    rate : frames per second of a film (default: 25).

    Notes
    -----
    Example: mocap view walk.bvh

    Example: mocap view walk.bvh cleaned.bvh --layout upon -o both.mp4 --size 1280x720
    """
    _check_view(clips, out, films_only=bool(size or rate), arranges=layout is not None)
    look: dict[str, Any] = {"captions": len(clips) > 1, "fps": rate or FILM_RATE}
    look |= {"size": _size(size), "yaw": None if camera is None else math.radians(camera)}
    motions = [reading.load(clips[0])] if len(clips) == 1 else reading.load_set(clips, clips)
    shown = arranged(motions, layout or "beside") if len(clips) > 1 else motions
    page = out or Path(tempfile.mkdtemp(prefix="mocap-"), f"{clips[0].stem}.html")
    widgets.save_animation(shown, page, **look, progress=bar("drawing"))
    print_rows(wrote=page)
    if not out:
        open_page(page)


def _check_view(clips: Sequence[Path], out: Path | None, *, films_only: bool, arranges: bool) -> None:
    """Raise for no clip, options without what they belong to, and a file that cannot be written."""
    if not clips:
        raise MocapError("mocap view needs CLIPS: the motion files to play.")
    if out:
        require_output(out)
    if films_only and (out is None or out.suffix.lower() not in (".gif", ".mp4")):
        raise MocapError("--size and --rate are of films: give -o with a name in .gif or .mp4.")
    if arranges and len(clips) == 1:
        raise MocapError("--layout arranges several clips: give two or more.")


def arranged(motions: "Sequence[Motion]", layout: str) -> "list[Motion]":
    """Place motions beside each other, one upon the other, or where they are."""
    from mocap import body  # the help needs no NumPy

    if layout == "as-is":
        return [*motions]
    spacing = BESIDE if layout == "beside" else 0.0
    first = spacing * (len(motions) - 1) / 2
    return [body.place(motion, 0.0, [first - spacing * n, 0.0]) for n, motion in enumerate(motions)]


def _size(text: str | None) -> tuple[int, int] | None:
    """Parse the size of a film.

    Examples
    --------
    >>> _size("1280x720")
    (1280, 720)
    """
    if text is None:
        return None
    parts = re.fullmatch(r"(\d{2,4})x(\d{2,4})", text)
    if parts is None:
        raise MocapError(f"Which size is '{text[:40]}'? Write WIDTHxHEIGHT in pixels, as in 1280x720.")
    return int(parts[1]), int(parts[2])


def judge(
    motions: Sequence[Path],
    *,
    reading: Reading,
    against: Sequence[Path] = (),
    path: Path | None = None,
    drawn: PathReading,
    json: bool = False,
) -> int:
    """Measure the quality of motions from any source, and rank them.

    The motions are listed from best to worst. The measures are jolts, trembling, bones that snap, frozen
    frames, feet below or above the ground, foot sliding, a path that does not fit the steps, joints that bend
    or rotate too far, bones of varying length, a body of an unusual size, and the distance from a path. Each
    number is the ratio of a measure to its limit, which captured motion keeps. Agreement with a request and
    liveliness are not measured.

    Parameters
    ----------
    motions (FILE) : motion files, or folders of them, including subfolders.
    against (CLIP) : the clips from which the motions were made.
    path : the path that they should follow, .csv with points x, z in metres, or .svg.
    json : print all numbers as JSON.

    Notes
    -----
    Example: mocap judge made.bvh --against clips/ --path line.csv
    """
    from mocap.quality.judging import judgement_table

    paths = find_files(motions)
    sources = find_files(against)
    spaces = reading.survey([*paths, *sources])
    read_source = partial(_read_surveyed, reading, spaces)
    recordings, _ = read_found(read_source, sources, against, READING)
    clips = [recording.motion for recording in recordings]
    line = drawn.load(path) if path else None
    judgements = []
    problems = []
    for file in bar("judging")(paths):
        try:
            recording = read_source(file, stretch=math.inf)
            judged = quality.judge(recording.motion, against=clips, path=line, stretch=recording.stretch)
            judgements.append(judged)
        except MocapError as error:
            problems.append(str(error))
    if json:
        print(dumps([judgement.as_dict() for judgement in judgements], indent=1))
    elif judgements:
        print(judgement_table(judgements))
    omissions = [text for judgement in judgements for text in judgement.left_out]
    for problem in dict.fromkeys([*omissions, *problems]):
        print(f"mocap: {printable(problem)}", file=sys.stderr)
    return 2 if problems else 0


def _read_surveyed(
    reading: Reading, spaces: Spaces, path: Path, *, stretch: float | None = None
) -> "Recording":
    """Read a clip in the space of its set."""
    return reading.read_with_roles(path, spaces.get(path), stretch=stretch)


def convert(
    source: Path,
    target: Path | None = None,
    *,
    out: Path | None = None,
    reading: Reading,
    to: Literal["bvh", "glb", "npz", "csv"] = "bvh",
    plain_names: PlainNames = False,
) -> int:
    """Convert motion files, or whole folders, to .bvh, .glb, .npz or .csv.

    Convert a clip, or all clips in a folder and its subfolders. For one clip, the suffix of OUT selects the
    format. Lengths in a .bvh file are centimetres. A .glb file is for engines and viewers, and shows a body
    of capsules. Its skeleton can be rigged: bones point along y, and the rest pose stands on the floor. An
    .npz file keeps all numbers, labels and contacts, in the layout of AMASS for the SMPL body. A .csv file is
    a table of the positions of joints in metres, which cannot be read again as a motion.

    Parameters
    ----------
    source (IN) : a motion file, or a folder.
    target (OUT) : file or folder to write.
    out : the same as OUT.
    to : format of the files in a folder.

    Notes
    -----
    Example: mocap convert clips/ out/ --to glb

    Example: mocap convert walk.bvh -o walk.npz
    """
    target = _only_one(target, out)
    pairs = conversion.plan(source, target, f".{to}")
    spaces = reading.survey([path for path, _ in pairs])
    load = partial(_load_plain if plain_names else Reading.load_any, reading, spaces=spaces)
    failed = conversion.convert(pairs, load, progress=bar("converting"))
    where_to = f" to {target}" if not source.is_dir() else f" to .{to}, in {target}"
    return report_failures("converted", len(pairs), failed, where_to)


def _only_one(target: Path | None, out: Path | None) -> Path:
    """Return the file or folder to write, which is an argument or an option."""
    if target is not None and out is not None:
        raise MocapError(f"mocap convert writes to one place, got {target} and {out}.")
    place = target or out
    if place is None:
        raise MocapError("mocap convert needs OUT: the file or the folder to write.")
    return place


def _load_plain(reading: Reading, path: Path, spaces: Spaces) -> "Motion":
    """Read a clip with plain names of joints; a function of the module can be sent to other processes."""
    return files.with_plain_names(reading.load_any(path, spaces))


def find(
    query: str,
    clips: Sequence[Path],
    *,
    out: Path | None = None,
    below: Annotated[float, CM] = 6.0,
    sources: Sources,
) -> None:
    """Find all motions similar to an example, and cut them out.

    The search finds motions in all clips that are similar to some frames of a clip, then motions similar to
    those. The matches are printed as a table, the most similar first. With --out, each is written to a file.

    Parameters
    ----------
    query (QUERY[:FROM-TO]) : a motion file and its frames, as in walk.amc:120-250 (without the last one).
    clips : motion files, or folders of them.
    out : folder to write to, with a file for each match (default: write none).
    below : largest RMS distance of a match, cm.

    Notes
    -----
    Example: mocap find punch.bvh:40-90 clips/ -o punches/
    """
    if out:
        require_folder(out)
    example, frames = _query(query)
    paths = find_files(clips)
    is_among_clips = example.resolve() in [path.resolve() for path in paths]
    motions, origins = sources.load(paths if is_among_clips else [*paths, example], [*clips, example])
    query_clip = [origin.path.resolve() for origin in origins].index(example.resolve())
    searched = len(motions) if is_among_clips else len(motions) - 1
    web = match_webs.build_web(motions, below=TUNED.web_threshold * below / 100, progress=bar("comparing"))
    matches = match_webs.search(web, query_clip, frames, below=below / 100)
    shown = [match for match in matches[1:] if match.clip < searched]
    print(f"{'clip':<20} {'frames':>13} {'seconds':>8} {'cm':>5} {'step':>5}")
    for match in shown:
        clip = motions[match.clip]
        seconds = (match.stop - match.start) / clip.fps
        place = f"{printable(clip.name):<20} {f'{match.start}-{match.stop}':>13}"
        print(f"{place} {seconds:>8.2f} {100 * match.cost:>5.1f} {match.generation:>5}")
    print_rows(found=f"{len(shown)} in {len({match.clip for match in shown})} clips")
    if out:
        make_folder(out)
        for match in bar("writing")(shown):
            name = f"{motions[match.clip].name}_{match.start}-{match.stop}.bvh"
            files.save(match_webs.cut_out(web, match), out / name)
        print_rows(wrote=f"{len(shown)} files to {out}")


def _query(text: str) -> tuple[Path, slice]:
    """Parse a query, the name of a clip and its frames.

    Examples
    --------
    >>> _query("walk.amc:120-250") == (Path("walk.amc"), slice(120, 250))
    True
    >>> _query("walk.amc")[1]
    slice(None, None, None)
    """
    parts = re.fullmatch(r"(.+?)(?::(\d{1,9})-(\d{1,9}))?", text, re.DOTALL)
    if not parts or (parts[2] is None and ":" in Path(text).name):
        raise MocapError(f"Which frames are '{text[-60:]}'? Write CLIP:FROM-TO, as in walk.amc:120-250.")
    first, last = (None if part is None else int(part) for part in parts.groups()[1:])
    if first is not None and last is not None and first >= last:
        raise MocapError(f"Frames go from the first to a later one: '{first}-{last}' has them the other way.")
    return Path(parts[1]), slice(first, last)
