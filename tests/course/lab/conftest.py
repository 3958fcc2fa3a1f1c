"""A file beside the notebooks for each test, and no function of another test."""

import pytest

from mocap.course.lab import adopting


@pytest.fixture(autouse=True)
def fresh(tmp_path, monkeypatch):
    """Start as a new kernel in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("MOCAP_MINE", raising=False)
    new_kernel()
    yield tmp_path / "my_graph.py"
    new_kernel()


def new_kernel():
    adopting._slots.cache_clear()
    adopting._kernel = adopting._Kernel()
