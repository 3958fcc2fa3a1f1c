"""A student's function drives the course from the exercise on; until then the package's stands in."""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import cache
from typing import Any

from mocap.course.check import Verdict
from mocap.course.checks import all_checks, nearest
from mocap.course.lab.guarding import Slot
from mocap.course.lab.kept_functions import keep, place, plain_source, read_text, run_sections
from mocap.errors import MocapError


def mine(what: str | Callable[..., Any] | Slot) -> Slot:
    """Put a student's function in its place, or give what stands there: theirs, or the package's.

    A function that passes its check is adopted: it is written into `my_graph.py` beside the notebook, and
    from then on it is what all notebooks get by its name. One that does not pass leaves its place as it was.
    Whose code stands there is printed. The environment variable MOCAP_MINE names another file; where it is
    empty, nothing is read or written.

    Parameters
    ----------
    what : the function that an exercise asks for, or its name.

    Returns
    -------
    The place; call it like the function.

    Raises
    ------
    MocapError : for a name that no exercise has.

    Examples
    --------
    >>> def hamilton(a, b):
    ...     return ...
    >>> hamilton = mine(hamilton)
    hamilton: the package's stands in until yours passes its check.
    >>> hamilton([0, 1, 0, 0], [0, 0, 1, 0]).tolist()
    [0.0, 0.0, 0.0, 1.0]

    Notebook: 08-path-synthesis
    """
    if isinstance(what, Slot):
        what = what.written if what.written is not what.stand_in else what.name
    slot = slots(what if isinstance(what, str) else what.__name__)[0]
    failed = callable(what) and not _take(slot, what)
    if slot.yours:
        kept = f", kept in {place()}" if slot.kept else ""
        print(f"{slot.name}: yours{kept}{'; it is the one that passed, not this one' if failed else ''}.")
    else:
        why = f"; yours {slot.stopped}." if slot.stopped else " until yours passes its check."
        print(f"{slot.name}: the package's stands in{why}")
    return slot


def slots(*names: str) -> list[Slot]:
    """Give the places of some exercises, with what the file beside the notebook holds, and print nothing new.

    Raises
    ------
    MocapError : for a name that no exercise has.
    """
    if unknown := [name for name in names if name not in all_checks()]:
        raise MocapError(f"The course has no exercise '{unknown[0][:40]}'; {nearest(unknown[0])}.")
    _refresh()
    return [_slots()[name] for name in names]


def whose(*names: str) -> str:
    """Say whose functions run in some places, as a line for a caption.

    Examples
    --------
    >>> whose("hamilton", "climb")
    "hamilton, climb: the package's"

    Notebook: 00-quickstart
    """
    found = slots(*names)
    parts = []
    for yours, of in ((True, "yours"), (False, "the package's")):
        if some := [slot.name for slot in found if slot.yours == yours]:
            parts.append(f"{', '.join(some)}: {of}")
    return " · ".join(parts)


def _take(slot: Slot, written: Callable[..., Any]) -> bool:
    """Adopt a function if it is right, and write it into the file; say whether it is right."""
    slot.written = written
    if not all_checks()[slot.name].verdict(written).right:
        return False
    slot.adopt(written, kept=False)
    try:
        if file := place():
            plain = plain_source(written, all_checks())  # type: ignore[arg-type]
            _read[0] = keep(file, slot.name, all_checks()[slot.name].notebook, plain)
            slot.kept = True
    except MocapError as error:
        print(f"{slot.name}: adopted until this kernel ends, but not kept. {error}"[:200])
    return True


_read = [""]  # what the file held when it was read last


def _refresh() -> None:
    """Read the file anew if it has changed: what was deleted from it goes, what passes its check comes."""
    file, text = place(), ""
    try:
        text = read_text(file)
    except MocapError as error:
        print(error)
    if text == _read[0]:
        return
    _read[0] = text
    found, said = run_sections(file, text, _slots()) if file else ({}, [])
    for slot in _slots().values():
        if slot.kept and slot.name not in found:
            slot.adopt(None, kept=False)
    for name in found.keys() - all_checks().keys():
        said.append(f"{file}: the course has no exercise '{name}'; it is not used."[:200])
    for slot in (_slots()[name] for name in found if name in all_checks()):
        slot.written = found[slot.name]
        try:
            with redirect_stdout(io.StringIO()):
                verdict = all_checks()[slot.name].verdict(slot.written)
        except SystemExit:
            verdict = Verdict(False, f"{slot.name}: your function ends Python.")
        slot.adopt(slot.written if verdict.right else None, kept=verdict.right)
        if not verdict.right:
            why = "does not pass its check any more, so the package's stands in."
            said.append(f"{file}: {slot.name} {why}\n{verdict}")
    print(*said, sep="\n", end="\n" * bool(said))


@cache
def _slots() -> dict[str, Slot]:
    return {name: Slot(check) for name, check in all_checks().items()}
