"""Named sets are read from a copy of one's own; each says whose it is, and which joints its legs are."""

import hashlib

import numpy as np
import pytest

from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.cli.main import main
from mocap.datasets import named_sets
from mocap.datasets.named_sets import SETS, from_set, list_set
from mocap.errors import MocapError
from mocap.files import load_save


def body_of(known):
    """Return a body with the joints that a set's legs and hips are said to have."""
    right = [named_sets._right(name) for name in known.legs]
    parents = [-1, 0, 1, 2, 3, 0, 5, 6, 7]
    offsets = [[0, 0, 0], *[[x, -0.4, 0.1] for x in (0.1, 0, 0, 0, -0.1, 0, 0, 0)]]
    return Skeleton([known.hips, *known.legs, *right], parents, offsets)


@pytest.fixture
def data(tmp_path, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path))
    named_sets._show.cache_clear()
    return tmp_path


@pytest.mark.parametrize("name", SETS)
def test_a_clip_is_read_wherever_it_lies_in_the_set(data, capsys, name):
    known, skeleton = SETS[name], body_of(SETS[name])
    still = Motion(skeleton, np.ones((3, 3)), np.tile([1.0, 0, 0, 0], (3, 9, 1)), known.fps)
    (data / name / "deep").mkdir(parents=True)
    load_save.save(still, data / name / "deep" / "walk.bvh")
    assert list_set(name) == ["walk"]
    clip = from_set(name, "walk")
    assert clip.fps == known.fps
    assert known.licence in capsys.readouterr().err
    from_set(name, "walk")
    assert capsys.readouterr().err == ""  # once is enough
    assert known.find_legs(clip.skeleton) == find_legs(clip.skeleton)


def test_a_clip_that_is_not_there_and_a_set_that_is_not_known_are_refused(data):
    with pytest.raises(MocapError, match=r"No clip 'x' in .*100style: get the set at zenodo.*CC BY 4.0"):
        from_set("100style", "x")
    with pytest.raises(MocapError, match="No set 'x' is known; there are: bandai_namco, lafan1, 100style"):
        list_set("x")
    assert list_set("lafan1") == []


def test_a_file_that_is_not_the_one_listed_is_refused(data, monkeypatch):
    (data / "lafan1").mkdir()
    (data / "lafan1" / "walk.bvh").write_text("HIERARCHY")
    monkeypatch.setitem(named_sets.HASHES, "walk", hashlib.sha256(b"another").hexdigest())
    with pytest.raises(MocapError, match=r"walk\.bvh is not the file listed: its checksum differs"):
        from_set("lafan1", "walk")


def test_without_a_folder_of_ones_own_the_cache_is_taken(monkeypatch):
    monkeypatch.delenv("MOCAP_DATA", raising=False)
    assert named_sets.folder_of("lafan1").parent.name == "mocap"


def test_the_sets_are_listed_with_their_licences(data, capsys):
    assert main(["data", "sets"]) == 0
    told = capsys.readouterr().out
    assert all(known.licence in told and known.address in told for known in SETS.values())
    assert "at hand  0 clips" in told


def test_a_real_copy(real_data, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(real_data / "bvh"))
    clips = list_set("bandai_namco")
    assert set(clips) == set(named_sets.HASHES)
    for name in clips:
        clip = from_set("bandai_namco", name)
        assert clip.fps == SETS["bandai_namco"].fps
        assert SETS["bandai_namco"].find_legs(clip.skeleton) == find_legs(clip.skeleton)
