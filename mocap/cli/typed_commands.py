"""A command is a typed function: its docstring is its help, and its parameters are its arguments.

A parameter by position is an argument, one by keyword an option. Its annotation says what it takes. Its help
stands in the docstring, as in `name (METAVAR) : text`, or in the annotation, where commands share an option.
A dataclass among the annotations stands for an option for each of its fields.
"""

import argparse
import inspect
import re
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import is_dataclass
from pathlib import Path
from textwrap import fill
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

Run = Callable[..., int | None]
_PARAMETER = re.compile(r"^(\w+)(?: \((\S+)\))? : (.*(?:\n +.*)*)", re.MULTILINE)


class Group(NamedTuple):
    """Commands under one name, and the text of its help."""

    text: str
    commands: "Mapping[str, Run | Group]"
    usage: str | None = None


def add_commands(above: argparse.ArgumentParser, commands: Mapping[str, Run | Group]) -> None:
    """Make a parser for each command, and name it in its options: an error shows its usage."""
    parsers: Any = above.add_subparsers(title="commands", required=True, metavar="COMMAND", prog=above.prog)
    for name, run in commands.items():
        whole = f"{inspect.getdoc(run)}" if callable(run) else run.text
        text, _, notes = whole.partition("\n\nNotes\n-----\n")
        about, _, parameters = text.partition("\n\nParameters\n----------\n")
        first, _, more = about.partition("\n\n")
        texts = {"help": first[0].lower() + first[1:].rstrip("."), "description": _filled(more or first)}
        parser = parsers.add_parser(
            name, epilog=_filled(notes), formatter_class=argparse.RawDescriptionHelpFormatter, **texts
        )
        parser.set_defaults(parser=parser, run=run)
        if callable(run):
            helps = {name: more for name, *more in _PARAMETER.findall(parameters)}
            for parameter in _parameters(run):
                _add_argument(parser, parameter, *helps.get(parameter.name, ()))
        else:
            parser.usage = run.usage
            add_commands(parser, run.commands)


def _filled(text: str) -> str:
    """Fill each paragraph by itself, but leave those with indented lines as they stand."""
    width = shutil.get_terminal_size().columns - 2
    return "\n\n".join(part if "\n " in part else fill(part, width) for part in text.split("\n\n"))


def _parameters(made: Any) -> Iterator[inspect.Parameter]:  # noqa: ANN401 (or a dataclass)
    """Yield the parameters of a function; instead of one that takes a dataclass, its fields, as options."""
    for parameter in inspect.signature(made).parameters.values():
        if is_dataclass(kind := parameter.annotation):
            yield from (field.replace(kind=field.KEYWORD_ONLY) for field in _parameters(kind))
        else:
            yield parameter


def _add_argument(
    parser: argparse.ArgumentParser, parameter: inspect.Parameter, metavar: str = "", text: str = ""
) -> None:
    """Say to argparse what an annotation says; `Annotated` adds a reader, a help text, further settings."""
    name, default, kind, extras = parameter.name, parameter.default, parameter.annotation, list[Any]()
    if get_origin(kind) is Annotated:
        kind, *extras = get_args(kind)
    needed = default is parameter.empty
    settings: dict[str, Any] = {} if needed else {"default": default}
    if kind is bool:
        settings["action"] = "store_true"
    elif get_origin(kind) is Literal:
        settings["choices"] = get_args(kind)
    else:
        settings["type"] = (*get_args(kind), kind)[0]  # of `Path | None` and `Sequence[Path]` a Path
    if get_origin(kind) is Sequence:
        settings["nargs"] = "+"
    for extra in extras:
        key = "help" if isinstance(extra, str) else "type"
        settings |= extra if isinstance(extra, dict) else {key: extra}
    settings |= {"metavar": metavar} if metavar else {}
    settings |= {"help": " ".join(text.split()).rstrip(".")} if text else {}
    if isinstance(default, str | Path | int | float) and kind is not bool:
        shown = f"{default:.3g}" if isinstance(default, float) else f"{default}"
        settings["help"] += f" (default: {shown})"
    if parameter.kind is parameter.KEYWORD_ONLY:
        flags = [*(["-o"] if name == "out" else []), f"--{name.replace('_', '-')}"]
        parser.add_argument(*flags, required=needed, **settings)
    else:
        many = {} if needed else {"nargs": "*" if "nargs" in settings else "?"}
        parser.add_argument(name, **settings | many)


def call(made: Any, options: argparse.Namespace) -> Any:  # noqa: ANN401
    """Call a command, or make a dataclass, with the values that its options were given."""
    values: dict[str, Any] = {}
    for name, parameter in inspect.signature(made).parameters.items():
        kind = parameter.annotation
        values[name] = call(kind, options) if is_dataclass(kind) else getattr(options, name)
    return made(**values)
