"""Decks: what a slide takes from its notebook; drawings for the board."""

import re

import numpy as np
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from PIL import Image

from mocap.cli.main import main
from mocap.course.notebooks import read
from mocap.course.opening import stored
from mocap.course.teaching import board, films
from mocap.course.teaching import slides as deck_module
from mocap.course.teaching.films import script_of
from mocap.course.teaching.slides import deck_file, deck_of
from tests.refusals import refused

DECKS = sorted((stored() / "slides").glob("*.md"))


def cell(source, *tags):
    shown = [new_output("stream", text="printed"), new_output("display_data", {"image/png": "AAAA"})]
    return new_code_cell(source, outputs=shown, metadata={"tags": list(tags)})


@pytest.fixture
def deck(tmp_path):
    """Return a function that reads a deck of these lines over a notebook of three cells."""
    text = new_markdown_cell(
        "# Title\n\n![A picture.](attachment:a.png)\n\nWords.", metadata={"tags": ["title"]}
    )
    notebook = new_notebook(cells=[text, cell("one = 1", "source:one"), cell("two = 1 + one")])

    def made(lines):
        (tmp_path / "00-walks.md").write_text(lines, "utf-8")
        return deck_of(tmp_path / "00-walks.md", notebook)

    return made


def test_slides_are_parted_by_dashes_and_have_headings_labels_and_notes(deck):
    first, second = deck("# Walks\n\nA body.\n\n---\n\n## Predict: How far?\n\nTwo\n\nNote: Say it.\n")
    assert (first.label, first.heading, [part.source for part in first.cells]) == ("", "Walks", ["A body."])
    assert (second.label, second.heading, second.notes) == ("Predict", "How far?", "Say it.")


def test_a_cell_is_taken_by_its_tag_or_by_words_and_shows_its_picture_or_its_code(deck):
    (slide,) = deck("# Walks\n{code source:one}\n{show 1 + one}\n{show title}\n{draw 11-pinned 2}")
    code, shown, picture, drawn = slide.cells
    assert (code.source, code.outputs) == ("one = 1", [])
    assert (shown.source, [output.output_type for output in shown.outputs]) == ("", ["display_data"])
    assert picture.source == "![A picture.](attachment:a.png)"
    assert drawn.outputs[0].data["image/png"].startswith("iVBOR")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("{show three}", "'three' is in 0 cells"),
        ("{show one}", "'one' is in 2 cells"),
        ("{shows one}", "'{shows one}' is not {show"),
    ],
)
def test_what_is_in_no_cell_or_in_two_is_refused(deck, line, said):
    refused(said, deck, f"# Walks\n\n{line}\n")


def test_a_notebook_without_a_deck_is_refused(tmp_path):
    refused("There is no deck", deck_of, tmp_path / "none.md", new_notebook())


@pytest.mark.parametrize("file", DECKS, ids=lambda file: file.stem)
def test_every_deck_takes_what_there_is_and_points_nowhere(file, monkeypatch):
    monkeypatch.setattr(deck_module, "pictures_of", lambda name: [name.encode()] * 6 * (name in board.BOARD))
    slides = deck_of(file, read(stored() / f"{file.stem}.ipynb"))
    assert deck_file(stored() / f"{file.stem}.ipynb") == file
    assert len(slides) >= 8
    for slide in slides:
        words = " ".join(cell.source for cell in slide.cells if cell.cell_type == "markdown")
        assert slide.heading and slide.cells
        assert not {"below", "above"} & set(re.findall(r"\w+", words.lower())), slide.heading
    for scene in script_of(slides, {}):
        assert films.font_of(36, bold=True).getlength(scene.heading) <= films.ROOM[0], scene.heading
        caption = films.wrapped(scene.words, films.font_of(26), films.ROOM[0])
        assert scene.kind == "card" or (scene.words and len(caption) <= 3), (
            f"no caption, or too long: {scene.heading}"
        )


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
def test_all_are_drawn():
    assert {len(board.pictures_of(name)) for name in board.BOARD} <= {1, 3, 4, 6}
