"""The commands that build motion graphs: `mocap demo`, `mocap graph build` and `mocap graph info`."""

import math
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from mocap import datasets, editing, graphs, quality, synthesis, widgets
from mocap._shared.atomic import make_folder, require_folder
from mocap.cli.options import Building, Seed, bar, check_out, number, require_other, tell, write_out
from mocap.cli.typed_commands import Group
from mocap.datasets.clip_origins import Origin
from mocap.errors import MocapError, MocapWarning, NoWalk, warn
from mocap.files.conversion import find_files

SHOWN = 7  # names of clips


def demo(
    clips: Sequence[Path] = (),
    *,
    out: Path = Path("mocap-demo"),
    building: Building,
    seconds: Annotated[float, number(0.1, 3600)] = 12.0,
    seed: Seed = 0,
) -> None:
    """Make a new walk out of clips, as walk.bvh and walk.gif.

    Build a motion graph of some clips, prune it, walk through it at random, and write the new motion as
    walk.bvh (centimetres) and walk.gif.

    Parameters
    ----------
    clips : motion files, or folders of them (default: the bundled clips).
    out : folder to write to.
    seconds : duration of the new walk.
    """
    require_folder(out)
    sources = find_files(clips)
    require_other(out / "walk.bvh", sources)
    motions = building.load(sources) if clips else [datasets.sample(name) for name in datasets.SAMPLES]
    whole = building.build(motions, bar("comparing"))
    try:
        pruned = graphs.prune(whole)
    except NoWalk as error:
        from mocap.graphs.thresholds import smallest_threshold  # the help needs no NumPy

        smallest = math.ceil(1e4 * smallest_threshold(whole.clips, window=whole.window)) / 100  # cm
        threshold = f"a threshold of {building.threshold:g} cm"
        raise NoWalk(f"No walk is left at {threshold}; these clips need at least {smallest:g} cm.") from error
    edges = synthesis.random_walk(pruned, seconds=seconds, seed=seed)
    walk = synthesis.to_motion(pruned, edges)
    costs = [100 * seam.cost for seam in synthesis.seams(pruned, edges)]
    names = [clip.name for clip in whole.clips]
    frames = sum(map(len, whole.clips))
    shown = ", ".join(names if len(names) <= SHOWN else [*names[:SHOWN], f"… {names[-1]}"])
    tell(clips=f"{len(names)}: {shown}")
    tell(frames=f"{frames} at {whole.fps:g} Hz, {frames / whole.fps:.1f} s")
    tell(body=f"{len(walk.skeleton)} joints, {quality.inspect(whole.clips[0]).height:.2f} m tall")
    tell(candidates=f"{whole.count('transition') // 2} pairs of windows alike")
    print(f"{'':<12} {'whole':>8}{'pruned':>8}")
    tell(transitions=f"{whole.count('transition'):8}{pruned.count('transition'):8}")
    tell(nodes=f"{len(whole.graph):8}{len(pruned.graph):8}")
    tell(edges=f"{whole.graph.number_of_edges():8}{pruned.graph.number_of_edges():8}")
    tell(**{"new walk": f"{walk.duration:.1f} s, {quality.inspect(walk).path:.1f} m"})
    tell(seams=f"{len(costs)}, the worst {max(costs, default=0.0):.1f} cm RMS")
    make_folder(out)
    write_out(walk, out / "walk.bvh")
    widgets.save_animation(walk, out / "walk.gif", progress=bar("drawing"))
    tell(wrote=out / "walk.gif")


def build(
    clips: Sequence[Path],
    *,
    out: Path = Path("graph.npz"),
    building: Building,
    by_labels: bool = False,
    whole: bool = False,
    mirror: bool = False,
    graphml: Path | None = None,
) -> None:
    """Build a motion graph, prune it and save it.

    Parameters
    ----------
    clips : motion files, or folders of them.
    out : file to write.
    by_labels : keep the largest component of each set of labels.
    whole : do not prune.
    mirror : add the mirror image of every clip: turns to both sides.
    graphml : a second file to write, .graphml, for other tools.

    Notes
    -----
    Example: mocap graph clips/ --mirror -o graph.npz
    """
    if by_labels and whole:
        raise MocapError("--by-labels says how to prune, --whole not to prune: give one of them.")
    sources = find_files(clips)
    check_out("graph", out, sources, [".npz"])
    if graphml:
        check_out("graph for other tools", graphml, sources, [".graphml"])
    motions = building.load(sources)
    origins = [Origin(file, building.skeleton, building.scale) for file in sources]
    if mirror:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", MocapWarning)
            motions += [editing.mirror(clip) for clip in motions]
        if caught:  # where bodies are lopsided, one warning is enough
            number = f" So it is with {len(caught) - 1} more." if len(caught) > 1 else ""
            warn(f"{caught[0].message}{number}")
        origins += [origin._replace(mirrored=True) for origin in origins]
    graph = building.build(motions, bar("comparing"))
    if not whole:
        graph = graphs.prune(graph, by_labels=by_labels)
    print(graphs.summary(graph.graph, fps=graph.fps).table())
    graphs.save(graph, out, origins)
    tell(wrote=out)
    if graphml:
        from mocap.graphs.graph_summary import write_graphml  # the help needs no NumPy

        write_graphml(graph, graphml)
        tell(wrote=graphml)


def info(file: Path) -> None:
    """Describe a saved graph.

    List a saved graph's clips and what it can play.

    Parameters
    ----------
    file : an .npz file from `mocap graph`.
    """
    from mocap.graphs.storage import read  # the help needs no NumPy

    content = read(file)
    for name, frames in zip(content.names, content.frames, strict=True):
        tell(clip=f"{name}: {frames} frames at {content.fps:g} Hz, {frames / content.fps:.1f} s")
    tell(window=f"{content.window} frames, {content.window / content.fps:.2f} s")
    print(graphs.summary(content.graph, fps=content.fps).table())


TEXT = """Build a motion graph and save it, or describe a saved one.

Build the motion graph of some clips, prune it and save it; or describe a saved graph. The graph remembers
where its clips are. The word `build` may be left out. For a folder of clips called info, write ./info.

Notes
-----
Example: mocap graph clips/ --mirror -o graph.npz"""
GRAPH = Group(TEXT, {"build": build, "info": info}, build)
