"""A graph of groups comes back from its file as it was; another file is refused."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.errors import FormatError, MocapError
from mocap.methods.groups.group_files import load_group, save_group
from mocap.methods.groups.group_graphs import play_group, random_group_walk
from tests.methods.groups.built import graph


def test_it_comes_back(tmp_path):
    group = graph(6, 6)
    save_group(group, tmp_path / "six.npz")
    back = load_group(tmp_path / "six.npz")
    assert (back.members, len(back.nodes), len(back.clips)) == (6, len(group.nodes), len(group.clips))
    walk = random_group_walk(group, 10)
    np.testing.assert_array_equal(play_group(back, walk).places, play_group(group, walk).places)
    assert back.clips[3].disc == group.clips[3].disc


@pytest.mark.parametrize("wrong", [{"end": 99}, {"move": complex(np.nan)}, {"turn": 2j}])
def test_clips_that_point_nowhere_are_refused(tmp_path, wrong):
    group = graph(6, 6)
    wrong = replace(group.clips[0], **wrong)
    save_group(replace(group, clips=(wrong, *group.clips[1:])), tmp_path / "six.npz")
    with pytest.raises(FormatError, match=r"expected that [a-z ,]+, got a damaged file"):
        load_group(tmp_path / "six.npz")


def test_other_files_are_refused(tmp_path):
    (tmp_path / "no.npz").write_bytes(b"no")
    with pytest.raises(FormatError, match="a group motion graph saved by mocap"):
        load_group(tmp_path / "no.npz")
    with pytest.raises(MocapError, match=r"written as \.npz"):
        save_group(graph(6, 6), tmp_path / "six.txt")
