"""The command `mocap`, or `python -m mocap`."""

import argparse
import sys
import warnings
from collections.abc import Sequence

from mocap.cli.course import add_course, add_lab
from mocap.cli.demo import add_demo
from mocap.cli.files import add_convert, add_data, add_info
from mocap.cli.graph import ACTIONS, add_graph
from mocap.cli.view import add_view
from mocap.cli.walk import add_walk
from mocap.errors import MocapError, MocapWarning


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mocap", description="New human motion out of captured motion.")
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


def _told_to_build(arguments: Sequence[str]) -> list[str]:
    """Let `mocap graph CLIPS` mean `mocap graph build CLIPS`.

    Examples
    --------
    >>> _told_to_build(["graph", "clips/"]), _told_to_build(["graph", "info", "graph.npz"])
    (['graph', 'build', 'clips/'], ['graph', 'info', 'graph.npz'])
    """
    command, *rest = arguments or [""]
    return (
        ["graph", "build", *rest]
        if command == "graph" and rest and rest[0] not in ACTIONS
        else list(arguments)
    )


def _tell(message: Warning | str, *_place: object, **_more: object) -> None:
    print(f"mocap: {message}", file=sys.stderr)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; give its exit status: 0, or 2 where the input is at fault, or 130 when interrupted."""
    options = _parser().parse_args(_told_to_build(sys.argv[1:] if arguments is None else arguments))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", MocapWarning)
            warnings.showwarning = _tell
            return int(options.run(options))
    except MocapError as error:
        print(f"mocap: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("mocap: interrupted; nothing half-written is left.", file=sys.stderr)
        return 130
