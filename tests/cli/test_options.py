"""A bar of progress is for people: it is on a terminal only, and leaves nothing behind."""

import io
import sys

import pytest

from mocap.cli.options import Building, bar
from mocap.errors import MocapError


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize(("screen", "drawn"), [(Terminal(), True), (io.StringIO(), False)])
def test_a_bar_is_drawn_on_a_terminal_only(monkeypatch, screen, drawn):
    monkeypatch.setattr(sys, "stderr", screen)
    assert list(bar("spelling")("abcd", delay=0.0, mininterval=0.0)) == list("abcd")
    assert ("spelling" in screen.getvalue()) == drawn


def test_a_quick_work_shows_no_bar(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert list(bar("spelling")("abcd")) == list("abcd")
    assert "spelling" not in sys.stderr.getvalue()


@pytest.mark.parametrize("seconds", [0.0, 0.04, -1.0])
def test_a_window_lasts_two_frames_at_least(seconds):
    with pytest.raises(MocapError, match="two frames or more"):
        Building(window=seconds).frames()
