"""The page of `mocap page` in use, as a short moving picture: a hand draws a line, and a figure walks it.

`python figures/idea.py` writes idea.gif; it needs Chromium. The page's clock stands still between two
pictures, so that the film is the same on a slow machine.
"""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from mocap import body
from mocap.widgets.walking_page import bundled_graph, walk_page

RATE = 25  # pictures per second
PROGRAMS = ("chromium", "chromium-browser", "chromium-headless-shell")
SIZE = {"width": 640, "height": 360}
STROKE = [
    (96, 262),
    (190, 190),
    (330, 236),
    (350, 318),
    (262, 322),
    (300, 220),
    (430, 150),
    (560, 186),
]  # pixels
COME = 0.4  # seconds until the hand draws
DRAW = 1.8  # seconds
WALK = 8.6  # seconds that the figure walks
COLOURS = 96
HAND = """document.body.insertAdjacentHTML("beforeend", `<svg id="hand" width="34" height="38"
viewBox="0 0 30 34"><path d="M9 2c2 0 3 1 3 3v9l9 2c3 1 4 3 4 6l-1 10H11L3 20c-1-2 1-4 3-3l1 1V5c0-2 1-3 2-3z"
fill="#fff" stroke="#2b2f3d" stroke-width="2"/></svg>`);
Object.assign(hand.style, { position: "fixed", pointerEvents: "none" });
for (const part of document.querySelectorAll("header p, #bottom, #caption")) part.style.display = "none";"""
MOVE = "([x, y]) => { hand.style.left = `${x - 10}px`; hand.style.top = `${y - 3}px`; }"


def pictures(page: Page) -> Iterator[Image.Image]:
    """Draw on the page, and give what is seen, picture by picture."""
    line = body.spline(STROKE).points
    come, draw, walk = (round(RATE * seconds) for seconds in (COME, DRAW, WALK))
    stroke = line[np.linspace(0, len(line) - 1, draw).astype(int)]
    course = [*np.linspace((400, 400), stroke[0], come), *stroke, *np.linspace(stroke[-1], (700, 300), 8)]
    for number in range(come + draw + walk):
        x, y = course[min(number, len(course) - 1)]
        page.mouse.move(x, y)
        page.evaluate(MOVE, [x, y])
        if number == come:
            page.mouse.down()
        if number == come + draw:
            page.mouse.up()
        page.clock.run_for(1000 / RATE)
        yield Image.open(io.BytesIO(page.screenshot())).convert("RGB")


def write(path: Path) -> None:
    """Write the moving picture; each frame keeps only what changed."""
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder, "walk.html")
        file.write_text(walk_page(bundled_graph()), "utf-8")
        program = next(filter(None, map(shutil.which, PROGRAMS)), None)
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page(viewport=SIZE)
        page.clock.install(time=0)
        page.goto(file.as_uri())
        page.wait_for_function("document.querySelectorAll('#kinds button').length > 1")
        page.clock.pause_at(600_000)
        page.click("#above")
        page.evaluate(HAND)
        page.clock.run_for(9000)
        seen = list(pictures(page))
        browser.close()
    palette = seen[len(seen) // 2].quantize(COLOURS)
    first, *rest = (picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in seen)
    first.save(path, save_all=True, append_images=rest, duration=1000 // RATE, loop=0, optimize=True)


if __name__ == "__main__":
    write(Path(__file__).with_name("idea.gif"))
