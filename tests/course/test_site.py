"""The course as pages, and in JupyterLite."""

import json
import re
from html.parser import HTMLParser

import nbformat
import pytest

from mocap.cli.main import main
from mocap.course import lite, notebooks
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


def test_jupyterlite_is_built_with_the_package_inside(tmp_path, capsys):
    pytest.importorskip("jupyterlite_pyodide_kernel", reason="pip install 'mocap[lite]'")
    assert main(["course", "lite", "-o", str(tmp_path / "lite")]) == 0
    assert (tmp_path / "lite" / "lab" / "index.html").exists()
    assert not (stored().parent / ".jupyterlite.doit.db").exists()
    (wheel,) = (tmp_path / "lite" / "pypi").glob("mocap-*.whl")
    assert wheel.stat().st_size > 1e5
    first = nbformat.read(tmp_path / "lite" / "files" / "00-quickstart.ipynb", 4)
    assert first.cells[1].source.startswith("%pip install -q mocap")


def test_without_jupyterlite_or_a_checkout_one_sentence_says_what_to_do(tmp_path, monkeypatch):
    with pytest.raises(MocapError, match="checkout" if lite.found() else "mocap\\[lite\\]"):
        lite.build_lite(tmp_path / "notebooks", tmp_path / "out")
    monkeypatch.setattr(lite, "found", lambda: False)
    with pytest.raises(MocapError, match="mocap\\[lite\\]"):
        lite.build_lite(tmp_path, tmp_path / "out")


def test_running_a_notebook_refreshes_its_code_and_settles_its_outputs(tmp_path):
    new = nbformat.v4
    cells = [
        new.new_code_cell("old", metadata={"tags": ["source:body.rotations.about_y"], "scrolled": True}),
        new.new_code_cell("for i in range(3):\n    print(i, flush=True)"),
        new.new_code_cell(
            "import ipywidgets\nfrom mocap.widgets import explore\nimport matplotlib.pyplot as plt\n"
            "explore(lambda x=1: plt.figure(), alt='Nothing.', x=(0, 2))"
        ),
    ]
    path = tmp_path / "n.ipynb"
    nbformat.write(new.new_notebook(cells=cells, metadata={"widgets": {"big": 1}}), path)
    assert main(["course", "run", str(path)]) == 0
    notebook = notebooks.read(path)
    assert notebook.metadata == {"kernelspec": notebooks.KERNEL, "language_info": {"name": "python"}}
    assert notebook.cells[0].source == notebooks.shown_source("body.rotations.about_y")
    assert notebook.cells[0].metadata == {"tags": ["source:body.rotations.about_y"]}
    (stream,) = notebook.cells[1].outputs
    assert stream.text == "0\n1\n2\n"
    (shown,) = notebook.cells[2].outputs
    assert set(shown.data) == {"image/png", "text/html", "text/plain"}


@pytest.mark.parametrize("text", ["{", '{"cells": 1}', "[]", ""])
def test_what_is_no_notebook_is_told(text, tmp_path):
    (tmp_path / "n.ipynb").write_text(text)
    with pytest.raises(MocapError, match=r"n\.ipynb: is not a notebook"):
        notebooks.read(tmp_path / "n.ipynb")


def test_a_notebook_that_is_not_there_is_told(tmp_path):
    with pytest.raises(MocapError, match=r"n\.ipynb: No such file"):
        notebooks.read(tmp_path / "n.ipynb")
