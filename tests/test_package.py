"""The names at the top of the package."""

import pytest

import mocap


def test_every_name_is_there():
    for name in mocap.__all__:
        assert getattr(mocap, name).__name__ == name
    assert set(mocap.__all__) <= set(dir(mocap))


def test_another_name_is_not():
    with pytest.raises(AttributeError, match="no attribute 'walk'"):
        _ = mocap.walk
