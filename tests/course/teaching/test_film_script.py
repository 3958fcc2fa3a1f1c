"""What a film shows, and for how long."""

import base64

from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from mocap.course.teaching.film_script import ENDS, LEARNT, SPEED, script_of
from tests.course.stored_notebooks import every_notebook, read

PNG = base64.b64encode(b"picture").decode()


def text(source, *tags):
    return new_markdown_cell(source, metadata={"tags": list(tags)})


def shows(source="x", page="<img>"):
    return new_code_cell(source, outputs=[new_output("display_data", {"image/png": PNG, "text/html": page})])


def script(*cells, recorded=None):
    return script_of(new_notebook(cells=cells), recorded or {})


@every_notebook
def test_a_film_lasts_three_minutes_and_its_words_can_be_read(name):
    scenes = script_of(read(name), {})
    assert 149.99 < sum(scene.seconds for scene in scenes) <= 210
    assert len(scenes) >= 6
    for scene in scenes:
        assert len(scene.words) <= SPEED * scene.seconds
        assert scene.heading
        assert scene.kind != "card" or scene.longer == 1  # nobody reads the same words for a minute
        assert all(line.endswith(ENDS) for line in scene.words.splitlines())
        assert not set("$`<") & set(scene.words)
    assert scenes[-1].heading == LEARNT
    assert scenes[0].words


def test_the_first_sentences_stand_below_the_first_picture_and_the_last_ones_below_the_next():
    first, second = script(text("## One\n\nLook. See."), shows(), text("It falls. Why?"), shows())
    assert (first.words, second.words) == ("Look. See.", "It falls. Why?")


def test_a_picture_without_words_of_its_own_has_its_sentence():
    _, second = script(text("## One\n\nLook."), shows(), shows(page='<img alt="A &amp; B rise.">'))
    assert second.words == "A & B rise."


def test_what_is_wrong_on_purpose_and_what_is_asked_is_not_shown():
    scenes = script(
        text("## One\n\nLook."),
        text("**Bug hunt.** Why?"),
        shows(),
        text("**Predict.** So?", "prediction"),
        text("Write it.", "ask:f"),
        text("## Read on\n\nBooks."),
    )
    assert [(scene.kind, scene.words) for scene in scenes] == [("card", "Look.")]


def test_an_experiment_moves_where_it_was_recorded():
    page = '<div class="mocap-still"><img>'
    recorded = {"x": {"name": "step", "labels": ["1", "2"], "pictures": [PNG, PNG], "at": 0}}
    (still,) = script(text("## One\n\nLook."), shows(page=page))
    (moving,) = script(text("## One\n\nLook."), shows(page=page), recorded=recorded)
    assert still.kind == "still"
    assert (moving.kind, moving.labels, moving.pictures) == (
        "moving",
        ["step: 1", "step: 2"],
        [b"picture"] * 2,
    )


def test_what_one_learnt_is_a_list():
    (scene,) = script(text("## What you learnt\n\n- One. More\n- B of $\\theta$."))
    assert scene.words == "One.\nB of θ."


def test_an_empty_notebook_has_no_film():
    assert script() == []
