"""The numbers of clips as plain dictionaries, for `mocap info --json`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mocap import quality
from mocap.cli.options import READING, FileReading
from mocap.cli.stages import bar
from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.files.recordings import Recording


def describe_clips(
    paths: Sequence[Path], reading: FileReading
) -> tuple[list[dict[str, Any]], list[dict[str, str]]]:
    """Describe each clip, and list the files that cannot be read.

    Parameters
    ----------
    paths : the files.
    reading : the options with which they are read.

    Returns
    -------
    A dictionary for each clip that could be read, and one with "file" and "error" for each other file.
    """
    clips = []
    failed = []
    spaces = reading.survey(paths)
    for path in bar("measuring")(paths):
        try:
            clips.append(_describe(path, reading.read_with_roles(path, spaces.get(path))))
        except MocapError as error:
            failed.append({"file": str(path), "error": error.worded(READING)})
    return clips, failed


def _describe(path: Path, recording: "Recording") -> dict[str, Any]:
    """Return the numbers of a clip, the space in which it was read, and what was assumed."""
    report = quality.inspect(recording.motion, recording.angles)
    space = recording.space
    assumed = recording.assumed
    assumption = assumed.worded(READING[assumed.parameter]) if assumed else ""
    read_as: dict[str, Any] = {"scale": None, "up": None, "doubt": ""}
    if space:
        read_as = {key: getattr(space, key) for key in read_as}
    return {"file": str(path), **report.as_dict(), **read_as, "assumed": assumption}
