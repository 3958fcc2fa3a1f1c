"""Players as part of a page or a notebook: live, as a picture, or as an alternative text."""

import base64
import html
import json
import re
from pathlib import Path
from string import Template
from typing import Any, ClassVar, Protocol

from mocap.plotting.picture import Picture

FOLDER = Path(__file__).parent

# Scripts of the player that other pages share.
CANVAS = FOLDER / "canvas.js"
SCENE = FOLDER / "player_scene.js"
PICTURE = FOLDER / "player_picture.js"
PAGE = FOLDER / "player_page.js"
HAND = FOLDER / "player_hand.js"
SHARED = [CANVAS, SCENE, PICTURE, PAGE, HAND]
SHADED = [FOLDER / "bodies.js", FOLDER / "player_body.js"]
TOUCH = FOLDER / "touch.js"
WHOLE = FOLDER / "page.html"

# Lines of a script that are removed from the joined module. No line of a template may start like one of them,
# which eslint checks.
COMMENT = re.compile(r"^ *(//.*|/\*\*([^*]|\*(?!/))*\*/)\n", re.MULTILINE)
IMPORT = re.compile(r"^import [^;]*;\n", re.MULTILINE)
EXPORT = re.compile(r"^export (?!default)", re.MULTILINE)


def joined(*files: Path) -> str:
    """Join scripts, without their comments, into the single module that a page or a widget runs."""
    script = "\n".join(file.read_text("utf-8") for file in files)
    for removed in (COMMENT, IMPORT, EXPORT):
        script = removed.sub("", script)
    return script


def script_json(data: object) -> str:
    r"""Write data as JSON that can stand in a script element, whatever the names in it.

    No text can end the element or open a comment in it, because "<" is written as an escape.

    Examples
    --------
    >>> print(script_json({"name": "<!--<script>"}))
    {"name":"\u003c!--\u003cscript>"}
    """
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


class Embedded(Protocol):
    """A part of a page, whose CSS class is `mocap-` and the name of the Python class in lower case."""

    scripts: ClassVar[tuple[Path, ...]]  # the scripts that draw the scene

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.alt!r})"

    @property
    def alt(self) -> str:
        """The alternative text, a sentence for readers who do not see it."""

    @property
    def scene(self) -> dict[str, Any]:
        """The scene that scripts draw, with bytes as `data`."""

    @property
    def picture(self) -> bytes:
        """The picture without scripts, a PNG."""

    @property
    def heading(self) -> str:
        """The heading of a stand-alone page."""
        return ""

    def still(self) -> Picture:
        """Return only the picture, for captured clips, whose data must not be stored in a notebook."""
        return Picture(self.picture, self.alt, fitted=False)  # as wide as the scene that replaces it

    def html(self) -> str:
        """Return the HTML of a part of a page, which shows the picture if no script runs."""
        kind = type(self).__name__
        data = base64.b64encode(self.scene["data"]).decode()
        scene = script_json({**self.scene, "data": data})
        still, _ = self.still()._repr_mimebundle_()
        return (
            f'<div class="mocap-{kind.lower()}">{still["text/html"]}'
            f'<script type="application/json">{scene}</script></div>\n'
            f'<script type="module">\n{joined(*self.scripts)}\nstart({kind});\n</script>\n'
        )

    def page(self) -> str:
        """Return the HTML of a stand-alone page, which needs no other file."""
        heading = f"<h1>{html.escape(self.heading)}</h1>\n" if self.heading else ""
        parts = {"title": html.escape(self.alt), "heading": heading, "body": self.html()}
        return Template(WHOLE.read_text("utf-8")).substitute(parts)

    def _repr_mimebundle_(self, **_: object) -> tuple[dict[str, str], dict[str, Any]]:
        bundle, metadata = self.still()._repr_mimebundle_()
        return bundle | {"text/html": self.html()}, metadata
