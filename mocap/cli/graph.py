"""The commands `mocap graph build` and `mocap graph info`: a motion graph that is saved, or described."""

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import datasets, editing, files, graphs
from mocap._shared.atomic import require_npz, require_writable
from mocap.cli.options import Building, bar, require_other, tell
from mocap.cli.typed_commands import Group
from mocap.errors import MocapError, MocapWarning

if TYPE_CHECKING:
    from mocap.body.motion import Motion


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
    clips : .amc, .bvh or AMASS .npz files, or folders of them.
    out : file to write.
    by_labels : keep the largest component of each set of labels.
    whole : do not prune.
    mirror : add the mirror image of every clip: turns to both sides.
    graphml : a second file to write, .graphml, for other tools.

    Notes
    -----
    Example: mocap graph clips/ --mirror -o graph.npz
    """
    require_npz(out)
    require_writable(out)
    if graphml and graphml.suffix.lower() != ".graphml":
        raise MocapError(f"--graphml writes .graphml, got '{graphml}'.")
    if graphml:
        require_writable(graphml)
    if by_labels and whole:
        raise MocapError("--by-labels says how to prune, --whole not to prune: give one of them.")
    building.frames()
    found = files.find_files(clips)
    require_other(out, found)
    motions = building.load(found)
    origins = [datasets.Origin(file, building.skeleton, building.scale) for file in found]
    if mirror:
        motions += _mirrored(motions)
        origins += [origin._replace(mirrored=True) for origin in origins]
    graph = building.build(motions, bar("comparing"))
    if not whole:
        graph = graphs.prune(graph, by_labels=by_labels)
    print(graphs.summary(graph.graph, fps=graph.fps).table())
    graphs.save(graph, out, origins)
    tell(wrote=out)
    if graphml:
        graphs.write_graphml(graph, graphml)
        tell(wrote=graphml)


def _mirrored(clips: "list[Motion]") -> "list[Motion]":
    """Mirror all clips; where bodies are lopsided, one warning is enough."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", MocapWarning)
        images = [editing.mirror(clip) for clip in clips]
    if caught:
        more = f" So it is with {len(caught) - 1} more." if len(caught) > 1 else ""
        warnings.warn(f"{caught[0].message}{more}", MocapWarning, stacklevel=2)
    return images


def info(file: Path) -> None:
    """Describe a saved graph.

    List a saved graph's clips and what it can play.

    Parameters
    ----------
    file : an .npz file from `mocap graph`.
    """
    found = graphs.read(file)
    for name, frames in zip(found.names, found.frames, strict=True):
        tell(clip=f"{name}: {frames} frames at {found.fps:g} Hz, {frames / found.fps:.1f} s")
    tell(window=f"{found.window} frames, {found.window / found.fps:.2f} s")
    print(graphs.summary(found.graph, fps=found.fps).table())


TEXT = """Build a motion graph and save it, or describe a saved one.

Build the motion graph of some clips, prune it and save it; or describe a saved graph. The graph remembers
where its clips are. The word `build` may be left out. For a folder of clips called info, write ./info.

Notes
-----
Example: mocap graph clips/ --mirror -o graph.npz"""
USAGE = "mocap graph [build] CLIPS... -o graph.npz\n       mocap graph info graph.npz"
GRAPH = Group(TEXT, {"build": build, "info": info}, USAGE)
