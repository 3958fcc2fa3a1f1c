"""Pictures and scripts of the site as files that its pages share, and pages without what changes nothing."""

from __future__ import annotations

import base64
import hashlib
import html
import io
import re
from pathlib import Path
from typing import Any

from PIL import Image

from mocap.plotting.picture import shown_width

WEBP_QUALITY = 72  # of 100: shaded bodies show no blocks
SCRIPT = re.compile(r'(?s)<script type="module">(.*?)</script>')
PICTURE = re.compile(r'(?: width="\d+")? src="data:image/(?:png|webp);base64,([^"]+)"')
RECORDED = re.compile(r'"data:image/(?:png|webp);base64,([^"]+)"')  # a picture of a recording
ATTACHED = re.compile(r"!\[([^]]*)\]\(attachment:([^)]+)\)")
# Players, inspectors and quizzes have widths of their own. Of captured clips only their pictures are stored.
DRAWN = re.compile(r'class="mocap-(?!still)')
PLAYED = re.compile(r"\b(play|inspector)\(")
PLAIN = re.compile(r'<span class="[npw]">([^<]*)</span>')  # code in the colour of the text around it


def share_attachments(notebook: Any, out: Path) -> None:  # noqa: ANN401
    """Move the attached pictures of a notebook to files, and show each as large as its letters need."""
    for cell in notebook.cells:
        attached = cell.pop("attachments", {})

        def shown(match: re.Match[str], attached: Any = attached) -> str:  # noqa: ANN401
            alt, name = match.groups()
            png = base64.b64decode(attached[name]["image/png"])
            source = _write(*smallest(png), out)
            return f'<p><img alt="{html.escape(alt)}" width="{shown_width(png)}" src="{source}"></p>'

        if attached:
            cell.source = ATTACHED.sub(shown, cell.source)


def share_outputs(notebook: Any, out: Path) -> None:  # noqa: ANN401
    """Move scripts and pictures of outputs to files that all pages share, each once."""

    def script(match: re.Match[str]) -> str:
        # No module: a browser does not load one where the page is a file.
        text = f"(() => {{{match[1].replace('export default', 'void')}}})();"
        return f'<script defer src="{_write(text.encode(), "js", out)}"></script>'

    def picture(match: re.Match[str]) -> str:
        data = base64.b64decode(match[1])
        return f' width="{shown_width(data)}" loading="lazy" src="{_write(*smallest(data), out)}"'

    def scene(match: re.Match[str]) -> str:
        return f' loading="lazy" src="{_write(*smallest(base64.b64decode(match[1])), out)}"'

    def recorded(match: re.Match[str]) -> str:
        return f'"{_write(*smallest(base64.b64decode(match[1])), out)}"'

    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "text/html" in data:
                page = SCRIPT.sub(script, data["text/html"])
                is_scene = DRAWN.search(page) or PLAYED.search(cell.source)
                page = PICTURE.sub(scene if is_scene else picture, page)
                data["text/html"] = RECORDED.sub(recorded, page)


def _write(content: bytes, suffix: str, out: Path) -> str:
    """Write a shared file under a name made of its content, and return its address on a page."""
    name = f"_shared/{hashlib.sha256(content).hexdigest()[:12]}.{suffix}"
    (out / name).write_bytes(content)
    return name


def smallest(data: bytes) -> tuple[bytes, str]:
    """Return the smallest of a picture's encodings, and its suffix: as it is, WebP without loss, or WebP.

    Examples
    --------
    >>> stream = io.BytesIO()
    >>> Image.new("RGB", (60, 40), "white").save(stream, "png")
    >>> smallest(stream.getvalue())[1]
    'webp'
    """
    picture = Image.open(io.BytesIO(data))
    encodings = [(data, str(picture.format).lower())]
    for options in ({"lossless": True}, {"quality": WEBP_QUALITY}):
        stream = io.BytesIO()
        picture.convert("RGB").save(stream, "webp", method=4, **options)
        encodings.append((stream.getvalue(), "webp"))
    return min(encodings, key=lambda encoding: len(encoding[0]))


def trim(site: Path) -> None:
    """Remove from a site what changes nothing on its pages.

    These are the maps that lead from the theme's scripts to their sources, and the marks of code that has the
    colour of the text around it, which are a tenth of all pages.
    """
    for file in site.glob("_static/**/*.map"):
        file.unlink()
    for page in site.rglob("*.html"):
        page.write_text(PLAIN.sub(r"\1", page.read_text("utf-8")), "utf-8")
