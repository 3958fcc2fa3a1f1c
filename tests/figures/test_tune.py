"""Trials of tuned constants: each constant is varied, or a script says why not; a script runs, quickly."""

import importlib.util
import subprocess
import sys
from dataclasses import FrozenInstanceError, fields
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "figures" / "tune"
SCRIPTS = sorted(path.stem for path in FOLDER.glob("[!_]*.py"))
ROOMS = sorted(path.parent for name in ("tuned", "limits") for path in (ROOT / "mocap").rglob(f"{name}.py"))
ROOMS.remove(ROOT / "mocap" / "_shared")  # its `limits` is a function of the operating system


@pytest.fixture
def script(request, monkeypatch) -> ModuleType:
    """Import a script of the folder, under a name of its own."""
    monkeypatch.syspath_prepend(str(FOLDER))
    spec = importlib.util.spec_from_file_location(f"tune_{request.param}", FOLDER / f"{request.param}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_room_with_tuned_constants_has_a_script():
    assert sorted(room.name for room in ROOMS) == SCRIPTS


@pytest.mark.parametrize("script", SCRIPTS, indirect=True)
def test_each_constant_is_varied_or_fixed_for_a_reason(script):
    study = script.STUDY
    assert study.unexplained() == set()
    assert all(len(reason) > 20 for reason in study.fixed.values())
    assert study.collections[0].is_bundled, "the quick trials need clips that come with the package"


@pytest.mark.parametrize("script", SCRIPTS, indirect=True)
def test_each_constant_has_a_unit_or_a_reason_and_other_values(script):
    study = script.STUDY
    constants = vars(study.room).get("TUNED") or study.room.LIMITS
    for field in fields(constants):
        assert study.reason(field.name), field.name
    for name, trial in study.trials.items():
        assert trial.values and getattr(constants, name) not in trial.values, name


@pytest.mark.parametrize("script", ["steering"], indirect=True)
def test_varied_constants_are_read_by_all_modules_and_then_as_before(script):
    from _trials import varied  # the script's folder is on the path here only

    from mocap.steering import path_search, tuned

    chosen = path_search.TUNED
    with varied(tuned, layer=0.5):
        assert path_search.TUNED.layer == tuned.TUNED.layer == 0.5
    assert path_search.TUNED is tuned.TUNED is chosen
    with pytest.raises(FrozenInstanceError):
        chosen.layer = 0.5


def test_a_quick_trial_marks_the_chosen_value_of_each_constant():
    command = [sys.executable, str(FOLDER / "body.py"), "--quick"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    tables = done.stdout.strip().split("\n\n")
    assert [table.partition(":")[0] for table in tables] == ["path_spacing", "hinge", "still"]
    for table in tables:
        assert sum(line.startswith("*") for line in table.splitlines()) == 1
        assert table.splitlines()[-1].split() != table.splitlines()[-2].split()[1:]


def test_captured_clips_that_are_not_here_are_told(tmp_path, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path))
    command = [sys.executable, str(FOLDER / "body.py"), "--only", "still"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (
        f"CMU 16, 26 walks: not in {tmp_path}. Let MOCAP_DATA name a folder with 16/16_11.amc." in done.stdout
    )
