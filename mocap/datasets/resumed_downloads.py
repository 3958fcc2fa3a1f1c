"""A download that goes on where it broke off, and is whole or refused."""

from __future__ import annotations

import hashlib
import time
from pathlib import Path
from urllib.parse import urlsplit

from mocap._shared.progress import Progress
from mocap.errors import MocapError

PIECE = 2**20  # bytes written at once
TRIES = 3  # after 1 and 2 seconds
TIMEOUT = 30.0  # seconds without an answer
MISSING, WHOLE = 404, 416  # a server's answers: no such file; nothing comes after what you have


def download(url: str, path: Path, *, sha256: str | None = None, progress: Progress = iter) -> None:
    """Download a file; what has come is kept in `path` + ".part", and the next try goes on from there.

    Parameters
    ----------
    url : where it is.
    path : the file to make; it appears once it is whole.
    sha256 : its checksum, where it is known.
    progress : shows how far it is, in pieces of a megabyte.

    Raises
    ------
    MocapError : where it cannot be had after three tries, is not the file listed, or cannot be kept.
    """
    part, place = path.with_name(f"{path.name}.part"), f"{urlsplit(url).netloc}/.../{url.rpartition('/')[2]}"
    try:
        _try_often(url, place, part, progress)
        if sha256 and _digest(part) != sha256:
            part.unlink()
            raise MocapError(f"{place} is not the file listed: its checksum differs.")
        part.replace(path)
    except OSError as error:
        raise MocapError(f"Cannot keep {path}: {error.strerror or error}.") from error


def _try_often(url: str, place: str, part: Path, progress: Progress) -> None:
    from requests import RequestException

    for attempt in range(TRIES):
        time.sleep(attempt)
        try:
            _go_on(url, part, progress)
            return
        except RequestException as error:
            failed, status = error, error.response.status_code if error.response is not None else None
            if status == MISSING:
                break
    answer = f"answers {status}" if status else "breaks off or does not answer"
    raise MocapError(f"{place} {answer}: try again later, it goes on from there.") from failed


def _go_on(url: str, part: Path, progress: Progress) -> None:
    """Ask for what is missing, and add it."""
    import requests

    have = part.stat().st_size if part.exists() else 0
    asked = {"Range": f"bytes={have}-"} if have else {}
    with requests.get(url, headers=asked, stream=True, timeout=TIMEOUT) as answer:
        if have and answer.status_code == WHOLE:
            return
        answer.raise_for_status()
        pieces = -(-int(answer.headers.get("Content-Length", 0)) // PIECE)
        shown = iter(progress(range(pieces)))
        with part.open("ab" if answer.status_code == 206 else "wb") as file:
            for piece in answer.iter_content(PIECE):
                file.write(piece)
                next(shown, None)


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
