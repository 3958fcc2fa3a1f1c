"""The command `mocap crowd`: a group that was planned, and a character for each member."""

import argparse
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import body, datasets, files, graphs, groups, plotting, widgets
from mocap._shared.atomic import make_folder, replacing, require_folder
from mocap.cli.options import SEED, SKELETON, bar, whole
from mocap.errors import MocapError, NoWalk

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.cli.options import Commands
    from mocap.graphs.motion_graph import MotionGraph
    from mocap.groups.scenes import Scene

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
FORMATS = ("bvh", "glb")


def add_crowd(commands: "Commands") -> None:
    """Add `mocap crowd`."""
    crowd = commands.add_parser(
        "crowd",
        help="plan the way of a group, and walk it with a character for each member",
        description="Plan how a group walks past points and around obstacles, and let a character of a "
        "motion graph walk each member's way, in place and in time. Writes a motion for each member, "
        "plan.png, and a film: crowd.mp4, or crowd.gif where imageio-ffmpeg is not installed.",
        epilog="Example: mocap crowd --members 12 --through points.csv --around discs.csv -o crowd/",
    )
    add = crowd.add_argument
    add("--members", type=whole(2, 48), default=6, help="how many walk (default: %(default)s)")
    add("--through", type=Path, required=True, help="a .csv with the points to pass in turn, x, z in metres")
    add("--around", type=Path, help="a .csv with obstacles, x, z, radius in metres")
    add("-o", "--out", type=Path, required=True, help="folder for the new files")
    add("--graph", type=Path, help="an .npz file from `mocap graph` (default: one of generated walks)")
    add("--skeleton", type=Path, help=SKELETON)
    add("--to", choices=FORMATS, default="bvh", help="format of the motions (default: %(default)s)")
    add("--no-film", action="store_true", help="write no film, which takes the longest")
    add("--seed", type=SEED, default=0, help="of the simulation (default: %(default)s)")
    crowd.set_defaults(run=_crowd)


def _crowd(options: argparse.Namespace) -> int:
    require_folder(options.out)
    scene = _scene(options)
    scene.check(0j)
    motion_graph = _graph(options)
    group = groups.build_group(options.members, seed=options.seed)
    found = groups.plan_group(group, scene)
    frames = round(found.seconds * groups.RATE) + 1
    plan = groups.Trajectories(*(part[:frames] for part in groups.play_group(group, found.clips)))
    print(f"{'planned':<12} {found.seconds:.1f} s for {options.members} members, {found.expanded} states")
    walkers = groups.walk_group(motion_graph, plan, progress=bar("walking"))
    print(f"{'walked':<12} {walkers.report()}")
    make_folder(options.out)
    for number, motion in enumerate(walkers.motions, 1):
        files.save(motion, options.out / f"member-{number:02}.{options.to}")
    with replacing(options.out / "plan.png") as beside:
        figure = plotting.draw_group_plan(plan.places, scene.points, scene.discs, near=scene.near)
        figure.savefig(beside, format="png")
    if not options.no_film:
        _film(list(walkers.motions), options.out)
    print(f"{'wrote':<12} {options.out}")
    return 0


def _film(motions: "list[Motion]", folder: Path) -> None:
    """Write an .mp4 where that can be; a .gif has half the frames, and is three times as large even so."""
    name, fps = ("crowd.mp4", 25.0) if find_spec("imageio_ffmpeg") else ("crowd.gif", 12.5)
    widgets.save_animation(motions, folder / name, fps=fps, progress=bar("drawing"))


def _scene(options: argparse.Namespace) -> "Scene":
    """Read where to go, and what stands in the way."""
    points = files.load_rows(options.through)
    discs = files.load_rows(options.around, ("x", "z", "radius")) if options.around else []
    scene: Scene = groups.Scene(
        tuple(complex(z, x) for x, z in points),
        tuple((complex(z, x), float(radius)) for x, z, radius in discs),
    )
    return scene


def _graph(options: argparse.Namespace) -> "MotionGraph":
    """Load the graph asked for, or build one of generated walks."""
    if options.graph is None:
        if options.skeleton:
            raise MocapError(
                "--skeleton belongs to --graph: the generated walks have a skeleton of their own."
            )
        clips = [body.resample(datasets.sample(name), 30) for name in WALKS]
        walks: MotionGraph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
        return walks
    found = graphs.read(options.graph)
    clips = graphs.find_clips(options.graph, skeleton=options.skeleton, progress=bar("reading"))
    graph: MotionGraph = graphs.load(options.graph, [body.resample(clip, found.fps) for clip in clips])
    if not any(kind == "transition" for *_, kind in graph.graph.edges(data="kind")):
        raise NoWalk(f"{options.graph} has no transition: no character can walk where it should.")
    return graph
