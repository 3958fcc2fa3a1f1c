"""The moving picture at the head of the README: short, small, and it moves."""

from itertools import pairwise
from pathlib import Path

import idea
import numpy as np
from PIL import Image

FILE = Path(idea.__file__).with_name("idea.gif")


def test_it_is_short_small_and_moves():
    assert FILE.stat().st_size < 2_000_000
    with Image.open(FILE) as film:
        assert 8 <= film.n_frames / idea.RATE <= 20
        assert film.info["duration"] == 1000 // idea.RATE
        pictures = []
        for frame in (0, film.n_frames // 2, film.n_frames - 1):
            film.seek(frame)
            pictures.append(np.asarray(film.convert("RGB")).astype(int))
    assert all(np.abs(a - b).mean() > 0.5 for a, b in pairwise(pictures))


def test_it_draws_what_it_says():
    picture = idea.Picture()
    assert picture.followed.off.mean() < 0.08  # metres: the walk is on the line
    assert len(picture.seams) >= 3
    assert len({name for _, name in picture.sources}) >= 2
    first = next(picture.frames())
    assert first.size == (720, 360)
