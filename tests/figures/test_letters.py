"""The letters of pictures as large as pages show them: about as large as the text around them."""

import base64
import io
import json

import pytest
from PIL import Image

from mocap.course.shared_files import DRAWN, PLAYED
from mocap.plotting.picture import shown_width
from tests.course.stored_notebooks import NAMES, ROOT, read

COLUMN = 736  # pixels, the width of the site's text
SMALLEST = 10  # pixels
LARGEST = 14
FIGURES = sorted((ROOT / "figures").glob("*.png"))
DENSE = ("following", "bending")  # sheets of many paths, whose letters are of 8 pixels


def letters(png):
    """Return the size of a picture's smallest letters in the column of a page; 12 where it has none."""
    picture = Image.open(io.BytesIO(png))
    size = float(picture.info.get("letters", "inf"))
    width = min(shown_width(png), COLUMN)
    return 12.0 if size == float("inf") else size * width / picture.width


@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_letters_of_figures_are_as_large_as_text(path):
    if path.stem in DENSE:
        pytest.skip("a sheet of many paths")
    assert SMALLEST <= letters(path.read_bytes()) <= LARGEST


@pytest.mark.parametrize("name", NAMES)
def test_letters_of_pictures_in_notebooks_are_as_large_as_text(name):
    for number, cell in enumerate(read(name).cells):
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            is_scene = DRAWN.search(data.get("text/html", "")) or PLAYED.search(cell.source)
            if "image/png" in data and not is_scene:
                size = letters(base64.b64decode(data["image/png"]))
                assert SMALLEST <= size <= LARGEST, f"cell {number}"


def test_recordings_are_shown_as_wide_as_the_pictures_in_their_notebooks():
    for path in sorted((ROOT / "notebooks" / "recordings").glob("*.json")):
        cells = {cell.source: cell for cell in read(path.stem).cells}
        for recording in json.loads(path.read_text("utf-8")):
            outputs = cells[recording["source"]].outputs
            pngs = [output.data["image/png"] for output in outputs if "image/png" in output.get("data", {})]
            assert recording["width"] == pytest.approx(shown_width(base64.b64decode(pngs[0])), rel=0.05)
