"""A file is written whole or not at all."""

import pytest

from mocap._shared.atomic import replacing
from mocap.errors import MocapError


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "walk.bvh"
    path.write_text("old")
    with replacing(path) as beside:
        beside.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]


@pytest.mark.parametrize("trouble", [KeyboardInterrupt, ZeroDivisionError, SystemExit])
def test_nothing_is_left_of_a_failure(tmp_path, trouble):
    path = tmp_path / "walk.bvh"
    path.write_text("old")
    with pytest.raises(trouble), replacing(path) as beside:
        beside.write_text("half a fi")
        raise trouble
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]


def test_a_new_file_has_ordinary_permissions(tmp_path):
    (tmp_path / "plain").write_text("")
    with replacing(tmp_path / "new") as beside:
        beside.write_text("")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_missing_folder_is_named(tmp_path):
    path = tmp_path / "nowhere" / "walk.bvh"
    with pytest.raises(MocapError, match=r"Cannot write .*walk.bvh: No such file"), replacing(path) as beside:
        beside.write_text("")


def test_a_folder_in_the_way_is_named(tmp_path):
    (tmp_path / "walk.bvh").mkdir()
    with pytest.raises(MocapError, match=r"Cannot write"), replacing(tmp_path / "walk.bvh") as beside:
        beside.write_text("")
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]
