"""The clips of a saved graph or web, by name, length and fingerprint, to find them again and compare them.

Such a file contains no frames of its clips. It stores the paths of their files, if these are given.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from mocap._shared.archives import Arrays, Layout, Rules
from mocap._shared.progress import Progress
from mocap._shared.records import NamedTuple
from mocap.body.concatenation import require_compatible
from mocap.body.fingerprints import fingerprint
from mocap.body.motion import Motion, resample
from mocap.datasets.clip_origins import NOWHERE, Origin, find_again, is_origin, stored_options
from mocap.datasets.samples import FPS, FRAMES_IN_0_1, SAMPLES, sample
from mocap.editing.mirroring import mirror, mirrored_label
from mocap.errors import MocapError, Remedy, shortened
from mocap.files.conversion import is_clip
from mocap.files.label_tables import LabelRow, label_clips
from mocap.files.load_save import load
from mocap.files.role_maps import are_packed_roles, packed_roles, unpacked_roles

MOST_FRAMES = 2**31  # of a clip
NEAR_FRAMES = 2  # frames by which the resampled length of a clip may differ from its duration
FASTEST = 1e6  # frames per second
CLIPS = ("C",)  # the shape of an array with an entry for each of C clips
TEXTS = (str, CLIPS)
# The arrays of a file for C clips and O origins.
LAYOUT: Layout = {
    "fps": (float, ()),
    "names": TEXTS,
    "frames": (int, CLIPS),  # of each clip
    "fingerprints": TEXTS,
    "origins": (str, ("O",)),
    "roles": TEXTS,  # of the joints of each clip, from `packed_roles`
}


class ClipReferences(NamedTuple):
    """References to the clips of a graph or web: their rate, names, lengths in frames, and fingerprints.

    A fingerprint of "" matches any clip. `origins` are texts of `Origin`, one for each clip, or none. `roles`
    are texts from `packed_roles`, one for each clip, or none in files of earlier versions.

    Examples
    --------
    >>> ClipReferences(30.0, ["walk"], [90], [""], []).names
    ['walk']
    """

    fps: float
    names: list[str]
    frames: list[int]
    fingerprints: list[str]
    origins: list[str]
    roles: Sequence[str] = ()


def arrays_of_clips(clips: Sequence[Motion], origins: Sequence[Origin], path: str | Path) -> dict[str, Any]:
    """Return the arrays of `LAYOUT` for clips of one rate, in a file that will be written to `path`."""
    arrays: dict[str, Any] = {"fps": clips[0].fps}
    arrays["names"] = [clip.name for clip in clips]
    arrays["frames"] = [len(clip) for clip in clips]
    arrays["fingerprints"] = [fingerprint(clip) for clip in clips]
    arrays["origins"] = [origin.text(Path(path).parent) for origin in origins]
    arrays["roles"] = [packed_roles(clip.skeleton.roles) for clip in clips]
    return arrays


def references_in(arrays: Arrays) -> ClipReferences:
    """Return the references in the arrays of a file."""
    return ClipReferences(**{key: arrays[key].tolist() for key in ClipReferences._fields if key in arrays})


def rules_of_clips(arrays: Arrays) -> Rules:
    """Yield the validity rules for the arrays of `LAYOUT`."""
    lengths = arrays["frames"]
    yield "origins are one for each clip, or none", len(arrays["origins"]) in (0, len(lengths))
    yield "origins are places of files", [is_origin(text) for text in arrays["origins"].tolist()]
    yield "the rate is above 0", 0 < arrays["fps"] < FASTEST
    yield "there are clips", len(lengths) > 0
    yield "clips have frames", (lengths > 0) & (lengths < MOST_FRAMES)
    if "roles" in arrays:
        yield "roles are names of joints", [are_packed_roles(text) for text in arrays["roles"].tolist()]


def find_files_of(references: ClipReferences, path: str | Path) -> list[Origin]:
    """Find the files of the clips to which a file at `path` refers, none for bundled samples.

    A clip is searched at its stored paths, then by its name in the folder of the file.

    Raises
    ------
    MocapError : for a clip that is not found.
    """
    folder = Path(path).parent
    if set(references.names) <= set(SAMPLES) and not references.origins:
        return []
    neighbours = {file.stem: file for file in sorted(folder.iterdir()) if is_clip(file)}
    places: list[Origin] = []
    for name, text in itertools.zip_longest(references.names, references.origins):
        origin = find_again(text, folder) if text else None
        if origin is None and name not in neighbours:
            lost = f"The clip '{shortened(name)}' is no longer where {path} found it."
            raise MocapError(lost, remedy=Remedy("give {}", "clips"))
        places.append(origin or Origin(neighbours[name]))
    return places


def load_references(
    references: ClipReferences,
    path: str | Path,
    clips: Sequence[Motion] | None,
    skeleton: Path | None,
    progress: Progress,
) -> list[Motion]:
    """Return the clips to which a file at `path` refers, in its order, at its rate, with the roles it stores.

    Parameters
    ----------
    references, path : the references in the file, and its path.
    clips : motions that include these clips; None to read them from their files, or to use bundled ones.
    skeleton : the `.asf` file of `.amc` clips, by default that of the origin, or one that matches.
    progress : wraps the iterable of files of clips, to show a progress bar.

    Raises
    ------
    MocapError : for a clip that is missing, cannot be read, or has changed.
    """
    if clips is None:
        clips = _load_clips(references, path, skeleton, progress)
        named = clips
    else:
        named = _with_stored_labels(clips, references)
    resampled = [resample(clip, references.fps) for clip in named]
    needed = [clip for clip in resampled if clip.name in references.names]
    with suppress(MocapError):  # give all clips the same end sites (differences are reported below)
        needed = list(require_compatible(needed))
    by_name = defaultdict[str, list[Motion]](list)
    for clip in needed:
        by_name[clip.name].append(clip)
    chosen: list[Motion] = []
    rows = zip(references.names, references.frames, references.fingerprints, strict=True)
    for name, length, digest in rows:
        fitting = [clip for clip in by_name[name] if _is_same(clip, length, digest)]
        if not fitting:
            fitting = _same_content(clips, references, len(chosen))
        if not (fitting or by_name[name]):
            names = shortened(", ".join(dict.fromkeys(clip.name for clip in clips)) or "none")
            raise MocapError(f"{path} needs the clip '{shortened(name)}'; given are: {names}.")
        if not fitting:
            raise _difference(path, by_name[name][-1], length)
        chosen.append(fitting[0])
    return with_stored_roles(chosen, references)


def _with_stored_labels(clips: Sequence[Motion], references: ClipReferences) -> list[Motion]:
    """Return clips with the stored labels, which replace others; those without keep theirs."""
    rows: dict[str, list[LabelRow]] = {}
    for name, text in zip(references.names, references.origins, strict=False):
        origin = stored_options(text)
        change = mirrored_label if origin.mirrored else str
        rows[name] = [LabelRow(name, start, stop, change(label)) for start, stop, label in origin.labels]
    return [label_clips([clip], rows.get(clip.name, ()))[0] for clip in clips]


def with_stored_roles(clips: Sequence[Motion], references: ClipReferences) -> list[Motion]:
    """Return clips whose joints have the stored roles, which replace others; those without keep theirs."""
    chosen = []
    for clip, text in itertools.zip_longest(clips, references.roles):
        stored = unpacked_roles(text) if text else {}
        skeleton = replace(clip.skeleton, roles=stored)
        chosen.append(replace(clip, skeleton=skeleton) if stored else clip)
    return chosen


def _load_clips(
    references: ClipReferences, path: str | Path, skeleton: Path | None, progress: Progress
) -> list[Motion]:
    """Load the clips of a file from their files, or return the bundled ones."""
    origins = find_files_of(references, path)
    if not origins:
        return [sample(name) for name in references.names]
    stored_roles = [unpacked_roles(text) for text in references.roles] or [{}] * len(origins)
    clips = []
    for name, roles, origin in zip(references.names, stored_roles, progress(origins), strict=True):
        clip = load(
            origin.path,
            skeleton=skeleton or origin.skeleton,
            scale=origin.scale,
            up=origin.up,
            root_offset=origin.root_offset,
            roles=roles,
        )
        labels = [LabelRow(clip.name, *row) for row in origin.labels]
        (clip,) = label_clips([clip], labels)
        clips.append(replace(mirror(clip) if origin.mirrored else clip, name=name))
    return clips


def _same_content(clips: Sequence[Motion], references: ClipReferences, number: int) -> list[Motion]:
    """Find clips with the content of a reference under another name, or whose mirror image it is."""
    name = references.names[number]
    digest = references.fingerprints[number]
    origin = stored_options(references.origins[number]) if references.origins else Origin(NOWHERE)
    fitting: list[Motion] = []
    for clip in clips if digest else ():
        if abs(clip.duration * references.fps - references.frames[number]) > NEAR_FRAMES:
            continue
        labels = [LabelRow(clip.name, *row) for row in origin.labels]
        (labelled,) = label_clips([clip], labels)
        shown = resample(mirror(labelled) if origin.mirrored else labelled, references.fps)
        if len(shown) == references.frames[number] and fingerprint(shown) == digest:
            fitting.append(replace(shown, name=name))
    return fitting


def _is_same(clip: Motion, length: int, digest: str) -> bool:
    """Return whether a clip has a length, in frames, and a fingerprint."""
    return len(clip) == length and (not digest or fingerprint(clip) == digest)


def _difference(path: str | Path, clip: Motion, length: int) -> MocapError:
    """Return the error that a clip differs from that of the file, which had `length` frames."""
    if _was_bundled_in_0_1(clip.name, length, clip.fps):
        return MocapError(
            f"{path} was built of the clips of mocap 0.1, which later versions do not have. "
            "Build it anew, or load it with mocap 0.1."
        )
    difference = "other poses, bones or units"
    if len(clip) != length:
        difference = f"{length} frames then, {len(clip)} now"
    named = f"another '{shortened(clip.name)}'"
    return MocapError(f"{path} was built of {named}: {difference}. Take that clip, or build anew.")


def _was_bundled_in_0_1(name: str, length: int, fps: float) -> bool:
    """Return whether a clip with this number of frames was bundled with mocap 0.1."""
    intervals = FRAMES_IN_0_1.get(name, 0) - 1
    return length == int(intervals * fps / FPS) + 1
