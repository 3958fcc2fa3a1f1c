"""The command `mocap`, or `python -m mocap`."""

import re
import signal
import sys
import threading
import time
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from inspect import BoundArguments
from itertools import chain, takewhile
from typing import Any, Literal

import cyclopts

import mocap
from mocap.cli import help_pages, refusals
from mocap.cli.clips import convert, find, info, judge, view
from mocap.cli.course import COURSE, lab
from mocap.cli.crowd import crowd
from mocap.cli.cutting import cut
from mocap.cli.data import DATA
from mocap.cli.edits import bend, blend, loop, retarget, warp
from mocap.cli.graph import GRAPH, demo
from mocap.cli.in_betweens import inbetween
from mocap.cli.labels import label
from mocap.cli.messages import VERBOSITY, Verbosity, at_verbosity, note, print_message
from mocap.cli.options import named_options, retargeting_advised
from mocap.cli.page import page
from mocap.cli.steer import steer
from mocap.cli.streams import PatientOutput, prepared_streams
from mocap.cli.typed_commands import Commands, Group, make_root, option_names
from mocap.cli.walk import walk
from mocap.errors import MocapError, MocapWarning, shortened
from mocap.files import formats

# Exit statuses
DONE = 0
UNEXPECTED = 1
REFUSED = 2
INTERRUPTED = 130
PIPE_CLOSED = 141

SHARED_FLAGS = ("-q", "--quiet", "-v", "--verbose", "--debug")  # the options of `Verbosity`
HELP_FLAGS = {"-h", "--help"}
AXIS_OPTIONS = ("--up", "--to-up")
AXES_DOWN = ("-x", "-y", "-z")
ENDS_OF_OPTIONS = ("--", "--jupyter")
RAISE: Any = {"exit_on_error": False, "print_error": False}
BASH_FILES = 'COMPREPLY=( $(compgen -f -- "${cur}") )'  # the completion of files by `cyclopts`
# A folder ends in a slash without a space after it, and names may contain spaces. Bash 3 has no `compopt`.
FOLDERS_TO_ENTER = "local IFS=$'\\n'; compopt -o filenames 2> /dev/null;"
NOWHERE: Any = object()  # an unused console for errors: that of `rich` takes 0.1 s to load
EPILOGUE = (
    "mocap COMMAND --help describes the arguments and options of a command. All commands take -q (no "
    "progress and no warnings), -v (the files that are read, and the duration of each stage) and --debug "
    "(the traceback of an error)."
)


def completion(shell: Literal["bash", "zsh", "fish"]) -> None:
    """Print the script with which a shell completes commands, options and choices.

    Parameters
    ----------
    shell : the shell.

    Notes
    -----
    Add this line to the configuration of the shell:
      bash  source <(mocap completion bash)    in ~/.bashrc
      zsh   source <(mocap completion zsh)     in ~/.zshrc, after compinit
      fish  mocap completion fish | source     in ~/.config/fish/config.fish

    Example: mocap completion bash
    """
    script = root().generate_completion(shell=shell)
    if shell == "zsh":  # zsh searches the script in a special folder, unless the script registers itself
        functions = re.findall(r"^(_\w+)\(\)", script, re.MULTILINE)
        script += f"\ncompdef {functions[0]} mocap"
    if shell == "bash":
        script = script.replace(BASH_FILES, f"{FOLDERS_TO_ENTER} {BASH_FILES}")
        script = script.replace("complete -F", "complete -o bashdefault -o default -F")
    print(script)


GRAPHS: Commands = {
    **{"demo": demo, "graph": GRAPH, "walk": walk},
    **{"steer": steer, "page": page, "crowd": crowd},
}
CLIPS: Commands = {
    **{"info": info, "view": view, "judge": judge},
    **{"convert": convert, "find": find, "label": label},
}
EDITS: Commands = {run.__name__: run for run in (cut, warp, bend, loop, blend, inbetween, retarget)}
COURSES: Commands = {"data": DATA, "course": COURSE, "lab": lab}
COMMANDS: dict[str, Commands] = {
    "Motion graphs": GRAPHS,
    "Clips": CLIPS,
    "Edits": EDITS,
    "Data and course": COURSES,
    "Shell": {"completion": completion},
}
"""All commands, in the groups in which `mocap --help` lists them."""


def root(wanted: str | None = None) -> cyclopts.App:
    """Create the command `mocap` with all its commands.

    Parameters
    ----------
    wanted : the name of the only command that is complete. The others can only be listed then. By default all
        are complete.
    """
    text = f"Create new human motion from captured motion. Motion files are {formats.listed()}."
    version = f"mocap {mocap.__version__}"
    return make_root("mocap", text, COMMANDS, Verbosity, version=version, epilogue=EPILOGUE, wanted=wanted)


def in_order(words: Sequence[str]) -> list[str]:
    """Put words in the order in which they are parsed.

    `-q`, `-v` and `--debug` may precede the name of a command. A group alone shows its help. The words after
    the `--` of `mocap lab` are the value of an option. `mocap help` is `mocap --help`. An axis such as `-z`
    after `--up` is its value.

    Examples
    --------
    >>> in_order(["-q", "info", "walk.bvh"]), in_order(["graph"])
    (['info', 'walk.bvh', '-q'], ['graph', '--help'])
    >>> in_order(["help", "info"])
    ['info', '--help']
    >>> in_order(["lab", "mine", "--", "--no-browser"])
    ['lab', 'mine', '--jupyter', '--no-browser']
    """
    words = _with_axes(words)
    leading = [*takewhile(lambda word: word in SHARED_FLAGS or not word.startswith("-"), words)]
    flags = [word for word in leading if word in SHARED_FLAGS]
    names = [word for word in leading if word not in SHARED_FLAGS]
    rest = [*names, *words[len(leading) :]]
    if rest[:1] == ["help"]:
        return [*rest[1:], "--help"]
    groups = [name for listed in COMMANDS.values() for name, run in listed.items() if isinstance(run, Group)]
    if not rest or rest in ([group] for group in groups):
        return [*rest, "--help"]
    end = rest.index("--") if "--" in rest else len(rest)
    last = rest[end:]
    if last and rest[0] == "lab":
        last = ["--jupyter", *last[1:]]
    return [*rest[:end], *flags, *last]


def _with_axes(words: Sequence[str]) -> list[str]:
    """Join `--up -z` to `--up=-z`, since an axis that points down looks like an option.

    Examples
    --------
    >>> _with_axes(["walk.bvh", "--up", "-z", "--to-up", "y"])
    ['walk.bvh', '--up=-z', '--to-up', 'y']
    """
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in AXIS_OPTIONS and word in AXES_DOWN:
            joined[-1] = f"{joined[-1]}={word}"
        else:
            joined.append(word)
    return joined


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status.

    The status is 0 for success, 2 for invalid input, 1 for an unexpected error, 130 after Ctrl-C or SIGTERM,
    and 141 after a closed pipe.

    Parameters
    ----------
    arguments : the words after `mocap`, by default those of the command line.
    """
    words = [*(sys.argv[1:] if arguments is None else arguments)]
    with prepared_streams() as output:
        try:
            status = _run(words)
            output.flush()
        except BaseException as error:
            status = _report_error(error, debug="--debug" in words)
            _end(output)
        if output.abandoned:
            output.discard()
            return PIPE_CLOSED
        return status


def _end(output: PatientOutput) -> None:
    """Print the output that preceded an error, if that is possible."""
    try:
        output.flush()
    except MocapError:
        output.discard()


def _run(words: Sequence[str]) -> int:
    """Parse the words, call the command, and return its exit status."""
    ordered = in_order(words)
    if ordered[0] == "--version":
        print(f"mocap {mocap.__version__}")
        return DONE
    app = root(ordered[0])
    if HELP_FLAGS & {*takewhile(lambda word: word not in ENDS_OF_OPTIONS, ordered)}:
        ordered = [word for word in ordered if word not in HELP_FLAGS]
        names, apps, rest = app.parse_commands(ordered)
        if apps[-1].default_command or not rest:
            print(help_pages.page(apps[-1], " ".join(["mocap", *names])))
            return DONE
    try:
        command, bound, _ = app.parse_args(ordered, error_console=NOWHERE, **RAISE)
    except cyclopts.CycloptsError as error:
        raise MocapError(refusals.explain(error, root(), ordered)) from error
    start = time.perf_counter()
    chosen = dict(chain.from_iterable(named.items() for named in COMMANDS.values()))[ordered[0]]
    if isinstance(chosen, Group):
        refusals.require_meant(ordered[1:], ordered[0], [*chosen.commands])
    with _sigterm_as_ctrl_c(), at_verbosity(_take_verbosity(bound)), warnings.catch_warnings():
        if VERBOSITY.get().quiet:
            warnings.simplefilter("ignore", MocapWarning)
        else:
            warnings.simplefilter("always", MocapWarning)
        warnings.showwarning = _show_warning
        options = option_names(command)
        if "joints" in options:
            options["roles"] = options["joints"]  # as the parameter is called in Python
        with named_options(options), retargeting_advised():
            status = command(*bound.args, **bound.kwargs)
        seconds = time.perf_counter() - start
        note(f"done in {seconds:.1f} s, {time.process_time():.1f} s of processor time")
    return int(status or DONE)


def _take_verbosity(bound: BoundArguments) -> Verbosity:
    """Remove the options of all commands from the arguments of a command, and return them."""
    names = ("quiet", "verbose", "debug")
    return Verbosity(**{name: bound.arguments.pop(name) for name in names if name in bound.arguments})


def _show_warning(message: Warning | str, *_place: object, **_options: object) -> None:
    """Print a warning as one line."""
    print_message(message)


def _report_error(error: BaseException, *, debug: bool) -> int:
    """Print an error as one sentence, with `debug` after its traceback, and return the exit status."""
    if isinstance(error, SystemExit):
        raise error
    if debug:
        traceback.print_exception(error)
    if isinstance(error, KeyboardInterrupt):
        notes = getattr(error, "__notes__", [])
        print_message(" ".join(["interrupted; no half-written file is left.", *notes]))
        return INTERRUPTED
    if isinstance(error, MocapError | OSError):  # an OSError is, for example, a name that is too long
        print_message(error)
        return REFUSED
    if isinstance(error, MemoryError):
        print_message(
            "out of memory: try fewer or shorter clips, or a lower frame rate (--debug shows where it was)."
        )
        return UNEXPECTED
    kind = type(error).__name__
    shown = shortened(f"{error}", 80) or "no further text"
    print_message(f"unexpected {kind}: {shown}. This is a bug; the same with --debug shows where.")
    return UNEXPECTED


@contextmanager
def _sigterm_as_ctrl_c() -> Iterator[None]:
    """Raise KeyboardInterrupt on SIGTERM, if this is the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, handler)
