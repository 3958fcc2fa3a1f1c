"""Saved motion graphs, which all commands read with their clips, also if these have moved."""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mocap import editing, graphs
from mocap.cli.options import Sources, require_file, with_chosen_roles
from mocap.cli.outputs import require_other
from mocap.cli.stages import bar
from mocap.errors import MocapError, MocapWarning
from mocap.files.conversion import find_files

if TYPE_CHECKING:
    from mocap.graphs.motion_graph import MotionGraph

BUILD_FIRST = "build a graph of it first, by mocap graph {}"

MovedClips = Annotated[
    Sequence[Path],
    "the clips of the graph, or folders of them, in which they are found by content (default: those from "
    "which it was built, at their stored locations)",
]


def load_graph(
    path: Path, sources: Sources, clips: Sequence[Path] = (), out: Path | None = None
) -> "MotionGraph":
    """Read a graph with its clips, from given files and folders or from the locations that it stores.

    Parameters
    ----------
    path : the graph.
    sources : how the clips are read. Its roles of joints replace those of the graph.
    clips : the files and folders; empty for the stored locations.
    out : the file that the command writes, which must be none of those that it reads.

    Raises
    ------
    MocapError : for a folder in place of a graph, options of clips without clips, and as for `graphs.load`.
    """
    from mocap.editing.mirroring import mirrored_name  # the help needs no NumPy
    from mocap.graphs.storage import find_origins, read

    require_file(path, BUILD_FIRST.format(path))
    reading = {"--scale": sources.scale, "--up": sources.up, "--root-offset": sources.root_offset}
    options_given = [option for option, value in reading.items() if value is not None]
    if options_given and not clips:
        raise MocapError(
            f"{options_given[0]} belongs to --clips: the graph remembers how its own clips are read."
        )
    files_read = find_files(clips) if clips else []
    if out is not None:
        require_other(out, files_read or [origin.path for origin in find_origins(path)])
    with warnings.catch_warnings():
        lopsided = ".* so its mirror image does not"  # `mocap graph` has already warned
        warnings.filterwarnings("ignore", lopsided, MocapWarning)
        if not clips:
            motion_graph = graphs.load(path, skeleton=sources.skeleton, progress=bar("reading"))
            return _with_joints(motion_graph, sources.joints)
        names = read(path).names
        motions, _ = sources.load(files_read, clips)
        motions += [editing.mirror(clip) for clip in motions if mirrored_name(clip.name) in names]
    return _with_joints(graphs.load(path, motions), sources.joints)


def _with_joints(motion_graph: "MotionGraph", joints: Sequence[Path]) -> "MotionGraph":
    """Return a graph whose clips have the roles of files, instead of those that the graph stores."""
    if not joints:
        return motion_graph
    clips = tuple(with_chosen_roles(clip, joints) for clip in motion_graph.clips)
    return replace(motion_graph, clips=clips)
