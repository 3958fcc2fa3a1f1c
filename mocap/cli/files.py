"""The commands for clip files: `mocap info`, `mocap judge`, `mocap convert` and `mocap data`."""

import argparse
import json
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import datasets, files, quality
from mocap.cli.options import LENGTH, add_reading, as_options, bar, require_amc, whole
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.body.skeleton import Skeleton
    from mocap.cli.options import Commands


def add_info(commands: "Commands") -> None:
    """Add `mocap info`."""
    info = commands.add_parser(
        "info",
        help="report a clip's length, path and flaws",
        description="Report how long a clip is, how far the body goes and turns, and what is wrong with it.",
    )
    info.add_argument("file", type=Path, help="an .amc, .bvh or .npz file")
    info.add_argument("--joints", action="store_true", help="list the names of the joints, too")
    add_reading(info)
    info.set_defaults(run=_info)


def _info(options: argparse.Namespace) -> int:
    require_amc(options.file, options.skeleton)
    motion = files.load(options.file, skeleton=options.skeleton, fps=options.fps, scale=options.scale)
    angles = files.read_angles(options.file, skeleton=options.skeleton)
    print(quality.inspect(motion, angles).table())
    if options.joints:
        print("\n".join(_tree(motion.skeleton)))
    return 0


def _tree(skeleton: "Skeleton") -> list[str]:
    """List a body's joints, each farther in than the joint above."""
    depths: list[int] = []
    for parent in skeleton.parents:
        depths.append(depths[parent] + 1 if parent >= 0 else 0)
    return [f"{'  ' * depth}{name}" for depth, name in zip(depths, skeleton.names, strict=True)]


def add_judge(commands: "Commands") -> None:
    """Add `mocap judge`."""
    judge = commands.add_parser(
        "judge",
        help="measure motions, whatever made them, and rank them",
        description="Measure motions, whatever program made them, and list the best first: jolts, trembling, "
        "feet that sink, float, slide or skate, joints that bend or turn too far, bones that change their "
        "length, a body of another size than people's, and how far from a path. "
        "Each number is a share of its limit; above 1 it stands out beyond what captured people do. "
        "Whether a motion is the one that was wanted, or looks alive, it cannot see.",
        epilog="Example: mocap judge made.bvh --against clips/ --path line.csv",
    )
    add = judge.add_argument
    add(
        "files",
        nargs="+",
        type=Path,
        metavar="FILE",
        help=".amc, .bvh or AMASS .npz files, or folders of them, and the folders inside",
    )
    add_reading(judge)
    add("--against", nargs="+", type=Path, default=[], metavar="CLIP", help="the clips that they are made of")
    add("--path", type=Path, help="the path that they should follow, .csv or .svg")
    add("--unit", type=LENGTH, help="metres per unit of length in the path (default: 1; for .svg 0.01)")
    add("--json", action="store_true", help="print all numbers as JSON")
    judge.set_defaults(run=_judge)


def _judge(options: argparse.Namespace) -> int:
    """Judge, and return 2 if any file could not be."""
    reading = {"skeleton": options.skeleton, "fps": options.fps, "scale": options.scale}
    clips = [files.load(path, **reading) for path in files.find_files(options.against)]
    path = files.load_path(options.path, scale=options.unit) if options.path else None
    judged, failed = [], []
    for file in bar("judging")(files.find_files(options.files, deep=True)):
        try:
            motion = files.load(file, stretch=math.inf, **reading)
            stretch = files.bone_stretch(file, scale=options.scale)
            judged.append(quality.judge(motion, against=clips, path=path, stretch=stretch))
        except MocapError as error:
            failed.append(str(error))
    if options.json:
        print(json.dumps([one.as_dict() for one in judged], indent=1))
    elif judged:
        print(quality.judgement_table(judged))
    for problem in dict.fromkeys([*(text for one in judged for text in one.left_out), *failed]):
        print(f"mocap: {as_options(problem)}", file=sys.stderr)
    return 2 if failed else 0


def add_convert(commands: "Commands") -> None:
    """Add `mocap convert`."""
    convert = commands.add_parser(
        "convert",
        help="convert clips between .amc, .bvh and AMASS .npz, or to .glb; whole folders of them",
        description="Convert a clip, or all clips in a folder and the folders inside it. For one clip, the "
        "suffix of OUT is the format. An .amc gets an .asf of its name. Lengths in a .bvh are centimetres. A "
        ".glb is for engines and viewers, and shows a body of capsules.",
        epilog="Example: mocap convert clips/ out/ --to glb",
    )
    convert.add_argument("source", type=Path, metavar="IN", help="an .amc, .bvh or .npz file, or a folder")
    convert.add_argument("target", type=Path, metavar="OUT", help="the new file, or folder")
    add_reading(convert)
    convert.add_argument(
        "--to",
        choices=["amc", "bvh", "glb"],
        default="bvh",
        help="format for the clips of a folder (default: %(default)s)",
    )
    convert.add_argument(
        "--widen", action="store_true", help="write an .asf in which all bones turn about three axes"
    )
    convert.set_defaults(run=_convert)


def _convert(options: argparse.Namespace) -> int:
    """Convert, and return 2 if any file failed."""
    pairs = files.plan(options.source, options.target, f".{options.to}")
    reading = files.Options(options.skeleton, options.fps, options.scale, options.widen)
    outcomes = files.convert(pairs, reading, bar("converting"))
    failed = [outcome for outcome in outcomes if outcome.problem]
    print(f"{'converted':<10} {len(outcomes) - len(failed)} of {len(outcomes)}")
    for outcome in failed:
        print(f"{'failed':<10} {as_options(outcome.problem)}")
    return 2 if failed else 0


def add_data(commands: "Commands") -> None:
    """Add `mocap data list`, `mocap data sets` and `mocap data fetch`."""
    what = "list clips to download, and download whole sets"
    data = commands.add_parser("data", help=what, description=f"{what.capitalize()}.")
    actions = data.add_subparsers(title="actions", required=True, metavar="ACTION")
    listing = actions.add_parser(
        "list",
        help="list the trials of the CMU database that datasets.cmu fetches",
        description="List the trials of the CMU database that datasets.cmu fetches by name.",
    )
    listing.add_argument("--subject", type=whole(1, 999), help="only this person's trials")
    listing.add_argument("--kind", help="only trials with this word in their description")
    listing.set_defaults(run=_list)
    what = "list the named sets that datasets.from_set reads, with their licences and joints"
    actions.add_parser("sets", help=what, description=f"{what.capitalize()}.").set_defaults(run=_sets)
    what = "download all clips of a named set, once"
    fetch = actions.add_parser("fetch", help=what, description=f"{what.capitalize()}.")
    fetch.add_argument("set", choices=list(datasets.SETS), help="its name")
    fetch.add_argument("--accept", action="store_true", help="accept the licence that the set is under")
    fetch.set_defaults(run=_fetch)


def _list(options: argparse.Namespace) -> int:
    trials = datasets.trials(options.subject, options.kind)
    print(f"{'trial':<8} {'frames':>6}  description")
    for trial in trials:
        print(f"{trial.name:<8} {trial.frames:>6}  {trial.description}")
    print(f"\n{datasets.TERMS}")
    return 0


def _fetch(options: argparse.Namespace) -> int:
    known = datasets.SETS[options.set]
    if not options.accept:
        print(known.terms())
        raise MocapError(f"If you accept this licence, add --accept: {known.size()} to download.")
    print(f"{len(datasets.fetch_set(options.set, bar('fetching')))} clips are at hand")
    return 0


def _sets(_: argparse.Namespace) -> int:
    for name, known in datasets.SETS.items():
        print(f"{name:<12} {known.title}")
        rows = [("licence", known.licence), ("allows", known.allows), ("address", known.address)]
        rows += [("download", known.size()), ("rate", f"{known.fps:g} Hz")]
        rows += [("hips", known.hips), ("left leg", ", ".join(known.legs))]
        rows += [("at hand", f"{len(datasets.list_set(name))} clips")]
        print("\n".join(f"{'':<12} {key:<8} {value}" for key, value in rows))
    return 0
