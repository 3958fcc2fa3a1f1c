"""The course as pages."""

import json
import re
from html.parser import HTMLParser

import pytest

from mocap.cli.main import main
from mocap.course.lab import stored
from mocap.course.site import build_site
from mocap.errors import MocapError


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    out = tmp_path_factory.mktemp("site") / "course"
    assert main(["course", "site", "-o", str(out)]) == 0
    return out


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.ids, self.pictures, self.loads = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids.append(attributes.get("id"))
        if tag == "a":
            self.links.append(attributes.get("href"))
        elif tag == "img":
            self.pictures.append(attributes)
        if tag in ("script", "link", "img", "iframe"):
            self.loads.append(attributes.get("src") or attributes.get("href") or "")


def pages(site):
    return {path.name: Page(path.read_text("utf-8")) for path in site.glob("*.html")}


def test_every_notebook_is_a_page_and_all_links_lead_somewhere(site):
    found = pages(site)
    assert {f"{path.stem}.html" for path in stored().glob("*.ipynb")} <= set(found)
    for name, page in found.items():
        for link in page.links:
            if re.match("https?:", link):
                continue
            file, _, anchor = link.partition("#")
            assert (file or name) in found, f"{name}: {link}"
            assert not anchor or anchor in found[file or name].ids or not file, f"{name}: {link}"


def test_nothing_is_loaded_from_elsewhere_and_every_picture_is_told(site):
    for name, page in pages(site).items():
        assert all(not re.match("(https?:)?//", load) for load in page.loads), name
        assert all(len(picture.get("alt", "")) >= 20 for picture in page.pictures), name


def test_formulas_are_drawn_by_the_browser_itself(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert '<math xmlns="http://www.w3.org/1998/Math/MathML" display="block">' in text
    for page in site.glob("*.html"):
        shown = re.sub(r"(?s)<(script|pre|code|style).*?</\1>", "", page.read_text("utf-8"))
        assert not re.search(r"\$\$|FORMULA\d|\\[a-zA-Z]+", shown), page


def test_the_search_finds_text_under_its_heading(site):
    text = (site / "search.js").read_text("utf-8")
    sections = json.loads(text.removeprefix("const sections = ").rstrip(";\n"))
    (found,) = [s for s in sections if s["heading"] == "One transition" and "00" in s["page"]]
    assert "lays the second clip on the first" in found["text"]
    found = pages(site)
    for section in sections:
        page, anchor = section["at"].split("#")
        assert anchor in found[page].ids, section["at"]


def test_a_folder_without_notebooks_is_told(tmp_path):
    with pytest.raises(MocapError, match="holds no notebooks"):
        build_site(tmp_path, tmp_path / "out")
