"""The short programs of notebooks/examples: each runs in an empty folder, and writes what it says."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "notebooks" / "examples"
WRITES = {
    "walk_along_a_line": {"walk.bvh", "walk.gif"},
    "blend_two_clips": {"blend_25.bvh", "blend_50.bvh", "blend_75.bvh", "from_walk_to_sneak.bvh"},
    "judge_a_clip": set(),
    "retarget_to_a_child": {"child.bvh"},
    "match_and_loop": {"joined.bvh", "loop.bvh"},
}
SAYS = {
    "walk_along_a_line": r"\d+ of \d+ transitions are left",
    "blend_two_clips": r"0\.50 sneaking: \d\.\d s; worst measure \w+, 0\.\d\d × its limit",
    "judge_a_clip": r"cut: jolt .*\n(.*\n)*gliding: foot_sliding",
    "retarget_to_a_child": r"adult: 1\.7\d m tall, .*\nchild: 1\.[123]\d m tall, 0\.\d\d m/s",
    "match_and_loop": r"are similar: [0-3]\.\d cm\n.*\na loop of 1\.\d\d s",
}


def test_each_example_is_short_explained_and_listed():
    readme = (FOLDER / "README.md").read_text("utf-8")
    paths = sorted(FOLDER.glob("*.py"))
    assert {path.stem for path in paths} == set(WRITES) == set(SAYS)
    for path in paths:
        text = path.read_text("utf-8")
        assert ast.get_docstring(ast.parse(text)).endswith(".")
        assert len([line for line in text.splitlines() if line.strip()]) <= 30
        assert f"({path.name})" in readme


@pytest.mark.sweep
@pytest.mark.parametrize("name", WRITES)
def test_each_example_runs_in_an_empty_folder(name, tmp_path):
    command = [sys.executable, "-X", "utf8", "-W", "error::DeprecationWarning:mocap", FOLDER / f"{name}.py"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, encoding="utf-8", check=False
    )
    assert done.returncode == 0, done.stderr
    assert re.search(SAYS[name], done.stdout), done.stdout
    assert {path.name for path in tmp_path.iterdir()} == WRITES[name]
    assert all(path.stat().st_size > 1000 for path in tmp_path.iterdir())
