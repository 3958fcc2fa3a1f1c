"""The command `mocap`, or `python -m mocap`."""

import argparse
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import NoReturn

import mocap
from mocap.cli.bend import add_bend
from mocap.cli.blend import add_blend
from mocap.cli.course import add_course, add_lab
from mocap.cli.crowd import add_crowd
from mocap.cli.demo import add_demo
from mocap.cli.files import add_convert, add_data, add_info, add_judge
from mocap.cli.find import add_find
from mocap.cli.graph import ACTIONS, add_graph
from mocap.cli.loop import add_loop
from mocap.cli.options import as_options
from mocap.cli.retarget import add_retarget
from mocap.cli.view import add_view
from mocap.cli.walk import add_walk
from mocap.cli.warp import add_warp
from mocap.errors import MocapError, MocapWarning, shortened

LONGEST = 150  # letters of a sentence about options, which may quote what was typed


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Raise, so that bad options are one sentence like all other errors."""
        shown = message if len(message) <= LONGEST else f"{message[:LONGEST]}…"
        raise MocapError(f"{shown} (see {self.prog} --help)")


def _parser() -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = _Parser(
        prog="mocap", description="New human motion out of captured motion."
    )
    parser.add_argument("--version", action="version", version=f"mocap {mocap.__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for add in (
        add_demo,
        add_graph,
        add_walk,
        add_blend,
        add_info,
        add_judge,
        add_convert,
        add_warp,
        add_bend,
        add_loop,
        add_find,
        add_crowd,
        add_retarget,
        add_data,
        add_view,
        add_course,
        add_lab,
    ):
        add(commands)
    _name_parsers(parser)
    return parser


def _name_parsers(parser: argparse.ArgumentParser) -> None:
    """Let each command's options name its parser, whose usage an error shows."""
    parser.set_defaults(parser=parser)
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                _name_parsers(command)


def _for_jupyterlab(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split off what stands after `--` in `mocap lab`: it is for JupyterLab.

    Examples
    --------
    >>> _for_jupyterlab(["lab", "mine", "--", "--no-browser"])
    (['lab', 'mine'], ['--no-browser'])
    """
    if words[:1] != ["lab"] or "--" not in words:
        return list(words), []
    at = list(words).index("--")
    return list(words[:at]), list(words[at + 1 :])


def _with_action(arguments: Sequence[str]) -> list[str]:
    """Let `mocap graph CLIPS` mean `mocap graph build CLIPS`.

    Examples
    --------
    >>> _with_action(["graph", "clips/"]), _with_action(["graph", "info", "graph.npz"])
    (['graph', 'build', 'clips/'], ['graph', 'info', 'graph.npz'])
    """
    command, *rest = arguments or [""]
    builds = command == "graph" and rest and rest[0] not in ACTIONS
    return ["graph", "build", *rest] if builds else list(arguments)


def _say(message: Warning | str, *_place: object, **_more: object) -> None:
    """Write an error or a warning as one line, with the names that options have on a command line."""
    text = re.sub(r"\S{200,}", lambda word: shortened(word[0]), as_options(str(message)))  # endless names
    print(f"mocap: {text}", file=sys.stderr)


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    words, after = _for_jupyterlab(_with_action(arguments))
    options, unknown = _parser().parse_known_args(words)
    if unknown:
        options.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
    options.after = after
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status.

    It is 0, 2 for bad input, 130 after Ctrl-C, or 141 after a closed pipe.

    Parameters
    ----------
    arguments : the words after `mocap`; those of the command line by default.
    """
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")  # a terminal that knows no ° shows ?
    try:
        options = _options(sys.argv[1:] if arguments is None else arguments)
        with warnings.catch_warnings():
            warnings.simplefilter("always", MocapWarning)
            warnings.showwarning = _say
            status = int(options.run(options))
            sys.stdout.flush()
            return status
    except MocapError as error:
        _say(str(error))
        return 2
    except BrokenPipeError:  # the reader has seen enough, as with `mocap data list | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    except KeyboardInterrupt:
        _say("interrupted; no half-written file is left.")
        return 130
