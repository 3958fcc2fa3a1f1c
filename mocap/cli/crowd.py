"""Groups of characters that walk through a graph: `mocap crowd`."""

import cmath
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any, Literal

from mocap import body, datasets, files, graphs, plotting, widgets
from mocap._shared.atomic import make_folder, replacing, require_folder
from mocap.cli.option_types import Joints, Seed, Skeleton, number
from mocap.cli.options import Building, Sources
from mocap.cli.outputs import print_rows
from mocap.cli.saved_graphs import MovedClips, load_graph
from mocap.cli.stages import bar
from mocap.cli.tuned import TUNED
from mocap.errors import MocapError, NoWalk
from mocap.methods import groups

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")


def crowd(
    *,
    members: Annotated[int, number(2, 48, int)] = 6,
    through: Path,
    around: Path | None = None,  # reads: name: the option's name
    out: Path,
    graph: Path | None = None,
    clips: MovedClips = (),
    skeleton: Skeleton = None,
    joints: Joints = (),
    to: Literal["bvh", "glb"] = "bvh",
    no_film: bool = False,
    seed: Seed = 0,
) -> None:
    """Plan the motion of a group, with a character for each member.

    Plan the paths of a group past points and around obstacles, and let a character of a motion graph follow
    the path of each member, in space and time. The group starts at x = 0, z = 0. Writes a motion for each
    member, plan.png, and a film, which is crowd.mp4, or crowd.gif if imageio-ffmpeg is not installed. Files
    with these names are replaced, and other files in the folder are not changed.

    Parameters
    ----------
    members : number of members.
    through : a .csv file with the points to pass in order, x, z in metres.
    around : a .csv file with obstacles, x, z, radius in metres.
    out : folder to write to.
    graph : an .npz file from `mocap graph` (default: a graph of generated walks).
    to : format of the motions.
    no_film : do not write the film, which takes most of the time.

    Notes
    -----
    Example: mocap crowd --members 12 --through points.csv --around discs.csv -o crowd/
    """
    require_folder(out)
    from mocap.files.text import load_rows  # the help needs no NumPy

    discs: Any = load_rows(around, ("x", "z", "radius")) if around else []
    points = tuple(complex(z, x) for x, z in load_rows(through))
    obstacles = tuple((complex(z, x), float(radius)) for x, z, radius in discs)
    scene = groups.Scene(points, obstacles)
    scene.check(0j)
    walks = _walks(graph, Sources(skeleton, joints=joints), clips)
    group = groups.build_group(members, seed=seed)
    plan, search = _plan(group, scene)
    effort = f"{search.expanded} states" if search else "steered, which is quicker"
    print_rows(planned=f"{(len(plan.positions) - 1) / groups.RATE:.1f} s for {members} members, {effort}")
    walkers = groups.walk_group(walks, plan, progress=bar("walking"))
    print_rows(walked=walkers.report())
    make_folder(out)
    for count, motion in enumerate(walkers.motions, 1):
        files.save(motion, out / f"member-{count:02}.{to}")
    with replacing(out / "plan.png") as picture:
        drawn = plotting.draw_group_plan(plan.positions, scene.points, scene.discs, radius=scene.radius)
        drawn.savefig(picture, bbox_inches="tight")
    if not no_film:  # even with half the frames, a .gif is three times as large as an .mp4
        name, fps = ("crowd.mp4", 25.0) if find_spec("imageio_ffmpeg") else ("crowd.gif", 12.5)
        widgets.save_animation(walkers.motions, out / name, discs=discs, fps=fps, progress=bar("drawing"))
    print_rows(wrote=out)


def _walks(path: Path | None, sources: Sources, clips: Sequence[Path]) -> "graphs.MotionGraph":
    """Load the requested graph, or build one of generated walks."""
    values = {"--skeleton": sources.skeleton, "--joints": sources.joints, "--clips": clips}
    if path is None and any(values.values()):
        option = next(name for name, value in values.items() if value)
        raise MocapError(f"{option} belongs to --graph: the generated walks have a skeleton of their own.")
    if path is None:
        return graphs.prune(Building().build([datasets.sample(name) for name in WALKS]))
    graph = load_graph(path, sources, clips)
    if not graph.count("transition"):
        raise NoWalk(f"{path} has no transition: no character can walk where it should.")
    return graph


def _plan(
    group: "groups.GroupGraph", scene: "groups.Scene"
) -> "tuple[groups.Configuration, groups.planning.GroupWalk | None]":
    """Plan a path that starts towards the first point or, if that fails, to one side of it."""
    refused: list[NoWalk] = []
    for heading in TUNED.side_headings:
        start = body.PlanarTransform(cmath.phase(scene.points[0]) + heading, 0.0, 0.0)
        limits = {"most": TUNED.side_states} if heading else {}
        try:
            return groups.lead_group(group, scene, start=start, **limits)
        except NoWalk as error:
            refused.append(error)
    raise refused[0]
