"""The commands that build motion graphs: `mocap demo`, `mocap graph build` and `mocap graph info`."""

import math
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

from mocap import datasets, editing, graphs, quality, synthesis, widgets
from mocap._shared.atomic import make_folder, require_folder, write_file
from mocap.cli.clusters import connect
from mocap.cli.option_types import Seed, number
from mocap.cli.options import Building
from mocap.cli.outputs import check_out, print_rows, require_other, write_out
from mocap.cli.stages import bar, timed_stage
from mocap.cli.tuned import TUNED
from mocap.cli.typed_commands import Group
from mocap.datasets.clip_origins import Origin
from mocap.errors import MocapError, MocapWarning, NoWalk, SkeletonMismatch, warn
from mocap.files.conversion import find_files

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.graphs.motion_graph import MotionGraph

SHOWN = 7  # names of clips
FILM_RATE = 12.5  # pictures per second of a film, which take most of the time of a demonstration
LONG_WINDOW = 3.0  # seconds. A larger value may have been meant as frames
SMALL_THRESHOLD = 0.3  # cm. A smaller value may have been meant as metres


def demo(
    clips: Sequence[Path] = (),
    *,
    out: Path = Path("mocap-demo"),
    building: Building,
    seconds: Annotated[float, number(0.1, 3600)] = 12.0,
    no_film: bool = False,
    seed: Seed = 0,
) -> None:
    """Create a page that walks along drawn paths, and a new walk, from clips.

    Build a motion graph of some clips, and prune it. Write walk.html, a page on which a figure walks along
    drawn paths. Then walk through the graph at random, and write the new motion as walk.bvh (centimetres) and
    as a film, walk.gif.

    Parameters
    ----------
    clips : motion files, or folders of them (default: the bundled clips).
    out : folder to write to.
    seconds : duration of the new walk, seconds.
    no_film : do not write the film, which takes most of the time.

    Notes
    -----
    Example: mocap demo --seconds 20 -o demo/
    """
    require_folder(out)
    paths = find_files(clips)
    require_other(out / "walk.bvh", paths)
    motions = [datasets.sample(name) for name in datasets.SAMPLES]
    if clips:
        motions, _ = building.load(paths, clips)
    whole = building.build(motions, bar("comparing"))
    try:
        pruned = graphs.prune(whole)
    except NoWalk as error:
        from mocap.graphs.thresholds import smallest_threshold  # the help needs no NumPy

        needed = math.ceil(1e4 * smallest_threshold(whole.clips, window=whole.window)) / 100
        threshold = f"a threshold of {building.threshold:g} cm"
        raise NoWalk(f"No walk is left at {threshold}; these clips need at least {needed:g} cm.") from error
    edges = synthesis.random_walk(pruned, seconds=seconds, seed=seed)
    walk = synthesis.to_motion(pruned, edges)
    _print_graphs(whole, pruned)
    costs = [100 * seam.cost for seam in synthesis.seams(pruned, edges)]
    print_rows(**{"new walk": f"{walk.duration:.1f} s, {quality.inspect(walk).path:.1f} m"})
    print_rows(seams=f"{len(costs)}, the worst {max(costs, default=0.0):.1f} cm RMS")
    make_folder(out)
    with timed_stage("making the page"):
        from mocap.widgets.walking_page import walk_page  # the help needs no NumPy

        write_file(out / "walk.html", walk_page(pruned))
    print_rows(wrote=f"{out / 'walk.html'}: open it in a browser, and draw")
    write_out(walk, out / "walk.bvh")
    if not no_film:
        widgets.save_animation(walk, out / "walk.gif", fps=FILM_RATE, progress=bar("drawing"))
        print_rows(wrote=out / "walk.gif")


def _print_graphs(whole: "MotionGraph", pruned: "MotionGraph") -> None:
    """Print the clips of a graph, and its size before and after pruning."""
    names = [clip.name for clip in whole.clips]
    frames = sum(map(len, whole.clips))
    shown = ", ".join(names if len(names) <= SHOWN else [*names[:SHOWN], f"… {names[-1]}"])
    body = whole.clips[0]
    print_rows(clips=f"{len(names)}: {shown}")
    print_rows(frames=f"{frames} at {whole.fps:g} Hz, {frames / whole.fps:.1f} s")
    print_rows(body=f"{len(body.skeleton)} joints, {quality.inspect(body).height:.2f} m tall")
    print_rows(candidates=f"{whole.count('transition') // 2} pairs of windows alike")
    print(f"{'':<12} {'whole':>8}{'pruned':>8}")
    pair = (whole, pruned)
    rows = {"transitions": [graph.count("transition") for graph in pair]}
    rows["nodes"] = [graph.graph.number_of_nodes() for graph in pair]
    rows["edges"] = [graph.graph.number_of_edges() for graph in pair]
    for name, counts in rows.items():
        print_rows(**{name: "".join(f"{count:8}" for count in counts)})


def build(
    clips: Sequence[Path],
    *,
    out: Path = Path("graph.npz"),
    building: Building,
    by_labels: bool = False,
    whole: bool = False,
    mirror: bool = False,
    labels: Path | None = None,
    licence: str | None = None,
    pack: bool = False,
    graphml: Path | None = None,
    jobs: Annotated[int | None, number(1, 1024, int)] = None,
    cluster: str | None = None,
) -> None:
    """Build a motion graph, prune it and save it.

    Parameters
    ----------
    clips : motion files, or folders of them.
    out : file to write, .npz.
    by_labels : keep the largest component of each set of labels.
    whole : do not prune the graph.
    mirror : add the mirror image of each clip, so that all turns exist to the left and to the right.
    labels : a .csv table with the columns clip, from, to and label, as written by mocap label. Its labels
        replace those of the clips that it names.
    licence (TEXT) : licence of the clips, or a .csv table with the columns clip and licence (default: that of
        a known data set). mocap walk lists the licences of a walk.
    pack : let the file carry its clips, so that it can be given away, with rotations as 16-bit numbers.
    graphml : second file to write, .graphml, for other tools.
    jobs : number of threads that compare clips (default: all cores that this process may use).
    cluster (ADDRESS) : compare clips on the workers of a Dask scheduler, as in tcp://10.0.0.5:8786. The graph
        is the same.

    Notes
    -----
    Example: mocap graph clips/ --mirror -o graph.npz
    """
    if jobs and cluster:
        raise MocapError("--jobs says how many threads work here, --cluster works elsewhere: give one.")
    if by_labels and whole:
        raise MocapError("--by-labels says how to prune, --whole not to prune: give one of them.")
    with timed_stage("finding the clips"):
        paths = find_files(clips)
    check_out("graph", out, paths, [".npz"])
    if graphml:
        check_out("graph for other tools", graphml, paths, [".graphml"])
    with connect(cluster) if cluster else nullcontext() as executor:
        read = _Clips(*building.load(paths, clips)).labelled(labels).licensed(licence)
        motions, origins = _mirrored(*read) if mirror else read
        with timed_stage("building"), _units_explained(building):
            graph = building.build(motions, bar("comparing"), jobs=jobs, executor=executor)
    if not whole:
        with timed_stage("pruning"), _units_explained(building):
            graph = graphs.prune(graph, by_labels=by_labels)
    with timed_stage("describing"):
        table = graphs.summary(graph).table()
    print(table)
    if not (whole or by_labels):
        _propose_threshold(graph, building)
    with timed_stage("writing"):
        graphs.save(graph, out, origins, pack=pack)
    if pack:
        from mocap.datasets.packed_clips import as_packed, packing_error  # the help needs no NumPy

        error = packing_error(graph.clips, as_packed(graph.clips))
        print_rows(packed=f"{len(graph.clips)} clips, whose joints move by at most {1e3 * error:.2g} mm")
    print_rows(wrote=out)
    if graphml:
        from mocap.graphs.graph_summary import write_graphml  # the help needs no NumPy

        write_graphml(graph, graphml)
        print_rows(wrote=graphml)


def _propose_threshold(pruned: "MotionGraph", building: Building) -> None:
    """Print how many frames larger thresholds would play, if a pruned graph plays few of its clips."""
    from mocap.graphs.thresholds import playable_fractions  # the help needs no NumPy

    frames = sum(map(len, pruned.clips))
    played = graphs.summary(pruned).frames
    if played >= TUNED.holds_together * frames or frames > TUNED.proposed_frames:
        return
    thresholds = [factor * building.threshold for factor in TUNED.larger_thresholds]
    metres = [threshold / 100 for threshold in thresholds]
    fractions = playable_fractions(pruned.clips, window=pruned.window, thresholds=metres).tolist()
    larger = list(zip(thresholds, fractions, strict=True))
    shown = ", ".join(f"{fraction:.0%} at {threshold:g}" for threshold, fraction in larger)
    sufficient = [threshold for threshold, fraction in larger if fraction >= TUNED.holds_together]
    advice = f"try --threshold {sufficient[0]:g}" if sufficient else "these clips hardly resemble each other"
    at_this = f"{played / frames:.0%} of the frames at {building.threshold:g} cm"
    print_rows(playable=f"{at_this}, {shown}: {advice}")


@contextmanager
def _units_explained(building: Building) -> Iterator[None]:
    """Add the unit of an option to an error if its value may have been meant in another unit."""
    try:
        yield
    except SkeletonMismatch:
        raise
    except MocapError as error:
        advice = ""
        if building.window > LONG_WINDOW:
            advice = f" --window is in seconds: {building.window:g} is {building.window:g} s; try 0.33."
        elif isinstance(error, NoWalk) and building.threshold < SMALL_THRESHOLD:
            advice = f" --threshold is in cm: {building.threshold:g} is {building.threshold:g} cm; try 4."
        raise type(error)(f"{error}{advice}") from error


class _Clips(NamedTuple):
    """Clips, and the files from which they were read."""

    motions: "list[Motion]"
    origins: list[Origin]

    def labelled(self, table: Path | None) -> "_Clips":
        """Give the clips the labels of a table, which their origins store."""
        if table is None:
            return self
        from mocap.files.label_tables import label_clips, load_labels  # the help needs no NumPy

        rows = load_labels(table)
        motions = label_clips(self.motions, rows)
        origins = []
        for clip, origin in zip(motions, self.origins, strict=True):
            of_clip = tuple((row.start, row.stop, row.label) for row in rows if row.clip == clip.name)
            origins.append(origin._replace(labels=of_clip))
        return _Clips(motions, origins)

    def licensed(self, stated: str | None) -> "_Clips":
        """Record the licences of the clips: that which is stated, those of a table, or of known data sets."""
        from mocap.datasets.clip_licences import read_licences, with_licences

        names = [clip.name for clip in self.motions]
        is_table = stated is not None and stated.lower().endswith(".csv")
        licences = read_licences(Path(stated), names) if stated and is_table else stated or {}
        origins = with_licences(self.origins, names, licences)
        unknown = sum(not origin.licence for origin in origins)
        if unknown:
            print_rows(licence=f"unknown for {unknown} of {len(origins)} clips; --licence records it")
        return _Clips(self.motions, origins)


def _mirrored(motions: "list[Motion]", origins: list[Origin]) -> _Clips:
    """Add the mirror images of clips."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", MocapWarning)
        motions = motions + [editing.mirror(clip) for clip in motions]
    if caught:  # one warning about asymmetric bodies is enough
        count = f" So it is with {len(caught) - 1} more." if len(caught) > 1 else ""
        warn(f"{caught[0].message}{count}")
    return _Clips(motions, origins + [origin._replace(mirrored=True) for origin in origins])


def info(file: Path) -> None:
    """Describe a saved graph.

    The description lists the clips of the graph, its size, and a summary of the motion that it can generate.

    Parameters
    ----------
    file : an .npz file from `mocap graph`.

    Notes
    -----
    Example: mocap graph info graph.npz
    """
    from mocap.graphs.storage import read  # the help needs no NumPy

    stored = read(file)
    for name, frames in zip(stored.names, stored.frames, strict=True):
        print_rows(clip=f"{name}: {frames} frames at {stored.fps:g} Hz, {frames / stored.fps:.1f} s")
    print_rows(window=f"{stored.window} frames, {stored.window / stored.fps:.2f} s")
    print(graphs.summary(stored.graph, fps=stored.fps).table())


TEXT = """Build a motion graph and save it, or describe a saved one.

The graph is pruned before it is saved. The file stores the locations of the clips, and with --pack the clips.
The word `build` may be omitted. For a folder of clips with the name info, write ./info.

Notes
-----
Example: mocap graph clips/ --mirror -o graph.npz"""
GRAPH = Group(TEXT, {"build": build, "info": info}, build)
