"""The command `mocap crowd`: a group that was planned, and a character for each member."""

import cmath
import re
from collections.abc import Sequence
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, Literal

from mocap import datasets, files, graphs, plotting, widgets
from mocap._shared.atomic import make_folder, replacing, require_folder
from mocap.cli.options import Building, Seed, Skeleton, bar, load_graph, number, tell
from mocap.errors import MocapError, NoWalk
from mocap.methods import groups

if TYPE_CHECKING:
    from mocap._shared.arrays import Points
    from mocap.body.motion import Motion
    from mocap.graphs.motion_graph import MotionGraph
    from mocap.methods.groups.group_graphs import GroupGraph, Placed
    from mocap.methods.groups.planning import GroupWalk
    from mocap.methods.groups.scenes import Scene

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
OURS = re.compile(r"^(?:member-\d\d\.(?:bvh|glb)|crowd\.(?:mp4|gif))$", re.MULTILINE)
WROTE, LONGEST = "mocap crowd wrote", 2000  # how the list of files begins, and its length at most
TURNS = (0.0, 0.5, -0.5, 1.0, -1.0)  # radians from the way to the first point, tried in this order
SOON = 400  # states; where the way ahead is closed, a side finds one soon or not at all


def crowd(
    *,
    members: Annotated[int, number(2, 48, int)] = 6,
    through: Path,
    around: Path | None = None,
    out: Path,
    graph: Path | None = None,
    skeleton: Skeleton = None,
    to: Literal["bvh", "glb"] = "bvh",
    no_film: bool = False,
    seed: Seed = 0,
) -> None:
    """Plan the way of a group, and walk it with a character for each member.

    Plan how a group walks past points and around obstacles, and let a character of a motion graph walk each
    member's way, in place and in time. The group starts at x = 0, z = 0. Writes a motion for each member,
    plan.png, and a film: crowd.mp4, or crowd.gif where imageio-ffmpeg is not installed. Replaces what an
    earlier crowd wrote into the folder, and leaves other files alone.

    Parameters
    ----------
    members : how many walk.
    through : a .csv with the points to pass in turn, x, z in metres.
    around : a .csv with obstacles, x, z, radius in metres.
    out : folder for the new files.
    graph : an .npz file from `mocap graph` (default: one of generated walks).
    to : format of the motions.
    no_film : write no film, which takes the longest.

    Notes
    -----
    Example: mocap crowd --members 12 --through points.csv --around discs.csv -o crowd/
    """
    require_folder(out)
    points = files.load_rows(through)
    discs = files.load_rows(around, ("x", "z", "radius")) if around else []
    scene = groups.Scene(
        tuple(complex(z, x) for x, z in points),
        tuple((complex(z, x), float(radius)) for x, z, radius in discs),
    )
    scene.check(0j)
    walks = _graph(graph, skeleton)
    group = groups.build_group(members, seed=seed)
    start, found = _plan(group, scene)
    frames = round(found.seconds * groups.RATE) + 1
    plan = groups.Trajectories(*(part[:frames] for part in groups.play_group(group, found.clips, start)))
    tell(planned=f"{found.seconds:.1f} s for {members} members, {found.expanded} states")
    walkers = groups.walk_group(walks, plan, progress=bar("walking"))
    tell(walked=walkers.report())
    _write(walkers.motions, plan.places, scene, out, to, no_film=no_film)
    tell(wrote=out)


def _graph(path: Path | None, skeleton: Path | None) -> "MotionGraph":
    """Load the graph asked for, or build one of generated walks."""
    if path is None and skeleton:
        raise MocapError("--skeleton belongs to --graph: the generated walks have a skeleton of their own.")
    if path is None:
        return graphs.prune(Building().build([datasets.sample(name) for name in WALKS]))
    graph = load_graph(path, skeleton)
    if not graph.count("transition"):
        raise NoWalk(f"{path} has no transition: no character can walk where it should.")
    return graph


def _plan(group: "GroupGraph", scene: "Scene") -> "tuple[Placed, GroupWalk]":
    """Plan a way that sets out towards the first point or, where that is closed, to one side of it."""
    refused: list[NoWalk] = []
    for turn in TURNS:
        start = groups.Placed(0, cmath.rect(1.0, cmath.phase(scene.points[0]) + turn))
        try:
            return start, groups.plan_group(group, scene, start=start, **({"most": SOON} if turn else {}))
        except NoWalk as error:
            refused.append(error)
    raise refused[0]


def _write(
    motions: "Sequence[Motion]", places: "Points", scene: "Scene", folder: Path, to: str, *, no_film: bool
) -> None:
    """Write a crowd's files; once all are whole, remove those of an earlier crowd that this one lacks."""
    film = "crowd.mp4" if find_spec("imageio_ffmpeg") else "crowd.gif"
    make_folder(folder)
    names = [f"member-{number:02}.{to}" for number in range(1, len(motions) + 1)]
    old, new = _written(folder), {*names, *([] if no_film else [film])}
    try:
        with TemporaryDirectory(prefix=".", dir=folder) as beside:
            for name, motion in zip(names, motions, strict=True):
                files.save(motion, Path(beside, name))
            _save_plan(places, scene, folder, old | new)  # before the others: it names all that is ever there
            for name in names:
                Path(beside, name).replace(folder / name)
        if not no_film:
            _film(motions, scene, folder / film)
        stale = [name for name in old - new if (folder / name).is_file()]
        for name in stale:
            (folder / name).unlink()
    except OSError as error:
        raise MocapError(f"Cannot write into {folder}: {error.strerror or error}.") from error
    _save_plan(places, scene, folder, new)
    if stale:
        tell(removed=f"{len(stale)} of the files of an earlier crowd")


def _save_plan(places: "Points", scene: "Scene", folder: Path, names: set[str]) -> None:
    """Save the plan as a picture that says, in a comment in the file, what was written beside it."""
    figure = plotting.draw_group_plan(places, scene.points, scene.discs, near=scene.near)
    with replacing(folder / "plan.png") as beside:
        figure.savefig(beside, format="png", metadata={"Comment": "\n".join([WROTE, *sorted(names), ""])})


def _written(folder: Path) -> set[str]:
    """Name the files that an earlier crowd wrote, as its plan says: other files may have such names, too."""
    with suppress(OSError):
        plan = (folder / "plan.png").read_bytes().decode("latin-1")
        return set(OURS.findall(plan.partition(WROTE)[2][:LONGEST]))
    return set()


def _film(motions: "Sequence[Motion]", scene: "Scene", path: Path) -> None:
    """Write an .mp4 where that can be; a .gif has half the frames, and is three times as large even so."""
    discs = [(centre.imag, centre.real, radius) for centre, radius in scene.discs]
    fps = 25.0 if path.suffix == ".mp4" else 12.5
    widgets.save_animation(motions, path, discs=discs, fps=fps, progress=bar("drawing"))
