"""Decks: what a slide takes from its notebook; drawings for the board; films, what they say and show."""

import base64
import io
import re
import shutil

import numpy as np
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output, writes
from PIL import Image

from mocap.cli.main import main
from mocap.course.notebooks import read
from mocap.course.opening import stored
from mocap.course.teaching import board, films
from mocap.course.teaching import slides as deck_module
from mocap.course.teaching.films import SPEED, Scene, script_of, spoken
from mocap.course.teaching.slides import Slide, deck_file, deck_of
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


def test_the_command_writes_them_and_a_sheet_of_all(tmp_path, monkeypatch, run):
    few = {name: board.BOARD[name] for name in ("04-laid-on", "11-pinned")}
    monkeypatch.setattr(board, "BOARD", few)
    assert run(f"course board -o {tmp_path}").out.startswith("wrote 3 pictures to")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["04-laid-on.png", "11-pinned.png", "board.png"]


def test_the_sheet_beside_the_course_shows_all():
    wide, high = Image.open(stored().parent / "figures" / "board.png").size
    assert wide > 1800
    assert high > 1200


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("A [*node*](G.md#n) of `graph`, [1, section 2].", "A node of graph,."),
        (r"From $\alpha$ to $x \le 2$.", "From α to x ≤ 2."),
        (r"So $\sum_k x_k$.", ""),
        ("From $x_0$ to $k^2$.", "From x₀ to k²."),
        ("<img>", ""),
        ("It is 3<!--= n --> cm.", "It is 3 cm."),
    ],
)
def test_captions_are_plain_words(text, words):
    assert spoken(text) == words


PNG = base64.b64encode(b"picture").decode()


def shows(page="<img>"):
    output = new_output("display_data", {"image/png": PNG, "text/html": page})
    return new_code_cell("", outputs=[output], metadata={"code": "x"})


def script(*cells, label="", recorded=None):
    return script_of([Slide(label, "One", list(cells), "")], recorded or {})


def test_the_words_of_a_slide_stand_below_each_of_its_pictures_as_long_as_they_take_to_read():
    attached = {"attachments": {"a.png": {"image/png": PNG}}}
    (alone,) = script(new_markdown_cell("![An alt text.](attachment:a.png)", **attached))
    assert (alone.kind, alone.words) == ("still", "")
    scenes = script(new_markdown_cell("1. It *falls*.\n2. See `why`.\n\n$$x_i$$"), shows(), shows())
    assert [(scene.kind, scene.words) for scene in scenes] == [("still", "It falls. See why.")] * 2
    (long,) = script(new_markdown_cell("word " * 100), shows())
    assert long.seconds > len(long.words) / SPEED


def test_a_slide_of_words_is_a_card_with_a_point_in_each_line_and_an_empty_one_is_none():
    (card,) = script(new_markdown_cell("- One.\n- B of $\\theta$."))
    assert (card.kind, card.heading, card.words) == ("card", "One", "One.\nB of θ.")
    assert script() == []


def test_exercises_are_for_the_class_and_predictions_are_asked():
    assert script(new_markdown_cell("So?"), shows(), label="Exercise") == []
    (asked,) = script(new_markdown_cell("So?"), label="Predict")
    assert (asked.kind, asked.heading) == ("card", "Predict: One")


def test_an_experiment_moves_where_it_was_recorded():
    page = '<div class="mocap-still"><img>'
    recorded = {"x": {"name": "step", "labels": ["1", "2"], "pictures": [PNG, PNG], "at": 0}}
    (still,), (moving,) = script(shows(page)), script(shows(page), recorded=recorded)
    assert still.kind == "still"
    assert (moving.kind, moving.labels, moving.pictures) == (
        "moving",
        ["step: 1", "step: 2"],
        [b"picture"] * 2,
    )


def png(colour="#00FF00"):
    data = io.BytesIO()
    Image.new("RGB", (200, 100), colour).save(data, "png")
    return data.getvalue()


def frames(*scenes):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(films, "FPS", 5)  # a quarter of the frames
        return [frame.copy() for frame in films.frames_of(list(scenes))]


def holds(frame, colour):
    return bool((np.asarray(frame) == colour).all(axis=-1).any())


def test_a_still_stands_and_a_bar_goes_on():
    made = frames(Scene("still", "Heading", "Words.", [png()]))
    assert {frame.shape for frame in made} == {(720, 1280, 3)}
    assert len(made) == 5 * 5
    assert holds(made[0], (0, 255, 0))
    assert (made[0][:700] == made[-1][:700]).all()
    assert (made[0][-3] != made[-1][-3]).any()


def test_an_experiment_goes_there_and_back():
    colours = ("#FF0000", "#00FF00", "#0000FF")
    made = frames(Scene("moving", "H", "W", [png(c) for c in colours], ["a", "b", "c"]))
    seen = [tuple(int(v) for v in made[round(5 * (0.7 * n + 0.3))][300, 640]) for n in range(5)]
    red, green, blue = (255, 0, 0), (0, 255, 0), (0, 0, 255)
    assert seen == [red, green, blue, green, red]


def test_cards_fit_and_do_not_cover_the_heading():
    words = "\n".join(["A point of some length that has to be broken into more than one line, or so."] * 9)
    scenes = Scene("still", "Heading", "", [png()]), Scene("card", "Heading", words)
    alone, card = (next(films.frames_of([scene])) for scene in scenes)  # all take half a gigabyte
    assert (alone[: films.TOP] == card[: films.TOP]).all()
    assert (card[680:700] == 255).all()


def test_a_long_heading_is_cut():
    first = next(films.frames_of([Scene("still", "word " * 60, "", [png()])]))
    assert (first[: films.TOP, 1280 - films.EDGE :] == 255).all() and (first[: films.TOP, 1100:] < 99).any()


@pytest.fixture
def notebook(tmp_path):
    path = tmp_path / "walk.ipynb"
    path.write_text(writes(new_notebook(cells=[new_markdown_cell("# Walks")])), "utf-8")
    (tmp_path / "slides").mkdir()
    (tmp_path / "slides" / "walk.md").write_text("# Walks\n\nA body walks.\n", "utf-8")
    return path


def test_the_command_writes_an_mp4(notebook, tmp_path, capsys, run):
    imageio = pytest.importorskip("imageio_ffmpeg", reason="pip install '.[video]'")
    out = tmp_path / "walk.mp4"
    assert run(f"course film {notebook} --still -o {out}").out == f"wrote {out}\n"
    meta = next(imageio.read_frames(str(out)))
    assert meta["size"] == (1280, 720)
    assert meta["fps"] == 20
    assert main(["course", "film", "--help"]) == 0
    assert "Example: mocap course film" in capsys.readouterr().out


def test_what_cannot_be_is_one_sentence(notebook, tmp_path, monkeypatch):
    pytest.importorskip("imageio_ffmpeg", reason="pip install '.[video]'")
    shutil.copy(notebook, tmp_path / "other.ipynb")
    refused(
        "There is no deck", films.render_film, tmp_path / "other.ipynb", tmp_path / "film.mp4", moving=False
    )
    monkeypatch.setattr(films, "write_mp4", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        films.render_film(notebook, tmp_path / "film.mp4", moving=False)
    assert not list(tmp_path.glob("film*"))
