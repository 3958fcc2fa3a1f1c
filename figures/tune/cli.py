"""Trials of the constants of the command: `python figures/tune/cli.py [--quick] [--clips FOLDER ...]`.

- `poor_seam`, `missed_cycle`: the best cycle of each clip. Warned: the percentage of clips of which the
  command warns; the clips that walk all the time should not be among them. Seam and missed: the largest of
  both measures among the clips, which the constants have to be above.
- `web_threshold`: a web whose paths may be farther than the matches that are asked for, 6 cm. Matches: how
  many are found for six strides, on average.
- `side_headings`, `side_states`: a group of four in a bay that is closed towards its goal. Found: the
  percentage of two bays that it finds a way out of.
- `similar_word`: misspelt commands, with a letter left out, doubled or changed. Right: the percentage for
  which the right one is suggested; wrong: that of words of other programs for which any is suggested.
"""

from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache, partial
from itertools import pairwise

import numpy as np
from _trials import BUNDLED_WALKS, CAPTURED_WALKS, Clips, Row, Study, Trial

from mocap._shared.arrays import runs
from mocap.body import PlanarTransform, find_legs
from mocap.cli import tuned
from mocap.cli.main import COMMANDS
from mocap.editing.cycles import find_loop
from mocap.errors import NoWalk
from mocap.feet import mark_plants
from mocap.methods.groups import GroupGraph, Scene, build_group, lead_group
from mocap.methods.match_webs import build_web, search

SECONDS = (0.8, 3.0)  # of a cycle
LONGEST = 8.0  # seconds of a clip
BELOW = 0.06  # metres
QUERIES = 6
OTHER_WORDS = ("git", "install", "status", "push", "render", "train", "plot", "commit", "export", "serve")


@cache
def cycles(clips: Clips) -> tuple[np.ndarray, np.ndarray]:
    """Return the seam and the missed distance of the best cycle of each clip, metres."""
    loops = [find_loop(clip[: round(LONGEST * clip.fps)], seconds=SECONDS) for clip in clips]
    return np.array([loop.seam for loop in loops]), np.array([loop.missed for loop in loops])


def looped(clips: Clips) -> Row:
    """Count clips of whose cycle the command warns."""
    seams, missed = cycles(clips)
    warned = (seams > tuned.TUNED.poor_seam) | (missed > tuned.TUNED.missed_cycle)
    row = {"warned, %": 100 * float(warned.mean()), "seam, cm": 100 * float(seams.max())}
    return row | {"missed, cm": 100 * float(missed.max())}


def matched(clips: Clips) -> Row:
    """Search strides in a web."""
    short = tuple(mark_plants(clip[: round(LONGEST * clip.fps)]) for clip in clips)
    web = build_web(short, below=tuned.TUNED.web_threshold * BELOW)
    strides = []
    for number, clip in enumerate(short):
        ankle = clip.skeleton.names[find_legs(clip.skeleton)[0].ankle]
        starts = [start for start, _ in runs(clip.contacts[ankle]).tolist() if start > 0]
        strides += [(number, slice(start, stop)) for start, stop in pairwise(starts)]
    chosen = strides[:: max(1, len(strides) // QUERIES)][:QUERIES]
    counts = [len(search(web, number, frames, below=BELOW)) for number, frames in chosen]
    return {"paths": len(web), "matches": float(np.mean(counts))}


@cache
def group() -> GroupGraph:
    """Build the graph of a small group."""
    return build_group(4, nodes=2, simulated=60.0)


def scenes() -> Iterator[Scene]:
    """Yield bays of discs, open to the start and closed before the goal, more and more to one side."""
    for shift in (0.0, 2.0):
        front = [9 + 1j * (shift + offset) for offset in np.arange(-6.0, 6.1, 1.1)]
        sides = [depth + 1j * (shift + side) for side in (-6.0, 6.0) for depth in np.arange(3.0, 9.0, 1.1)]
        yield Scene((18 + 0j,), tuple((complex(disc), 0.6) for disc in front + sides))


def led(clips: Clips) -> Row:
    """Lead a group around walls, as `mocap walk` does."""
    successes = [is_led(scene) for scene in scenes()]
    return {"found, %": 100 * float(np.mean(successes))}


def is_led(scene: Scene) -> bool:
    """Tell whether a group finds a way in any of the directions that are tried."""
    for turn in tuned.TUNED.side_headings:
        limits = {"most": tuned.TUNED.side_states} if turn else {}
        try:
            lead_group(group(), scene, start=PlanarTransform(turn, 0.0, 0.0), **limits)
        except NoWalk:
            continue
        return True
    return False


def suggested(clips: Clips) -> Row:
    """Suggest commands for misspelt ones."""
    commands = [name for names in COMMANDS.values() for name in names]
    similar = partial(get_close_matches, possibilities=commands, n=1, cutoff=tuned.TUNED.similar_word)
    right = [similar(word) == [command] for command in commands for word in misspelt(command)]
    wrong = [bool(similar(word)) for word in OTHER_WORDS]
    return {"right, %": 100 * float(np.mean(right)), "wrong, %": 100 * float(np.mean(wrong))}


def misspelt(word: str) -> Iterator[str]:
    """Yield a word without a letter, with a letter twice, with another one, and with two swapped."""
    middle = len(word) // 2
    first = word[:middle]
    letter = word[middle]
    rest = word[middle + 1 :]
    yield first + rest
    yield first + 2 * letter + rest
    yield first + "x" + rest
    yield first[:-1] + letter + first[-1:] + rest


# reads: statement: a table
TRIALS = {
    "poor_seam": Trial(looped, (0.01, 0.02, 0.03, 0.1)),
    "missed_cycle": Trial(looped, (0.05, 0.02, 0.1, 0.3)),
    "web_threshold": Trial(matched, (1.0, 1.15, 2.0)),
    "side_headings": Trial(led, ((0.0,), (0.0, 0.5, -0.5)), needs_clips=False),
    "side_states": Trial(led, (50, 4000), needs_clips=False),
    "similar_word": Trial(suggested, (0.9, 0.4, 0.5, 0.7, 0.8), needs_clips=False),
}
FIXED = {
    "holds_together": "what a user may expect of a graph, which no trial tells",
    "larger_thresholds": "a user chooses one of the proposals",
    "proposed_frames": "a limit of the time that it takes",
}
STUDY = Study(tuned, TRIALS, FIXED, (BUNDLED_WALKS, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
