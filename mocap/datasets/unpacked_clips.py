"""The clips of an archive, written one by one, with a list of their checksums."""

from __future__ import annotations

import hashlib
import zipfile
import zlib
from pathlib import Path, PurePosixPath

from mocap._shared.atomic import replacing, write_text
from mocap._shared.progress import Progress
from mocap.datasets.known_sets import HASHES
from mocap.errors import MocapError

SUMS = "SHA256SUMS"  # as `sha256sum --check` reads it


def read_sums(folder: Path) -> dict[str, str]:
    """Read the checksums of fetched clips, by their files' names; none where no list is."""
    try:
        lines = (folder / SUMS).read_text("utf-8").splitlines()
    except OSError:
        return {}
    return {name: digest for digest, _, name in (line.partition("  ") for line in lines)}


def write_sums(folder: Path, sums: dict[str, str]) -> None:
    """Write the checksums of fetched clips."""
    write_text(folder / SUMS, "".join(f"{digest}  {name}\n" for name, digest in sorted(sums.items())))


def check_clip(path: Path, data: bytes, sums: dict[str, str]) -> str:
    """Give a clip's checksum.

    Raises
    ------
    MocapError : where it is not the one listed, or not the one of the first time.
    """
    digest = hashlib.sha256(data).hexdigest()
    if digest != HASHES.get(path.stem, sums.get(path.name, digest)):
        kept = "listed" if path.stem in HASHES else f"fetched first, by {SUMS}"
        raise MocapError(f"{path} is not the file {kept}: its checksum differs. Get it anew.")
    return digest


def unpack(archive: Path, folder: Path, progress: Progress = iter) -> list[str]:
    """Write all .bvh files of an archive into a folder, without the archive's own folders.

    Parameters
    ----------
    archive : a .zip file.
    folder : where the clips go; their checksums go into its `SHA256SUMS`.
    progress : shows how far it is.

    Returns
    -------
    The clips' names.

    Raises
    ------
    MocapError : for a damaged archive, one without clips, and a clip that is not the one fetched before.
    """
    sums = read_sums(folder)
    try:
        with zipfile.ZipFile(archive) as files:
            clips = [file for file in files.infolist() if _is_clip(file.filename)]
            for file in progress(clips):
                path = folder / PurePosixPath(file.filename).name
                data = files.read(file)
                sums[path.name] = check_clip(path, data, sums)
                with replacing(path) as beside:
                    beside.write_bytes(data)
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError) as error:
        raise MocapError(f"{archive} is damaged, or no .zip file: delete it, and try again.") from error
    if not clips:
        raise MocapError(f"{archive} holds no .bvh file.")
    write_sums(folder, sums)
    return [PurePosixPath(file.filename).stem for file in clips]


def _is_clip(name: str) -> bool:
    """Tell clips from other files, and from what macOS adds to archives."""
    path = PurePosixPath(name)
    return path.suffix.lower() == ".bvh" and not path.name.startswith("._")
