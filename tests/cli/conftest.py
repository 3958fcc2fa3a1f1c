"""Clips in a folder, for commands to read."""

from functools import cache

import pytest

from mocap.files import load_save
from mocap.methods.groups import build_group
from tests.strategies import wave


@pytest.fixture
def clips(tmp_path, monkeypatch):
    """Stand in a folder with two clips."""
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        load_save.save(clip, tmp_path / f"{clip.name}.bvh")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(autouse=True, scope="session")
def one_group():
    """Build the group of `mocap crowd` once: it takes seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mocap.methods.groups.build_group", cache(build_group))
        yield
