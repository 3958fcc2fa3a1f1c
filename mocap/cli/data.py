"""The commands for clips of other labs: `mocap data list`, `sets` and `fetch`."""

from typing import Annotated, Literal

from mocap import datasets
from mocap.cli.option_types import number
from mocap.cli.stages import bar
from mocap.cli.typed_commands import Group
from mocap.errors import MocapError

SetName = Literal["lafan1", "bandai_namco", "100style"]  # the keys of `named_sets.SETS`


def list_trials(
    *, subject: Annotated[int | None, number(1, 999, int)] = None, kind: str | None = None
) -> None:
    """List the trials of the CMU database.

    The function datasets.cmu downloads them by name.

    Parameters
    ----------
    subject : only the trials of the subject with this number.
    kind : only the trials with this word in their description.

    Notes
    -----
    Example: mocap data list --subject 16 --kind jump
    """
    from mocap.datasets.cmu_database import TERMS  # the help needs no NumPy

    print(f"{'trial':<8} {'frames':>6}  description")
    for trial in datasets.trials(subject, kind):
        print(f"{trial.name:<8} {trial.frames:>6}  {trial.description}")
    print(f"\n{TERMS}")


def list_sets() -> None:
    """List the named sets of clips, with their licences and joints.

    The function datasets.from_set reads their clips.
    """
    from mocap.datasets.named_sets import SETS, clips_of

    for name, row in SETS.items():
        print(f"{name:<12} {row.title}")
        rows = {"licence": row.licence, "allows": row.allows, "address": row.address}
        rows |= {"download": row.size(), "rate": f"{row.fps:g} Hz", "hips": row.hips}
        rows |= {"left leg": ", ".join(row.legs), "at hand": f"{len(clips_of(name))} clips"}
        print("\n".join(f"{'':<12} {key:<8} {value}" for key, value in rows.items()))


def fetch(set: SetName, *, accept: bool = False) -> None:
    """Download all clips of a named set.

    Clips that have been downloaded before are skipped. An interrupted download is resumed when the same
    command is run again.

    Parameters
    ----------
    set : the name of the set.
    accept : accept the licence of the set.

    Notes
    -----
    Example: mocap data fetch lafan1 --accept
    """
    from mocap.datasets.named_sets import SETS, fetch_set

    named_set = SETS[set]
    if not accept:
        print(named_set.terms())
        raise MocapError(f"If you accept this licence, add --accept: {named_set.size()} to download.")
    clips = fetch_set(set, bar("fetching"))
    print(f"{len(clips)} clips are at hand")


DATA = Group(
    "List and download clips of other labs.",
    {"list": list_trials, "sets": list_sets, "fetch": fetch},
)
