"""The least processor time of some runs: what else the machine does takes time, but never gives any."""

import time

import numpy as np


def fastest(*works, turns=5):
    """Give the seconds of each work, which take turns; of each the fastest turn counts."""
    seconds = []
    for _ in range(turns):
        for work in works:
            start = time.process_time()
            work()
            seconds.append(time.process_time() - start)
    return np.array(seconds).reshape(turns, -1).min(0)


def least(work, times=5):
    """Give the seconds of one work."""
    return float(fastest(work, turns=times)[0])


def held(what, took, most):
    """Say what something takes, and hold it to a bound."""
    print(f"\n{what}: {took:.3g}, at most {most:.3g}")
    assert took <= most
