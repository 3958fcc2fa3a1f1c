"""Faults of rising size in bundled clips are seen by `judge`, and ranked by size; the clips have none."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mocap.body import Motion, resample
from mocap.datasets import sample

SCRIPT = Path(__file__).parents[2] / "figures" / "judged_faults.py"
SPEC = importlib.util.spec_from_file_location("judged_faults", SCRIPT)
faults = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(faults)

NAMES = [fault.name for fault in faults.FAULTS]


def clip(name: str, fps: float) -> Motion:
    return resample(sample(name), fps)[: round(5 * fps)]


@pytest.mark.parametrize("fault", faults.FAULTS, ids=NAMES)
@pytest.mark.parametrize(("name", "fps"), [("walk_curve_1", 30), ("jog", 60)])
def test_the_larger_faults_are_seen_and_all_are_ranked_by_size(fault, name, fps):
    clean, *scores = faults.scores_of(clip(name, fps), fault)
    assert clean == 0
    assert min(scores[-2:]) > 0.1
    assert (np.diff([clean, *scores]) > -faults.RISE).all()


def test_there_are_eight_faults_or_more_in_four_sizes():
    assert len(set(NAMES)) >= 8
    for fault in faults.FAULTS:
        assert list(fault.sizes) == sorted(fault.sizes) and len(fault.sizes) == 4


def test_the_script_lists_the_clips_of_a_folder(tmp_path):
    (tmp_path / "broken.bvh").write_text("no clip")
    command = [sys.executable, str(SCRIPT), str(tmp_path), "--fps", "30", "--without", "bundled"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "left out: broken.bvh" in done.stdout and "| fault |" in done.stdout
