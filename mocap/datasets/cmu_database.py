"""Trials of the CMU Graphics Lab Motion Capture Database, downloaded once and cached.

`cmu.tsv` beside this module lists the files of subjects 02, 03, 16, 49 and 127 with their SHA-256, by which
each download is verified. `downloads` stores them as `<subject>/<file>`.
"""

from __future__ import annotations

import csv
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple, overload

from mocap._shared.quantities import described
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.datasets.downloads import fetch
from mocap.editing.retargeting import wear
from mocap.editing.stances import Stance
from mocap.errors import MocapError, shortened
from mocap.files.load_save import load

BASE_URL = "http://mocap.cs.cmu.edu/subjects"
TERMS = (
    "These clips come from the CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu), created with "
    "funding from NSF EIA-0196217. They are free for research and in commercial products, but you may not "
    "resell them, not even converted."
)


class Trial(NamedTuple):
    """A trial of the database, with its description there.

    Examples
    --------
    >>> trials(127)[0]
    Trial(name='127_01', subject=127, frames=..., description=...)
    """

    name: str
    subject: int
    frames: int
    description: str


@cache
def _registry() -> dict[str, dict[str, str]]:
    with Path(__file__).with_name("cmu.tsv").open(encoding="utf-8", newline="") as file:
        return {row["file"]: row for row in csv.DictReader(file, delimiter="\t")}


def is_listed(name: str, digest: str) -> bool:
    """Return whether a file of this name and SHA-256 is part of the database.

    Examples
    --------
    >>> is_listed("02_01.amc", "0")
    False
    """
    listed = _registry().get(f"{name.split('_')[0].removesuffix('.asf')}/{name}")
    return listed is not None and listed["sha256"] == digest


def trials(subject: int | None = None, kind: str | None = None) -> list[Trial]:
    """List the trials that `cmu` can return.

    Parameters
    ----------
    subject : only trials of this person.
    kind : only trials with this word in their description, in upper or lower case.

    Raises
    ------
    MocapError : if there is no such trial.

    Examples
    --------
    >>> [trial.name for trial in trials(subject=127, kind="walk")]
    ['127_04']
    """
    listed = []
    for name, row in _registry().items():
        person, file = name.split("/")
        is_kind = kind is None or re.search(rf"\b{re.escape(kind)}\b", row["description"], re.IGNORECASE)
        if file.endswith(".amc") and is_kind and subject in (None, int(person)):
            trial = Trial(file.removesuffix(".amc"), int(person), int(row["frames"]), row["description"])
            listed.append(trial)
    if not listed:
        subjects = ", ".join(sorted({name.split("/")[0] for name in _registry()}))
        person_asked = f" of subject {subject}" if subject is not None else ""
        word_asked = f" with '{shortened(kind, 40)}' in its description" if kind is not None else ""
        raise MocapError(f"No trial{person_asked}{word_asked} is listed; the subjects are {subjects}.")
    return listed


@overload
def cmu(clip: str, *, skeleton: Skeleton | Stance | None = None) -> Motion: ...
@overload
def cmu(
    clip: None = None,
    *,
    subject: int | None = None,
    kind: str | None = None,
    skeleton: Skeleton | Stance | None = None,
) -> list[Motion]: ...
def cmu(
    clip: str | None = None,
    *,
    subject: int | None = None,
    kind: str | None = None,
    skeleton: Skeleton | Stance | None = None,
) -> Motion | list[Motion]:
    """Return a trial of the CMU database, or all trials of a person or a kind, at 120 Hz.

    Each person has another skeleton, but a motion graph needs the same one for all clips. With `skeleton`,
    all motions are retargeted to it.

    Parameters
    ----------
    clip : the name of a trial, such as "16_15".
    subject : without `clip`, the number of the person.
    kind : without `clip`, a word of the description, such as "walk"; `mocap data list` shows all trials.
    skeleton : the skeleton to which motions are retargeted by `editing.wear`; by default, each has that of
        its person. A stance, such as `editing.stance_of(cmu("16_15"))`, also defines the heights of the feet.

    Returns
    -------
    The motion named `clip`, or without a name a list of motions.

    Raises
    ------
    MocapError : for a trial that is not listed, a name that is not a text, and a file that cannot be
        downloaded. With `skeleton` also as by `editing.wear`, for example for a trial in which a foot never
        stands.

    Examples
    --------
    >>> cmu("16_99")
    Traceback (most recent call last):
    mocap.errors.MocapError: No trial '16_99' is listed; `mocap data list` shows those that are.

    Notebook: 10-real-data
    """
    if clip is None and subject is None and kind is None:
        raise MocapError('Which trials? Name one, as in cmu("16_15"), or give subject= or kind=.')
    _require_name(clip)
    motions = []
    for name in [trial.name for trial in trials(subject, kind)] if clip is None else [clip]:
        folder = name.split("_")[0]
        if f"{folder}/{name}.amc" not in _registry():
            raise MocapError(f"No trial '{name}' is listed; `mocap data list` shows those that are.")
        asf = fetch_listed(f"{folder}/{folder}.asf")
        motion = load(fetch_listed(f"{folder}/{name}.amc"), skeleton=asf, fps=120.0)
        motions.append(motion if skeleton is None else wear(motion, skeleton))
    return motions if clip is None else motions[0]


def _require_name(clip: object) -> None:
    """Raise unless the name of a trial is a text or None."""
    if clip is None or isinstance(clip, str):
        return
    all_trials = f"; cmu(subject={clip}) are all trials of a person" if isinstance(clip, int) else ""
    raise MocapError(f'A trial is named as in cmu("16_15"), got {described(clip)}{all_trials}.')


def fetch_listed(name: str) -> Path:
    """Find a listed file, such as "16/16.asf", in the cache, or download it."""
    return fetch(name, f"{BASE_URL}/{name}", _registry()[name]["sha256"], TERMS)
