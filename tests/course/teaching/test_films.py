"""Films: what they say and show, for how long, their frames, and the file."""

import base64
import io
import shutil

import numpy as np
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output, writes
from PIL import Image

from mocap.cli.main import main
from mocap.course.teaching import films
from mocap.course.teaching.films import SPEED, Scene, script_of, spoken
from mocap.course.teaching.slides import Slide
from tests.refusals import refused


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
    alone, card = (frames(scene)[0] for scene in scenes)
    assert (alone[: films.TOP] == card[: films.TOP]).all()
    assert (card[680:700] == 255).all()


def test_a_long_heading_is_cut():
    (first, *_) = frames(Scene("still", "word " * 60, "", [png()]))
    assert (first[: films.TOP, 1280 - films.EDGE :] == 255).all() and (first[: films.TOP, 1100:] < 99).any()


@pytest.fixture
def notebook(tmp_path):
    path = tmp_path / "walk.ipynb"
    path.write_text(writes(new_notebook(cells=[new_markdown_cell("# Walks")])), "utf-8")
    (tmp_path / "slides").mkdir()
    (tmp_path / "slides" / "walk.md").write_text("# Walks\n\nA body walks.\n", "utf-8")
    return path


def test_the_command_writes_an_mp4(notebook, tmp_path, capsys):
    imageio = pytest.importorskip("imageio_ffmpeg", reason="pip install imageio-ffmpeg")
    out = tmp_path / "walk.mp4"
    assert main(["course", "film", str(notebook), "--still", "-o", str(out)]) == 0
    assert capsys.readouterr().out == f"wrote {out}\n"
    meta = next(imageio.read_frames(str(out)))
    assert meta["size"] == (1280, 720)
    assert meta["fps"] == 20
    with pytest.raises(SystemExit):
        main(["course", "film", "--help"])
    assert "For example: mocap course film" in capsys.readouterr().out


def test_what_cannot_be_is_one_sentence(notebook, tmp_path, monkeypatch):
    shutil.copy(notebook, tmp_path / "other.ipynb")
    refused(
        "There is no deck", films.render_film, tmp_path / "other.ipynb", tmp_path / "film.mp4", moving=False
    )
    monkeypatch.setattr(films, "write_mp4", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        films.render_film(notebook, tmp_path / "film.mp4", moving=False)
    assert not list(tmp_path.glob("film*"))
