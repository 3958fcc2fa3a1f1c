"""The notebooks of the course, each read once for all tests."""

from functools import cache
from pathlib import Path

from mocap.course import notebooks
from tests.loops import for_each

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "notebooks"
NAMES = sorted(path.stem for path in FOLDER.glob("*.ipynb"))
PAGES = sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*.md"))
every_notebook = for_each(NAMES)


@cache
def read(name):
    return notebooks.read(FOLDER / f"{name}.ipynb")


def markdown(name):
    return "\n\n".join(cell.source for cell in read(name).cells if cell.cell_type == "markdown")
