"""The command `mocap course`: for those who teach from the notebooks, and those who write them."""

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mocap.progress import bar

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]


def add_course(commands: "Commands") -> None:
    """Add `mocap course`, with a command of its own for each thing to do."""
    course = commands.add_parser(
        "course",
        help="hand out, mark, publish or run the notebooks",
        description="Hand out, mark, publish or run the notebooks of the course.",
    )
    doing = course.add_subparsers(title="commands", required=True, metavar="COMMAND")
    _add(doing, "handout", _handout, "copy the notebooks without their solutions", Path("mocap-handout"))
    _add(doing, "site", _site, "write the course as HTML pages that need no network", Path("mocap-site"))
    _add(doing, "lite", _lite, "build a JupyterLite site, which runs in the browser", Path("mocap-lite"))
    mark = _add(doing, "mark", _mark, "mark a folder of handed-in notebooks into a .csv", Path("marks.csv"))
    mark.add_argument("folder", type=Path, help="folder with the notebooks, such as name/02-matching.ipynb")
    run = doing.add_parser("run", help="run notebooks anew and store them with their outputs")
    run.add_argument("notebooks", nargs="*", type=Path, help="(default: all of the checkout)")
    run.set_defaults(run=_run)


def _add(commands: "Commands", name: str, run: object, what: str, out: Path) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=what, description=f"{what[0].upper()}{what[1:]}.")
    command.add_argument("-o", "--out", type=Path, default=out, help="where to (default: %(default)s)")
    command.set_defaults(run=run)
    return command


def _notebooks() -> Path:
    from mocap.lab import stored

    return stored()


def _handout(options: argparse.Namespace) -> int:
    from mocap.handout import hand_out

    copies = hand_out(_notebooks(), options.out)
    print(f"wrote {len(copies)} notebooks to {options.out}")
    return 0


def _site(options: argparse.Namespace) -> int:
    from mocap.course_site import build_site

    print(f"wrote {build_site(_notebooks(), options.out, partial(bar, what='converting'))}")
    return 0


def _lite(options: argparse.Namespace) -> int:
    from mocap.course_lite import build_lite

    print(f"wrote {build_lite(_notebooks(), options.out)}")
    return 0


def _mark(options: argparse.Namespace) -> int:
    from mocap.atomic import write_text
    from mocap.handout import mark, to_csv

    marks = []
    try:
        for one in mark(options.folder, partial(bar, what="marking")):
            marks.append(one)  # one by one: what is marked stays, even after Ctrl-C
    finally:
        if marks:
            write_text(options.out, to_csv(marks))
    right = sum(mark.right for mark in marks)
    print(f"wrote {options.out}: {right} of {len(marks)} are right")
    return 0


def _run(options: argparse.Namespace) -> int:
    from mocap.course import run

    folder = _notebooks()
    for notebook in bar(options.notebooks or sorted(folder.glob("*.ipynb")), what="running"):
        run(notebook, folder.parent / "figures")
    return 0
