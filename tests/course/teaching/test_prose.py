"""Markdown cut into blocks and sentences."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.course.teaching.prose import blocks, sentences, shortened, spoken
from tests.course.stored_notebooks import read


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("One. Two! Three? Four", ["One.", "Two!", "Three?", "Four"]),
        ("See Eq. 4 of A. Smith. *Then* go.", ["See Eq. 4 of A. Smith.", "*Then* go."]),
        ("**Predict.** What? It is 3.5 cm.", ["**Predict.**", "What?", "It is 3.5 cm."]),
        ("It is so (see there. And [there. Too](x.md#y. Z)). Then.", None),
        (
            "The sum $a. B$ and `c. D` stay. [Gle98] asks.",
            ["The sum $a. B$ and `c. D` stay.", "[Gle98] asks."],
        ),
    ],
)
def test_sentences_end_where_a_reader_says(text, parts):
    found = sentences(text)
    assert found == parts if parts else " ".join(found) == text and len(found) == 2


def test_a_lead_is_no_sentence_and_more_is_given_where_there_is_room():
    text = "**Bug hunt.** A walk stumbles. Why? Look at the seam."
    assert shortened(text) == "**Bug hunt.** A walk stumbles."
    assert shortened(text, 40) == "**Bug hunt.** A walk stumbles. Why?"
    assert shortened("It is *not so. At all.*") == "It is *not so.*"


def test_what_is_no_prose_stays_whole():
    for block in ("$$a. B$$", "| a. B |", "![A. B](c.png)", "## Why? So"):
        assert shortened(block) == block


def test_a_list_keeps_its_items():
    assert shortened("1. one. More\n   here. Yes\n2. two") == "1. one. More here."[:7] + "\n2. two"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("A [*node*](G.md#n) of `graph`, [1, section 2].", "A node of graph,."),
        (r"From $\alpha$ to $x \le 2$.", "From α to x ≤ 2."),
        (r"So $\sum_k x_k$.", ""),
        ("<img>", ""),
        ("It is 3<!--= n --> cm.", "It is 3 cm."),
    ],
)
def test_captions_are_plain_words(text, words):
    assert spoken(text) == words


@given(st.text(alphabet="ab. AB?!*$`()[]\n", max_size=60))
def test_no_text_loses_a_word(text):
    assert " ".join(sentences(text)).split() == text.split()
    for block in blocks(text):
        assert shortened(block)


def test_the_blocks_of_a_notebook_hold_all_its_words():
    for cell in read("04-blending").cells:
        if cell.cell_type == "markdown" and "<!--" not in cell.source:
            assert "".join(" ".join(blocks(cell.source)).split()) == "".join(cell.source.split())
