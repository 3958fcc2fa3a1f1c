"""Numbers in prose: found, compared with their values, and written anew."""

import json

import nbformat
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nbclient.exceptions import CellExecutionError

from mocap.course import notebooks, real_clips
from mocap.course.marked_values import Marked, compare, marked, question, refreshed, values_of, wrong
from tests.refusals import refused


@given(st.floats(-1e6, 1e6), st.integers(0, 3))
def test_a_value_written_into_the_text_agrees_with_it(value, decimals):
    shown = f"{1:.{decimals}f}"
    text = refreshed(f"It is {shown}<!--= x --> cm.", {"x": value})
    assert wrong(text, {"x": value}) == []
    assert refreshed(text, {"x": value}) == text


@pytest.mark.parametrize(
    ("shown", "value", "agrees"),
    [
        ("2.8", 2.84, True),
        ("2.8", 2.86, False),
        ("−2.8", -2.8, True),
        ("-3", -3.2, True),
        ("17 000", 17000, True),
        ("17 000", 17001, False),
        ("997", np.int64(997), True),
    ],
)
def test_a_number_agrees_to_the_digits_shown(shown, value, agrees):
    (mark,) = marked(f"so **{shown}<!--= x -->** it is")
    assert mark == Marked(shown, False, "x")
    assert mark.agrees(float(value)) == agrees


def test_an_approximate_number_is_within_a_tenth():
    (mark,) = marked("about 500<!--~ ratio -->")
    assert mark.is_approximate
    assert [mark.agrees(value) for value in (440, 460, 550, 560)] == [False, True, True, False]


def test_signs_and_gaps_are_kept_when_a_number_is_written_anew():
    text = "2<!--= n --> of −1.0<!--= x -->, and 9 000<!--= big -->, and 10<!--= same -->"
    new = refreshed(text, {"n": 21, "x": -2.25, "big": 12345, "same": 10})
    assert new == "21<!--= n --> of −2.2<!--= x -->, and 12 345<!--= big -->, and 10<!--= same -->"


def test_what_has_no_value_stays_and_is_listed():
    values = values_of(["n + 1", "1 / 0"], {"n": 1})
    text = "2<!--= n + 1 --> and 5<!--= 1 / 0 -->"
    assert refreshed(text, values) == text
    assert wrong(text, values) == ["The text says 5; '1 / 0' gives ZeroDivisionError: division by zero."]
    with pytest.raises(ValueError, match="The text says 3; 'n' gives 1"):
        compare(["3<!--= n -->", "1<!--= n -->"], {"n": 1})


def test_a_mark_without_a_number_is_an_error():
    refused("No number stands directly before", list, marked("some <!--= n -->"), kind=ValueError)


def test_the_question_is_answered_in_a_line_of_json(capsys):
    exec(question(["3<!--= n --> of 4<!--= 2 * n -->"]), {"n": 2})
    assert json.loads(capsys.readouterr().out) == {"n": 2, "2 * n": 4}


def test_a_number_that_nothing_computes_stops_the_run(tmp_path, monkeypatch):
    values = json.dumps({"off": 2.25, "gone": "NameError"})
    answered, path = [nbformat.v4.new_output("stream", name="stdout", text=values)], tmp_path / "n.ipynb"
    monkeypatch.setattr(notebooks, "execute", lambda run, _: run.cells[-1].update(outputs=answered))
    cells = [nbformat.v4.new_markdown_cell(f"It is 9.9<!--= {name} --> cm off.") for name in ("off", "gone")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    refused("n.ipynb, cell 1: The text says 9.9; 'gone' gives NameError", notebooks.run, path, tmp_path)
    cells[1].metadata["tags"] = ["real"]  # the clips that it needs may be missing
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    notebooks.run(path, tmp_path)
    assert nbformat.read(path, 4).cells[0].source == "It is 2.2<!--= off --> cm off."


class Undisplayed:
    """A run whose first cell computes a result that cannot be displayed: the reply names no error."""

    def __init__(self, notebook, **options):
        self.notebook = notebook

    def execute(self, **options):
        self.on_cell_start(cell=self.notebook.cells[0], cell_index=0)
        output = nbformat.v4.new_output("error", ename="ValueError", evalue="no picture", traceback=[])
        self.notebook.cells[0].outputs = [output]
        raise CellExecutionError("", "NoneType", "None")


def test_a_result_that_cannot_be_displayed_is_named_by_its_error(tmp_path, monkeypatch):
    monkeypatch.setattr("nbclient.NotebookClient", Undisplayed)
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("shown")])
    path = tmp_path / "n.ipynb"
    refused("n.ipynb, cell 0: ValueError: no picture", notebooks.execute, notebook, path)


def test_people_are_given_or_a_sentence(monkeypatch, capsys):
    monkeypatch.setattr(real_clips.datasets, "cmu", lambda name: name.upper())
    assert real_clips.people("a", "b") == ["A", "B"]
    assert capsys.readouterr().out == ""
