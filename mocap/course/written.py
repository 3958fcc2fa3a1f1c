"""Written answers, which a person reads: design tasks, predictions and discussions.

A handout has a cell of text for each of them, with a tag such as `written:design-1`. `mark` collects what
students wrote there, and every other cell of text that the course's notebook does not have.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import Any, NamedTuple

MARKS = {"design": "**Design task.**", "prediction": "**Predict.**", "discussion": "**Discuss.**"}
"""What stands before a question that is answered in words, by the kind of the answer."""

TEMPLATE = "**Your answer:**"
KIND = "written"
OTHER = "a text of the student's"
MOST_LETTERS = 20_000  # of an answer; what follows is cut


class Answer(NamedTuple):
    """A written answer.

    Attributes
    ----------
    handed_in : the path of the notebook.
    question : the name of the cell, such as `design-1`; `OTHER` for a cell that the student has added.
    text : what is written.
    """

    handed_in: str
    question: str
    text: str


def questions_of(notebook: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    """Yield the names of the written answers that a notebook asks for, with the cells of the questions.

    Examples
    --------
    >>> from nbformat.v4 import new_markdown_cell, new_notebook
    >>> texts = ("**Predict.** Which is longer?", "**Design task.** A robot")
    >>> [name for name, _ in questions_of(new_notebook(cells=list(map(new_markdown_cell, texts))))]
    ['prediction-1', 'design-1']
    """
    counts = dict.fromkeys(MARKS, 0)
    for cell in notebook.cells:
        for kind, words in MARKS.items():
            if cell.cell_type == "markdown" and words in cell.source:
                counts[kind] += 1
                yield f"{kind}-{counts[kind]}", cell


def answers_in(notebook: Any, handed_in: str, course: Collection[str]) -> list[Answer]:  # noqa: ANN401
    """List what a student has written in a notebook, without templates that were left as they are.

    Parameters
    ----------
    notebook : as it was handed in.
    handed_in : its path.
    course : the texts of the course's notebook, which are no answers.

    Examples
    --------
    >>> from nbformat.v4 import new_markdown_cell, new_notebook
    >>> cell = new_markdown_cell("**Your answer:** Two.", metadata={"tags": ["written:design-1"]})
    >>> [answer.text for answer in answers_in(new_notebook(cells=[cell]), "ada/02.ipynb", ())]
    ['Two.']
    """
    answers = []
    printed = {_without_numbers(text) for text in course}  # another version of the course has other numbers
    for cell in notebook.cells:
        tags = [str(tag).split(":", 1) for tag in cell.metadata.get("tags", ())]
        names = [tag[1] for tag in tags if tag[0] == KIND and len(tag) > 1]
        text = cell.source.strip().removeprefix(TEMPLATE).strip()
        is_text = cell.cell_type == "markdown" and _without_numbers(cell.source) not in printed
        if text and is_text:
            answers.append(Answer(handed_in, names[0] if names else OTHER, text[:MOST_LETTERS]))
    return answers


def _without_numbers(text: str) -> str:
    return re.sub(r"\d", "", text.strip())
