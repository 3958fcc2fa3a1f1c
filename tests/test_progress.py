"""The bar hands on what it is given, and draws only on a terminal and only after a while."""

import io

import pytest

from mocap.progress import bar


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_it_hands_on_everything_and_wipes_its_line():
    terminal = Terminal()
    assert list(bar("abcd", "spelling", stream=terminal, delay=0)) == list("abcd")
    drawn = terminal.getvalue()
    assert "\rspelling [###############               ] 2/4" in drawn
    assert drawn.endswith("\r\x1b[K")


def test_quick_work_and_files_stay_clean():
    for stream, delay in ((Terminal(), 60), (io.StringIO(), 0)):
        assert list(bar([1, 2], stream=stream, delay=delay)) == [1, 2]
        assert stream.getvalue() == ""


def test_an_interruption_wipes_the_line_too():
    terminal = Terminal()
    with pytest.raises(KeyboardInterrupt):
        for _ in bar([1, 2, 3], stream=terminal, delay=0):
            raise KeyboardInterrupt
    assert terminal.getvalue().endswith("\x1b[K") or terminal.getvalue() == ""
