"""The commands and their options, as tests go through them."""

from collections.abc import Sequence

import cyclopts

from mocap.cli.main import RAISE, in_order, root
from mocap.cli.typed_commands import command_names


def command(words: str) -> cyclopts.App:
    """Return a command by its words, as in "graph info"."""
    app = root()
    for word in words.split():
        app = app[word]
    return app


def options(words: str) -> list[str]:
    """List the long options of a command, but for `--debug`, which shows tracebacks."""
    arguments = command(words).assemble_argument_collection()
    return [argument.names[-1] for argument in arguments if argument.index is None and argument.show][:-1]


def understood(words: Sequence[str]) -> bool:
    """Check that words fit a command; raise a CycloptsError that says what does not."""
    root().parse_args(in_order(words), **RAISE)
    return True


# `mocap graph` alone is `mocap graph build`.
LEAVES = [name for name in command_names(root(), deep=True) if name != "graph"]
