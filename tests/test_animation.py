"""Motions as files, read back."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

from mocap import plotting
from mocap.errors import MocapError
from tests.strategies import wave


def test_an_animation_has_a_picture_every_time_step(tmp_path):
    motion = wave(31)  # one second
    path = plotting.save_animation(motion, tmp_path / "wave.gif", fps=20)
    with Image.open(path) as gif:
        assert gif.n_frames == 21
        assert gif.info["duration"] == 50
        first = np.asarray(gif.convert("RGB"))
        gif.seek(10)
        assert np.any(np.asarray(gif.convert("RGB")) != first)
    assert list(tmp_path.iterdir()) == [path]


def test_nothing_is_written_and_no_figure_left_when_drawing_is_interrupted(tmp_path):
    def interrupted(items):
        yield items[0]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        plotting.save_animation(wave(30), tmp_path / "wave.gif", progress=interrupted)
    assert list(tmp_path.iterdir()) == []
    assert plt.get_fignums() == []


def test_only_gifs_are_written(tmp_path):
    with pytest.raises(MocapError, match=r"written as \.gif, got"):
        plotting.save_animation(wave(9), tmp_path / "wave.mov")
