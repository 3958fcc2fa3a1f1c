"""The bundled clips by name; they need no network."""

from functools import cache

from mocap.body.motion import Motion
from mocap.datasets import generated

SAMPLES: tuple[str, ...] = generated.NAMES
"""The names of the bundled walks, from which motion graphs are built; `sample("jump")` is a jump."""


@cache
def sample(name: str = "walk_circle") -> Motion:
    """Give a bundled clip, generated at 120 Hz, with its footplants as contacts; the same at each call.

    Parameters
    ----------
    name : one of `SAMPLES`, or "jump".

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
