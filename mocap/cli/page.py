"""A web page on which a figure walks through a graph: `mocap page`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mocap._shared.atomic import write_file
from mocap.cli.option_types import Joints, Skeleton
from mocap.cli.options import Sources, require_file
from mocap.cli.outputs import check_out, open_page, print_rows, require_address
from mocap.cli.saved_graphs import BUILD_FIRST, MovedClips, load_graph
from mocap.cli.stages import timed_stage
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.graphs.motion_graph import MotionGraph


def page(
    graph: Path | None = None,
    *,
    out: Path | None = None,
    address: str = "",
    clips: MovedClips = (),
    skeleton: Skeleton = None,
    joints: Joints = (),
) -> None:
    """Create a web page on which a figure walks along drawn paths.

    The page is one file that contains the motion graph and needs no network. It can be sent, or published on
    a website. Without arguments, the page of the bundled clips is written and opened in the browser.

    Parameters
    ----------
    graph : an .npz file from `mocap graph` (default: a graph of the bundled clips).
    out : file to write, .html (default: walk.html).
    address (URL) : where the page will be published, as in https://example.org/walk.html. Links to the page
        then show a picture, which is written beside it as a .png.

    Notes
    -----
    Example: mocap page graph.npz -o walk.html
    """
    _check_page(graph, address, skeleton or joints or clips)
    file = out or Path("walk.html")
    check_out("page", file, formats=[".html"])
    if graph:
        require_file(graph, BUILD_FIRST.format(graph))
    with timed_stage("loading packages"):
        from mocap.widgets.link_picture import link_picture  # the help needs no NumPy
        from mocap.widgets.walking_page import walk_page

    motions = _graph_of(graph, Sources(skeleton, joints=joints), clips)
    picture = file.with_suffix(".png")
    shown = address.rpartition("/")[0] + f"/{picture.name}" if address else ""
    with timed_stage("making the page"):
        text = walk_page(motions, picture=shown)
    write_file(file, text)
    print_rows(wrote=f"{file}, {len(text) / 1e6:.2f} MB")
    if address:
        write_file(picture, link_picture(motions))
        print_rows(wrote=picture)
    if not (graph or out or address):
        open_page(file)


def _graph_of(path: Path | None, sources: Sources, clips: Sequence[Path]) -> "MotionGraph":
    """Load a graph, or build that of the bundled clips."""
    from mocap.widgets.walking_page import bundled_graph  # the help needs no NumPy

    return load_graph(path, sources, clips) if path else bundled_graph()


def _check_page(graph: Path | None, address: str, value: object) -> None:
    """Raise for options of a graph without a graph, and for an address that is no URL."""
    if graph is None and value:
        raise MocapError("--skeleton, --joints and --clips belong to a graph: the bundled clips need none.")
    require_address(address, "https://example.org/walk.html")
