"""The notebooks of the course in JupyterLab, opened, run and used as a reader would.

All of them, in about five minutes: pytest -m "exhaustive or not exhaustive" -n 0 tests/browser/test_course.py
"""

from pathlib import Path

import pytest

from tests.browser.conftest import wait_until

FOLDER = Path(__file__).parents[2] / "notebooks"
# The first has players, sliders, choices and a canvas to draw on.
# The experiments of all notebooks are driven without a browser, by tests/course/driving.py.
NOTEBOOKS = [
    pytest.param(path, id=path.stem, marks=[pytest.mark.exhaustive] * (path.stem != "00-quickstart"))
    for path in sorted(FOLDER.glob("*.ipynb"))
]
FAILED = ".jp-OutputArea-output[data-mime-type='application/vnd.jupyter.error']"


@pytest.mark.parametrize("notebook", NOTEBOOKS)
def test_it_runs_and_all_its_sliders_move(notebook, run, page, request):
    if notebook.stem == "10-real-data":
        request.getfixturevalue("real_data")
    run(notebook.read_text("utf-8"), notebook.name)
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
