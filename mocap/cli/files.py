"""The commands for clip files: `mocap info`, `mocap judge`, `mocap convert` and `mocap data`."""

import math
import sys
from collections.abc import Sequence
from dataclasses import asdict
from json import dumps
from pathlib import Path
from typing import Annotated, Literal

from mocap import datasets, files, quality
from mocap.cli.options import Reading, Unit, as_options, bar, number, tell_of_failures
from mocap.cli.typed_commands import Group
from mocap.errors import MocapError


def info(file: Path, *, joints: bool = False, reading: Reading) -> None:
    """Report a clip's length, path and flaws.

    Report how long a clip is, how far the body goes and turns, and what is wrong with it.

    Parameters
    ----------
    file : an .amc, .bvh or .npz file.
    joints : list the names of the joints, too.
    """
    motion = reading.read(file)
    print(quality.inspect(motion, files.read_angles(file, skeleton=reading.skeleton)).table())
    depths: list[int] = []
    for parent, name in zip(motion.skeleton.parents, motion.skeleton.names if joints else (), strict=False):
        depths.append(depths[parent] + 1 if parent >= 0 else 0)
        print(f"{'  ' * depths[-1]}{name}")


def judge(
    made: Sequence[Path],
    *,
    reading: Reading,
    against: Sequence[Path] = (),
    path: Path | None = None,
    unit: Unit = None,
    json: bool = False,
) -> int:
    """Measure motions, whatever made them, and rank them.

    Measure motions, whatever program made them, and list the best first: jolts, trembling, feet that sink,
    float, slide or skate, joints that bend or turn too far, bones that change their length, a body of another
    size than people's, and how far from a path. Each number is a share of its limit; above 1 it stands out
    beyond what captured people do. Whether a motion is the one that was wanted, or looks alive, it cannot
    see.

    Parameters
    ----------
    made (FILE) : .amc, .bvh or AMASS .npz files, or folders of them, and the folders inside.
    against (CLIP) : the clips that they are made of.
    path : the path that they should follow, .csv or .svg.
    json : print all numbers as JSON.

    Notes
    -----
    Example: mocap judge made.bvh --against clips/ --path line.csv
    """
    clips = [files.load(clip, **asdict(reading)) for clip in files.find_files(against)]
    line = files.load_path(path, scale=unit) if path else None
    judged, problems = [], []
    for file in bar("judging")(files.find_files(made, deep=True)):
        try:
            motion = files.load(file, stretch=math.inf, **asdict(reading))
            stretch = files.bone_stretch(file, scale=reading.scale)
            judged.append(quality.judge(motion, against=clips, path=line, stretch=stretch))
        except MocapError as error:
            problems.append(str(error))
    if json:
        print(dumps([one.as_dict() for one in judged], indent=1))
    elif judged:
        print(quality.judgement_table(judged))
    for problem in dict.fromkeys([*(text for one in judged for text in one.left_out), *problems]):
        print(f"mocap: {as_options(problem)}", file=sys.stderr)
    return 2 if problems else 0


def convert(
    source: Path,
    target: Path,
    *,
    reading: Reading,
    to: Literal["amc", "bvh", "glb"] = "bvh",
    widen: bool = False,
) -> int:
    """Convert clips between .amc, .bvh and AMASS .npz, or to .glb; whole folders of them.

    Convert a clip, or all clips in a folder and the folders inside it. For one clip, the suffix of OUT is the
    format. An .amc gets an .asf of its name. Lengths in a .bvh are centimetres. A .glb is for engines and
    viewers, and shows a body of capsules.

    Parameters
    ----------
    source (IN) : an .amc, .bvh or .npz file, or a folder.
    target (OUT) : the new file, or folder.
    to : format for the clips of a folder.
    widen : write an .asf in which all bones turn about three axes.

    Notes
    -----
    Example: mocap convert clips/ out/ --to glb
    """
    pairs = files.plan(source, target, f".{to}")
    options = files.Options(reading.skeleton, reading.fps, reading.scale, widen)
    outcomes = files.convert(pairs, options, bar("converting"))
    return tell_of_failures("converted", len(pairs), [one.problem for one in outcomes if one.problem])


def list_trials(
    *, subject: Annotated[int | None, number(1, 999, int)] = None, kind: str | None = None
) -> None:
    """List the trials of the CMU database that datasets.cmu fetches.

    List the trials of the CMU database that datasets.cmu fetches by name.

    Parameters
    ----------
    subject : only this person's trials.
    kind : only trials with this word in their description.
    """
    print(f"{'trial':<8} {'frames':>6}  description")
    for trial in datasets.trials(subject, kind):
        print(f"{trial.name:<8} {trial.frames:>6}  {trial.description}")
    print(f"\n{datasets.TERMS}")


def list_sets() -> None:
    """List the named sets that datasets.from_set reads, with their licences and joints."""
    for name, known in datasets.SETS.items():
        print(f"{name:<12} {known.title}")
        rows = [("licence", known.licence), ("allows", known.allows), ("address", known.address)]
        rows += [("download", known.size()), ("rate", f"{known.fps:g} Hz")]
        rows += [("hips", known.hips), ("left leg", ", ".join(known.legs))]
        rows += [("at hand", f"{len(datasets.list_set(name))} clips")]
        print("\n".join(f"{'':<12} {key:<8} {value}" for key, value in rows))


def fetch(set: Annotated[str, {"choices": list(datasets.SETS)}], *, accept: bool = False) -> None:
    """Download all clips of a named set, once.

    Parameters
    ----------
    set : its name.
    accept : accept the licence that the set is under.
    """
    known = datasets.SETS[set]
    if not accept:
        print(known.terms())
        raise MocapError(f"If you accept this licence, add --accept: {known.size()} to download.")
    print(f"{len(datasets.fetch_set(set, bar('fetching')))} clips are at hand")


DATA = Group(
    "List clips to download, and download whole sets.",
    {"list": list_trials, "sets": list_sets, "fetch": fetch},
)
