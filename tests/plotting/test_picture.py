"""Pictures with their sentences, as notebooks keep them."""

import base64
import io

import matplotlib.pyplot as plt
import numpy as np
import pytest
from bs4 import BeautifulSoup
from matplotlib.figure import Figure
from nbconvert import HTMLExporter
from nbformat.v4 import new_code_cell, new_notebook, new_output
from PIL import Image

from mocap.plotting import bodies, charts, grids
from mocap.plotting.picture import DPI, SHOWN, show
from tests.refusals import refused
from tests.strategies import wave


@pytest.fixture(autouse=True)
def no_figure_stays_open():
    yield
    assert plt.get_fignums() == []


def image(picture):
    return Image.open(io.BytesIO(picture.picture))


def axes():
    return Figure(figsize=(2, 1)).add_subplot()


@pytest.mark.parametrize(
    "drawn",
    [
        lambda: axes().figure,
        axes,
        lambda: axes().plot([0, 1]),
        lambda: axes().hist([1, 2, 2]),
        lambda: Figure(figsize=(2, 1)).subplots(1, 2),
    ],
)
def test_the_whole_figure_of_what_was_drawn_is_shown(drawn):
    assert image(show(drawn(), alt="A drawing.")).size == (2 * DPI, DPI)


def test_the_figure_is_closed_and_its_picture_stays():
    plt.figure(figsize=(2, 2)).add_subplot().plot([0, 1])
    picture = show(plt.gca(), alt="A line.")
    assert plt.get_fignums() == []
    assert np.ptp(np.asarray(image(picture).convert("L")).astype(int)) > 200


@pytest.mark.parametrize("nothing", [None, [], (), "a line", np.array(3.0), 3])
def test_a_thing_on_no_figure_is_refused(nothing):
    refused("must be given as a figure", show, nothing, alt="Nothing.")


def test_a_picture_without_a_sentence_is_refused():
    refused("needs a sentence", show, axes(), alt=" ")


@pytest.mark.parametrize(
    "draw",
    [
        lambda: bodies.film_strip([wave(30), wave(30, phase=1)]),
        lambda: grids.distance_image(np.random.default_rng(0).random((300, 300)).cumsum(0), fps=30),
        lambda: charts.path_from_above(wave(90)),
    ],
)
def test_pictures_are_small(draw):
    assert len(show(draw(), alt="A picture.").picture) < 60_000


def test_a_page_shows_a_picture_with_letters_as_large_as_its_text():
    figure = Figure(figsize=(4, 4))
    figure.text(0.5, 0.5, "words", fontsize=20)
    data, metadata = show(figure, alt="Words.")._repr_mimebundle_()
    width = metadata["image/png"]["width"]
    assert f'width="{width}"' in data["text/html"]
    assert 20 / 72 * DPI * width / (4 * DPI) == pytest.approx(SHOWN, abs=0.1)
    assert show(axes(), alt="A drawing.")._repr_mimebundle_()[1]["image/png"]["width"] <= 2 * DPI


def test_few_colours_change_nothing_visible():
    figure = Figure(figsize=(3, 3))
    grids.distance_image(np.hypot(*np.mgrid[-40:40, -40:40]), fps=30, ax=figure.add_subplot())
    few = image(show(figure, alt="A valley.")).convert("RGB")
    stream = io.BytesIO()
    figure.savefig(stream, dpi=DPI)
    apart = np.abs(np.asarray(few, int) - np.asarray(Image.open(stream).convert("RGB"), int))
    assert apart.mean() < 1.5  # of 255
    assert apart.max() < 16


def test_pages_made_of_a_notebook_carry_the_sentence():
    data, metadata = show(axes(), alt='A "line" < a curve.')._repr_mimebundle_()
    assert base64.b64decode(data["image/png"])[:4] == b"\x89PNG"
    assert data["text/plain"] == metadata["image/png"]["alt"] == 'A "line" < a curve.'
    output = new_output("execute_result", data, metadata=metadata)
    notebook = new_notebook(cells=[new_code_cell("show(...)", outputs=[output])])
    page, _ = HTMLExporter(template_name="lab").from_notebook_node(notebook)
    assert [img["alt"] for img in BeautifulSoup(page, "html.parser")("img")] == ['A "line" < a curve.']
