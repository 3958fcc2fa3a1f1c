"""The numbers in `figures/control.md` are those of today's characters; times are left out."""

from pathlib import Path

import compare_control
import pytest

from mocap import quality
from mocap.body import SHAPES
from mocap.methods.motion_matching import MotionMatcher, tabulate

TABLE = Path(compare_control.__file__).with_name("control.md")
NAME = "bundled clips"


def rows(label):
    """Give the cells of a way of control: what it is judged by, and how far it is off each path."""
    lines = TABLE.read_text("utf-8").split(f"## {NAME}")[1].split("\n## ")[0].splitlines()
    return [line.strip("| ").split(" | ")[1:] for line in lines if line.startswith(f"| {label} | ")]


def led(make, shape, speed):
    off, _ = compare_control.lead(make(), SHAPES[shape](), speed)
    return f"{off.mean():.2f}, {off.max():.2f}"


@pytest.fixture
def clips(monkeypatch):
    monkeypatch.setattr("sys.argv", ["compare_control"])
    return compare_control.clip_sets()[NAME]


def test_matching_follows_a_circle_as_the_table_says(clips):
    some, speed = clips
    table = tabulate(some)
    cell = rows("matching, future × 1")[1][list(SHAPES).index("circle")]
    now = led(lambda: MotionMatcher(table), "circle", speed)
    kept, now = ([float(part) for part in text.split(", ")] for text in (cell, now))
    assert kept == pytest.approx(now, abs=0.03), "write it anew: python figures/compare_control.py FOLDER"


@pytest.mark.exhaustive
def test_every_way_is_worth_what_the_table_says(clips):
    some, speed = clips
    made, refused = compare_control.ways(NAME, some)
    assert not refused
    for label, (make, _) in made.items():
        judged, off = rows(label)
        assert judged[:-3] == compare_control._judged(make, quality.spread(some), speed).split(" | ")[:-2]
        assert off == [led(make, shape, speed) for shape in SHAPES]
