"""Numbers, vectors and tables of the exam as text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

SMALL = 1e-9  # of a part of a number that is zero


def number(value: float, decimals: int = 3) -> str:
    """Write a number with at most some decimals.

    Examples
    --------
    >>> number(0.5), number(-1e-12), number(-34.64101, 1)
    ('0.5', '0', '−34.6')
    """
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text.replace("-", "−")


def vector(values: Iterable[float]) -> str:
    """Write a vector.

    Examples
    --------
    >>> vector([0.5, 0, -1])
    '(0.5, 0, −1)'
    """
    return f"({', '.join(map(number, values))})"


def complex_number(value: complex) -> str:
    """Write a complex number.

    Examples
    --------
    >>> complex_number(5 - 2j), complex_number(1j), complex_number(-3)
    ('5 − 2i', 'i', '−3')
    """
    real = number(value.real)
    imaginary = "i" if abs(value.imag) == 1 else f"{number(abs(value.imag))}i"
    if abs(value.imag) < SMALL:
        return real
    sign = "−" if value.imag < 0 else ""
    if abs(value.real) < SMALL:
        return f"{sign}{imaginary}"
    return f"{real} {sign or '+'} {imaginary}"


def texts(**values: float | str) -> dict[str, str]:
    """Write numbers as texts, by their names.

    Examples
    --------
    >>> texts(thigh=40, shank=41.5)
    {'thigh': '40', 'shank': '41.5'}
    """
    return {name: value if isinstance(value, str) else number(value) for name, value in values.items()}


def formula(text: str) -> str:
    """Write a formula, in which a minus sign is that of TeX.

    Examples
    --------
    >>> formula("m = −i")
    '$m = -i$'
    """
    return f"${text.replace('−', '-')}$"


def table(rows: Sequence[Sequence[int]]) -> str:
    """Write a grid of numbers as a Markdown table, with the numbers of its rows and columns.

    Examples
    --------
    >>> print(table([[7, 6], [5, 4]]))
    | | 0 | 1 |
    |---|---|---|
    | **0** | 7 | 6 |
    | **1** | 5 | 4 |
    """
    columns = range(len(rows[0]))
    lines = [f"| | {' | '.join(map(str, columns))} |", f"|{'---|' * (len(columns) + 1)}"]
    lines += [f"| **{row}** | {' | '.join(map(str, cells))} |" for row, cells in enumerate(rows)]
    return "\n".join(lines)
