"""Tables of joint positions: Python's and pandas' readers find the positions of the motion."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from mocap.files import load_save, position_tables
from tests.refusals import refused
from tests.strategies import random_motion, wave


def read(path):
    """Read a table with Python's reader: the names of its columns, and its numbers."""
    with path.open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    return names, np.array(rows, float)


@pytest.mark.parametrize("frames", [1, 2, 50])
def test_the_columns_are_times_and_positions_in_metres(tmp_path, frames):
    motion = replace(random_motion(frames, frames), fps=29.97)
    load_save.save(motion, tmp_path / "a.CSV")
    names, table = read(tmp_path / "a.CSV")
    assert names == ["time", *(f"{name}_{axis}" for name in motion.skeleton.names for axis in "xyz")]
    assert np.array_equal(table[:, 0], np.arange(frames) / motion.fps)
    assert np.abs(table[:, 1:].reshape(motion.positions.shape) - motion.positions).max() <= 5.0001e-7


def test_a_long_motion_is_written_in_parts_with_the_same_lines(tmp_path, monkeypatch):
    motion = wave(100)
    load_save.save(motion, tmp_path / "whole.csv")
    monkeypatch.setattr(position_tables, "POSITIONS_AT_ONCE", 30)
    load_save.save(motion, tmp_path / "parts.csv")
    assert (tmp_path / "parts.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_precision_is_the_number_of_decimals_and_no_zero_is_negative(tmp_path):
    load_save.save(wave(9), tmp_path / "a.csv", precision=2)
    text = (tmp_path / "a.csv").read_text("utf-8")
    assert "-0.00," not in text and ",0.00," in text
    assert np.abs(read(tmp_path / "a.csv")[1][:, 1:] - wave(9).positions.reshape(9, -1)).max() <= 0.0051


def test_odd_names_are_quoted_and_control_characters_refused(tmp_path):
    names = ['a,"b"', "Hüfte", "手", "=1+1"]
    motion = replace(wave(2), contacts={}, skeleton=replace(wave(2).skeleton, names=names))
    load_save.save(motion, tmp_path / "a.csv")
    assert [name[:-2] for name in read(tmp_path / "a.csv")[0][1::3]] == names
    for odd in ("a\nb", "a\0", "\udc80"):
        skeleton = replace(motion.skeleton, names=[odd, "b", "c", "d"])
        refused(
            "cannot hold a joint called",
            load_save.save,
            replace(motion, skeleton=skeleton),
            tmp_path / "b.csv",
        )
    assert [file.name for file in tmp_path.iterdir()] == ["a.csv"]


def test_positions_far_away_are_refused(tmp_path):
    far = replace(wave(2), root_positions=np.full((2, 3), 1e12))
    refused(r"'wave' goes 1e\+09 m far: no table holds it", load_save.save, far, tmp_path / "a.csv")


def test_a_table_cannot_be_read_as_a_motion(tmp_path):
    load_save.save(wave(2), tmp_path / "a.csv")
    remedy = "export or save the motion itself first, as .bvh or .npz"
    refused(f"a table of positions has no rotations: {remedy}", load_save.load, tmp_path / "a.csv", most=300)
