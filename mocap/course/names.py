"""Which names some code defines, and which it uses: for the file that keeps functions, and for marking."""

from __future__ import annotations

import symtable


def names_of(source: str) -> tuple[set[str], set[str]]:
    """Return the names that some code defines, and those that it uses from outside of its functions.

    Code that is no Python has none.

    Examples
    --------
    >>> names_of("def half(x): return x / two")
    ({'half'}, {'two'})
    """
    try:
        top = symtable.symtable(source, "", "exec")
    except (SyntaxError, ValueError):
        return set(), set()
    made = [symbol for symbol in top.get_symbols() if symbol.is_assigned() or symbol.is_imported()]
    used, tables = set(), [top]
    while tables:
        table = tables.pop()
        tables += table.get_children()
        symbols = [symbol for symbol in table.get_symbols() if symbol.is_referenced()]
        used |= {symbol.get_name() for symbol in symbols if table is top or symbol.is_global()}
    return {symbol.get_name() for symbol in made}, used
