"""Captured clips for notebooks that can do without them."""

import os
from pathlib import Path

from mocap import datasets
from mocap.body.motion import Motion, resample
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants
from mocap.files.load_save import load

UNEVEN = ("03_01", "03_03", "03_04")  # walks on uneven ground
SETTLED = 20  # frames at the start of CMU's trials: until there some joints turn too fast


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


def collections(fps: float = 120) -> dict[str, list[Motion]]:
    """Give the four collections on which the course measures side by side, or those of them that are here.

    Parameters
    ----------
    fps : frames per second. Where captured clips are resampled, their feet are marked as well.

    Returns
    -------
    By name: "generated", four bundled clips; "homework", the homework's three walks, from a folder `hw3` in
    the one that the environment variable MOCAP_DATA names, or beside it; "CMU 16", a person's 26 walks; and
    "CMU 03", three walks of another one on uneven ground. Of CMU's trials the first 20 frames are cut.

    Examples
    --------
    >>> [clip.name for clip in collections()["generated"]]
    ['walk_straight', 'sneak', 'jog', 'stop_and_go']

    Notebook: 09-discussion
    """
    folder = Path(os.environ.get("MOCAP_DATA", "."))
    homework = sorted([*folder.glob("hw3/*.AMC"), *folder.parent.glob("hw3/*.AMC")])
    walks = people(*(f"16_{trial}" for trial in (*range(11, 35), 47, 58)))
    uneven = people(*UNEVEN) if walks else []
    by_name = {"generated": [datasets.sample(name) for name in datasets.SAMPLES[3:]]}
    by_name["homework"] = [load(file) for file in homework]
    by_name["CMU 16"] = [clip[SETTLED:] for clip in walks]
    by_name["CMU 03"] = [clip[SETTLED:] for clip in uneven]
    if fps != 120:
        by_name = {name: [resample(clip, fps) for clip in clips] for name, clips in by_name.items()}
        captured = {name: clips for name, clips in by_name.items() if name != "generated"}
        by_name |= {name: list(map(mark_plants, clips)) for name, clips in captured.items()}
    return {name: clips for name, clips in by_name.items() if clips}
