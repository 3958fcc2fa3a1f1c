"""The commands `mocap course`, for those who teach from the notebooks or write them, and `mocap lab`."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mocap import course
from mocap._shared.atomic import require_writable, write_text
from mocap.cli.options import bar
from mocap.course import marking

if TYPE_CHECKING:
    from mocap.cli.options import Commands

MARKING = """Mark a folder of handed-in notebooks into two .csv files: OUT has a line for each exercise, and
OUT-table a line for each student. Each notebook runs in a process of its own, with a new folder as its home,
few variables in its environment, and limits of time, memory, processes and file size. On Linux it has no
network, where the system allows that; the first line printed says whether it does. All this does not keep a
notebook from reading or writing what you can read or write, from sockets that are files, or from an attack on
the marker by somebody who knows how. If you do not trust those who hand in, mark in a container without a
network: notebooks/README.md has the command."""
NETWORK = {
    True: "marking without a network: notebooks cannot open a connection",
    False: "marking WITH the network: this system cannot keep notebooks from using it; a container can",
}


def add_course(commands: "Commands") -> None:
    """Add `mocap course` and its own commands."""
    parser = commands.add_parser(
        "course",
        help="hand out, mark, publish or run the notebooks",
        description="Hand out, mark, publish or run the notebooks of the course.",
    )
    doing = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    _add(doing, "handout", _handout, "copy the notebooks without their solutions", Path("mocap-handout"))
    _add_shows(doing)
    _add(doing, "lite", _lite, "build a JupyterLite site, which runs in the browser", Path("mocap-lite"))
    mark = _add(doing, "mark", _mark, "mark a folder of handed-in notebooks into a .csv", Path("marks.csv"))
    mark.description = MARKING
    mark.epilog = "For example: mocap course mark handed-in -o marks.csv"
    mark.add_argument("folder", type=Path, help="holds a folder for each student, with notebooks")
    again = "run notebooks again and store them with their outputs"
    which = "write notebooks/PAPERS.md: which line of which paper is in which function, test and cell"
    doing.add_parser("papers", help=which, description=f"W{which[1:]}.").set_defaults(run=_papers)
    run = doing.add_parser("run", help=again, description=f"{again.capitalize()}.")
    run.add_argument("notebooks", nargs="*", type=Path, help="files to run (default: the whole course)")
    run.set_defaults(run=_run)


def _add_shows(doing: "Commands") -> None:
    """Add the commands that show the course: as pages, slides, films and drawings."""
    site = _add(
        doing, "site", _site, "write the course as HTML pages that need no network", Path("mocap-site")
    )
    slides = _add(
        doing, "slides", _slides, "write the course as slides that need no network", Path("mocap-slides")
    )
    slides.epilog = "For example: mocap course slides -o slides, then open slides/index.html."
    for made in (site, slides):
        made.add_argument(
            "--moving",
            action="store_true",
            help="run the notebooks (minutes) and record the experiments' sliders",
        )
    film = _add(doing, "film", _film, "render a film of a notebook, of about three minutes", None)
    film.epilog = "For example: mocap course film notebooks/06-pruning.ipynb -o pruning.mp4"
    film.add_argument("notebook", type=Path, help="file of the notebook")
    film.add_argument("--still", action="store_true", help="do not run it: sliders stand still")
    board = _add(doing, "board", _board, "write drawings for the board as PNGs", Path("mocap-board"))
    board.epilog = "For example: mocap course board -o board, then open board/board.png."


def _add(
    commands: "Commands", name: str, run: object, what: str, out: Path | None
) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=what, description=f"{what[0].upper()}{what[1:]}.")
    said = out or "the notebook's name, here"
    command.add_argument("-o", "--out", type=Path, default=out, help=f"where to write (default: {said})")
    command.set_defaults(run=run)
    return command


def _handout(options: argparse.Namespace) -> int:
    copies = course.hand_out(course.stored(), options.out)
    print(f"wrote {len(copies)} notebooks to {options.out}")
    return 0


def _site(options: argparse.Namespace) -> int:
    print(
        f"wrote {course.build_site(course.stored(), options.out, bar('converting'), moving=options.moving)}"
    )
    return 0


def _slides(options: argparse.Namespace) -> int:
    from mocap.course import teaching

    folder, shown = course.stored(), bar("converting")
    print(f"wrote {teaching.build_slides(folder, options.out, shown, moving=options.moving)}")
    return 0


def _film(options: argparse.Namespace) -> int:
    from mocap.course import teaching

    out = options.out or Path(options.notebook.with_suffix(".mp4").name)
    require_writable(out)
    teaching.render_film(options.notebook, out, moving=not options.still, progress=bar("drawing"))
    print(f"wrote {out}")
    return 0


def _board(options: argparse.Namespace) -> int:
    from mocap.course import teaching

    files = teaching.write_board(options.out, bar("drawing"))
    print(f"wrote {len(files)} pictures to {options.out}; {files[-1]} shows all")
    return 0


def _lite(options: argparse.Namespace) -> int:
    print(f"wrote {course.build_lite(course.stored(), options.out)}")
    return 0


def _mark(options: argparse.Namespace) -> int:
    table = options.out.with_stem(f"{options.out.stem}-table")
    require_writable(options.out)
    print(NETWORK[marking.offline()], file=sys.stderr)
    marks: list[marking.Mark] = []
    try:
        for one in marking.mark(options.folder, bar("marking")):
            if marks and one.handed_in != marks[-1].handed_in:
                _write_marks(marks, options.out, table)
            marks.append(one)
    finally:  # so that Ctrl-C keeps the marks made so far
        _write_marks(marks, options.out, table)
    right = sum(mark.right for mark in marks)
    print(f"wrote {options.out} and {table}: {right} of {len(marks)} are right")
    return 0


def _write_marks(marks: "list[marking.Mark]", out: Path, table: Path) -> None:
    if marks:
        write_text(out, marking.to_csv(marks))
        write_text(table, marking.to_table(marks))


def _run(options: argparse.Namespace) -> int:
    folder = course.stored()
    for notebook in bar("running")(options.notebooks or sorted(folder.glob("*.ipynb"))):
        course.run(notebook, folder.parent / "figures")
    if (folder.parent / "tests").is_dir():  # of a checkout: headings and calls may have changed
        course.write_ledger(folder.parent)
    return 0


def _papers(_: argparse.Namespace) -> int:
    print(f"wrote {course.write_ledger(course.stored().parent)}")
    return 0


def add_lab(commands: "Commands") -> None:
    """Add `mocap lab`."""
    what = "open the course in JupyterLab"
    more = "What stands after -- goes to JupyterLab: mocap lab -- --no-browser --port 8890"
    lab = commands.add_parser("lab", help=what, description=f"{what[0].upper()}{what[1:]}. {more}.")
    lab.add_argument(
        "folder",
        nargs="?",
        type=Path,
        default=Path("mocap-course"),
        help="folder for a copy of the notebooks, outside a checkout (default: %(default)s)",
    )
    lab.set_defaults(run=_lab)


def _lab(options: argparse.Namespace) -> int:
    return int(course.open_course(options.folder, options.after))
