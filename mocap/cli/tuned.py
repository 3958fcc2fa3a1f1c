"""Constants of the command that trials chose; `figures/tune/cli.py` runs the trials again."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    poor_seam: float = 0.06  # metres RMS. The cycles of eight walks had seams of 0.5 to 3 cm
    missed_cycle: float = 0.15  # metres. Cycles of walks miss 1 to 9 cm, a pose held before a run misses 30
    # Thresholds are proposed for a graph that plays less of its clips. Graphs of walks play 80 % or more
    holds_together: float = 0.5  # of the frames
    larger_thresholds: tuple[float, ...] = (1.5, 2.0, 3.0)  # times the one that was given
    proposed_frames: int = 20_000  # frames up to which the clips are compared again, in some seconds
    # A path of the web ends where frames are no longer as near as asked, although on average they still are.
    # With 4 / 3 CMU 02_05's punch finds two more below 6 cm. With 2 no others.
    web_threshold: float = 4 / 3  # times the threshold of `mocap find`
    side_headings: tuple[float, ...] = (0.0, 0.5, -0.5, 1.0, -1.0)  # radians, tried in this order
    side_states: int = 400  # where the way ahead is closed, a side finds one soon or not at all
    similar_word: float = 0.6  # of two words, as `difflib` measures it; "conver" and "convert" have 0.92


TUNED = Tuned()
