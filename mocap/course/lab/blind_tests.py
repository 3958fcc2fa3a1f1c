"""The blind test in a notebook or on a page: films, some with a seam, and each with its control.

A control is one of the same two clips at the same phase, without a seam. Which of the two it is, is drawn for
each pair: if it were always the first, a viewer could tell the films apart by the steps that follow. Both
films show the same motion up to the seam, or else after it.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from mocap.blending.joining import align_window, join
from mocap.body.motion import Motion
from mocap.body.planar import align_frames, place
from mocap.course.lab.sensitivity import sentence
from mocap.errors import MocapError
from mocap.matching.transitions import Transition, Transitions
from mocap.plotting.bodies import film_strip
from mocap.plotting.picture import few_colours, small_png
from mocap.plotting.style import COLOURS
from mocap.widgets.embedding import CANVAS, PAGE, PICTURE, SCENE, Embedded
from mocap.widgets.player import SIDES, packed_character

SECONDS = 2.6  # how long a film is
AROUND = 0.3  # a seam lies within as many seconds of the middle, so that nobody knows when it comes
MATCHED = 1 / 3  # seconds of the windows over which matches were found
NEAR = 0.75  # matches cost at least this share of the threshold, so that tests of other thresholds differ
STEP = 0.002  # metres; coordinates of films are whole numbers of it. A pixel shows about four of them.
ALT = (
    "The films play where scripts run, as in JupyterLab and on the site of the course. Here are two rows "
    "of stick figures that walk. In one of the two films is a seam; poses do not show which."
)


# reads: name: notebooks use `found`
def blind_test(
    clips: Sequence[Motion], found: Transitions, window: int = 10, below: float = 0.04, seed: int = 0
) -> BlindTest:
    """Show twenty pairs of films, in each of which a reader chooses the one with a seam.

    A film lasts 2.6 s. The control is one of the same two clips at the same phase, without a seam; the films
    of a pair play side by side until the reader answers, with the arrow keys or by touch. Nothing is said
    about single answers. At the end stands d′ with its confidence interval, as of `d_prime`, and the
    answers can be saved as a file for `class_curve`.

    Parameters
    ----------
    clips : of one skeleton and rate. The films stand in the notebook, so use clips that may be passed on.
    found : matches of these, as from `find_transitions`, over windows of a third of a second.
    window : frames of the blends.
    below : the threshold, metres: the matches cost at most that, and at least three quarters of it.
    seed : the same seed gives the same pairs in the same order.

    Returns
    -------
    The test; a notebook shows it as the last line of a cell. Without a script it is a picture of one pair.

    Raises
    ------
    MocapError : for fewer than 20 such matches, clips of several rates, and a window longer than 2 s.

    Examples
    --------
    >>> from mocap import datasets, matching
    >>> clips = [datasets.sample("walk_circle")[:2400:4]]
    >>> blind_test(clips, matching.find_transitions(clips, window=10, below=0.04))
    Blind test: 20 pairs of films, seams below 4.0 cm, blends of 10 frames, seed 0.

    Notebook: 09b-blend-window
    """
    return BlindTest(make_pairs(clips, choose(clips, found, below, seed), window, seed), window, below, seed)


@dataclass(frozen=True, eq=False, repr=False)
class BlindTest(Embedded):
    """The result of `blind_test`; a notebook shows it live, as a picture or a sentence."""

    pairs: Sequence[Pair]
    window: int
    below: float
    seed: int
    scripts = (CANVAS, SCENE, PICTURE, PAGE, Path(__file__).with_name("blind.js"))

    def __repr__(self) -> str:
        return (
            f"Blind test: {len(self.pairs)} pairs of films, seams below {100 * self.below:.1f} cm, "
            f"blends of {self.window} frames, seed {self.seed}."
        )

    @property
    def alt(self) -> str:
        """The description of the test and of its picture."""
        return f"{self!r} {ALT}"

    @cached_property
    def picture(self) -> bytes:
        """The first pair, the left film above, as a PNG."""
        seam, control, on_left, *_ = self.pairs[0]
        films = [seam, control] if on_left else [control, seam]
        rows = [Image.open(io.BytesIO(small_png(film_strip([film])))) for film in films]
        joined = Image.fromarray(np.concatenate([np.asarray(row.convert("RGB")) for row in rows]))
        return few_colours(joined, min(float(row.info["letters"]) for row in rows))

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The data of the script: all films, of each pair the one with the seam first.

        They are packed as characters of the player, but in steps of two millimetres. All have one body.
        """
        films: list[dict[str, Any]] = []
        data = b""
        for film in (film for pair in self.pairs for film in (pair.seam, pair.control)):
            body, block = packed_character(film, COLOURS["middle"], STEP)
            low = np.round(body.pop("low"), 4).tolist()
            films.append({"frames": body.pop("frames"), "offset": len(data), "low": low})
            data += block
        count = len(self.pairs)
        scene: dict[str, Any] = {"about": repr(self), "body": body | {"name": ""}, "films": films}
        scene["data"] = zlib.compress(data, 9)
        scene["plan"] = {"below_cm": round(100 * self.below, 3), "window": self.window, "seed": self.seed}
        scene["onLeft"] = [pair.on_left for pair in self.pairs]
        scene["sides"] = [COLOURS[side] for side in SIDES]
        scene["sentences"] = [sentence(right, count) for right in range(count + 1)]
        return scene


class Pair(NamedTuple):
    """Two films, the one with the seam and its control, and whether the seam is in the left one.

    `unshown` is the clip of the two that the control does not show: a film without a seam in its place.
    """

    seam: Motion
    control: Motion
    on_left: bool
    match: Transition
    unshown: Motion


def choose(
    clips: Sequence[Motion], matches: Transitions, below: float, seed: int, count: int = 20
) -> Transitions:
    """Choose matches near a threshold at random, with enough of both clips around them.

    Raises
    ------
    MocapError : for clips of several rates, and where there are not enough matches.
    """
    if len({clip.fps for clip in clips}) != 1:
        raise MocapError("A blind test needs clips of one rate; resample them.")
    fps = clips[0].fps
    lengths = np.array([len(clip) for clip in clips])
    rest_of_source = lengths[matches.source] - matches.leave  # frames
    rest_of_target = lengths[matches.target] - matches.enter  # frames
    beside_match = np.minimum.reduce([matches.leave, matches.enter, rest_of_source, rest_of_target])
    is_inside = beside_match >= round((SECONDS / 2 + AROUND + MATCHED) * fps)
    is_later = abs(matches.leave - matches.enter) > fps  # and no mere moment on
    is_elsewhere = (matches.source != matches.target) | is_later
    is_near = (matches.cost <= below) & (matches.cost > NEAR * below)
    usable: Transitions = matches[is_near & is_elsewhere & is_inside]
    if len(usable) < count:
        costs = f"{100 * NEAR * below:.1f} to {100 * below:.1f} cm"
        needed = f"{count} matches of {costs}, with {SECONDS / 2 + AROUND:.1f} s of both clips around"
        raise MocapError(f"A blind test needs {needed}; got {len(usable)}.")
    chosen: Transitions = usable[np.random.default_rng(seed).permutation(len(usable))[:count]]
    return chosen


def make_pairs(clips: Sequence[Motion], matches: Transitions, window: int, seed: int) -> list[Pair]:
    """Make a pair of each match; the same seed gives the same pairs.

    Parameters
    ----------
    clips : all of the same skeleton and rate.
    matches : of these, as from `choose`, over windows of a third of a second.
    window : frames of the blends.
    seed : of what is drawn: the clip of the control, the side, and where the seam is.

    Raises
    ------
    MocapError : for a window that does not fit into a film.
    """
    fps = clips[0].fps
    longest = int((SECONDS - 2 * AROUND) * fps)
    if not 1 <= window <= longest:
        raise MocapError(f"A window has 1 to {longest} frames here, got {window}.")
    rng = np.random.default_rng([seed, 1])
    pairs = []
    for match in matches:
        seam_at = round((SECONDS / 2 + rng.uniform(-AROUND, AROUND)) * fps)
        first = _film(clips[match.source], match.leave, seam_at)
        second = _film(clips[match.target], match.enter, seam_at)
        start = seam_at - window // 2
        second = align_window(first, start, second, start, window)
        joined = join(first, start, second, start, window)
        control, unshown = (first, second) if rng.random() < 0.5 else (second, first)
        ahead = align_frames(first[seam_at:], place(first[seam_at:], 0.0, (0.0, 0.0)))
        films = ahead.apply_motion(joined), ahead.apply_motion(control)
        pairs.append(Pair(*films, bool(rng.random() < 0.5), match, ahead.apply_motion(unshown)))
    return pairs


def _film(clip: Motion, window_start: int, seam_at: int) -> Motion:
    """Cut a film in which the middle of the matched window is at the seam."""
    begin = window_start + round(MATCHED * clip.fps / 2) - seam_at
    return clip[begin : begin + round(SECONDS * clip.fps)]
