"""Drawings for the board."""

import numpy as np
import pytest
from PIL import Image

from mocap.cli.main import main
from mocap.course.opening import stored
from mocap.course.teaching import board


@pytest.mark.parametrize("name", ["04-laid-on", "11-pinned"])
def test_a_drawing_has_its_steps_with_numbers(name):
    page = np.asarray(board.board_sheet(name))
    count = len(list(board.BOARD[name][1]()))
    blue = tuple(int(board.DISC[at : at + 2], 16) for at in (1, 3, 5))
    for number in range(count if count > 1 else 0):
        columns = 2 if count == 4 else 3
        x = board.GAP + number % columns * (board.PANEL[0] + board.GAP)
        y = board.HEAD + number // columns * (board.PANEL[1] + board.GAP)
        assert tuple(page[y + 5, x + 24]) == blue
    assert (page[:, -board.GAP // 2 :] == 255).all()  # no heading is cut


def test_the_command_writes_them_and_a_sheet_of_all(tmp_path, monkeypatch, capsys):
    few = {name: board.BOARD[name] for name in ("04-laid-on", "11-pinned")}
    monkeypatch.setattr(board, "BOARD", few)
    assert main(["course", "board", "-o", str(tmp_path)]) == 0
    assert capsys.readouterr().out.startswith("wrote 3 pictures to")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["04-laid-on.png", "11-pinned.png", "board.png"]


def test_the_sheet_beside_the_course_shows_all():
    wide, high = Image.open(stored().parent / "figures" / "board.png").size
    assert wide > 1800
    assert high > 1200


@pytest.mark.sweep
def test_all_are_drawn(tmp_path):
    assert len(board.write_board(tmp_path)) == len(board.BOARD) + 1
    assert {len(board.pictures_of(name)) for name in board.BOARD} <= {1, 3, 4, 6}
