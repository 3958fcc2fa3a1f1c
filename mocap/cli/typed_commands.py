"""Conversion of a typed function to a command, with its docstring as help and its parameters as arguments.

A positional parameter is an argument, and a keyword parameter an option. Its annotation is the type of its
value. Its help is in the docstring, as `name (METAVAR) : text`, or in the annotation if commands share the
option. A dataclass as an annotation adds an option for each of its fields. `cyclopts` parses the words, reads
values, detects errors, and generates the completion of shells.
"""

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NamedTuple, cast, get_args, get_origin

import cyclopts
from cyclopts import App, Parameter, Token

Run = Callable[..., int | None]
_PARAMETER = re.compile(r"^(\w+)(?: \((\S+)\))? : (.*(?:\n +.*)*)", re.MULTILINE)
PLAIN_WORDS = Parameter(  # no `--no-clean`, no JSON for lists, and the last of repeated options applies
    negative=(), json_list=False, json_dict=False, allow_repeating=True
)
OPTIONS = cyclopts.Group("Options")
SEVERAL = Parameter(consume_multiple=(1, None))  # an option takes all words up to the next option
AT_MOST_ONE = Parameter(consume_multiple=(0, 1))
ONE_EACH = Parameter(consume_multiple=False)  # an option is repeated for each of its values


class Group(NamedTuple):
    """Commands under one name, with the text of its help and the default command."""

    text: str
    commands: "Mapping[str, Run | Group]"
    default: Run | None = None


Commands = dict[str, Run | Group]


class Help(NamedTuple):
    """The parts of a command's docstring."""

    summary: str
    parameters: Mapping[str, tuple[str, str]]  # the displayed name, or "", and the text
    notes: str


@dataclass(frozen=True)
class OptionalValue:
    """The value of an option that is given without a value."""

    value: float


def make_root(
    name: str,
    text: str,
    commands: Mapping[str, Commands],
    shared: type,
    *,
    version: str,
    epilogue: str,
    wanted: str | None = None,
) -> App:
    """Create the command of a program with all its commands, in groups.

    Parameters
    ----------
    name, text, version, epilogue : the name of the program and the texts of its help.
    commands : the commands by name, in groups by title.
    shared : as for `make_command`.
    wanted : the name of the only command that gets its parameters. By default all do.
    """
    app = App(
        name=name,
        help=text,
        version=version,
        help_epilogue=epilogue,
    )
    for place, (title, runs) in enumerate(commands.items()):
        group = cyclopts.Group(title, sort_key=place)
        for inner, (word, run) in enumerate(runs.items()):
            if wanted in (None, word):
                app.command(make_command(word, run, shared, group=group, sort_key=inner))
            else:
                app.command(App(name=word, help=read_help(run).summary, group=group, sort_key=inner))
    return app


def make_command(name: str, run: Run | Group, shared: type, **settings: Any) -> App:  # noqa: ANN401 (of an App)
    """Create a command from a typed function, or from a group of them.

    Parameters
    ----------
    name : the word that calls it.
    run : the function, or the group.
    shared : a dataclass of options that all commands have, and that are not passed to the function.
    settings : settings of the `App`, such as the `group` in which it is listed.
    """
    default = run.default if isinstance(run, Group) else run
    text = read_help(run)
    command = App(
        name=name, help=text.summary, help_epilogue=text.notes, group_parameters=OPTIONS, **settings
    )
    if default:
        command.default(_take_words(default, read_help(default), shared))
    if isinstance(run, Group):
        for place, (below, inner) in enumerate(run.commands.items()):
            command.command(make_command(below, inner, shared, sort_key=place))
    return command


def command_names(app: App, *, deep: bool = False) -> list[str]:
    """List the commands of an app, with `deep` including those inside its groups, such as `data fetch`."""
    names = []
    for name in app:
        below = app[name]
        if name.startswith("-"):
            continue
        inner = command_names(below, deep=True) if deep else []
        names += [f"{name} {word}" for word in inner]
        if below.default_command or not inner:
            names.append(name)
    return names


def read_docstring(thing: Any) -> str:  # noqa: ANN401 (a function or a class)
    """Return a docstring, from the source code if `python -OO` has removed it."""
    if thing.__doc__ is not None:
        return inspect.getdoc(thing) or ""
    try:
        (definition,) = ast.parse(textwrap.dedent(inspect.getsource(thing))).body
    except OSError:  # without the source code, the command works without a help text
        return ""
    return ast.get_docstring(cast(ast.FunctionDef, definition)) or ""


def read_help(run: Run | Group) -> Help:
    """Split a command's docstring into its summary, its parameters, and notes for the end of the page.

    Examples
    --------
    >>> def greet(name):
    ...     '''Say hello.
    ...
    ...     Parameters
    ...     ----------
    ...     name (NAME) : who is greeted.
    ...     '''
    >>> read_help(greet)
    Help(summary='Say hello.', parameters={'name': ('NAME', 'who is greeted')}, notes='')
    """
    whole = run.text if isinstance(run, Group) else read_docstring(run)
    text, _, notes = whole.partition("\n\nNotes\n-----\n")
    summary, _, parameters = text.partition("\n\nParameters\n----------\n")
    helps = {
        name: (shown, " ".join(words.split()).removesuffix("."))
        for name, shown, words in _PARAMETER.findall(parameters)
    }
    return Help(summary, helps, notes)


def _take_words(run: Run, text: Help, shared: type) -> Run:
    """Return a function with a flat signature for `cyclopts`, which calls the command with its dataclasses.

    Its keywords include the shared options, which the caller must remove first.
    """
    plain = [*_flatten(run), *_as_options(shared)]
    parameters = [_describe(parameter, text) for parameter in plain]
    extras = [(parameter.name, extra) for parameter in plain for extra in _split(parameter)[1]]
    alone = {name: extra for name, extra in extras if isinstance(extra, OptionalValue)}
    positional = [parameter.name for parameter in parameters if parameter.kind is parameter.POSITIONAL_ONLY]

    def take(*arguments: object, **options: object) -> int | None:
        typed = dict(zip(positional, arguments, strict=False)) | options
        typed |= {name: extra.value for name, extra in alone.items() if typed.get(name) == []}
        status: int | None = call(run, typed)
        return status

    # These attributes are read by `inspect.signature` and `typing.get_type_hints`.
    vars(take)["__signature__"] = inspect.Signature(parameters)
    take.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    take.__doc__ = None
    return take


def call(target: Any, typed: Mapping[str, object]) -> Any:  # noqa: ANN401 (or a dataclass)
    """Call a command, or create a dataclass, with the values that were typed."""
    parameters = inspect.signature(target).parameters
    values: dict[str, Any] = {}
    for name, parameter in parameters.items():
        if is_dataclass(parameter.annotation):
            values[name] = call(parameter.annotation, typed)
        elif name in typed:
            values[name] = typed[name]
    positional = [name for name in values if parameters[name].kind is inspect.Parameter.POSITIONAL_ONLY]
    arguments = [values.pop(name) for name in positional]
    return target(*arguments, **values)


def _flatten(run: Run) -> Iterator[inspect.Parameter]:
    """Yield the parameters of a command, with the fields of dataclasses as options."""
    for parameter in inspect.signature(run).parameters.values():
        if is_dataclass(parameter.annotation):
            yield from _as_options(parameter.annotation)
        elif parameter.kind is parameter.POSITIONAL_OR_KEYWORD:
            yield parameter.replace(kind=parameter.POSITIONAL_ONLY)
        else:
            yield parameter


def _as_options(fields: Any) -> Iterable[inspect.Parameter]:  # noqa: ANN401 (a dataclass)
    """Return the fields of a dataclass as keyword parameters."""
    parameters = inspect.signature(fields).parameters.values()
    return [parameter.replace(kind=parameter.KEYWORD_ONLY) for parameter in parameters]


def _describe(parameter: inspect.Parameter, text: Help) -> inspect.Parameter:
    """Annotate a parameter for `cyclopts`, from the docstring and its own annotation."""
    kind, extras = _split(parameter)
    is_list = get_origin(kind) is Sequence
    settings = [PLAIN_WORDS, Parameter(show_default=_shown_default(parameter.default))]
    settings += [SEVERAL] if is_list and parameter.kind is parameter.KEYWORD_ONLY else []
    settings += [_setting(extra, is_list) for extra in extras]
    shown, words = text.parameters.get(parameter.name, ("", ""))
    settings += [Parameter(help=words)] if words else []
    if parameter.kind is parameter.KEYWORD_ONLY:
        flags = [*(["-o"] if parameter.name == "out" else []), option_of(parameter.name)]
        settings.append(Parameter(name=flags, metavar=shown or parameter.name.removesuffix("_").upper()))
    elif shown:
        settings.append(Parameter(name=shown))
    if any(isinstance(extra, OptionalValue) for extra in extras):
        kind = list[float]
    return parameter.replace(annotation=Annotated[kind, Parameter.combine(*settings)])


def _split(parameter: inspect.Parameter) -> tuple[Any, list[object]]:
    """Split an annotation into the type of a parameter and the extras of `Annotated`."""
    if get_origin(parameter.annotation) is not Annotated:
        return parameter.annotation, []
    kind, *extras = get_args(parameter.annotation)
    return kind, extras


def _shown_default(value: object) -> bool | str:
    """Return a default value as a help page shows it, or False for a flag and for no default.

    Examples
    --------
    >>> _shown_default(1 / 3), _shown_default("bvh"), _shown_default(None)
    ('0.333', 'bvh', False)
    """
    if isinstance(value, bool) or not isinstance(value, str | Path | int | float):
        return False
    return f"{value:.3g}" if isinstance(value, float) else f"{value}"


def _setting(extra: object, is_list: bool) -> Parameter:
    """Return the setting for an extra of `Annotated`: a help text, an `OptionalValue`, or a converter."""
    if isinstance(extra, Parameter):
        return extra
    if isinstance(extra, str):
        return Parameter(help=extra)
    if isinstance(extra, OptionalValue):
        return AT_MOST_ONE
    assert callable(extra)
    return Parameter(converter=partial(_convert, extra, is_list))


def _convert(read: Callable[[str], object], is_list: bool, _kind: object, words: Sequence[Token]) -> object:
    """Convert the words of an option, or the last word if a single value was given more than once."""
    values = [read(word.value) for word in words]
    return values if is_list else values[-1]


def option_names(command: Callable[..., object]) -> dict[str, str]:
    """Return the option of each keyword parameter of a command."""
    parameters = inspect.signature(command).parameters.values()
    return {
        parameter.name: option_of(parameter.name)
        for parameter in parameters
        if parameter.kind is parameter.KEYWORD_ONLY
    }


def option_of(name: str) -> str:
    """Return the name of the option of a parameter.

    Examples
    --------
    >>> option_of("by_labels")
    '--by-labels'
    >>> option_of("from_")  # `from` is a word of Python
    '--from'
    """
    return f"--{name.removesuffix('_').replace('_', '-')}"
