"""`mocap view`, as a person types it."""

from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

from mocap.cli.main import main


def test_view_opens_a_page_of_the_clip(clips, capsys, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or True)
    assert main(["view", str(clips / "a.bvh")]) == 0
    (address,) = opened
    page = Path(url2pathname(urlsplit(address).path))
    assert "A stick figure plays a" in page.read_text("utf-8")
    assert str(page) in capsys.readouterr().out


def test_view_says_where_the_page_is_when_no_browser_opens(clips, capsys, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda address: False)
    assert main(["view", str(clips / "a.bvh")]) == 0
    assert "open that page yourself" in capsys.readouterr().err


def test_view_keeps_a_file_and_opens_nothing(clips, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda address: pytest.fail("opened"))
    assert main(["view", str(clips / "a.bvh"), "-o", str(clips / "a.png")]) == 0
    assert (clips / "a.png").read_bytes().startswith(b"\x89PNG")


def test_view_of_no_clip_is_one_sentence(clips, capsys):
    assert main(["view", str(clips / "missing.bvh")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
