"""What shaded bodies cost in a player of 1200 × 800 pixels without a graphics card, beside strokes."""

import os
from pathlib import Path

import pytest

from mocap.datasets import sample
from mocap.widgets.player import play
from tests.browser.conftest import browser
from tests.browser.test_page import PLAYER, twelve

pytestmark = pytest.mark.benchmark
__all__ = ["browser"]
STYLE = ".mocap-page .mocap-player canvas { height: 800px !important } body { max-width: 1216px !important }"


def cpu_seconds():
    """Add up the CPU time of all processes that this one has started."""
    children, found, todo = {}, 0.0, [os.getpid()]
    for stat in Path("/proc").glob("[0-9]*/stat"):
        fields = stat.read_text().rsplit(")", 1)[1].split()
        children.setdefault(int(fields[1]), []).append(
            (int(stat.parent.name), int(fields[11]) + int(fields[12]))
        )
    while todo:
        for process, ticks in children.get(todo.pop(), []):
            todo.append(process)
            found += ticks / os.sysconf("SC_CLK_TCK")
    return found


def milliseconds(browser, file):
    """Measure the CPU time for a picture, over six seconds of playing."""
    page = browser.new_page(viewport={"width": 1232, "height": 1000})
    page.goto(file)
    page.wait_for_timeout(2500)
    before, busy = page.evaluate(f"{PLAYER}.pictures"), cpu_seconds()
    page.wait_for_timeout(6000)
    pictures, busy = page.evaluate(f"{PLAYER}.pictures") - before, cpu_seconds() - busy
    page.close()
    return 1000 * busy / pictures


@pytest.mark.parametrize(("bodies", "times"), [(1, 4), (12, 9)])
def test_shaded_bodies_cost_no_more_than_some_times_those_of_strokes(browser, tmp_path, bodies, times):
    file = tmp_path / "player.html"
    page = (play(sample("walk_straight")) if bodies == 1 else twelve()).page()
    file.write_text(page.replace("</style>", f"{STYLE}</style>", 1), "utf-8")
    shaded, strokes = (milliseconds(browser, file.as_uri() + flat) for flat in ("", "?flat"))
    print(f"\n{bodies}: {shaded:.0f} ms of CPU shaded, {strokes:.0f} ms in strokes")
    assert shaded < times * strokes
