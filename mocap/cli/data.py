"""The commands for clips of other labs: `mocap data list`, `sets` and `fetch`."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

from mocap import datasets
from mocap.cli.options import bar, number
from mocap.cli.typed_commands import Group
from mocap.datasets.named_sets import SETS, clips_of, fetch_set
from mocap.errors import MocapError


def list_trials(
    *, subject: Annotated[int | None, number(1, 999, int)] = None, kind: str | None = None
) -> None:
    """List the trials of the CMU database that datasets.cmu fetches.

    List the trials of the CMU database that datasets.cmu fetches by name.

    Parameters
    ----------
    subject : only this person's trials.
    kind : only trials with this word in their description.
    """
    from mocap.datasets.cmu_database import TERMS  # the help needs no NumPy

    print(f"{'trial':<8} {'frames':>6}  description")
    for trial in datasets.trials(subject, kind):
        print(f"{trial.name:<8} {trial.frames:>6}  {trial.description}")
    print(f"\n{TERMS}")


def list_sets() -> None:
    """List the named sets that datasets.from_set reads, with their licences and joints."""
    for name, row in SETS.items():
        print(f"{name:<12} {row.title}")
        rows = {"licence": row.licence, "allows": row.allows, "address": row.address}
        rows |= {"download": row.size(), "rate": f"{row.fps:g} Hz", "hips": row.hips}
        rows |= {"left leg": ", ".join(row.legs), "at hand": f"{len(clips_of(name))} clips"}
        print("\n".join(f"{'':<12} {key:<8} {value}" for key, value in rows.items()))


def fetch(set: Annotated[str, {"choices": list(SETS)}], *, accept: bool = False) -> None:
    """Download all clips of a named set, once.

    Download all clips of a named set, unless they are at hand. A download that broke off, or that Ctrl-C
    ended, continues when the same command is run again.

    Parameters
    ----------
    set : its name.
    accept : accept the licence that the set is under.
    """
    named_set = SETS[set]
    if not accept:
        print(named_set.terms())
        raise MocapError(f"If you accept this licence, add --accept: {named_set.size()} to download.")
    with sigterm_as_ctrl_c():
        clips = fetch_set(set, bar("fetching"))
    print(f"{len(clips)} clips are at hand")


@contextmanager
def sigterm_as_ctrl_c() -> Iterator[None]:
    """Raise KeyboardInterrupt when the system asks the process to end (SIGTERM), in the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, handler)


DATA = Group(
    "List clips to download, and download whole sets.",
    {"list": list_trials, "sets": list_sets, "fetch": fetch},
)
