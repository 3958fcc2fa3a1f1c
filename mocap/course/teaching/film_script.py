"""What a film of a notebook shows, for how long, above which words.

The slides of each section give scenes: pictures, players and recorded experiments, in order, with the first
sentences or those that stand before the picture. A scene lasts as long as its words take to read. Of all
scenes those that count most are taken, until about three minutes are full.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any

from mocap.course.site import STILL
from mocap.course.teaching.deck import deck_of
from mocap.course.teaching.moving_figures import Figures, stored_figures
from mocap.course.teaching.prose import sentences, spoken

SPEED = 15.0  # characters that are read per second
WORDS = 200  # characters of a caption at most
LOOK = {"card": 3.0, "still": 5.0, "moving": 9.0, "player": 10.0}  # seconds of a scene at least
SHORTEST, MIDDLE = 150.0, 180.0  # seconds of a film
ENDS = (".", "!", "?", ")", '"', "…")
LEARNT = "What you learnt"
ALT = re.compile(r' alt="([^"]*)"')
SKIPPED = ("Read on", "Your bets", "Where to go from here")
NO_PROSE = ("<", "$$", "```", "|", "**", "![", "#")


@dataclass
class Scene:
    """A scene of a film: its kind, its heading, its words, what it shows, and how long.

    `pictures` are PNGs: one of a still scene, many of a moving one, with `labels`.
    """

    kind: str
    heading: str
    words: str
    counts: int  # scenes that count less are left out first
    pictures: list[bytes] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    figures: Figures | None = None
    longer: float = 1.0

    @property
    def seconds(self) -> float:
        """How long it is shown: as long as its words take to read, or more."""
        return self.longer * max(LOOK[self.kind], len(self.words) / SPEED + 0.5)


def script_of(notebook: Any, recorded: Mapping[str, Any]) -> list[Scene]:  # noqa: ANN401
    r"""Choose the scenes of a film of about three minutes.

    Parameters
    ----------
    notebook : with its outputs.
    recorded : recordings of experiments by the source of their cell; without one, a still picture is shown.

    Returns
    -------
    The scenes, from the title to what one learnt; together 2:30 to 3:30 minutes.

    Examples
    --------
    >>> from nbformat.v4 import new_markdown_cell, new_notebook
    >>> cells = [new_markdown_cell("# Walks\n\nA body walks."), new_markdown_cell("## Why?\n\nFor fun.")]
    >>> [(scene.heading, scene.words) for scene in script_of(new_notebook(cells=cells), {})]
    [('Walks', 'A body walks.'), ('Why?', 'For fun.')]
    """
    scenes = list(_scenes(notebook, recorded))
    taken: set[int] = set()
    total = 0.0
    for number, scene in sorted(enumerate(scenes), key=lambda pair: pair[1].counts):
        if total + scene.seconds <= MIDDLE or scene.counts == 0:
            taken.add(number)
            total += scene.seconds
    chosen = [scenes[number] for number in sorted(taken)]
    shown = [scene for scene in chosen if scene.kind != "card"] or chosen  # to look at, as words are not
    looked = sum(scene.seconds for scene in shown)
    whole = max(SHORTEST, min(MIDDLE, total + looked))  # at most twice as long, if that is long enough
    for scene in shown:
        scene.longer = max(1.0, (whole - total + looked) / looked)
    return chosen


def _scenes(notebook: Any, recorded: Mapping[str, Any]) -> Iterator[Scene]:  # noqa: ANN401
    """Yield what the slides of each section show; one without a picture is a card of its words."""
    told = [one for one in deck_of(notebook) if one.kind != "exercise" and one.heading not in SKIPPED]
    for number, (title, slides) in enumerate(groupby(told, lambda slide: slide.heading)):
        scenes, first, before, hunted = list[Scene](), "", "", False
        for kind, cell in ((slide.kind, cell) for slide in slides for cell in slide.cells):
            if cell.cell_type == "markdown":
                hunted = "**Bug hunt" in cell.source  # what is shown after it is wrong on purpose
                scenes += [Scene("still", "", first, 1, [data]) for data in _attached(cell)]
                if title == LEARNT:
                    lines = (spoken(line.lstrip("- ")) for line in cell.source.splitlines())
                    first = "\n".join(filter(None, [first, *lines]))
                elif kind not in ("prediction", "answer") and not cell.source.startswith(NO_PROSE):
                    before = _caption(cell.source.lstrip("-*0123456789. ")) or before
                    first = first or before
            elif not hunted:
                taken = {scene.words for scene in scenes}
                scenes += _shown(cell, before if scenes else first, taken, recorded)
        if scenes:
            scenes[0].counts = min(scenes[0].counts, 2) if number else 0
        elif first:
            scenes = [Scene("card", "", first, 0 if title == LEARNT else 3)]
        for scene in scenes:  # a picture may stand above the first sentence
            yield replace(scene, heading=spoken(title), words=scene.words or first)


def _attached(cell: Any) -> list[bytes]:  # noqa: ANN401
    found = re.match(r"!\[.*\]\(attachment:(.*)\)$", cell.source, re.DOTALL)
    return [base64.b64decode(cell.attachments[found[1]]["image/png"])] if found else []


def _caption(text: str) -> str:
    words = ""
    for said in map(spoken, sentences(text)):
        if not said.endswith(ENDS) or len(words) + len(said) > WORDS:  # others lead to a formula or a list
            break
        words = f"{words} {said}".strip()
    return words


def _shown(cell: Any, words: str, taken: Container[str], recorded: Mapping[str, Any]) -> list[Scene]:  # noqa: ANN401
    """Make a scene of what a cell shows."""
    (output,) = cell.outputs or [{}]
    data, code = output.get("data", {}), cell.metadata.get("code")
    page = data.get("text/html", "")
    if words in taken:  # the picture's own sentence is better than one again
        words = _caption(html.unescape("".join(ALT.findall(page)[:1]))) or words
    if figures := stored_figures(page):
        return [Scene("player", "", words, 1, figures=figures)]
    if STILL in page and code in recorded:
        one = recorded[code]
        pictures = [base64.b64decode(picture) for picture in one["pictures"]]
        return [Scene("moving", "", words, 1, pictures, [f"{one['name']}: {at}" for at in one["labels"]])]
    still = [base64.b64decode(data["image/png"])] if "image/png" in data else []
    return [Scene("still", "", words, 4, still)] if still else []
