"""No later cell changes what an experiment draws with: its slider must work after the last cell too."""

import ast

from tests.course.stored_notebooks import every_notebook, read


def bound(tree):
    """List the names that a cell binds for all cells."""
    parts = [n for n in tree.body if not isinstance(n, ast.FunctionDef)]
    stored = {
        n.id for p in parts for n in ast.walk(p) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)
    }
    return stored | {n.name for n in tree.body if isinstance(n, ast.FunctionDef)}


def used(name, functions):
    """List the names that a function, and the functions that it calls, use from other cells."""
    found, todo = set(), [name]
    while todo:
        node = functions.pop(todo.pop(), None)
        if node is not None:
            names = [n for n in ast.walk(node) if isinstance(n, ast.Name)]
            own = {n.id for n in names if isinstance(n.ctx, ast.Store)}
            own |= {n.arg for n in ast.walk(node) if isinstance(n, ast.arg)}
            todo += {n.id for n in names} - own
            found |= {n.id for n in names} - own
    return found


@every_notebook
def test_no_later_cell_binds_a_name_that_an_experiment_draws_with(name):
    cells = [cell for cell in read(name).cells if cell.cell_type == "code"]
    trees = [ast.parse(cell.source) for cell in cells]
    every = {n.name: n for tree in trees for n in tree.body if isinstance(n, ast.FunctionDef)}
    for at, tree in enumerate(trees):
        for call in (n for n in ast.walk(tree) if isinstance(n, ast.Call)):
            if getattr(call.func, "id", "") in ("explore", "draw_path") and isinstance(
                call.args[0], ast.Name
            ):
                mine = used(call.args[0].id, dict(every))
                for later, other in zip(trees[at + 1 :], cells[at + 1 :], strict=True):
                    assert not mine & bound(later), f"{cells[at].id}, {other.id}"
