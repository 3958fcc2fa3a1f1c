"""Students of all kinds: for each a notebook as a list of cells, (tag, source)."""

import os
import tomllib
from pathlib import Path

import nbformat

SLEEP = f"4242.{os.getpid()}"  # seconds, by which the tests find the process, and no other run's
START = ("", "import numpy as np\nfrom mocap.course import checks")
SPEED = (
    "exercise:speed",
    "def speed(positions, fps):\n    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps",
)
CHEAPEST = (
    "exercise:cheapest",
    "def cheapest(grid, minima):\n    return minima[np.argmin(grid[minima[:, 0], minima[:, 1]])]",
)
HONEST = [START, SPEED, CHEAPEST]
STUDENTS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
LOOKING = Path(__file__).with_name("looking_for_answers.py").read_text("utf-8")
TELLING = "import os, signal, socket\ndone = []\n{}def speed(positions, fps): raise ValueError(done)"
ATTEMPT = "try:\n  {0}\n  done.append({0!r})\nexcept OSError: pass\n"


def speed(source):
    """Give a notebook in which all is right but `speed`, which is this."""
    return [START, ("exercise:speed", source), CHEAPEST]


def handed(name, words=()):
    """Give the cells of a student, with words, such as the path of a file, put into the sources."""
    one, cells = STUDENTS[name], []
    words = dict(words) | {"SLEEP": SLEEP, "START": START[1], "RIGHT": SPEED[1], "CHEAPEST": CHEAPEST[1]}
    words["LOOKING"] = LOOKING
    attempts = "".join(map(ATTEMPT.format, one.get("attempts", ())))
    for tag, source in one.get("cells") or speed(one.get("speed") or TELLING.format(attempts)):
        for old, new in words.items():
            source = source.replace(old, str(new))
        cells.append((tag, source))
    return cells


def hand_in(cells, file, spoil=lambda text: text):
    """Write a notebook; `spoil` changes its text at the end, and may give bytes."""
    made = [nbformat.v4.new_code_cell(s, metadata={"tags": [tag] if tag else []}) for tag, s in cells]
    file.parent.mkdir(parents=True, exist_ok=True)
    text = spoil(nbformat.writes(nbformat.v4.new_notebook(cells=made)))
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
