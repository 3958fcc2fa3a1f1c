"""Labels of clips from a table: the kind of motion in each stretch of a clip."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.errors import FormatError, MocapError, shortened
from mocap.files.named_tables import read_table, write_table

COLUMNS = ("clip", "from", "to", "label")
TIME = re.compile(r"\d{1,9}|\d{1,9}(\.\d{1,9})?s|")
SHOWN = 5  # names of clips in an error


class LabelRow(NamedTuple):
    """A label for a stretch of a clip, a row of a table of labels.

    `start` is the first frame of the stretch and `stop` the one after its last, as texts: frames of the clip
    as in "45", seconds as in "1.5s", or "" for the start and the end of the clip.

    Examples
    --------
    >>> LabelRow("walk", "0s", "1.5s", "stand").label
    'stand'
    """

    clip: str
    start: str
    stop: str
    label: str


def load_labels(path: str | Path) -> list[LabelRow]:
    r"""Read a table of labels from a `.csv` file with the columns clip, from, to and label.

    Raises
    ------
    FormatError, MocapError : as for `files.named_tables.read_table`, for times in another form, and for rows
        without a clip or a label.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "labels.csv")
    ...     _ = file.write_text("clip,from,to,label\nwalk,0s,1.5s,stand\n")
    ...     load_labels(file)
    [LabelRow(clip='walk', start='0s', stop='1.5s', label='stand')]
    """
    rows = []
    for line, cells in read_table(path, COLUMNS):
        label = LabelRow(*(cells[column] for column in COLUMNS))
        for text in (label.start, label.stop):
            if not TIME.fullmatch(text):
                expected = "times such as 45 (a frame) or 1.5s"
                raise FormatError(path, line, expected, f"'{shortened(text, 30)}'")
        if not (label.clip and label.label):
            raise FormatError(path, line, "the name of a clip and a label", "an empty cell")
        rows.append(label)
    return rows


def save_labels(path: str | Path, rows: Iterable[LabelRow]) -> None:
    """Write a table of labels, which `load_labels` reads.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_labels(f"{folder}/labels.csv", [LabelRow("walk", "", "45", "stand")])
    ...     load_labels(f"{folder}/labels.csv")
    [LabelRow(clip='walk', start='', stop='45', label='stand')]
    """
    write_table(path, COLUMNS, rows)


def label_clips(clips: Sequence[Motion], rows: Sequence[LabelRow]) -> list[Motion]:
    """Give clips the labels of a table, in place of those that they have.

    A clip that the table does not name keeps its labels. A frame may have several labels.

    Parameters
    ----------
    clips : motions at the rates of their files, because rows may count their frames.
    rows : from `load_labels`.

    Raises
    ------
    MocapError : for a row whose clip is not among them, and one whose stretch has no frame of its clip.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> (clip,) = label_clips([sample("walk_straight")[:90]], [LabelRow("walk_straight", "", "30", "start")])
    >>> int(clip.labels["start"].sum()), sorted(clip.labels)
    (30, ['start'])
    """
    names = [clip.name for clip in clips]
    for row in rows:
        if row.clip not in names:
            similar = get_close_matches(row.clip, names, n=SHOWN, cutoff=0) or names[:SHOWN]
            shown = shortened(", ".join(similar), 80)
            raise MocapError(f"There is no clip '{shortened(row.clip, 40)}' to label; there are: {shown}.")
    return [_with_rows(clip, [row for row in rows if row.clip == clip.name]) for clip in clips]


def _with_rows(clip: Motion, rows: Sequence[LabelRow]) -> Motion:
    """Give a clip the labels of its rows, in place of those it has; without rows it is returned as it is."""
    if not rows:
        return clip
    labels: dict[str, Mask] = {}
    for row in rows:
        start = _frame(row.start, clip, 0)
        stop = _frame(row.stop, clip, len(clip))
        if not 0 <= start < stop <= len(clip):
            stretch = f"from {row.start or 'the start'} to {row.stop or 'the end'}"
            length = f"'{shortened(clip.name, 40)}' has {len(clip)} frames, {len(clip) / clip.fps:.2f} s"
            label = f"'{shortened(row.label, 40)}' {stretch}"
            raise MocapError(f"The label {label} is not in its clip: {length}.")
        labels.setdefault(row.label, np.zeros(len(clip), bool))[start:stop] = True
    return replace(clip, labels=labels)


def _frame(text: str, clip: Motion, default: int) -> int:
    """Return the frame for a time in a row; one that rounding puts after the end is the end."""
    if not text:
        return default
    if not text.endswith("s"):
        return int(text)
    frame = round(float(text.removesuffix("s")) * clip.fps)
    return len(clip) if frame == len(clip) + 1 else frame


def rows_of(clip: Motion) -> list[LabelRow]:
    """Return the labels of a clip as rows of a table, in seconds, ordered by time.

    Seconds have four decimals, from which `label_clips` finds the same frames up to 1000 frames per second.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> [tuple(row) for row in rows_of(sample("walk_straight"))]
    [('walk_straight', '0s', '9.65s', 'walk')]
    """
    stretches = []
    for label, mark in clip.labels.items():
        stretches += [(start, label, stop) for start, stop in runs(mark).tolist()]
    rows = []
    for start, label, stop in sorted(stretches):
        rows.append(LabelRow(clip.name, seconds(start / clip.fps), seconds(stop / clip.fps), label))
    return rows


def seconds(time: float) -> str:
    """Format a time for a table of labels.

    Examples
    --------
    >>> seconds(1.5), seconds(0.0), seconds(1 / 3)
    ('1.5s', '0s', '0.3333s')
    """
    return f"{time:.4f}".rstrip("0").rstrip(".") + "s"
