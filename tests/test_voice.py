"""Names that users see are the field's terms, and each exception has its reason."""

import ast
import subprocess
import sys
from textwrap import dedent

import pytest

from tests import voice


def names(code):
    return {name for _, name in voice.public_names(ast.parse(dedent(code)))}


# The package ------------------------------------------------------------------------------------------------


def test_no_public_name_holds_a_private_word():
    found = [finding for finding in voice.all_findings() if finding.name not in voice.EXCEPTIONS]
    lines = [f"{f.path}:{f.line}: {f.name}: {voice.TERMS[f.word]}" for f in found]
    assert not lines, "\n".join(lines)


def test_exceptions_are_few_and_have_a_reason():
    assert len(voice.EXCEPTIONS) <= voice.MOST_EXCEPTIONS == 40
    for name, reason in voice.EXCEPTIONS.items():
        assert voice.private_word(name), f"{name} needs no exception"
        assert len(reason.split()) >= 4, f"{name}: {reason}"


def test_every_exception_occurs():
    assert set(voice.EXCEPTIONS) <= {finding.name for finding in voice.all_findings()}


def test_every_term_has_words_in_its_place():
    for word, term in voice.TERMS.items():
        assert word.isalpha() and word.islower() and term
        assert word not in voice.words_of(term.replace(" ", "_").replace(",", "_")), word


@pytest.mark.parametrize("room", voice.WAITING)
def test_rooms_that_wait_exist_and_still_have_to(room):
    path = voice.ROOT / room
    files = [path] if path.suffix else sorted(path.rglob("*.py"))
    assert all(map(voice.is_waiting, files))
    assert any(finding for file in files for finding in voice.findings(file)), "nothing left to wait for"


# The search -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("plant_slides", ["plant", "slides"]),
        ("PlantSlide", ["plant", "slide"]),
        ("BVHPlace", ["bvhplace"]),
        ("slide2Turn", ["slide2", "turn"]),
        ("__move__", ["move"]),
        ("place()", ["place"]),
        ("turning", ["turning"]),
    ],
)
def test_names_are_split_at_underscores_and_capitals(name, words):
    assert voice.words_of(name) == words


@pytest.mark.parametrize(
    ("name", "word"), [("find_hops()", "hops"), ("Wishes", "wishes"), ("moved", None), ("footplant", None)]
)
def test_a_private_word_is_a_whole_word(name, word):
    assert voice.private_word(name) == word


def test_names_are_those_of_functions_classes_parameters_and_fields():
    code = """
        def walk(first, /, second, *rest, third=0, **others):
            inner = first

        async def wait(): ...

        class Walk:
            pace: float
            seams = 0

            def __init__(self, gap):
                self.hop = gap
                self._hidden = 0
        """
    parameters = {"first", "second", "rest", "third", "others"}
    assert names(code) == {"walk()", "wait()", "Walk", "pace", "seams", "hop"} | parameters


def test_names_with_an_underscore_are_left_out():
    assert names("def _walk(way): ...") == set()
    assert names("class _Walk:\n    way: int") == set()


def test_a_file_waits_if_its_room_does():
    mocap = voice.ROOT / "mocap"
    assert voice.is_waiting(mocap / "editing" / "pins.py")
    assert voice.is_waiting(mocap / "steering" / "characters.py")
    assert not voice.is_waiting(mocap / "steering" / "followed.py")
    assert not voice.is_waiting(mocap / "editing_rooms.py")


def test_findings_have_the_line_and_the_word(monkeypatch, tmp_path):
    monkeypatch.setattr(voice, "ROOT", tmp_path)
    path = tmp_path / "walks.py"
    path.write_text("STEP = 1\n\n\ndef find_hops(graph): ...\n", "utf-8")
    assert list(voice.findings(path)) == [voice.Finding("walks.py", 4, "find_hops()", "hops")]


def test_docstrings_that_begin_with_no_function_are_listed(tmp_path):
    path = tmp_path / "walks.py"
    path.write_text(
        'def give():\n    """Give a walk."""\n\n\ndef walk():\n    """Return a walk."""\n', "utf-8"
    )
    assert list(voice.openings(path)) == [(1, "Give a walk.")]


def test_prose_is_that_of_docstrings_and_comments():
    assert voice.prose_of('"""A walk."""\nx = "text"  # a comment\n') == '"""A walk."""\n# a comment'


@pytest.mark.parametrize("option", [[], ["--count"]])
def test_it_runs_as_a_script(option):
    command = [sys.executable, "tests/voice.py", *option]
    ran = subprocess.run(command, cwd=voice.ROOT, capture_output=True, text=True, encoding="utf-8")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ("words of docstrings" in ran.stdout) == bool(option)
