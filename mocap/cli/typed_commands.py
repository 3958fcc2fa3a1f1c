"""A command is a typed function: its docstring is its help, and its parameters are its arguments.

A parameter by position is an argument, one by keyword an option. Its annotation says what it takes. Its help
stands in the docstring, as in `name (METAVAR) : text`, or in the annotation, where commands share an option.
A dataclass among the annotations stands for an option for each of its fields.
"""

import argparse
import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import is_dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, get_args, get_origin

if TYPE_CHECKING:
    Parsers = argparse._SubParsersAction[Any]

Run = Callable[..., int | None]
_PARAMETER = re.compile(r"^(\w+)(?: \((\S+)\))? : (.*(?:\n +.*)*)", re.MULTILINE)


class Group(NamedTuple):
    """Commands under one name, and the text of its help."""

    text: str
    commands: "Mapping[str, Run | Group]"
    usage: str | None = None


class _Text(argparse.HelpFormatter):
    """Fill each paragraph by itself, but leave those with indented lines as they stand."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        paragraphs = text.split("\n\n")
        fill = super()._fill_text
        return "\n\n".join(part if "\n " in part else fill(part, width, indent) for part in paragraphs)


def add_commands(parsers: "Parsers", commands: "Mapping[str, Run | Group]") -> None:
    """Make a parser for each command, and name it in its options: an error shows its usage."""
    for name, run in commands.items():
        text = run.text if isinstance(run, Group) else inspect.getdoc(run) or ""
        text, _, notes = text.partition("\n\nNotes\n-----\n")
        about, _, parameters = text.partition("\n\nParameters\n----------\n")
        first, _, more = about.partition("\n\n")
        parser = parsers.add_parser(
            name,
            help=first[0].lower() + first[1:].rstrip("."),
            description=more or first,
            epilog=notes,
            formatter_class=_Text,
            usage=run.usage if isinstance(run, Group) else None,
        )
        parser.set_defaults(parser=parser)
        if isinstance(run, Group):
            below = parser.add_subparsers(
                title="commands", required=True, metavar="COMMAND", prog=parser.prog
            )
            add_commands(below, run.commands)
        else:
            _add_arguments(parser, run, {name: more for name, *more in _PARAMETER.findall(parameters)})
            parser.set_defaults(run=partial(_call, run))


def _add_arguments(parser: argparse.ArgumentParser, made: Run, helps: Mapping[str, list[str]]) -> None:
    """Add an argument for each parameter of a function, or for each field of a dataclass."""
    for name, parameter in inspect.signature(made).parameters.items():
        if is_dataclass(parameter.annotation):
            _add_arguments(parser, parameter.annotation, {})  # type: ignore[arg-type]
            continue
        settings = _settings(parameter)
        if name in helps:
            metavar, text = helps[name]
            settings |= {"help": " ".join(text.split()).rstrip(".")} | (
                {"metavar": metavar} if metavar else {}
            )
        shown = parameter.default
        if isinstance(shown, str | Path | int | float) and not isinstance(shown, bool):
            text = f"{shown:.3g}" if isinstance(shown, float) else f"{shown}"
            settings["help"] += f" (default: {text})"
        if parameter.kind is parameter.KEYWORD_ONLY or is_dataclass(made):
            flags = [*(["-o"] if name == "out" else []), f"--{name.replace('_', '-')}"]
            parser.add_argument(*flags, required=shown is parameter.empty, **settings)
        else:
            many = {} if shown is parameter.empty else {"nargs": "*" if "nargs" in settings else "?"}
            parser.add_argument(name, **settings | many)


def _settings(parameter: inspect.Parameter) -> dict[str, Any]:
    """Say to argparse what an annotation says; `Annotated` adds a reader, a help text, further settings."""
    kind, *extras = get_args(parameter.annotation) or [parameter.annotation]
    if get_origin(parameter.annotation) is not Annotated:
        kind, extras = parameter.annotation, []
    settings = {} if parameter.default is parameter.empty else {"default": parameter.default}
    if kind is bool:
        settings["action"] = "store_true"
    elif get_origin(kind) is Literal:
        settings["choices"] = get_args(kind)
    else:
        settings["type"] = (*get_args(kind), kind)[0]  # of `Path | None` and `Sequence[Path]` a Path
    if get_origin(kind) is Sequence:
        settings["nargs"] = "+"
    for extra in extras:
        settings |= (
            extra if isinstance(extra, dict) else {"help" if isinstance(extra, str) else "type": extra}
        )
    return settings


def _call(run: Run, options: argparse.Namespace) -> int:
    """Run a command with the values that were given."""
    return run(**_values(run, options)) or 0


def _values(made: Run, options: argparse.Namespace) -> dict[str, Any]:
    """Give a function's parameters, or a dataclass's fields, the values of the options."""
    values: dict[str, Any] = {}
    for name, parameter in inspect.signature(made).parameters.items():
        kind: Run = parameter.annotation
        nested = is_dataclass(parameter.annotation)
        values[name] = kind(**_values(kind, options)) if nested else getattr(options, name)
    return values
