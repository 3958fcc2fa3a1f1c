"""The commands `mocap course`, for those who teach from the notebooks or write them, and `mocap lab`."""

import sys
from argparse import SUPPRESS
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from mocap import course
from mocap._shared.atomic import require_writable, write_text
from mocap.cli.options import bar
from mocap.cli.typed_commands import Group
from mocap.course import marking, teaching

NETWORK = {
    True: "marking without a network: notebooks cannot open a connection",
    False: "marking WITH the network: this system cannot keep notebooks from using it; a container can",
}
Moving = Annotated[bool, "run the notebooks (minutes) and record the experiments' sliders"]


def handout(*, out: Path = Path("mocap-handout")) -> None:
    """Copy the notebooks without their solutions.

    Parameters
    ----------
    out : where to write.
    """
    print(f"wrote {len(course.hand_out(course.stored(), out))} notebooks to {out}")


def site(*, out: Path = Path("mocap-site"), moving: Moving = False) -> None:
    """Write the course as HTML pages that need no network.

    Parameters
    ----------
    out : where to write.
    """
    print(f"wrote {course.build_site(course.stored(), out, bar('converting'), moving=moving)}")


def slides(*, out: Path = Path("mocap-slides"), moving: Moving = False) -> None:
    """Write the course as slides that need no network.

    Parameters
    ----------
    out : where to write.

    Notes
    -----
    For example: mocap course slides -o slides, then open slides/index.html.
    """
    print(f"wrote {teaching.build_slides(course.stored(), out, bar('converting'), moving=moving)}")


def lite(*, out: Path = Path("mocap-lite")) -> None:
    """Build a JupyterLite site, which runs in the browser.

    Parameters
    ----------
    out : where to write.
    """
    print(f"wrote {course.build_lite(course.stored(), out)}")


def film(notebook: Path, *, out: Path | None = None, still: bool = False) -> None:
    """Render a film of a notebook, of about three minutes.

    Parameters
    ----------
    notebook : file of the notebook.
    out : where to write (default: the notebook's name, here).
    still : do not run it: sliders stand still.

    Notes
    -----
    For example: mocap course film notebooks/06-pruning.ipynb -o pruning.mp4
    """
    out = out or Path(notebook.with_suffix(".mp4").name)
    require_writable(out)
    teaching.render_film(notebook, out, moving=not still, progress=bar("drawing"))
    print(f"wrote {out}")


def board(*, out: Path = Path("mocap-board")) -> None:
    """Write drawings for the board as PNGs.

    Parameters
    ----------
    out : where to write.

    Notes
    -----
    For example: mocap course board -o board, then open board/board.png.
    """
    files = teaching.write_board(out, bar("drawing"))
    print(f"wrote {len(files)} pictures to {out}; {files[-1]} shows all")


def mark(folder: Path, *, out: Path = Path("marks.csv")) -> None:
    """Mark a folder of handed-in notebooks into a .csv.

    Mark a folder of handed-in notebooks into two .csv files: OUT has a line for each exercise, and OUT-table
    a line for each student. Each notebook runs in a process of its own, with a new folder as its home, few
    variables in its environment, and limits of time, memory, processes and file size. On Linux it has no
    network, where the system allows that; the first line printed says whether it does. All this does not
    keep a notebook from reading or writing what you can read or write, from sockets that are files, or from
    an attack on the marker by somebody who knows how. If you do not trust those who hand in, mark in a
    container without a network: notebooks/README.md has the command.

    Parameters
    ----------
    folder : holds a folder for each student, with notebooks.
    out : where to write.

    Notes
    -----
    For example: mocap course mark handed-in -o marks.csv
    """
    table = out.with_stem(f"{out.stem}-table")
    require_writable(out)
    print(NETWORK[marking.offline()], file=sys.stderr)
    marks: list[marking.Mark] = []
    try:
        for one in marking.mark(folder, bar("marking")):
            if marks and one.handed_in != marks[-1].handed_in:
                _write_marks(marks, out, table)  # so that a kill loses one notebook's marks
            marks.append(one)
    finally:  # so that Ctrl-C keeps the marks made so far
        _write_marks(marks, out, table)
    print(f"wrote {out} and {table}: {sum(one.right for one in marks)} of {len(marks)} are right")


def _write_marks(marks: "list[marking.Mark]", out: Path, table: Path) -> None:
    if marks:
        write_text(out, marking.to_csv(marks))
        write_text(table, marking.to_table(marks))


def run(notebooks: Sequence[Path] = ()) -> None:
    """Run notebooks again and store them with their outputs.

    Parameters
    ----------
    notebooks : files to run (default: the whole course).
    """
    folder = course.stored()
    for notebook in bar("running")(notebooks or sorted(folder.glob("*.ipynb"))):
        course.run(notebook, folder.parent / "figures")


def lab(
    folder: Path = Path("mocap-course"),
    *,
    after: Annotated[Sequence[str], {"nargs": "...", "help": SUPPRESS}] = (),
) -> int:
    """Open the course in JupyterLab.

    Open the course in JupyterLab. What stands after -- goes to JupyterLab: mocap lab -- --no-browser --port
    8890.

    Parameters
    ----------
    folder : folder for a copy of the notebooks, outside a checkout.
    """
    return int(course.open_course(folder, after))


COURSE = Group(
    "Hand out, mark, publish or run the notebooks.",
    {command.__name__: command for command in (handout, site, slides, film, board, lite, mark, run)},
)
