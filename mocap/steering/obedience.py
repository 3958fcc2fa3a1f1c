"""How soon a character obeys: command it to turn many times, and measure the delays."""

import time
from typing import NamedTuple

import numpy as np

from mocap.errors import MocapError
from mocap.steering.characters import Character

LONGEST = 8.0  # seconds; a turn that takes longer counts as that long


class Delay(NamedTuple):
    """The delay until a character obeys, and the CPU time per step.

    `mean` and `slowest` (95 %) are delays in seconds; `step` (mean) and `worst` are CPU times in ms. Two mean
    parts of the delay are `waiting`, until the character can make its next choice, and `blending`, in
    transitions after it. The rest is spent in clips that turn. `never` is the number of
    turns that took longer than 8 s.
    """

    mean: float
    slowest: float
    step: float
    worst: float
    waiting: float
    blending: float
    never: int


def measure_delay(character: Character, *, turns: int = 60, speed: float = 1.1, seed: int = 0) -> Delay:
    """Command a character to turn by 30 to 120 degrees many times, and measure how soon it obeys.

    It obeys when its direction over the last third of a second is within 20 degrees of the command. A turn
    that takes longer than 8 s counts as 8 s. The next command comes as soon as this one is obeyed.

    Parameters
    ----------
    character : any controller, just made; it has walked on when this returns.
    turns : the number of turns.
    speed : metres per second.
    seed : of the random turns.

    Raises
    ------
    MocapError : for less than one turn.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.steering import Controller
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> 0 < measure_delay(Controller(graph), turns=1).mean <= 8
    True

    Notebook: 08b-steering
    """
    if turns < 1:
        raise MocapError(f"A delay is measured on one turn or more, got turns={turns}.")
    random, fps = np.random.default_rng(seed), character.fps
    heading, back = 0.0, round(fps / 3)
    track, costs, delays, never = [0j] * back, [], [], 0
    for _ in range(turns):
        heading += random.choice([-1, 1]) * random.uniform(np.pi / 6, 2 * np.pi / 3)
        wait, frames, blends = character.frames_left, 0, 0
        obeys = False
        while not obeys and frames < round(LONGEST * fps):
            start = time.thread_time()
            pose = character.step(heading, speed)
            costs.append(time.thread_time() - start)
            track.append(complex(pose.root_position[2], pose.root_position[0]))
            blends += pose.blending and frames >= wait
            way = (track[-1] - track[-1 - back]) * np.exp(-1j * heading)
            obeys, frames = frames >= back and abs(np.angle(way)) < np.pi / 9, frames + 1
        delays.append((frames, min(wait, frames), blends))
        never += not obeys
    took, waited, blended = np.transpose(delays) / fps
    slowest, cost = float(np.percentile(took, 95)), 1e3 * np.array(costs)
    # The first step looks ahead from the start without any frame to do so before; games do it while loading.
    worst, parts = float(cost[1:].max()), (float(waited.mean()), float(blended.mean()))
    return Delay(float(took.mean()), slowest, float(cost[1:].mean()), worst, *parts, never)
