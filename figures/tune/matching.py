"""Trials of the constants of searches: `python figures/tune/matching.py [--quick] [--clips FOLDER ...]`.

Only the time depends on them: CPU s of all threads, and s by the clock; each is the lesser of two runs.
What is found is counted as a check: it must be the same in all rows of a table.

- `small_grid`, `tile`: grids of distances of all clips with the first one.
- `few_windows`, `sparse`, `pair_sample`, and the bound's constants: the transitions of all clips within 4 cm.
  The bound is used for few near pairs among many windows, so `few_windows` is 0 in the trials of the bound.
- `block`: the same search by products, with the bound switched off.
- `few_frames`: the same search in 64 bits and in 32, which is quicker and takes half the memory.
"""

import time
from collections.abc import Callable

from _trials import CAPTURED_WALKS, Clips, Collection, Row, Study, Trial, cmu, varied

from mocap.matching import distance_grid, find_transitions, tuned

THRESHOLD = 0.04  # metres
WINDOW = 10  # frames
ALWAYS = 10**9  # windows: more than there are


def timed(work: Callable[[], int]) -> Row:
    """Do the work twice, and return its count and the least times by the clock and of the processor."""
    clock = []
    processor = []
    for _ in range(2):
        clock_start = time.perf_counter()
        processor_start = time.process_time()
        count = work()
        clock.append(time.perf_counter() - clock_start)
        processor.append(time.process_time() - processor_start)
    return {"count": count, "s": min(clock), "CPU s": min(processor)}


def grids(clips: Clips) -> Row:
    """Compute the grids of the first clip with all."""
    return timed(lambda: sum(distance_grid(clips[0], clip, window=WINDOW).size for clip in clips))


def transitions(clips: Clips) -> Row:
    """Search all transitions."""
    return timed(lambda: len(find_transitions(clips, window=WINDOW, below=THRESHOLD)))


def by_bound(clips: Clips) -> Row:
    """Search by the lower bound, however few windows there are."""
    with varied(tuned, few_windows=0):
        return transitions(clips)


def by_products(clips: Clips) -> Row:
    """Search by products of matrices, however many windows there are."""
    with varied(tuned, few_windows=ALWAYS):
        return transitions(clips)


BUNDLED = Collection("four bundled clips", ("walk_circle", "sneak", "jog", "stop_and_go"))
CMU_NAMES = cmu("02", *range(1, 11)) + cmu("03", *range(1, 5)) + cmu("16", *range(1, 59))
CMU = Collection("CMU 02, 03 and 16", CMU_NAMES)

# reads: statement: a table
TRIALS = {
    "small_grid": Trial(grids, (0, 100_000, 2_000_000, ALWAYS)),
    "tile": Trial(grids, ((1024, 2560), (64, 160), (128, 320), (512, 1280))),
    "few_frames": Trial(transitions, (0,)),
    "few_windows": Trial(transitions, (0, 2000, 20_000, ALWAYS)),
    "block": Trial(by_products, (320, 640, 2560, 5120)),
    "wide_block": Trial(by_bound, (1280, 4096, 16_384)),
    "sparse": Trial(by_bound, (0.0, 0.01, 0.2, 1.0)),
    "bound_sample": Trial(by_bound, (64, 128, 512)),
    "ground_directions": Trial(by_bound, (4, 7, 14)),
    "height_directions": Trial(by_bound, (10, 20, 60)),
    "directions": Trial(by_bound, (12, 24, 96)),
    "leaf": Trial(by_bound, (16, 64, 256, 512)),
    "pairs_together": Trial(by_bound, (64, 256, 4096, 16_384)),
    "pair_sample": Trial(by_bound, (150, 300, 1200)),
}
STUDY = Study(tuned, TRIALS, {}, (BUNDLED, CAPTURED_WALKS, CMU))

if __name__ == "__main__":
    STUDY.main(__doc__)
