"""Tables of numbers in `.csv` files, as people write them: with a heading or not, with commas or blanks."""

import re
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import FormatError
from mocap.files.text import read_text, to_numbers


def load_rows(path: str | Path, names: tuple[str, ...] = ("x", "z")) -> Array:
    r"""Read a table of numbers, one row per line.

    Numbers stand between commas, semicolons or blanks; lines without numbers at the start are a heading, and
    what follows a # is left out.

    Parameters
    ----------
    path : the file.
    names : of the columns, for errors.

    Returns
    -------
    Shape (rows, columns); numbers may be infinite or NaN.

    Raises
    ------
    FormatError, MocapError : for a file that cannot be read, a line with more or fewer numbers, and no line.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "discs.csv")
    ...     _ = file.write_text("x, z, radius\n1, 2, 0.5  # a stone\n")
    ...     load_rows(file, ("x", "z", "radius"))
    array([[1. , 2. , 0.5]])
    """
    path = Path(path)
    rows: list[Array] = []
    example = ", ".join(("1.5", "2", "0.5")[: len(names)])
    expected = f"{', '.join(names[:-1])} and {names[-1]} in each line, such as '{example}'"
    for number, line in enumerate(read_text(path).split("\n"), 1):
        text = line.partition("#")[0]
        parts = [part.split() or [""] for part in text.replace(";", ",").split(",")]
        if not text.strip() or (not rows and not re.search(r"\d", line)):
            continue
        rows.append(to_numbers(path, number, [word for part in parts for word in part], expected, len(names)))
    if not rows:
        raise FormatError(path, None, expected, "no numbers")
    return np.array(rows)
