"""The course's site, its pages opened as files: they load nothing, they play, and the search finds."""

import pytest

from mocap.course.lab import stored
from mocap.course.site import build_site
from tests.browser.conftest import wait_until


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return build_site(stored(), tmp_path_factory.mktemp("site"))


def test_a_page_plays_folds_and_is_searched(page, site, artefacts):
    page.goto(site.as_uri())
    players = page.locator(".mocap-player")
    assert players.count() >= 3
    players.first.scroll_into_view_if_needed()
    wait_until(lambda: page.evaluate("document.querySelector('.mocap-player').player?.pictures > 3"))
    folded = page.locator("details").first
    assert folded.locator("p, pre").first.is_hidden()
    folded.locator("summary").click()
    wait_until(folded.locator("p, pre").first.is_visible)
    formula = page.locator("math[display=block]").first
    assert formula.bounding_box()["height"] > 15  # the browser itself draws it
    page.locator("#search").fill("one transition")
    hit = page.locator("#found a").first
    assert hit.inner_text().startswith("One transition")
    page.screenshot(path=artefacts / "site-search.png")
    hit.click()
    wait_until(lambda: "#one-transition" in page.url)
    page.locator("#search").fill("no such word")
    wait_until(lambda: page.locator("#found").inner_text() == "Nothing found.")


def test_every_page_fits_a_phone(page, site, artefacts):
    page.set_viewport_size({"width": 390, "height": 800})
    for file in sorted(site.parent.glob("[0-9]*.html")):
        page.goto(file.as_uri())
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, file.name
        assert page.locator("nav a[aria-current=page]").count() == 1
    page.screenshot(path=artefacts / "site-phone.png")
