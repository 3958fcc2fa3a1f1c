"""An exam that a key draws: the same from the same key, and its answers are right."""

import re
import shutil
import stat
import subprocess
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest

import mocap
from mocap import plain
from mocap.cli.main import main
from mocap.course.exam import cases, drawing, sheets, wording
from mocap.course.exam.drawing import Draws, read_key
from mocap.course.opening import stored
from tests.refusals import refused

KEYS = [f"key {number} of the tests of the exam".encode() for number in range(12)]
FILE = stored() / "teaching" / "exam.md"
TEXT = FILE.read_text("utf-8")
POINTS = re.compile(r"\((\d(?:\.\d+)?)(?:, or 1 [^)]*)?\)")


def question(number, key):
    return sheets.drawn(key)[number]


def numbers_in(text):
    """List the numbers of a text, with the minus signs of prose."""
    return [float(part.replace("−", "-")) for part in re.findall(r"[−-]?\d+(?:\.\d+)?", text)]


def complex_of(text):
    """Read a complex number as the exam writes it."""
    text = re.sub(r"(?<![\d.])i", "1i", text.replace("−", "-").replace(" ", "").strip("$"))
    return complex(text.replace("i", "j"))


def window(text):
    """Read the points of a window, such as `$g = 0,\\ 2$`, as x, y and z."""
    ground = [complex_of(part) for part in text.strip("$").partition("=")[2].split(",\\")]
    return np.array([[point.imag, 0, point.real] for point in ground])


def run(case, function):
    """Run the source of a case on a function."""
    _, source = case
    (name,) = {build.__name__ for build in cases.QUESTIONS.values() if f"{build.__name__}(" in source}
    exec(source, {"np": np, "nx": nx, "mocap": mocap, "plain": plain, name: function})


def passes(number, key, function):
    """Return whether a function passes all cases of a question."""
    for case in cases.QUESTIONS[number](Draws(key, number)):
        try:
            run(case, function)
        except Exception:
            return False
    return True


def test_the_practice_sheet_has_the_numbers_of_the_published_key():
    assert sheets.filled(TEXT, sheets.PRACTICE) == TEXT


def test_the_same_key_draws_the_same_exam_and_others_draw_others():
    exams = [sheets.write_exam(key, {}) for key in KEYS]
    assert exams[0] == sheets.write_exam(KEYS[0], {})
    for name in ("exam.md", "answers.md"):
        assert len({exam[name] for exam in exams}) == len(KEYS)


@pytest.mark.parametrize("number", sorted({*sheets.BY_HAND, *cases.QUESTIONS}))
def test_each_question_is_drawn_by_the_key_alone(number):
    if number in cases.QUESTIONS:
        drawn = {repr([*cases.QUESTIONS[number](Draws(key, number))]) for key in KEYS}
    else:
        drawn = {repr(question(number, key)) for key in KEYS}
    assert len(drawn) >= len(KEYS) - 4  # few questions have only some dozens of variants


def test_no_number_is_drawn_twice_from_one_hash():
    draws = [Draws(key, number).integer(name, 0, 10**9) for key in KEYS for number in (1, 2) for name in "ab"]
    assert len(set(draws)) == len(draws)


def test_all_drawn_numbers_are_asked():
    asked = {match["name"] for match in sheets.DRAWN.finditer(TEXT)} - {"version", "formulas"}
    assert asked == {name for q in sheets.drawn(KEYS[0]).values() for name in q.values}


def test_each_answer_has_five_points():
    for key in KEYS:
        for number, drawn in sheets.drawn(key).items():
            points = [float(p) for text in (*drawn.results, *drawn.reasons) for p in POINTS.findall(text)[:1]]
            assert sum(points) == sheets.FULL, number


def test_students_see_no_mark_of_a_drawn_number_and_no_answer():
    exam = sheets.write_exam(KEYS[0], {30: "It tilts the floor."})
    assert "<!--" not in exam["exam.md"] and "../" not in exam["exam.md"]
    assert drawing.mark_of(KEYS[0]) in exam["exam.md"] and drawing.mark_of(KEYS[0]) in exam["answers.md"]
    assert "It tilts the floor." in exam["answers.md"] and "It tilts the floor." not in exam["exam.md"]
    assert set(re.findall(r"\]\(([^)]*)\)", exam["exam.md"])) <= set(exam)


@pytest.mark.parametrize("key", KEYS)
def test_answers_by_hand_agree_with_the_course(key):
    drawn = sheets.drawn(key)
    rotation, translation = plain.align(window(drawn[3].values["g"]), window(drawn[3].values["h"]))
    assert numbers_in(drawn[3].results[0])[0] == round(np.degrees(np.angle(rotation)))
    assert np.isclose(complex_of(drawn[3].results[1].split(" is ")[1].split(":")[0]), translation)
    larger = plain.window_distance(window(drawn[3].values["g"]), window(drawn[4].values["h_larger"]))
    assert np.isclose(numbers_in(drawn[4].results[1])[0], larger)
    factor, shift = (complex_of(drawn[6].values[name].partition("=")[2]) for name in ("factor", "shift"))
    root = factor * float(drawn[6].values["ahead"]) + shift
    assert numbers_in(drawn[6].results[0].partition(":")[2])[:2] == [root.imag, root.real]
    back = complex_of(drawn[6].results[2].removeprefix("and translates by ").partition(" (")[0])
    assert np.isclose(np.conj(factor) * root + back, float(drawn[6].values["ahead"]))


@pytest.mark.parametrize("key", KEYS)
def test_the_leg_of_question_two_has_its_length(key):
    leg = {name: float(text) for name, text in question(2, key).values.items()}
    height, ahead = (numbers_in(text)[0] for text in question(2, key).results[1:])
    behind = "behind" in question(2, key).results[2]
    ankle = np.array([-ahead if behind else ahead, height - leg["hip"]])
    length = leg["thigh"] ** 2 + leg["shank"] ** 2  # law of cosines
    length += 2 * leg["thigh"] * leg["shank"] * np.cos(np.radians(leg["backwards"]))
    assert abs(np.linalg.norm(ankle) - np.sqrt(length)) < 0.15  # both are rounded to 0.1


@pytest.mark.parametrize("key", KEYS)
def test_minima_of_question_five_are_those_of_the_course(key):
    rows = [
        numbers_in(line.replace("**", ""))[1:] for line in question(5, key).values["grid"].split("\n")[4:9]
    ]
    found = [tuple(map(int, cell)) for cell in plain.local_minima(np.array(rows), 4)]
    inner = [cell for cell in found if 0 < cell[0] < 4 and 0 < cell[1] < 5]
    assert [*zip(*[iter(numbers_in(question(5, key).results[0])[:4])] * 2, strict=True)] == inner


@pytest.mark.parametrize("key", KEYS)
def test_graphs_by_hand_have_the_size_that_the_course_counts(key):
    drawn = sheets.drawn(key)
    count = {"Two": 2, "Three": 3, "Four": 4}[drawn[10].values["clips"]]
    matches = int(drawn[10].values["matches"])
    found = [(0, 30 * n, 1, 30 * n + 12, 0.0, (1, 0)) for n in range(1, matches + 1)]
    found += [(b, j, a, i, cost, transform) for a, i, b, j, cost, transform in found]
    graph = plain.cut_and_join([range(400)] * count, found)
    assert [len(graph), graph.size()] == [numbers_in(text)[0] for text in drawn[10].results]
    early, late = (int(drawn[11].values[name]) for name in ("early", "late"))
    pair = [(0, early, 0, late, 0.0, (1, 0)), (0, late, 0, early, 0.0, (1, 0))]
    looped = nx.DiGraph(plain.cut_and_join([range(240)], pair))
    loops = [sum(looped.edges[e]["frames"] for e in pairwise([*c, c[0]])) for c in nx.simple_cycles(looped)]
    assert numbers_in(drawn[11].results[1])[2] == min(loops)


@pytest.mark.parametrize("key", KEYS)
def test_the_missing_arrow_connects_the_whole_graph_and_no_other_does(key):
    drawn = question(12, key)
    arrows = [tuple(map(int, pair)) for pair in re.findall(r"(\d) → (\d)", drawn.values["arrows"])]
    stated = {tuple(map(int, pair)) for pair in re.findall(r"(\d) → (\d)", drawn.results[2])}
    for a in range(1, 8):
        for b in {*range(1, 8)} - {a}:
            is_whole = nx.is_strongly_connected(nx.DiGraph([*arrows, (a, b)]))
            assert is_whole == ((a, b) in stated)
    parts = [
        set(map(int, part)) for part in re.findall(r"{(\d)(?:, (\d), (\d))?}", drawn.results[0]) if part[1]
    ]
    assert sorted(map(sorted, parts)) == sorted(
        sorted(part) for part in nx.strongly_connected_components(nx.DiGraph(arrows)) if len(part) > 1
    )


@pytest.mark.parametrize("key", KEYS)
def test_walks_of_question_fourteen_are_expanded_as_a_search_expands_them(key):
    values = {name: [int(n) for n in numbers_in(text)] for name, text in question(14, key).values.items()}
    tree = dict(zip("ABC", values["branches"], strict=True))

    def expanded(bound):
        best, count, waiting = np.inf, 0, [(0, "")]
        while waiting:
            cost, node = waiting.pop()
            if cost + bound * (node != "goal") >= best:
                continue
            if node == "goal":
                best = cost
                continue
            count += 1
            goals = [(cost + price, "goal") for price in values.get(f"goals_{node.lower()}", [])]
            waiting += sorted(
                goals if node else [(price, name) for name, price in tree.items()], reverse=True
            )
        return count

    assert [expanded(0), expanded(1)] == [numbers_in(text)[0] for text in question(14, key).results]


def farthest_by_loops(clip):
    """Find the farthest joint with the loops that the question forbids."""
    best = ("", 0.0)
    for positions in plain.joint_positions(clip):
        for name, position in zip(clip.skeleton.names, positions, strict=True):
            best = max(best, (name, np.linalg.norm(position - positions[0])), key=lambda found: found[1])
    return best


def steps_by_simulation(odds):
    """Follow many walks, which the question allows for a test only: here as powers of the matrix."""
    return sum(np.linalg.matrix_power(odds, n).sum(axis=1) for n in range(1, 400))


@pytest.mark.parametrize("key", KEYS[:4])
def test_functions_by_forbidden_ways_pass_the_cases(key):
    assert passes(16, key, farthest_by_loops)
    assert passes(21, key, lambda p, q: plain.slerp(p, q, 0.5))
    assert passes(27, key, steps_by_simulation)


def stated(*_):
    return 0


def nothing(*_):
    return None


@pytest.mark.parametrize("number", cases.QUESTIONS)
@pytest.mark.parametrize("function", [stated, nothing])
def test_a_function_that_ignores_its_input_fails(number, function):
    assert not passes(number, KEYS[0], function)


def test_a_function_with_a_typical_mistake_fails():
    def unturned(p, q):  # without the translation
        return np.sqrt(((p - q) ** 2).sum(axis=1).mean())

    def plain_sum(p, q):  # the longer arc for the other sign
        return (p + q) / np.linalg.norm(p + q)

    def farthest_from_origin(clip):
        away = np.linalg.norm(plain.joint_positions(clip), axis=-1).max(axis=0)
        return clip.skeleton.names[away.argmax()], away.max()

    for number, wrong in ((18, unturned), (21, plain_sum), (16, farthest_from_origin)):
        assert not passes(number, KEYS[0], wrong)


def test_no_file_of_the_checkout_answers_the_exam():
    folder = stored() / "teaching"
    if shutil.which("git") and (folder.parents[1] / ".git").exists():
        tracked = subprocess.run(
            ["git", "ls-files", "."], cwd=folder, capture_output=True, text=True, check=True
        )
        names = tracked.stdout.split()
        assert "exam.md" in names and not [name for name in names if "answers" in name]


# The command -----------------------------------------------------------------------------------------------


def test_the_command_makes_a_key_once_and_draws_the_same_exam_again(tmp_path, capsys):
    key = tmp_path / "exam.key"
    assert main(["course", "exam", "--key", str(key), "-o", str(tmp_path / "one")]) == 0
    assert "wrote a new key" in capsys.readouterr().out
    assert stat.S_IMODE(key.stat().st_mode) & 0o077 == 0
    assert main(["course", "exam", "--key", str(key), "-o", str(tmp_path / "two")]) == 0
    assert "new key" not in capsys.readouterr().out
    written = {path.name: path.read_bytes() for path in (tmp_path / "one").iterdir()}
    assert written == {path.name: path.read_bytes() for path in (tmp_path / "two").iterdir()}
    assert set(written) == {"exam.md", "answers.md", *sheets.PICTURES}
    other = tmp_path / "other.key"
    assert read_key(other)[0] != read_key(key)[0]


def test_answers_that_a_teacher_has_edited_are_not_replaced(tmp_path, capsys):
    line = ["course", "exam", "--key", str(tmp_path / "exam.key"), "-o", str(tmp_path / "exam")]
    assert main(line) == 0
    (tmp_path / "exam" / "answers.md").write_text("mine")
    assert main(line) == 2
    assert "exists already; choose another folder" in capsys.readouterr().err
    assert (tmp_path / "exam" / "answers.md").read_text() == "mine"


def test_words_of_the_teacher_are_in_the_answers(tmp_path):
    words = tmp_path / "words.toml"
    words.write_text('28 = "Half a stride apart (2)."\n1 = "A quaternion contains half the angle."\n')
    line = [
        "course",
        "exam",
        "--key",
        str(tmp_path / "k"),
        "--words",
        str(words),
        "-o",
        str(tmp_path / "exam"),
    ]
    assert main(line) == 0
    answers = (tmp_path / "exam" / "answers.md").read_text("utf-8")
    assert "Half a stride apart (2)." in answers and "A quaternion contains half the angle." in answers


def test_a_bad_key_is_refused(tmp_path):
    short = tmp_path / "short.key"
    short.write_text("2026\n")
    refused("short.key: a key has 20 to 10000 characters, got 4", read_key, short)
    long = tmp_path / "long.key"
    long.write_bytes(b"x" * 20_000)
    refused("long.key: a key has 20 to 10000 characters, got more", read_key, long)
    refused("Is a directory", read_key, tmp_path)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('41 = "x"', "'41' is no question; the exam has 1 to 40"),
        ("28 = 3", "28 is no text of at most 5000 letters"),
        (f'28 = "{"x" * 5001}"', "28 is no text of at most 5000 letters"),
        ("28 = ", "cannot be read"),
    ],
)
def test_bad_words_are_refused(tmp_path, text, said):
    (tmp_path / "words.toml").write_text(text)
    refused(said, sheets.read_words, tmp_path / "words.toml")


def test_numbers_are_written_as_in_prose():
    assert [wording.number(value) for value in (-0.0001, 1.5, -2)] == ["0", "1.5", "−2"]
    assert [wording.complex_number(z) for z in (0j, -1j, 2 + 1j, -2 - 3j)] == ["0", "−i", "2 + i", "−2 − 3i"]
