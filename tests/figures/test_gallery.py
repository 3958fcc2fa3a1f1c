"""The pictures in figures/ are those that `gallery.py` draws now; the moving one is short and moves."""

from itertools import pairwise
from pathlib import Path

import gallery
import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

from tests.refusals import refused

FIGURES = Path(__file__).parents[2] / "figures"


SLOW = ("walk", "segments", "dying_walks", "match_webs", "groups", "parametric_graph", "path", "steered")
PICTURES = [pytest.param(name, marks=[pytest.mark.sweep] * (name in SLOW)) for name in gallery.PICTURES]


@pytest.mark.parametrize("name", PICTURES)
def test_no_picture_is_stale(name):
    figure = gallery.PICTURES[name]()
    kept, now = gallery.drawn_in(FIGURES / f"{name}.png"), gallery.fingerprint(figure)
    plt.close("all")
    assert kept.keys() == now.keys(), "draw them anew: python figures/gallery.py"
    for kind, numbers in now.items():
        assert kept[kind] == pytest.approx(numbers, rel=1e-3, abs=1e-3), f"{name}: python figures/gallery.py"


def test_all_are_written_with_their_fingerprints(tmp_path, monkeypatch):
    monkeypatch.setattr(gallery, "PICTURES", {"pruning": gallery.draw_pruning})
    (path,) = gallery.draw_all(tmp_path)
    assert gallery.drawn_in(path) == gallery.fingerprint(gallery.draw_pruning())
    again = path.read_bytes()
    gallery.draw_all(tmp_path)
    assert path.read_bytes() == again
    plt.close("all")
    refused("is no picture of", gallery.drawn_in, tmp_path / "nowhere.png")


FILE = FIGURES / "idea.gif"


def test_it_is_short_small_and_moves():
    idea = pytest.importorskip(
        "idea", reason="pip install '.[ci]'", exc_type=ImportError
    )  # it drives a browser
    assert FILE.stat().st_size < 2_000_000
    with Image.open(FILE) as film:
        assert 8 <= film.n_frames / idea.RATE <= 20 and idea.RATE == 25
        assert film.size == tuple(idea.SIZE.values())
        assert film.info["duration"] == 1000 // idea.RATE
        pictures = []
        for frame in (0, film.n_frames // 2, film.n_frames - 1):
            film.seek(frame)
            pictures.append(np.asarray(film.convert("RGB")).astype(int))
    assert all(np.abs(a - b).mean() > 0.5 for a, b in pairwise(pictures))
