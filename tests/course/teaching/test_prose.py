"""Markdown as words."""

import pytest

from mocap.course.teaching.prose import spoken


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("A [*node*](G.md#n) of `graph`, [1, section 2].", "A node of graph,."),
        (r"From $\alpha$ to $x \le 2$.", "From α to x ≤ 2."),
        (r"So $\sum_k x_k$.", ""),
        ("From $x_0$ to $k^2$.", "From x₀ to k²."),
        ("<img>", ""),
        ("It is 3<!--= n --> cm.", "It is 3 cm."),
    ],
)
def test_captions_are_plain_words(text, words):
    assert spoken(text) == words
