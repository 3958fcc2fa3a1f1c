"""Clips in a folder, for commands to read."""

import pytest

from mocap.files import load_save
from tests.strategies import wave


@pytest.fixture
def clips(tmp_path):
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        load_save.save(clip, tmp_path / f"{clip.name}.bvh")
    return tmp_path
