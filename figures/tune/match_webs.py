"""Trials of the constants of match webs: `python figures/tune/match_webs.py [--quick] [--clips FOLDER ...]`.

The web of 6 s in the middle of each clip, of matches within 12 cm, and a search in it from six strides, each
from one strike of a foot to the next. A match is right if it is in a clip of the same kind: one label, or
without labels both runs or both walks.

- Paths: how many the web holds, and their cells. Matches: how many a search finds from a stride, on average;
  right: the percentage that is of its kind.
- `part_rows`, `part_columns`: the whole web of two clips, and the numbers of its largest part. Smaller parts
  cut long paths, so that there are more.
- `leak`, `few_matches`: the percentage of searches that warn of a leak, with a threshold of 6 cm and with one
  of 12 cm, at which wrong matches lead to others.
- `convex`, `ridge`: strides that are mixed for a turn and a speed. Missed: the mean error of the values that
  the samples promise, in percent of their range; far: the mean distance of the samples, likewise.
"""

import warnings
from functools import cache
from itertools import pairwise

import numpy as np
from _trials import WALKS, Clips, Collection, Row, Study, Trial, cmu, middle_of

from mocap._shared.arrays import runs
from mocap.body import Motion, find_legs
from mocap.feet import mark_plants
from mocap.methods.match_webs import (
    MotionSpace,
    build_web,
    heading_change,
    mean_speed,
    sample_space,
    search,
    tuned,
)
from mocap.methods.match_webs.target_weights import sample_weights
from mocap.methods.match_webs.webs import MatchWeb
from mocap.methods.parametric_graphs import Examples, cut_strides

SECONDS = 6.0  # of each clip
BELOW = 0.12  # metres
STRICT = 0.06  # metres
QUERIES = 6
TARGETS = 200
RUN = 2.0  # m/s


@cache
def short(clips: Clips) -> Clips:
    """Return the middles of the clips."""
    return tuple(middle_of(clip, SECONDS) for clip in clips)


def kind_of(clip: Motion) -> str:
    """Return the label of most of a clip's frames, or what its speed says."""
    if clip.labels:
        return max(clip.labels, key=lambda label: clip.labels[label].mean())
    steps = np.linalg.norm(np.diff(clip.root_positions[:, [0, 2]], axis=0), axis=1)
    return "run" if steps.mean() * clip.fps >= RUN else "walk"


@cache
def strides(clips: Clips) -> list[tuple[int, slice]]:
    """Return six strides of a left foot, evenly chosen: numbers of clips and frames."""
    strides_of_all: list[tuple[int, slice]] = []
    for number, clip in enumerate(clips):
        marked = mark_plants(clip)
        ankle = clip.skeleton.names[find_legs(clip.skeleton)[0].ankle]
        starts = [start for start, _ in runs(marked.contacts[ankle]).tolist() if start > 0]
        strides_of_all += [(number, slice(start, stop)) for start, stop in pairwise(starts)]
    return strides_of_all[:: max(1, len(strides_of_all) // QUERIES)][:QUERIES]


def searched(clips: Clips, web: MatchWeb) -> Row:
    """Search from the strides, and count what is right."""
    counts = []
    right = []
    for number, frames in strides(clips):
        matches = search(web, number, frames, below=BELOW)
        counts.append(len(matches))
        right += [kind_of(clips[match.clip]) == kind_of(clips[number]) for match in matches]
    return {"matches": float(np.mean(counts)), "right, %": 100 * float(np.mean(right))}


def web_and_search(clips: Clips) -> Row:
    """Build a web, and search in it."""
    clips = short(clips)
    web = build_web(clips, below=BELOW)
    return {"paths": len(web.offsets) - 1, "cells": len(web.cells)} | searched(clips, web)


def in_parts(clips: Clips) -> Row:
    """Build the web of the first two clips, in whole, and measure its largest part."""
    web = build_web(clips[:2], below=BELOW)
    sides = [min(len(web.cells), side) for side in (tuned.TUNED.part_rows, tuned.TUNED.part_columns)]
    return {"paths": len(web.offsets) - 1, "largest part, MB": 8e-6 * sides[0] * sides[1]}


@cache
def web_of(clips: Clips) -> MatchWeb:
    """Build a web with the chosen constants, once."""
    return build_web(clips, below=BELOW)


def search_alone(clips: Clips) -> Row:
    """Search in the web of the chosen constants."""
    return searched(short(clips), web_of(short(clips)))


def leaks(clips: Clips) -> Row:
    """Count searches that warn of a leak."""
    return {f"{100 * below:.0f} cm, %": leaking(short(clips), below) for below in (STRICT, BELOW)}


def leaking(clips: Clips, below: float) -> float:
    """Return the percentage of searches that warn of a leak."""
    warned = []
    for number, frames in strides(clips):
        with warnings.catch_warnings(record=True, action="always") as caught:
            search(web_of(clips), number, frames, below=below)
        warned.append(any("One step found" in str(warning.message) for warning in caught))
    return 100 * float(np.mean(warned))


@cache
def space_of(clips: Clips) -> tuple[MotionSpace[Examples], np.ndarray]:
    """Sample a space of strides by turn and speed, and draw targets between its values."""
    strides_of = cut_strides([mark_plants(clip) for clip in clips if kind_of(clip) == "walk"])
    space = sample_space(strides_of, lambda blend: [heading_change(blend), mean_speed(blend)])
    random = np.random.default_rng(0)
    pairs = random.integers(len(space.values), size=(TARGETS, 2))
    return space, space.values[pairs].mean(axis=1)


def targets(clips: Clips) -> Row:
    """Mix samples for targets, and compare what the samples promise."""
    space, goals = space_of(clips)
    rows, weights = sample_weights(space, goals)
    promised = np.einsum("mk,mkd->md", weights, space.values[rows])
    span = np.ptp(space.values, axis=0)
    distances = np.linalg.norm((space.values[rows] - goals[:, None]) / span, axis=-1)
    mean_distance = 100 * float((weights * distances).sum(axis=1).mean())
    return {"missed, %": 100 * float((np.abs(promised - goals) / span).mean()), "far, %": mean_distance}


KINDS = Collection("four walks, a jog and a sneak", (*WALKS, "jog", "sneak"))
CAPTURED = Collection("CMU 16, ten walks and five runs", cmu("16", *range(15, 25), 35, 36, 37, 45, 46))

# reads: statement: a table
TRIALS = {
    "slope": Trial(web_and_search, (1, 3, 4)),
    "least_advance": Trial(web_and_search, (20, 14)),
    "near_path": Trial(web_and_search, (0, 1, 8)),
    "off_minimum": Trial(web_and_search, (0.0, 0.25, 1.0)),
    "part_rows": Trial(in_parts, (1200, 350)),
    "part_columns": Trial(in_parts, (1000, 8000)),
    "same_match": Trial(search_alone, (0.9, 0.3, 0.7)),
    "cover": Trial(search_alone, (0.5, 0.7, 1.0)),
    "leak": Trial(leaks, (2, 3, 10)),
    "few_matches": Trial(leaks, (0, 5, 50)),
    "convex": Trial(targets, (3, 6, 24, 48)),
    "ridge": Trial(targets, (5e-2, 0.0, 5e-5, 5e-3)),
}
STUDY = Study(tuned, TRIALS, {}, (KINDS, CAPTURED))

if __name__ == "__main__":
    STUDY.main(__doc__)
