"""The notebooks of the course, opened, run and played with as a reader would."""

from pathlib import Path

import pytest

from tests.browser.conftest import wait_until

FOLDER = Path(__file__).parents[2] / "notebooks"
# Of every kind one: players, an image to point at, a canvas to draw on, the discussion's sliders. All the
# others are driven without a browser, in tests/test_course.py.
NOTEBOOKS = [
    FOLDER / f"{name}.ipynb"
    for name in ("00-quickstart", "02-matching", "08-path-synthesis", "09-discussion")
]
FAILED = ".jp-OutputArea-output[data-mime-type='application/vnd.jupyter.error']"


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs_and_all_its_sliders_move(notebook, run, artefacts):
    page = run(notebook.read_text("utf-8"), notebook.name)
    assert page.locator(FAILED).count() == 0
    for number in range(page.locator(".noUi-handle").count()):
        handle = page.locator(".noUi-handle").nth(number)
        handle.scroll_into_view_if_needed()
        handle.focus()
        box = handle.locator("xpath=ancestor::*[contains(@class, 'widget-vbox')]").first
        for key, end in (("End", "aria-valuemax"), ("Home", "aria-valuemin")):
            page.keyboard.press(key)
            wait_until(lambda h=handle, e=end: h.get_attribute("aria-valuenow") == h.get_attribute(e))
            page.wait_for_timeout(300)
            assert "Error:" not in box.inner_text()
    page.screenshot(path=artefacts / f"{notebook.stem}.png")
