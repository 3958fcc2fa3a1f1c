"""What a film of a notebook shows, for how long, above which words.

Each section gives scenes: its pictures, players and recorded experiments, in order, with the section's first
sentences or those that stand before the picture. A scene lasts as long as its words take to read. Of all
scenes those that count most are taken, until about three minutes are full.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from mocap.course.site import STILL
from mocap.course.teaching.moving_figures import Figures, stored_figures
from mocap.course.teaching.prose import blocks, sentences, shortened, spoken

SPEED = 15.0  # characters that are read per second
WORDS = 200  # characters of a caption at most
LOOK = {"card": 3.0, "still": 5.0, "moving": 9.0, "player": 10.0}  # seconds of a scene at least
SHORTEST, MIDDLE = 150.0, 180.0  # seconds of a film
ENDS = (".", "!", "?", ")", '"', "…")
LEARNT = "What you learnt"
ALT = re.compile(r' alt="([^"]*)"')
SKIPPED = ("Read on", "Your bets", "Where to go from here")
UNSEEN = ("ask:", "exercise:", "check:", "solution:", "slide:skip")


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


@dataclass
class _Section:
    heading: str
    words: str = ""  # the first sentences
    before: str = ""  # the paragraph that came last
    scenes: list[Scene] = field(default_factory=list)

    def show(self, kind: str, words: str, counts: int, **shown: Any) -> None:  # noqa: ANN401
        self.scenes.append(Scene(kind, self.heading, words, counts, **shown))


def _scenes(notebook: Any, recorded: Mapping[str, Any]) -> Iterator[Scene]:  # noqa: ANN401
    """Yield what each section shows; one without a picture is a card of its words."""
    for number, section in enumerate(_sections(notebook, recorded)):
        if section.scenes:
            section.scenes[0].counts = min(section.scenes[0].counts, 2) if number else 0
        elif section.words:
            section.show("card", section.words, 0 if section.heading == LEARNT else 3)
        yield from section.scenes


def _sections(notebook: Any, recorded: Mapping[str, Any]) -> list[_Section]:  # noqa: ANN401
    made, hunted = [_Section("")], False
    for cell in notebook.cells:
        tags = cell.metadata.get("tags", ())
        if any(tag.startswith(UNSEEN) for tag in tags):
            continue
        if cell.cell_type == "markdown":
            hunted = "**Bug hunt" in cell.source  # what is shown after it is wrong on purpose
            for block in blocks(cell.source):
                if block.startswith("#"):
                    made.append(_Section(spoken(block.lstrip("# "))))
                elif block.startswith("![") and "attachment:" in block:
                    data = cell.attachments[block.rpartition("attachment:")[2].rstrip(")")]["image/png"]
                    made[-1].show("still", "", 1, pictures=[base64.b64decode(data)])
                elif not {"answer", "prediction"} & {*tags} or made[-1].heading == LEARNT:
                    _read(block, made[-1])
        elif not hunted:
            _show(cell, made[-1], recorded)
    return [section for section in made if section.heading and section.heading not in SKIPPED]


def _read(block: str, section: _Section) -> None:
    """Take the first sentences of a block that are plain words, as many as can be read below a picture."""
    if section.heading == LEARNT:
        lines = (spoken(line.lstrip("- ")) for line in shortened(block).splitlines())
        section.words = "\n".join(filter(None, [section.words, *lines]))
    elif not block.startswith(("<", "$$", "```", "|", "**")):
        section.before = _caption(block.lstrip("-*0123456789. ")) or section.before
        if not section.words:
            section.words = section.before
            for scene in section.scenes:  # a picture above the first sentence
                scene.words = section.words


def _caption(text: str) -> str:
    words = ""
    for said in map(spoken, sentences(text)):
        if not said.endswith(ENDS) or len(words) + len(said) > WORDS:  # others lead to a formula or a list
            break
        words = f"{words} {said}".strip()
    return words


def _show(cell: Any, section: _Section, recorded: Mapping[str, Any]) -> None:  # noqa: ANN401
    """Make a scene of each thing that a cell shows."""
    known = list(section.scenes)
    for data in (output.get("data", {}) for output in cell.get("outputs", ())):
        page, words = data.get("text/html", ""), section.before if known else section.words
        if any(scene.words == words for scene in known):  # its own sentence is better than one again
            words = _caption(html.unescape("".join(ALT.findall(page)[:1]))) or words
        if figures := stored_figures(page):
            section.show("player", words, 1, figures=figures)
        elif STILL in page and cell.source in recorded:
            one = recorded[cell.source]
            labels = [f"{one['name']}: {label}" for label in one["labels"]]
            pictures = [base64.b64decode(picture) for picture in one["pictures"]]
            section.show("moving", words, 1, pictures=pictures, labels=labels)
        elif "image/png" in data:
            section.show("still", words, 4, pictures=[base64.b64decode(data["image/png"])])
