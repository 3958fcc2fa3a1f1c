"""Captured clips for notebooks that can do without them."""

from mocap import datasets
from mocap.body.motion import Motion
from mocap.errors import MocapError


def people(*names: str) -> list[Motion]:
    """Give trials of the CMU database, or say in one sentence why there are none.

    A notebook shows them beside generated clips. Where they can be neither found nor fetched, its cells get
    an empty list and draw the generated clips alone.

    Parameters
    ----------
    names : of trials, such as "16_15".

    Returns
    -------
    The motions, at 120 Hz; no motion where one of them cannot be had.

    Examples
    --------
    >>> people("16_99")
    Without real clips: No trial '16_99' is listed; `mocap data list` shows those that are.
    []

    Notebook: 01-skeletons-and-clips
    """
    try:
        return [datasets.cmu(name) for name in names]
    except MocapError as error:
        print(f"Without real clips: {error}")
        return []
