"""The command `mocap`, or `python -m mocap`."""

import argparse
import sys
import warnings
from collections.abc import Sequence

import mocap
from mocap.cli.course import add_course, add_lab
from mocap.cli.demo import add_demo
from mocap.cli.files import add_convert, add_data, add_info
from mocap.cli.graph import ACTIONS, add_graph
from mocap.cli.view import add_view
from mocap.cli.walk import add_walk
from mocap.errors import MocapError, MocapWarning


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mocap", description="New human motion out of captured motion.")
    parser.add_argument("--version", action="version", version=f"mocap {mocap.__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for add in (
        add_demo,
        add_graph,
        add_walk,
        add_info,
        add_convert,
        add_data,
        add_view,
        add_course,
        add_lab,
    ):
        add(commands)
    return parser


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
    """Write an error or a warning as one line."""
    print(f"mocap: {message}", file=sys.stderr)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status: 0, 2 for bad input, or 130 after Ctrl-C.

    Parameters
    ----------
    arguments : the words after `mocap`; those of the command line by default.
    """
    options = _parser().parse_args(_with_action(sys.argv[1:] if arguments is None else arguments))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", MocapWarning)
            warnings.showwarning = _say
            return int(options.run(options))
    except MocapError as error:
        _say(str(error))
        return 2
    except KeyboardInterrupt:
        _say("interrupted; no half-written file is left.")
        return 130
