"""The command `mocap`, or `python -m mocap`."""

import argparse
import errno
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import NoReturn

import mocap
from mocap.cli.clips import convert, find, info, judge, view
from mocap.cli.course import COURSE, lab
from mocap.cli.data import DATA
from mocap.cli.edits import bend, blend, loop, retarget, warp
from mocap.cli.graph import GRAPH, demo
from mocap.cli.in_betweens import inbetween
from mocap.cli.options import as_options
from mocap.cli.typed_commands import Group, Run, add_commands, call
from mocap.cli.walk import crowd, page, walk
from mocap.errors import MocapError, MocapWarning, printable, shortened
from mocap.files import formats

LONGEST = 150  # letters of a sentence about options, which may quote what was typed
ACTIONS = (*GRAPH.commands, "-h", "--help")  # before any other word, `build` may be left out
CLIPS: tuple[Run, ...] = (blend, info, judge, convert, warp, bend, loop, find, crowd, retarget, inbetween)
COMMANDS: dict[str, Run | Group] = {"demo": demo, "graph": GRAPH, "walk": walk, "page": page}
COMMANDS |= {run.__name__: run for run in CLIPS}
COMMANDS |= {"data": DATA, "view": view, "course": COURSE, "lab": lab}


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Raise, so that bad options are one sentence like all other errors."""
        shown = message if len(message) <= LONGEST else f"{message[:LONGEST]}…"
        raise MocapError(f"{shown} (see {self.prog} --help)")


def _parser() -> argparse.ArgumentParser:
    description = f"New human motion out of captured motion. Motion files are {formats.listed()}."
    parser = _Parser(prog="mocap", description=description)
    parser.add_argument("--version", action="version", version=f"mocap {mocap.__version__}")
    parser.set_defaults(parser=parser)
    add_commands(parser, COMMANDS)
    return parser


def _written_out(words: list[str]) -> list[str]:
    """Write abbreviations in full: `build` after `mocap graph`, and the option that `--` of `mocap lab` is.

    Examples
    --------
    >>> _written_out(["graph", "clips/"]), _written_out(["graph", "info", "graph.npz"])
    (['graph', 'build', 'clips/'], ['graph', 'info', 'graph.npz'])
    >>> _written_out(["lab", "mine", "--", "--no-browser"])
    ['lab', 'mine', '--jupyter', '--no-browser']
    """
    if words[:1] == ["graph"] and words[1:] and words[1] not in ACTIONS:
        return ["graph", "build", *words[1:]]
    return ["--jupyter" if word == "--" and words[0] == "lab" else word for word in words]


def _say(message: Warning | str, *_place: object, **_options: object) -> None:
    """Write an error or a warning as one line, with the names that options have on a command line."""
    text = as_options(printable(message))
    text = re.sub(r"\S{200,}", lambda word: shortened(word[0]), text)  # endless names
    print(f"mocap: {text}", file=sys.stderr)


def _pipe_is_closed(error: Exception) -> bool:
    """Return whether the reader has seen enough, as with `mocap data list | head`.

    Windows reports that as an invalid argument of a file without a name.
    """
    invalid = isinstance(error, OSError) and error.errno == errno.EINVAL and error.filename is None
    return isinstance(error, BrokenPipeError) or (os.name == "nt" and invalid)


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
        words = _written_out(sys.argv[1:] if arguments is None else [*arguments])
        options, unknown = _parser().parse_known_args(words)
        if unknown:
            options.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
        with warnings.catch_warnings():
            warnings.simplefilter("always", MocapWarning)
            warnings.showwarning = _say
            status = int(call(options.run, options) or 0)
            sys.stdout.flush()
            return status
    except (MocapError, OSError) as error:  # of the system: such as a name that is too long
        if _pipe_is_closed(error):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 141
        _say(str(error))
        return 2
    except KeyboardInterrupt as interruption:
        advice = getattr(interruption, "__notes__", [])
        _say(" ".join(["interrupted; no half-written file is left.", *advice]))
        return 130
