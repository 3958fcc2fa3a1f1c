"""The command `mocap walk`: a walk through a saved graph, along a path or at random."""

import itertools
import math
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mocap import editing, files, graphs, steering, synthesis
from mocap.cli.options import (
    LENGTH,
    TURN,
    Clean,
    Skeleton,
    Sources,
    Unit,
    bar,
    check_out,
    load_graph,
    number,
    require_other,
    tell,
    write_out,
)
from mocap.datasets.clip_origins import find_again
from mocap.errors import MocapError, MocapWarning

if TYPE_CHECKING:
    from mocap.graphs.motion_graph import MotionGraph

UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
LONGEST = 24 * 3600.0  # seconds of a random walk


def walk(
    graph: Path,
    *,
    path: Path | None = None,
    random: str | None = None,
    out: Path = Path("walk.bvh"),
    clips: Sequence[Path] = (),
    skeleton: Skeleton = None,
    scale: Annotated[float | None, LENGTH] = None,
    unit: Unit = None,
    label: Annotated[Sequence[str], {"action": "append", "nargs": None, "default": []}] = (),
    bend: Annotated[float | None, TURN, {"nargs": "?", "const": 60.0}] = None,
    width: Annotated[int | None, number(1, 10_000, int)] = None,
    clean: Clean = False,
    seed: Annotated[int | None, number(0, 2**32 - 1, int)] = None,
) -> int:
    """Walk through a saved graph, along a path or at random.

    Walk through a graph saved by `mocap graph`, along a path drawn on the ground or at random, and write the
    motion as .bvh (centimetres) or .glb (for engines and viewers). Ctrl-C while it searches writes the best
    walk so far.

    Parameters
    ----------
    graph : an .npz file from `mocap graph`.
    path : a path: .csv with points x, z in metres, or an .svg picture.
    random (TIME) : duration of a random walk, such as 60s, 10min or 1h.
    out : file to write.
    clips : the clips of the graph (default: those that it was built of, where it remembers them).
    scale : metres per unit of length in the .bvh clips that --clips names.
    label (METRES:LABEL) : kind of motion from that many metres along the path, as in 6.5:sneak; may be
        repeated.
    bend (DEGREES) : lay the walk on the path, turned by up to so many degrees per second (without a number:
        60).
    width : walks that the search keeps at a time (default: 100).
    seed : seed of the random walk (default: 0).

    Notes
    -----
    Example: mocap walk graph.npz --path line.csv --bend -o walk.bvh
    """
    if (path is None) == (random is None):
        raise MocapError("Give one of --path and --random: where to walk, or for how long.")
    if random is not None and (label or width or unit or bend):
        raise MocapError("--label, --bend, --width and --unit belong to --path, not to --random.")
    if random is None and seed is not None:
        raise MocapError("--seed belongs to --random: a walk along a path leaves nothing to chance.")
    if scale and not clips:
        raise MocapError("--scale belongs to --clips: the graph remembers the unit of its own clips.")
    check_out("walk", out, (".bvh", ".glb"))
    if path is None:
        seconds, found = _seconds(random or ""), _graph(graph, clips, Sources(skeleton, scale), out)
        frames = synthesis.dump(
            found, out, seconds=seconds, seed=seed or 0, clean=clean, progress=bar("writing")
        )
        tell(walked=f"{frames / found.fps:.1f} s at random", wrote=out)
        return 0
    line = files.load_path(path, scale=unit)
    wishes = steering.Wishes(labels=[_label(text) for text in label])
    settings = steering.Settings(width=width or 100, progress=bar("searching"))
    found = _graph(graph, clips, Sources(skeleton, scale), out)
    followed = steering.follow_path(found, line, wishes, settings=settings, bend=math.radians(bend or 0))
    tell(walked=followed.report())
    write_out(followed.motion(clean=clean or bool(bend)), out)
    return 130 if followed.found.stopped else 0


def _seconds(text: str) -> float:
    """Read a duration.

    Examples
    --------
    >>> _seconds("60s"), _seconds("1.5min"), _seconds("2")
    (60.0, 90.0, 2.0)
    """
    found = re.fullmatch(r"(\d+\.?\d*|\.\d+)\s*(s|min|h)?", text.strip())
    seconds = float(found[1]) * UNITS[found[2] or "s"] if found else 0.0
    if not 0 < seconds <= LONGEST:
        raise MocapError(f"How long is '{text[:40]}'? Write 60s, 10min or 1h, up to 24h.")
    return seconds


def _label(text: str) -> tuple[float, str]:
    """Read a label and where it starts, as in 6.5:sneak."""
    metres, _, label = text.partition(":")
    try:
        return float(metres), label
    except ValueError:
        raise MocapError(f"From where on is '{text[:40]}'? Write METRES:LABEL, as in 6.5:sneak.") from None


def _graph(path: Path, clips: Sequence[Path], sources: Sources, out: Path) -> "MotionGraph":
    """Read the graph, and the clips that it was built of: those given, or those that it remembers."""
    found = graphs.read(path)
    require_other(out, files.find_files(clips) if clips else _remembered(path, out.suffix))
    with warnings.catch_warnings():
        lopsided = ".* so its mirror image does not"  # `mocap graph` has said so
        warnings.filterwarnings("ignore", lopsided, MocapWarning)
        if not clips:
            return load_graph(path, sources.skeleton)
        given = sources.load(clips)
        given += [editing.mirror(c) for c in given if editing.mirrored_name(c.name) in found.names]
    return load_graph(path, None, given)


def _remembered(path: Path, suffix: str) -> list[Path]:
    """List the files of a graph's clips, as it remembers them or of their names beside it."""
    found, folder, sources = graphs.read(path), path.parent, list[Path]()
    for name, text in itertools.zip_longest(found.names, found.origins):
        origin = find_again(text, folder) if text else None
        sources.append(origin.path if origin else folder / f"{name}{suffix}")
    return [source for source in sources if source.is_file()]
