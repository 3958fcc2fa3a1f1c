"""The names at the top of the package."""

import re
from pathlib import Path

import pytest

import mocap
from mocap import datasets


def test_every_name_is_there():
    for name in mocap.__all__:
        assert getattr(mocap, name).__name__.split(".")[-1] == name
    assert set(mocap.__all__) <= set(dir(mocap))


def test_another_name_is_not():
    with pytest.raises(AttributeError, match="mocap attribute walk"):
        _ = mocap.walk


def test_the_ten_lines_of_the_readme_run(tmp_path, monkeypatch):
    readme = (Path(__file__).parents[1] / "README.md").read_text()
    (lines,) = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(datasets, "SAMPLES", ["walk_circle", "walk_curve_1"])  # two clips and 2 s are quick
    exec(lines.replace("seconds=20", "seconds=2"), {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["walk.bvh", "walk.gif"]
