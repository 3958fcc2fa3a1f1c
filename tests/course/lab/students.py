"""Three students: one solves all, one every second exercise, one is wrong everywhere."""

import ast
import linecache
from functools import cache
from itertools import count

from mocap.course import notebooks
from tests.course.stored_notebooks import NAMES, read

LABELS = count()


@cache
def solutions():
    """Give the source of each solution by its name, and the imports of its notebook."""
    found = {}
    for notebook in (read(name) for name in NAMES if name.startswith("0")):
        first = ast.parse(next(cell.source for cell in notebook.cells if cell.cell_type == "code"))
        imports = [ast.unparse(n) for n in first.body if isinstance(n, ast.Import | ast.ImportFrom)]
        for name, cell in notebooks.tagged(notebook, "solution"):
            found[name] = "\n".join(imports), notebooks.solution(cell)
    return found


def written(name, source=None, others=()):
    """Make a function as a notebook does: its source can be read, and its names are the notebook's."""
    first, solved = solutions()[name]
    source = solved if source is None else source
    space = {"__name__": "__main__", **dict(others)}
    exec(first, space)
    space.update(others)
    file = f"<cell {next(LABELS)}>"
    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    exec(compile(source, file, "exec"), space)
    return space[name]


def wrong(name):
    """Make a function of the right name that returns the stub's `...`, as before the exercise is solved."""
    return written(name, f"def {name}(*arguments):\n    return ...\n")
