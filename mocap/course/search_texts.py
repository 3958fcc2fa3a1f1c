"""The sentences of the site's pages in one script, from which its search shows excerpts.

A browser reads no other page where the site is a folder of files. The search page loads this script.
"""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

from mocap._shared.atomic import write_file

FILE = "_static/texts.js"
LONGEST = 400  # letters of a paragraph that are kept
OF_REFERENCE = 3  # paragraphs of a page of the reference: the search shows the names of its functions
SHORTEST = 40  # letters of a paragraph that an excerpt can be of
SKIPPED = re.compile(r"(^|\s)(cell|note|sidebar\S*|toc\S*|headerlink)(\s|$)")  # classes of what is no prose
# Elements without an end.
EMPTY = ("area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "wbr")


class Prose(HTMLParser):
    """The paragraphs of a page's article, without code, outputs and notes.

    Examples
    --------
    >>> page = Prose()
    >>> page.feed('<p>Menu</p><article><p>A <b>foot</b> stands.</p><pre>1.0</pre></article>')
    >>> page.paragraphs
    ['A foot stands.']
    """

    def __init__(self) -> None:
        super().__init__()
        self.paragraphs: list[str] = []
        self._open: list[str] = []  # the elements around the position, "" for one that is skipped

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Enter an element."""
        if tag in EMPTY:
            return
        classes = dict(attrs).get("class") or ""
        is_skipped = tag in ("pre", "script", "style", "nav", "math") or SKIPPED.search(classes)
        self._open.append("" if is_skipped else tag)
        if tag in ("p", "dd", "li"):
            self.paragraphs.append("")

    def handle_endtag(self, tag: str) -> None:
        """Leave an element, and drop its paragraph if nothing was in it."""
        if tag not in EMPTY and self._open:
            self._open.pop()
        if self.paragraphs and not self.paragraphs[-1].strip():
            self.paragraphs.pop()

    def handle_data(self, data: str) -> None:
        """Add the text of a paragraph."""
        is_prose = "article" in self._open and "" not in self._open
        if is_prose and not {"p", "dd", "li"}.isdisjoint(self._open) and self.paragraphs:
            self.paragraphs[-1] += data.replace("\n", " ")


def paragraphs_of(page: str) -> list[str]:
    """Return the paragraphs of a page that an excerpt can be of."""
    prose = Prose()
    prose.feed(page)
    texts = [text.strip() for text in prose.paragraphs]
    return [text[:LONGEST] for text in texts if len(text) >= SHORTEST]


def write_search_texts(site: Path) -> None:
    """Write the paragraphs of all pages of a site, by the names that its search has for the pages."""
    texts = {}
    for page in sorted(site.rglob("*.html")):
        name = page.relative_to(site).with_suffix("").as_posix()
        paragraphs = paragraphs_of(page.read_text("utf-8"))
        texts[name] = paragraphs[:OF_REFERENCE] if name.startswith("reference/") else paragraphs
    of_pages = {name: paragraphs for name, paragraphs in texts.items() if paragraphs}
    data = json.dumps(of_pages, ensure_ascii=False, separators=(",", ":"))
    write_file(site / FILE, f"const TEXTS = {data};\n")
