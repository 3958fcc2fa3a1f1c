"""Clips of people, for tests that are run on request and where these clips are at hand."""

from functools import cache
from pathlib import Path

from mocap.body.motion import Motion, resample
from mocap.files.load_save import load

HOMEWORK, WALKER = "homework", "CMU 16, walks"
TRIALS = (*range(11, 35), 47, 58)  # the walks among subject 16's trials


@cache
def captured(data: Path, name: str) -> tuple[Motion, ...]:
    """Load a set of clips at 30 Hz."""
    folder = data / "cmu" / "16"
    own = [folder / f"16_{number:02}.amc" for number in TRIALS]
    files = {HOMEWORK: sorted((data / "hw3").glob("*.AMC")), WALKER: own}
    return tuple(resample(load(file), 30) for file in files[name])
