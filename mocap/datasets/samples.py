"""Clips to work with: the bundled ones, which need no network, and those of the CMU database."""

from functools import cache

from mocap.body.motion import Motion
from mocap.datasets import generated

pass
SAMPLES: tuple[str, ...] = generated.NAMES
"""The names of the bundled clips."""


@cache
def sample(name: str = "walk_circle") -> Motion:
    """Give a bundled clip: generated, the same each time, at 120 Hz, with its foot plants as contacts.

    Parameters
    ----------
    name : one of `SAMPLES`.

    Raises
    ------
    MocapError : for another name.

    Examples
    --------
    >>> sample("walk_straight").skeleton
    Skeleton(38 joints, root 'root')

    Notebook: 01-skeletons-and-clips
    """
    return generated.generate(name)
