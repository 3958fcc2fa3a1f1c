"""The decks as pages."""

import io
import re
import shutil
from contextlib import redirect_stdout

import pytest

from mocap.cli.main import main
from mocap.course.opening import stored
from mocap.course.site import MOVING
from mocap.course.teaching import slides
from tests.refusals import refused

NAME = "06-pruning"


@pytest.fixture(scope="module")
def decks(tmp_path_factory):
    pytest.importorskip("sphinx_revealjs", reason="pip install '.[slides]'")
    folder, out = tmp_path_factory.mktemp("notebooks"), tmp_path_factory.mktemp("slides")
    shutil.copy(stored() / f"{NAME}.ipynb", folder)
    shutil.copytree(stored() / "slides", folder / "slides")
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as said:
        patch.setattr("mocap.cli.course.stored", lambda: folder)
        assert main(["course", "slides", "-o", str(out)]) == 0
    assert said.getvalue() == f"wrote {out / 'index.html'}\n"
    return out


@pytest.fixture(scope="module")
def page(decks):
    return (decks / f"{NAME}.html").read_text("utf-8")


def test_each_written_deck_is_a_page_that_is_listed(decks, page):
    listed = re.findall(r'href="([^"]*)"', (decks / "index.html").read_text("utf-8"))
    assert listed == [f"{NAME}.html"]
    assert page.count("<section") == page.count("</section>") > 10
    assert page.count("<div") == page.count("</div>")
    assert "$" not in re.sub(r"(?s)<(script|style|pre|code)\b.*?</\1>", "", page)


def test_a_deck_loads_only_what_lies_beside_it_and_links_lead_to_decks_or_are_words(decks, page):
    for found in re.findall(r'<(?:script|link|img)[^>]* (?:src|href)="([^"]*)"', page):
        assert found.startswith("data:") or (decks / found).is_file()
    for link in re.findall(r'<a [^>]*href="([^"]*)"', page):
        assert link.startswith("https://") or (decks / link).is_file()
    assert "MIT" in (decks / "reveal/dist/reveal.js").read_text("utf-8")[:300]
    assert "Permission is hereby granted" in (decks / "reveal/LICENSE").read_text("utf-8")


def test_recordings_move_by_the_sites_script_and_only_the_speaker_reads_the_notes(page):
    assert page.count(MOVING.read_text("utf-8")) == 1
    shown = re.sub(r'<aside class="notes">.*?</aside>', "", page, flags=re.DOTALL)
    assert "Ask: which part" in page and "Ask: which part" not in shown


def test_a_package_without_the_files_is_not_taken(monkeypatch, tmp_path):
    class Found:
        origin = str(tmp_path / "__init__.py")

    monkeypatch.setattr(slides, "find_spec", lambda name: Found)
    refused("sphinx-revealjs", slides.build_slides, stored(), tmp_path / "out")
