"""The sheet of questions and the sheet of answers that a key draws, from `teaching/exam.md` of the notebooks.

A drawn text stands between two comments there, `<!--thigh-->40<!--/-->`. The numbers of that file are those
of a key that is published, so that the file can be read and used for practice.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

from mocap.course.exam import cases, graphs_and_walks, poses_and_windows
from mocap.course.exam.drawing import Draws, Question, mark_of
from mocap.course.marking.rosters import read_table
from mocap.course.opening import stored
from mocap.errors import MocapError

PRACTICE = b"the key of the practice sheet"
DRAWN = re.compile(r"<!--(?P<name>\w+)-->(?P<text>.*?)<!--/-->", re.DOTALL)
ASKED = re.compile(r"^\*\*(\d+)\.\*\*", re.MULTILINE)  # where a question begins
PARTS = re.compile(r"^## (.*)$", re.MULTILINE)
PICTURES = ("exam-grid.png", "exam-curve.png")
BY_HAND = {**poses_and_windows.QUESTIONS, **graphs_and_walks.QUESTIONS}
LONGEST = 5_000  # letters of an answer in words
YOURS = "*Your words:*"
FULL = 5  # points of a question

HEAD = """# Answers, version {mark}

For teachers only. The numbers were computed from your key, and the points of each part are in parentheses. \
Answers in words are yours: after *Your words*, write what you expect before you mark. To keep them for the \
next exam, write them into a file of lines such as `28 = "..."`, and give it to `mocap course exam --words`.
"""
CODE = """A submitted function gets the points of each case that it passes, unless it returns the same for \
all. Copy the function and the cases into a notebook, after a first cell with \
`import mocap, numpy as np, networkx as nx` and `from mocap import plain`. \
Look at functions that pass no case: the reason may be a misprint.
"""
CASE = """{kind} ({points}):

```python
{source}
```
"""


def write_exam(key: bytes, words: Mapping[int, str]) -> dict[str, str | bytes]:
    """Return the files of an exam by their names: questions, answers, and the pictures of questions.

    Parameters
    ----------
    key : from `read_key`.
    words : the teacher's answers in words, from `read_words`.
    """
    folder = stored() / "teaching"
    text = (folder / "exam.md").read_text("utf-8")
    files: dict[str, str | bytes] = {name: (folder / name).read_bytes() for name in PICTURES}
    files["exam.md"] = DRAWN.sub(r"\g<text>", filled(text, key, f"Version {mark_of(key)}.", "formula sheet"))
    files["answers.md"] = answers(text, key, words)
    return files


def read_words(file: Path | None) -> dict[int, str]:
    """Read answers in words, from lines `28 = "..."` with the numbers of questions.

    Raises
    ------
    MocapError : if the file cannot be read, names no question, or holds what is no text.

    Examples
    --------
    >>> read_words(None)
    {}
    """
    table: dict[str, object] = read_table(file, tomllib.loads) if file else {}
    numbers = {str(number) for number in _numbers((stored() / "teaching" / "exam.md").read_text("utf-8"))}
    words = {}
    for name, text in table.items():
        if name not in numbers:
            raise MocapError(f"{file}: '{name:.40}' is no question; the exam has 1 to {len(numbers)}.")
        if not isinstance(text, str) or len(text) > LONGEST:
            raise MocapError(f"{file}: {name} is no text of at most {LONGEST} letters.")
        words[int(name)] = text
    return words


def filled(text: str, key: bytes, version: str = "", formulas: str = "") -> str:
    """Write the numbers that a key draws into the questions.

    Parameters
    ----------
    text : of `exam.md`.
    key : the key.
    version : replaces the sentence about the example numbers, if it is given.
    formulas : replaces the link to the formula sheet, if it is given.

    Raises
    ------
    KeyError : if the text has a name that no question draws.
    """
    values = {name: value for question in drawn(key).values() for name, value in question.values.items()}
    fixed = {"version": version, "formulas": formulas}

    def new(match: re.Match[str]) -> str:
        name = match["name"]
        value = (fixed[name] or match["text"]) if name in fixed else values[name]
        return f"<!--{name}-->{value}<!--/-->"

    return DRAWN.sub(new, text)


def drawn(key: bytes) -> dict[int, Question]:
    """Draw the questions by hand."""
    return {number: draw(Draws(key, number)) for number, draw in BY_HAND.items()}


def answers(text: str, key: bytes, words: Mapping[int, str]) -> str:
    """Write the sheet of answers.

    Parameters
    ----------
    text : of `exam.md`, whose questions are answered in its order and under its headings.
    key : the key.
    words : the teacher's answers in words.
    """
    questions = drawn(key)
    lines = [HEAD.format(mark=mark_of(key))]
    _, *parts = PARTS.split(text)
    for heading, body in zip(parts[::2], parts[1::2], strict=True):
        lines.append(f"## {heading}\n")
        numbers = _numbers(body)
        if numbers[0] in cases.QUESTIONS:
            lines.append(CODE)
        for number in numbers:
            lines.append(f"**{number}.**{''.join(_answer(number, key, questions.get(number)))}")
            lines.append(_words(number, questions.get(number), words))
    return "\n".join(line for line in lines if line)


def _numbers(text: str) -> list[int]:
    """List the numbers of the questions of a text."""
    return [int(number) for number in ASKED.findall(text)]


def _answer(number: int, key: bytes, question: Question | None) -> Iterator[str]:
    """Yield the parts of an answer that are computed."""
    if question:
        yield "\n"
        for result in question.results:
            yield f"\n- {result}"
        yield "\n"
    elif number in cases.QUESTIONS:
        build = cases.QUESTIONS[number]
        yield f" `{build.__name__}`\n"
        tests = list(build(Draws(key, number)))
        for kind, source in tests:
            yield "\n" + CASE.format(kind=kind, points=f"{FULL / len(tests):.3g}", source=source)
    else:
        yield f" In words ({FULL}).\n"


def _words(number: int, question: Question | None, words: Mapping[int, str]) -> str:
    """Return the place of an answer in words, or the answer."""
    if number in words:
        return f"{words[number]}\n"
    if question and not question.reasons:
        return ""
    reasons = "; ".join(question.reasons) if question else ""
    return f"{reasons}{': ' if reasons else ''}{YOURS}\n"
