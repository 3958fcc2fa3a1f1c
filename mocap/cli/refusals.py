"""Errors for invalid commands, options and values: one sentence with a suggestion."""

import os
import re
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Literal, get_args, get_origin

import cyclopts

from mocap.cli.tuned import TUNED
from mocap.cli.typed_commands import command_names
from mocap.errors import MocapError, shortened

LONGEST = 60  # characters of a word that is quoted
SYNONYMS = {
    "--path": "--along",  # the path of `mocap walk` and that of `mocap bend`
    "--along": "--path",
    "--fps": "--rate",  # the frame rate of what is written
}


def explain(error: cyclopts.CycloptsError, root: cyclopts.App, words: Sequence[str] = ()) -> str:
    """Return the error message for words that cannot be parsed.

    Parameters
    ----------
    error : the error of `cyclopts`.
    root : the command `mocap` with all its commands.
    words : the words after `mocap`.
    """
    program = " ".join(["mocap", *(error.command_chain or ())])
    if isinstance(error, cyclopts.MissingArgumentError):
        problem = _missing(error, program, words)
    else:
        problem = _problem(error, program, root)
    return f"{problem.removesuffix('.')} (see {program} --help)"


def require_meant(words: Sequence[str], group: str, commands: Iterable[str]) -> None:
    """Raise for a word after a group that is neither a file nor a command, but resembles a command.

    Parameters
    ----------
    words : the words after the name of the group, which has a default command.
    group : the name of the group.
    commands : the commands of the group.

    Examples
    --------
    >>> require_meant(["inof", "graph.npz"], "graph", ["build", "info"])
    Traceback (most recent call last):
    mocap.errors.MocapError: 'inof' is no file and no command. Did you mean 'info'? (see mocap graph --help)
    """
    if not words or words[0] in commands or os.path.lexists(words[0]):
        return
    if meant := get_close_matches(words[0], commands, 1, TUNED.similar_word):
        problem = f"{_quoted(words[0])} is no file and no command.{_meant(meant)}"
        raise MocapError(f"{problem} (see mocap {group} --help)")


def _problem(error: cyclopts.CycloptsError, program: str, root: cyclopts.App) -> str:
    """Return the error message without the reference to the help."""
    match error:
        case cyclopts.UnknownCommandError():
            return _unknown_command(error, program, root)
        case cyclopts.UnknownOptionError():
            word = error.token.keyword or error.token.value
            return _unknown_option(word, program, _option_names(error.argument_collection))
        case cyclopts.UnusedCliTokensError():
            return f"{program} takes no further argument, got {_quoted((error.unused_tokens or [''])[0])}."
        case cyclopts.CoercionError():
            return _not_a_value(error)
    return shortened(str(error), 2 * LONGEST)


def _unknown_command(error: cyclopts.CycloptsError, program: str, root: cyclopts.App) -> str:
    """Return the error message for an unknown command, with suggestions from all groups."""
    word = (error.unused_tokens or [""])[0]
    if word.startswith("-"):
        meant = suggestion(word, ["--help", "--version"])
        advice = "." if meant else ": write options after the name of a command."
        return f"{program} has no option {_quoted(word)}{advice}{meant}"
    app = error.app or root
    names = command_names(app)
    close = get_close_matches(word, names, 1, TUNED.similar_word)
    if not close:
        close = [name for name in command_names(root, deep=True) if name.split()[-1] == word]
    return f"{program} has no command {_quoted(word)}.{_meant(close)}"


def _option_names(arguments: Iterable[cyclopts.Argument]) -> list[str]:
    """List the options of a command."""
    names = [name for argument in arguments for name in argument.names if name.startswith("-")]
    return [*names, "--help"]


def _unknown_option(word: str, program: str, names: Sequence[str]) -> str:
    """Return the error message for an unknown option, with a suggestion."""
    alias = SYNONYMS.get(word)
    meant = _meant([alias]) if alias and alias in names else suggestion(word, names)
    return f"{program} has no option {_quoted(word)}.{meant}"


def _missing(error: cyclopts.MissingArgumentError, program: str, words: Sequence[str]) -> str:
    """Return the error message for a missing argument or value, or for an unknown option before it."""
    assert error.argument is not None
    names = " or ".join(error.argument.names)
    if error.keyword or any(token.keyword for token in error.argument.tokens):
        option = error.keyword or names
        return _below_zero(option, words) or f"{error.keyword or names} needs a value."
    options = _option_names(error.app.assemble_argument_collection()) if error.app else words
    typed = [word.partition("=")[0] for word in words if word.startswith("--") and word != "--"]
    for word in typed:
        if word not in options:
            return _unknown_option(word, program, options)
    return f"{program} needs {names}."


def _below_zero(option: str, words: Sequence[str]) -> str:
    """Return the error message for a value such as -5s, which looks like an option, or ""."""
    following = words[words.index(option) + 1 :][:1] if option in words else []
    if following and re.match(r"-[\d.]", following[0]):
        return f"{option} takes no value below zero, got {_quoted(following[0])}."
    return ""


def _not_a_value(error: cyclopts.CoercionError) -> str:
    """Return the error message for an invalid value, with the expected type and the nearest choice."""
    name = error.argument.name if error.argument else ""
    word = error.token.value if error.token else ""
    if error.token and error.token.keyword:
        name = error.token.keyword
    if error.msg:
        return f"{name}: {shortened(str(error.msg), 2 * LONGEST)}."
    kind = error.target_type
    if get_origin(kind) is Literal:
        choices = [str(choice) for choice in get_args(kind)]
        return f"{name}: {_quoted(word)} is none of {', '.join(choices)}.{suggestion(word, choices)}"
    expected = KINDS.get(kind, "a value that fits")
    return f"{name}: {_quoted(word)} is not {expected}."


KINDS: dict[object, str] = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
}


def suggestion(word: str, names: Iterable[str]) -> str:
    """Return a question with the most similar name, or "".

    Examples
    --------
    >>> suggestion("--skelton", ["--scale", "--skeleton"])
    " Did you mean '--skeleton'?"
    >>> suggestion("--sk", ["--scale", "--skeleton"])
    " Did you mean '--skeleton'?"
    >>> suggestion("--colour", ["--scale", "--skeleton"])
    ''
    """
    names = list(names)
    beginnings = [name for name in names if len(word) > len("--") and name.startswith(word)]
    return _meant(beginnings or get_close_matches(word, names, 1, TUNED.similar_word))


def _meant(names: list[str]) -> str:
    return f" Did you mean '{names[0]}'?" if names else ""


def _quoted(word: str) -> str:
    return f"'{shortened(word, LONGEST)}'"
