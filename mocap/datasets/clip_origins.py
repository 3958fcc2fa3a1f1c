"""The files from which clips were read, and the options, by which they can be read again."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

AXES = (None, "y", "z", "-y", "-z", "x", "-x")  # that may point up in a file
ROOT_OFFSETS = (None, "add", "ignore")
OPTIONAL = ("mirrored", "up", "root_offset", "licence")  # parts of a text that may be missing
NOWHERE = Path()
LONGEST_LICENCE = 200  # characters


class Origin(NamedTuple):
    """The file from which a clip was read, and the parameters of `mocap.load`.

    If `mirrored`, the clip is the mirror image of the motion in the file. `labels` are rows (start, stop,
    label) as of `files.label_tables`, which replace the labels of the file; `licence` is that of the clip, ""
    if it is unknown. A clip that a file carries has the path `NOWHERE`.
    """

    path: Path
    skeleton: Path | None = None
    scale: float | None = None
    mirrored: bool = False
    up: str | None = None
    root_offset: str | None = None
    licence: str = ""
    labels: tuple[tuple[str, str, str], ...] = ()

    def text(self, folder: Path) -> str:
        """Serialise an origin as JSON, with the path of each file relative to a folder, and absolute.

        Examples
        --------
        >>> Origin(Path("clips/walk.bvh"), scale=0.0254).text(Path("graphs"))
        '{"path": ["../clips/walk.bvh", "/.../clips/walk.bvh"], "skeleton": [], "scale": 0.0254}'
        """
        skeleton = _places(self.skeleton, folder) if self.skeleton else []
        places = [] if self.path == NOWHERE else _places(self.path, folder)
        scale = None if self.scale is None else float(self.scale)
        kept: dict[str, object] = {"path": places, "skeleton": skeleton, "scale": scale}
        if self.mirrored:
            kept["mirrored"] = True
        if self.up is not None:
            kept["up"] = self.up
        if self.root_offset is not None:
            kept["root_offset"] = self.root_offset
        if self.licence:
            kept["licence"] = self.licence
        if self.labels:
            kept["labels"] = self.labels
        return json.dumps(kept)


def _places(file: Path, folder: Path) -> list[str]:
    try:
        relative = [Path(os.path.relpath(file, folder)).as_posix()]
    except ValueError:  # on Windows, from one drive to another
        relative = []
    return [*relative, str(file.resolve())]


def find_again(text: str, folder: Path) -> Origin | None:
    """Find the file of a clip from `Origin.text`, by its relative or absolute path; None if it is missing.

    Examples
    --------
    >>> find_again(Origin(Path("clips/gone.bvh")).text(Path("graphs")), Path("graphs"))
    """
    kept = json.loads(text)
    path = _first_file(folder / name for name in kept["path"])
    skeleton = _first_file(folder / name for name in kept["skeleton"])
    if path is None:
        return None
    return _with_options(Origin(path, skeleton, kept["scale"]), kept)


def stored_options(text: str) -> Origin:
    """Return an origin without its files, from `Origin.text`: what is known of a clip wherever it is.

    Examples
    --------
    >>> stored_options(Origin(Path("walk.bvh"), licence="CC0").text(Path("."))).licence
    'CC0'
    """
    kept = json.loads(text)
    return _with_options(Origin(NOWHERE, None, kept["scale"]), kept)


def _with_options(origin: Origin, kept: dict[str, Any]) -> Origin:
    """Return an origin with the parts of a text that may be missing."""
    options = {name: kept[name] for name in OPTIONAL if name in kept}
    labels = tuple((start, stop, label) for start, stop, label in kept.get("labels", ()))
    return origin._replace(**options, labels=labels)


def _first_file(places: Iterable[Path]) -> Path | None:
    return next((place for place in places if place.is_file()), None)


def is_origin(text: str) -> bool:
    """Return whether a text is valid output of `Origin.text`.

    Examples
    --------
    >>> is_origin('{"path": ["walk.bvh"], "skeleton": [], "scale": null}'), is_origin("walk.bvh")
    (True, False)
    """
    with suppress(ValueError):
        match json.loads(text):
            case {"path": [*path], "skeleton": [*skeleton], "scale": float() | None, **more}:
                fine = isinstance(more.get("mirrored", False), bool) and more.get("up") in AXES
                fine = fine and more.get("root_offset") in ROOT_OFFSETS
                fine = fine and _is_licence(more.get("licence", "")) and _are_labels(more.get("labels", []))
                return fine and all(isinstance(place, str) for place in path + skeleton)
    return False


def _is_licence(value: object) -> bool:
    """Return whether a value is a short text."""
    return isinstance(value, str) and len(value) <= LONGEST_LICENCE


def _are_labels(value: object) -> bool:
    """Return whether a value is a list of rows (start, stop, label) with valid times."""
    return isinstance(value, list) and all(map(_is_label, value))


def _is_label(row: object) -> bool:
    """Return whether a value is a row (start, stop, label) with valid times."""
    from mocap.files.label_tables import TIME  # the help of commands needs no NumPy

    match row:
        case [str(start), str(stop), str(label)]:
            return bool(TIME.fullmatch(start) and TIME.fullmatch(stop) and label)
    return False
