"""Formulas of Markdown as MathML, which browsers draw themselves, without a network."""

from __future__ import annotations

import re

from mocap.errors import missing

try:
    from docutils.utils.math.latex2mathml import tex2mathml
except ImportError as error:
    raise missing("Formulas on slides need docutils, which is not installed", "slides") from error

# What the converter does not know.
OTHERWISE = {"°": r"^\circ ", r"\dots": r"\ldots", r"\big": "", r"\Big": ""}
NAME = r"(?:<msup>\s*)?<mi>[a-z]{2,}</mi>"  # of a function, such as sin
BEFORE = re.compile(rf"(</m(?:i|n|row|su[bp]|subsup|frac|sqrt)>\s*)(?={NAME})")
AFTER = re.compile(r"<mo>&ApplyFunction;</mo>(?=\s*<m[^o])")
DOTTED = re.compile(r"<munderover>\s*(<mi>\w</mi>)([^˙¨]+)(<mo[^>]*>[˙¨]</mo>)\s*</munderover>")
CLOSING = re.compile(r"(<msup>\s*<mo)(>[|‖])")  # else it is drawn too low
THIN = '<mspace width="0.167em"/>'


def to_mathml(formula: str, *, block: bool = False) -> str:
    r"""Write a formula as MathML, with thin spaces around the names of functions, as TeX sets them.

    Parameters
    ----------
    formula : in LaTeX.
    block : whether it stands on a line of its own.

    Examples
    --------
    >>> print(to_mathml(r"\sin\theta"))
    <math xmlns="http://www.w3.org/1998/Math/MathML">
      <mi>sin</mi>
      <mspace width="0.167em"/>
      <mi>θ</mi>
    </math>
    """
    for command, replacement in OTHERWISE.items():
        formula = formula.replace(command, replacement)
    drawn = DOTTED.sub(r"<msub><mover>\1\3</mover>\2</msub>", tex2mathml(formula, as_block=block))
    drawn = CLOSING.sub(r'\1 stretchy="false"\2', drawn)
    return AFTER.sub(THIN, BEFORE.sub(rf"\1{THIN}", drawn))
