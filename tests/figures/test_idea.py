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
        assert 8 <= film.n_frames / idea.RATE <= 20 and idea.RATE == 25
        assert film.size == tuple(idea.SIZE.values())
        assert film.info["duration"] == 1000 // idea.RATE
        pictures = []
        for frame in (0, film.n_frames // 2, film.n_frames - 1):
            film.seek(frame)
            pictures.append(np.asarray(film.convert("RGB")).astype(int))
    assert all(np.abs(a - b).mean() > 0.5 for a, b in pairwise(pictures))
