"""Walking cycles of generated walks, found by the web: a space of turns and speeds."""

from functools import cache
from itertools import product

import numpy as np
from walking import generate_walk

from mocap.blending.registering import register
from mocap.body import arcs
from mocap.methods.match_webs import build_web, cut_out, heading_change, mean_speed, sample_space, search
from tests.methods.match_webs.conftest import cycles

# Seconds · 30: about where the hand of 02_05 is at the target.
PUNCHES = (42, 85, 130, 173, 216, 259, 301, 346, 392)
SPEEDS, TURNS = (0.8, 1.1, 1.4), (-120, 0, 120)


def gait(motion):
    """Degrees that the body turns, and metres per second."""
    return np.degrees(heading_change(motion)), mean_speed(motion)


@cache
def found():
    walks = [
        generate_walk(arcs((0, 0), 0, [(5, np.radians(degrees))]).points, speed=speed, seed=seed)
        for seed, (speed, degrees) in enumerate(product(SPEEDS, TURNS))
    ]
    web = build_web(walks, below=0.1)
    matches = search(web, 4, cycles(walks[4], 0.5, 2)[0], below=0.08, lengths=(0.6, 1.6))
    whole = [match for match in matches if match.start > 8 and match.stop < len(walks[match.clip]) - 8]
    return web, whole


@cache
def space(count=100):
    web, matches = found()
    examples = [cut_out(web, match) for match in matches]
    return sample_space(register(examples, slack=0), gait, count=count, scale=(10, 0.1))
