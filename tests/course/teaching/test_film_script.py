"""What a film shows, and for how long."""

import base64

from nbformat.v4 import new_code_cell, new_markdown_cell, new_output

from mocap.course.teaching.deck import Slide
from mocap.course.teaching.film_script import SPEED, script_of

PNG = base64.b64encode(b"picture").decode()


def shows(page="<img>"):
    output = new_output("display_data", {"image/png": PNG, "text/html": page})
    return new_code_cell("", outputs=[output], metadata={"code": "x"})


def script(*cells, label="", recorded=None):
    return script_of([Slide(label, "One", list(cells), "")], recorded or {})


def test_the_words_of_a_slide_stand_below_each_of_its_pictures_as_long_as_they_take_to_read():
    attached = {"attachments": {"a.png": {"image/png": PNG}}}
    (alone,) = script(new_markdown_cell("![An alt text.](attachment:a.png)", **attached))
    assert (alone.kind, alone.words) == ("still", "")
    scenes = script(new_markdown_cell("1. It *falls*.\n2. See `why`.\n\n$$x_i$$"), shows(), shows())
    assert [(scene.kind, scene.words) for scene in scenes] == [("still", "It falls. See why.")] * 2
    (long,) = script(new_markdown_cell("word " * 100), shows())
    assert long.seconds > len(long.words) / SPEED


def test_a_slide_of_words_is_a_card_with_a_point_in_each_line_and_an_empty_one_is_none():
    (card,) = script(new_markdown_cell("- One.\n- B of $\\theta$."))
    assert (card.kind, card.heading, card.words) == ("card", "One", "One.\nB of θ.")
    assert script() == []


def test_exercises_are_for_the_class_and_predictions_are_asked():
    assert script(new_markdown_cell("So?"), shows(), label="Exercise") == []
    (asked,) = script(new_markdown_cell("So?"), label="Predict")
    assert (asked.kind, asked.heading) == ("card", "Predict: One")


def test_an_experiment_moves_where_it_was_recorded():
    page = '<div class="mocap-still"><img>'
    recorded = {"x": {"name": "step", "labels": ["1", "2"], "pictures": [PNG, PNG], "at": 0}}
    (still,), (moving,) = script(shows(page)), script(shows(page), recorded=recorded)
    assert still.kind == "still"
    assert (moving.kind, moving.labels, moving.pictures) == (
        "moving",
        ["step: 1", "step: 2"],
        [b"picture"] * 2,
    )
