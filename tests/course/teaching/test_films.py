"""Films: their frames, and the file."""

import io
import shutil

import numpy as np
import pytest
from nbformat.v4 import new_markdown_cell, new_notebook, writes
from PIL import Image

from mocap.cli.main import main
from mocap.course.teaching import films
from mocap.course.teaching.film_script import Scene
from tests.refusals import refused


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


@pytest.mark.exhaustive
def test_a_real_film_with_recordings(tmp_path):
    from mocap.course.opening import stored

    out = films.render_film(stored() / "06-pruning.ipynb", tmp_path / "film.mp4")
    assert out.stat().st_size < 5_000_000
