"""A page on which a figure is steered through a graph and recorded: `mocap steer`."""

import gc
import sys
from collections.abc import Callable, Sequence
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mocap import files
from mocap.cli.messages import print_message
from mocap.cli.option_types import Joints, Skeleton, number
from mocap.cli.options import Sources, named_options, require_file
from mocap.cli.outputs import check_out, print_rows, warn_of_lost_roles
from mocap.cli.saved_graphs import BUILD_FIRST, MovedClips, load_graph
from mocap.cli.stages import timed_stage
from mocap.cli.typed_commands import ONE_EACH
from mocap.cli.walk import INTERRUPTED
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.graphs.motion_graph import MotionGraph


def steer(
    graph: Path | None = None,
    *,
    out: Path | None = None,
    port: Annotated[int, number(0, 65535, int)] = 0,
    no_browser: bool = False,
    label: Annotated[Sequence[str], ONE_EACH] = (),
    clips: MovedClips = (),
    skeleton: Skeleton = None,
    joints: Joints = (),
) -> int:
    """Steer a figure through a graph by keys, gamepad, mouse or finger, and record it.

    A page opens in the browser. There, arrow keys or W, A, S, D, the left stick of a gamepad, or a place on
    the ground that is pressed set the direction, and Shift sets the faster pace. The space key starts and
    ends a recording, which the page offers as a .bvh file. Only this machine can open the page. Ctrl-C ends
    it. Without a graph, the bundled clips are steered.

    Parameters
    ----------
    graph : an .npz file from `mocap graph` (default: a graph of the bundled clips).
    out : file to which recordings are also written, .bvh, .glb, .npz or .csv. A second recording is written
        beside the first one, as in steered-2.bvh.
    port : port of the page on this machine, 0 for a free one.
    no_browser : print the address of the page, and open no browser.
    label : kind of motion to choose from. The option may be repeated: the first kind is that of the start,
        and the second that of Shift (default: any kind, and with Shift the fastest).

    Notes
    -----
    Example: mocap steer graph.npz -o steered.bvh
    """
    if graph is None and (skeleton or joints or clips):
        raise MocapError("--skeleton, --joints and --clips belong to a graph: the bundled clips need none.")
    if graph:
        require_file(graph, BUILD_FIRST.format(graph))
    if out:
        check_out("recording", out, [graph] if graph else [])
    with timed_stage("loading packages"):
        from mocap.graphs.storage import licences_in  # the help needs no NumPy
        from mocap.widgets.steering_server import SteeringServer

    motions = _graph_of(graph, Sources(skeleton, joints=joints), clips, out)
    licences = sorted({name or "unknown" for name in licences_in(graph).values()}) if graph else []
    with timed_stage("preparing the figure"), named_options({"port": "--port"}):
        server = SteeringServer(motions, label, port=port, recorded=_writer(out))
    with server:
        if licences:
            print_rows(licences=", ".join(licences))
        _print_now(steer=server.address)
        print_message("only this machine can open the page; Ctrl-C ends it.")
        gc.freeze()  # a step waits for no visit of the collector to the graph
        try:
            if not no_browser:
                _open(server.address)
            server.serve_forever()
        except KeyboardInterrupt:
            print_message(f"the page has ended, after {_counted(server.recordings)}.")
    return INTERRUPTED


def _graph_of(path: Path | None, sources: Sources, clips: Sequence[Path], out: Path | None) -> "MotionGraph":
    """Load a graph, or build that of the bundled clips."""
    from mocap.widgets.walking_page import bundled_graph  # the help needs no NumPy

    return load_graph(path, sources, clips, out) if path else bundled_graph()


def _writer(out: Path | None) -> "Callable[[Motion], str]":
    """Return a function that writes each recording to a file of its own, and says to which."""
    written: list[Path] = []

    def write(motion: "Motion") -> str:
        if out is None:
            _print_now(recorded=f"{motion.duration:.1f} s")
            return ""
        file = _free_name(out) if written else out
        files.save(motion, file)
        written.append(file)
        _print_now(wrote=f"{file}, {motion.duration:.1f} s")
        warn_of_lost_roles(motion, file)
        return f"It is also in {file}."

    return write


def _print_now(**rows: object) -> None:
    """Print results at once, also if the output is no terminal: the command goes on."""
    print_rows(**rows)
    sys.stdout.flush()


def _free_name(out: Path) -> Path:
    """Return the first of steered-2.bvh, steered-3.bvh and so on that does not exist."""
    names = (out.with_stem(f"{out.stem}-{number}") for number in count(2))
    return next(name for name in names if not name.exists())


def _open(address: str) -> None:
    """Open the page in the browser, or say that none opened."""
    import webbrowser  # imported here, because it takes a while

    if not webbrowser.open(address):
        print_message("no browser opened; open that address yourself.")


def _counted(recordings: int) -> str:
    """Return a number of recordings in words.

    Examples
    --------
    >>> _counted(1), _counted(3)
    ('1 recording', '3 recordings')
    """
    return f"{recordings} recording{'' if recordings == 1 else 's'}"
