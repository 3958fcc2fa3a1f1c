"""What a film of a notebook shows, for how long, above which words: a scene for each slide of its deck.

A scene shows the picture, the player or the recorded experiment of a slide above the slide's words; a slide
without one is a card of its words. It lasts as long as its words take to read.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from mocap.course.site import STILL
from mocap.course.teaching.deck import Slide
from mocap.course.teaching.prose import spoken
from mocap.widgets.filmed_scene import FilmedScene, stored_scene

SPEED = 15.0  # characters that are read per second
LOOK = {"card": 3.0, "still": 5.0, "moving": 9.0, "player": 10.0}  # seconds of a scene at least


@dataclass
class Scene:
    """A scene of a film: its kind, its heading, its words, what it shows, and how long.

    `pictures` are PNGs: one of a still scene, many of a moving one, with `labels`.
    """

    kind: str
    heading: str
    words: str
    pictures: list[bytes] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    figures: FilmedScene | None = None

    @property
    def seconds(self) -> float:
        """How long it is shown: as long as its words take to read, or more."""
        return max(LOOK[self.kind], len(self.words) / SPEED + 0.5)


def script_of(slides: Iterable[Slide], recorded: Mapping[str, Any]) -> list[Scene]:
    """Give the scenes of a film.

    Parameters
    ----------
    slides : from `deck_of`; exercises are for the class.
    recorded : recordings of experiments by the source of their cell; without one, a still picture is shown.
    """
    return [scene for slide in slides if slide.label != "Exercise" for scene in _scenes(slide, recorded)]


def _scenes(slide: Slide, recorded: Mapping[str, Any]) -> Iterator[Scene]:
    """Yield a scene for each thing that a slide shows, or one of its words alone."""
    written = [cell.source for cell in slide.cells if cell.cell_type == "markdown"]
    texts = [text for text in written if not text.startswith("![")]
    lines = [line for text in texts for line in text.splitlines() if re.search("[^-|: ]", line)]
    rows = (re.sub(r"^\s*(?:[-*]|\d+\.) ", "", line).strip("|").split(" | ") for line in lines)  # of tables
    words, shown = list(filter(None, ("\t".join(map(spoken, row)) for row in rows))), False
    heading = spoken(f"{slide.label}: {slide.heading}" if slide.label else slide.heading)
    for cell in slide.cells:
        for kind, *parts in _shown(cell, recorded):
            shown = True
            yield Scene(kind, heading, " ".join(words), *parts)
    if not shown and words:
        yield Scene("card", heading, "\n".join(words))


def _shown(cell: Any, recorded: Mapping[str, Any]) -> Iterator[tuple[Any, ...]]:  # noqa: ANN401
    """Yield what a cell shows: the kind of a scene, its pictures, their labels, and figures."""
    if found := re.match(r"!\[.*\]\(attachment:(.*)\)", cell.source, re.DOTALL):
        yield "still", [base64.b64decode(cell.attachments[found[1]]["image/png"])]
    for output in cell.get("outputs", ()):
        data, code = output.get("data", {}), cell.metadata.get("code")
        page = data.get("text/html", "")
        if figures := stored_scene(page):
            yield "player", [], [], figures
        elif STILL in page and code in recorded:
            one = recorded[code]
            pictures = [base64.b64decode(picture) for picture in one["pictures"]]
            yield "moving", pictures, [f"{one['name']}: {at}" for at in one["labels"]]
        elif "image/png" in data:
            yield "still", [base64.b64decode(data["image/png"])]
