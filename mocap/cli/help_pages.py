"""Help pages in plain text: the usage of a command, its description, and tables of commands and options.

`cyclopts` also has help pages, but needs 0.15 s to load the package that colours them, as long as everything
else takes.
"""

import shutil
from collections.abc import Iterator
from textwrap import fill, wrap
from typing import TYPE_CHECKING, NamedTuple

from cyclopts import Group

if TYPE_CHECKING:
    from cyclopts import App, Argument

INDENT = "  "  # before a row, and between its columns
WIDEST_NAME = 24  # characters of the first column. A longer name has its own line
WIDEST_PAGE = 100  # characters of a line. Longer lines are hard to read
COMMANDS = "Commands"  # the heading of commands without a group


class Row(NamedTuple):
    """A row of a table in a help page."""

    table: str
    name: str
    text: str


def page(app: "App", program: str) -> str:
    """Return the help page of a command.

    Parameters
    ----------
    app : the command.
    program : the words that call it, as in `mocap graph info`.
    """
    width = min(shutil.get_terminal_size().columns, WIDEST_PAGE) - 1
    collection = app.assemble_argument_collection() if app.default_command else []
    arguments = [argument for argument in collection if argument.show]
    tables: dict[str, list[Row]] = {}
    for row in (*_command_rows(app), *map(_argument_row, arguments)):
        tables.setdefault(row.table, []).append(row)
    parts = [_usage(program, arguments, width), _fold(app.help, width)]
    parts += [_table(title, rows, width) for title, rows in tables.items()]
    parts += [_fold(app.help_epilogue or "", width)]
    return "\n\n".join(filter(None, parts))


def _command_rows(app: "App") -> Iterator[Row]:
    """Yield a row for each subcommand, in the table of its group."""
    for name in app:
        if not name.startswith("-"):
            below = app[name]
            yield Row(_title(below.group, COMMANDS), name, below.help.partition("\n\n")[0])


def _title(group: object, default: str) -> str:
    """Return the heading of a group, which `cyclopts` stores as a tuple."""
    first = group[0] if isinstance(group, tuple) and group else group
    return first.name if isinstance(first, Group) else default


def _argument_row(argument: "Argument") -> Row:
    """Return the row of an argument or option, in the table of its group."""
    settings = argument.parameter
    needed = argument.required and argument.index is None
    choices = argument.get_choices()
    remarks = [f"one of {', '.join(choices)}"] if choices else []
    remarks += [f"default: {settings.show_default}"] if settings.show_default else []
    remarks += ["required"] if needed else []
    text = settings.help or ""
    if remarks:
        text = f"{text} ({'; '.join(remarks)})".strip()
    if argument.index is not None:
        return Row("Arguments", argument.name.upper(), text)
    names = ", ".join(sorted(argument.names, key=len))
    shown = names if argument.is_flag() else f"{names} {settings.metavar}"
    return Row(_title(settings.group, "Options"), shown, text)


def _usage(program: str, arguments: list["Argument"], width: int) -> str:
    """Return the usage of a command, with its arguments and required options."""
    words = [program]
    for argument in arguments:
        if argument.index is not None:
            dots = "..." if argument.token_count()[1] else ""
            name = f"{argument.name.upper()}{dots}"
            words.append(name if argument.required else f"[{name}]")
        elif argument.required:
            words.append(f"{min(argument.names, key=len)} {argument.parameter.metavar}")
    words.append("[OPTIONS]" if arguments else "COMMAND")
    return fill(f"Usage: {' '.join(words)}", width, subsequent_indent=" " * len("Usage: "))


def _table(title: str, rows: list[Row], width: int) -> str:
    """Format a heading and the rows of a table, with aligned texts."""
    column = min(WIDEST_NAME, max(len(row.name) for row in rows))
    indent = f"{INDENT}{' ' * column}{INDENT}"
    lines = [f"{title}:"]
    for row in rows:
        texts = wrap(row.text, width - len(indent)) or [""]
        start = f"{INDENT}{row.name:<{column}}"
        if len(row.name) <= column:
            start = f"{start}{INDENT}{texts.pop(0)}"
        lines += [start.rstrip(), *(indent + text for text in texts)]
    return "\n".join(lines)


def _fold(text: str, width: int) -> str:
    """Wrap each paragraph, except those with indented lines."""
    parts = text.split("\n\n")
    return "\n\n".join(part if "\n " in part else fill(part, width) for part in parts)
