"""The benchmark: its frame on a toy task, and what every task must have; and the table of control."""

from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import benchmark
import compare_control
import numpy as np
import pytest
import tasks

import mocap
from mocap import quality
from mocap.body import SHAPES
from mocap.datasets import sample
from mocap.errors import MocapError
from mocap.methods.motion_matching import MotionMatcher, tabulate
from tests.loops import for_each

CASES = [tasks.Case("toys", f"toy-{n}", {"start": [[n]]}, 2.0 * n) for n in range(1, 6)]


def refuses_the_first(case):
    if case.truth == 2:
        raise MocapError("Not this one.")
    return np.array([[case.truth - 1.0]])


TOY = SimpleNamespace(
    MEASURES={"off": True, "guessed": False},
    BASELINES=("start", "nothing"),
    METHODS={
        "start": lambda case: np.array(case.given["start"]),
        "nothing": lambda case: np.zeros((1, 1)),
        "guess": refuses_the_first,
    },
    score=lambda case, answer: (abs(answer[0, 0] - case.truth), answer[0, 0]),
)


def rows_of_toys(task):
    """Run a task on the toys, without the columns that are no measures."""
    return [row for row in benchmark.run(task, CASES) if row.measure in task.MEASURES]


def test_methods_are_compared_with_the_best_baseline_case_by_case():
    methods = {**TOY.METHODS, "worse": lambda case: np.full((1, 1), 99)}
    worse = SimpleNamespace(**{**vars(TOY), "METHODS": methods})
    lines = benchmark.table(worse, rows_of_toys(worse))
    assert lines[0] == "| | | off ↓ | guessed ↑ |"
    assert lines[2] == "| toys (5) | *start* | 3.00 [2.00, 4.00] | 3.00 [2.00, 4.00] |"
    assert lines[4] == "|  | guess, refuses 1 | 1.00 [1.00, 1.00]; 4 : 1 | 6.00 [4.50, 7.50]; 4 : 1 |"
    assert lines[5] == "|  | worse | 93 [91, 95]; **0 : 5** | 99 [99, 99]; 5 : 0 |"
    counts = benchmark.summary({"Toys": "\n".join(lines)})[2:]
    assert counts == [
        "| Toys | guess | 1 | 0 | 0 | 0 | 2 | 0 | 0 | 0 |",
        "| Toys | worse | 0 | 0 | 1 | 0 | 1 | 0 | 1 | 0 |",
    ]


def test_a_baseline_counts_on_all_measures_at_once():
    """The second row is worse than one baseline, and the third than none, though one wins each measure."""
    table = "| | | off ↓ | near ↑ |\n|---|\n| toys (2) | *a* | 1.00 | 5.00 |\n|  | *b* | 9 | 9 |\n"
    cells = {
        "better": "0.50; 2 : 0 | 9; 0 : 0",
        "lower": "1.00; 0 : 0 | 4; **0 : 2**",
        "between": "2; **0 : 2** | 8; **0 : 2**",
    }
    lines = [f"|  | {name} | {cell} |" for name, cell in cells.items()]
    counts = benchmark.summary({"Toys": table + "\n".join(lines)})[2:]
    ranks = [line.split(" | ")[2:6] for line in counts]
    assert ranks == [["1", "0", "0", "0"], ["0", "0", "0", "1"], ["0", "0", "1", "0"]]


def test_one_who_is_better_than_one_baseline_and_as_far_as_another_is_between():
    assert benchmark.dominates((1.0, 2.0), (1.0, 1.0))
    assert not benchmark.dominates((1.0, 1.0), (1.0, 1.0))
    assert not benchmark.dominates((2.0, 0.0), (1.0, 1.0))
    assert benchmark.dominates((-9.0, 0.0), (-np.inf, -np.inf))
    assert not benchmark.dominates((-np.inf,), (-np.inf,))


def test_what_is_decided_is_marked_once_and_counted_by_itself():
    text = "| | | shake ↓ | slide, mm ↓ | CPU, s |\n|---|\n| toys (2) | *as it is* | 1 | 5 | 1 |\n"
    text += "|  | clean up | 2; **0 : 2** | 0; 2 : 0 | 1 |\n|  | other | 3; 1 : 1 | 9; **0 : 2** | 1 |"
    once = benchmark.marked("Clean up", text)
    assert once.splitlines()[3] == "|  | clean up | 2; **0 : 2** † | 0; 2 : 0 | 1 |"
    assert benchmark.marked("Clean up", once) == once
    lines = benchmark.list_decided({"Clean up": once})
    assert "wins 2 cells. Of these 1 are decided by\nconstruction (†), which leaves 1:" in lines[0]
    assert any(line.startswith("| Clean up | shake | 1 | ") for line in lines)
    assert benchmark.summary({"Clean up": once})[2].endswith(" | 1 | 0 | 1 | 1 |")


def test_seams_and_time_stand_beside_the_measures_and_the_clips_below():
    body = sample()[:4]
    methods = {"start": lambda case: body, "walk": lambda case: tasks.Walked(body, 0.5)}
    walks = SimpleNamespace(
        MEASURES={"off": True, "long": False},
        BASELINES=("start",),
        METHODS=methods,
        score=lambda case, answer: (case.truth, len(answer)),
        of_clips=lambda case: (np.nan, 7.0),
    )
    lines = benchmark.table(walks, list(benchmark.run(walks, CASES)))
    assert lines[0] == "| | | off ↓ | long ↑ | seams/s | CPU, s |"
    assert [line.split(" | ")[-2] for line in lines[2:]] == ["–", "0.5", "–"]
    assert lines[4].startswith("|  | the clips themselves, refuses 0".removesuffix(", refuses 0"))
    assert lines[4].split(" | ")[2:4] == ["–", "7.00 [7.00, 7.00]"]
    assert [row.method for row in benchmark.rows_of("\n".join(lines))] == ["start", "walk"]


def test_a_task_that_is_run_again_takes_the_place_of_its_section():
    text = benchmark.page({"Webs": "| | | old |\n|---|", "Control": "| | | kept |", "Other": "no task"})
    sections = benchmark.sections_of(text)
    assert list(sections) == ["Control", "Webs"]
    assert sections["Control"] == "| | | kept |"
    again = benchmark.sections_of(benchmark.page({**sections, "Webs": "| | | new |"}))
    assert again == {"Control": "| | | kept |", "Webs": "| | | new |"}


def test_the_page_has_a_section_for_every_task():
    page = benchmark.PAGE.read_text("utf-8")
    found = benchmark.sections_of(page)
    assert list(found) == [benchmark.title_of(name) for name in tasks.TASKS]
    assert benchmark.page(found) == page, "count it anew: python figures/benchmark.py --again"
    for name in tasks.TASKS:
        task = import_module(f"tasks.{name}")
        text = found[benchmark.title_of(name)]
        assert task.__doc__.strip() in page
        assert all(f"| *{one}*" in text for one in task.BASELINES)


def test_an_answer_of_another_program_is_scored_as_those_of_methods(tmp_path):
    for case in CASES[1:]:
        (tmp_path / f"{case.name}.csv").write_text(f"{case.truth - 1}\n")
    rows = [row for row in benchmark.run(TOY, CASES, tmp_path) if row.measure in TOY.MEASURES]
    values = {m: [row.value for row in rows if row.method == m] for m in ("guess", benchmark.ENTERED)}
    assert np.array_equal(values["guess"], values[benchmark.ENTERED], equal_nan=True)  # the first is missing


def test_what_cannot_be_scored_is_refused_in_a_sentence(tmp_path, capsys):
    """Text, a nan, too many columns, and no table at all: none of them ends the others."""
    for case, text in zip(CASES, ("one", "nan", "1,2"), strict=False):
        (tmp_path / f"{case.name}.csv").write_text(text)
    rows = list(benchmark.run(TOY, CASES[:4], tmp_path))
    assert np.isnan([row.value for row in rows if row.method == benchmark.ENTERED]).all()
    words = ("is no table of numbers: could not", "of 1 finite", "of 1 finite", "toy-4.csv not found")
    for line, case, word in zip(capsys.readouterr().err.splitlines(), CASES[:4], words, strict=True):
        assert line.startswith(f"toys, {case.name}: ") and word in line and len(line) <= 200
    with pytest.raises(SystemExit):
        benchmark.main(["webs", "--enter", str(tmp_path / "nowhere")])
    assert "There is no folder" in capsys.readouterr().err


@for_each(tasks.TASKS)
def test_every_task_names_its_clips_measures_and_baselines(name):
    task = import_module(f"tasks.{name}")
    assert task.__doc__ and set(task.BASELINES) < set(task.METHODS) and len(task.MEASURES) <= 6
    assert all(isinstance(less, bool) for less in task.MEASURES.values())
    for collection, names in task.CLIPS.items():
        assert names == tuple(dict.fromkeys(names)), collection
        own = benchmark.clips([one for one in names if "/" not in one], ())
        assert collection != "bundled clips" or len(own) == len(names)


def test_a_perfect_copy_comes_back_from_its_files_with_the_least_errors(tmp_path):
    task = import_module("tasks.in_betweening")
    clips = benchmark.clips(task.CLIPS["bundled clips"], ())
    case = next(case for case in task.cases("bundled clips", clips) if case.name.endswith("-15"))
    benchmark.write(tmp_path, case)
    assert {"past.bvh", "next.bvh", "frames.csv"} < {path.name for path in (tmp_path / case.name).iterdir()}
    mocap.save(case.truth[0], tmp_path / f"{case.name}.bvh")
    assert task.score(case, benchmark.read(tmp_path, case)) == pytest.approx((0, 0, 0), abs=1e-4)
    assert min(task.score(case, task.METHODS["linear"](case))) > 1e-3


TABLE = Path(compare_control.__file__).with_name("control.md")
NAME = "bundled clips"


def rows(label):
    """Give the cells of a way of control: what it is judged by, and how far it is off each path."""
    lines = TABLE.read_text("utf-8").split(f"## {NAME}")[1].split("\n## ")[0].splitlines()
    return [line.strip("| ").split(" | ")[1:] for line in lines if line.startswith(f"| {label} | ")]


def led(make, shape, speed, response):
    ahead = compare_control.distance_ahead(speed, response)
    off, _ = compare_control.lead(make(), SHAPES[shape](), speed, ahead)
    return f"{off.mean():.2f}, {off.max():.2f}"


@pytest.fixture
def clips(monkeypatch):
    monkeypatch.setattr("sys.argv", ["compare_control"])
    return compare_control.clip_sets()[NAME]


def test_matching_follows_a_circle_as_the_table_says(clips):
    some, speed = clips
    table = tabulate(some)
    judged, off = rows("matching, future × 1")
    now = led(lambda: MotionMatcher(table), "circle", speed, float(judged[0].split()[0]))
    cell = off[list(SHAPES).index("circle")]
    kept, now = ([float(part) for part in text.split(", ")] for text in (cell, now))
    assert kept == pytest.approx(now, abs=0.03), "write it anew: python figures/compare_control.py FOLDER"


@pytest.mark.exhaustive
def test_every_way_is_worth_what_the_table_says(clips):
    some, speed = clips
    made, refused = compare_control.prepare_ways(NAME, some)
    assert not refused
    for label, (make, _) in made.items():
        judged, off = rows(label)
        reports = compare_control.judge(make, quality.spread(some), speed)
        assert judged[:-3] == compare_control._judged(reports).split(" | ")[:-2]
        response = float(np.mean([report.delay.mean for report in reports]))
        assert off == [led(make, shape, speed, response) for shape in SHAPES]
