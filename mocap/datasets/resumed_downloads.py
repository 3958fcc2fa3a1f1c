"""Downloads of large files that resume after an interruption, with verification of the result.

The next call requests the rest of the file (`Range`), on the condition that its validator, an ETag or a date,
is still the same (`If-Range`; RFC 9110, sections 13.1.5 and 14). If the file has changed, or the server does
not support ranges, the download starts again. `partial_files` stores the received bytes.
"""

from __future__ import annotations

import re
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, NamedTuple
from urllib.parse import urlsplit

from mocap._shared.progress import Progress
from mocap.datasets.partial_files import MEGABYTE, Part, Record, keeping, require_space, sha256_of
from mocap.errors import MocapError, shortened

if TYPE_CHECKING:
    from requests import RequestException, Response

PIECE = 2**18  # bytes received at a time, the largest loss if a connection breaks
PAUSES = (1.0, 2.0, 3.0)  # seconds before each retry, as long as no new bytes are received
TIMEOUT = 30.0  # seconds without a response
LARGEST = 4000  # MB of a file whose size is not listed: 2.7 times the largest dataset
ROUNDING = 1  # MB: listed sizes are integers

# Status codes (RFC 9110, section 15):
WHOLE = 200
PARTIAL = 206  # with the requested range
FINAL = (401, 403, 404, 410)  # a retry would have the same result
BEYOND_END = 416  # no byte of the range exists


class Listing(NamedTuple):
    """The known properties of a file before it is downloaded.

    Parameters
    ----------
    url : the address.
    megabytes : the rounded size; None if it is unknown.
    sha256 : the checksum; None if it is unknown.
    """

    url: str
    megabytes: int | None = None
    sha256: str | None = None

    def name(self) -> str:
        """Return the server and the name of the file, for messages.

        Examples
        --------
        >>> Listing("https://example.org/sets/2022/walks.zip").name()
        'example.org/.../walks.zip'
        """
        parts = urlsplit(self.url)
        return shortened(f"{parts.netloc}/.../{parts.path.rpartition('/')[2]}", 60)


def download(listing: Listing, target: Path, progress: Progress = iter) -> str:
    """Download a file, or the part of it that earlier calls did not receive.

    Parameters
    ----------
    listing : its address, and its size and checksum if they are known.
    target : the path of the file, in a folder that exists. The file is created once it is complete and has
        the listed checksum.
    progress : shows the progress of the download, as `tqdm.tqdm` does.

    Returns
    -------
    The SHA-256 of the file.

    Raises
    ------
    MocapError : if the server does not send it, with the way to resume, and if it cannot be stored, for lack
        of permission or of space. Also if its checksum differs from that listed. Then nothing is stored.

    Examples
    --------
    >>> download(Listing("https://example.org/walks.zip"), Path("nowhere/walks.zip"))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot keep walks.zip in nowhere (No such file or directory): let MOCAP_DATA ...
    """
    part = Part(target, listing.url)
    try:
        with keeping(target):
            part.path.touch()  # raises before any request
            _receive(listing, part, progress)
            digest = sha256_of(part.path)
            if listing.sha256 not in (None, digest):
                part.drop()
                raise MocapError(
                    f"{listing.name()} is not the file listed: its checksum differs. Nothing of it is kept; "
                    f"try again later, or get the set from its authors."
                )
            part.finish()
    except KeyboardInterrupt as interruption:
        interruption.add_note(part.advice())
        raise
    finally:
        with suppress(OSError):  # of a folder that cannot be written into
            part.tidy()
    return digest


def _receive(listing: Listing, part: Part, progress: Progress) -> None:
    """Request the file, or the rest of it, until it is complete."""
    furthest = part.size()
    failures = 0
    while not part.is_whole():
        error = _try_request(listing, part, progress)
        if error is None:
            continue
        if part.size() >= furthest + PIECE:
            failures = 0  # an unreliable connection that makes progress may continue
            furthest = part.size()
        status = getattr(error.response, "status_code", None)
        if failures == len(PAUSES) or status in FINAL:
            happened = f"answers {status}" if status else "breaks off or does not answer"
            raise MocapError(f"{listing.name()} {happened}. {part.advice()}") from error
        time.sleep(PAUSES[failures])
        failures += 1


def _try_request(listing: Listing, part: Part, progress: Progress) -> RequestException | None:
    """Request the missing bytes once. Return an error after which a retry may succeed, or None."""
    from requests import RequestException
    from requests.exceptions import InvalidSchema, InvalidURL, TooManyRedirects

    try:
        _request(listing, part, progress)
    except (InvalidSchema, InvalidURL, TooManyRedirects) as error:
        raise MocapError(
            f"{listing.name()} leads to an address that is not safe to download from: get the set from its "
            f"authors."
        ) from error
    except RequestException as error:
        return error
    return None


def _request(listing: Listing, part: Part, progress: Progress) -> None:
    """Request the missing bytes once, and append those received to the part.

    Raises
    ------
    RequestException : if the request fails, or not all missing bytes are received.
    """
    import requests

    headers = {"Accept-Encoding": "identity"}  # ranges count the bytes of the file itself
    earlier = part.continuable()
    if earlier and earlier.validator:
        headers |= {"Range": f"bytes={part.size()}-", "If-Range": earlier.validator}
    with requests.get(listing.url, headers=headers, stream=True, timeout=TIMEOUT) as answer:
        _require_safe(answer)
        if earlier and answer.status_code != WHOLE and not _continues(answer, part, earlier):
            part.drop()  # the next request is for the whole file
            return
        answer.raise_for_status()
        if answer.status_code == WHOLE:
            offered = _describe(answer, listing.url)
            part.drop()
            _require_size(listing, part, offered.length, 0)
            part.write(offered)
        elif earlier is None or answer.status_code != PARTIAL:
            raise requests.RequestException(f"unexpected status {answer.status_code}", response=answer)
        else:
            _require_size(listing, part, earlier.length, part.size())
        _append(listing, part, answer, progress)
    if not part.is_whole():
        raise requests.RequestException("less was sent than announced")


def _require_safe(answer: Response) -> None:
    """Reject redirections from https to http; `requests` rejects those to `file:` and similar schemes."""
    from requests.exceptions import InvalidSchema

    schemes = [urlsplit(step.url).scheme for step in (*answer.history, answer)]
    if "https" in schemes and "http" in schemes[schemes.index("https") :]:
        raise InvalidSchema("from https to http")


def _continues(answer: Response, part: Part, earlier: Record) -> bool:
    """Return whether a response is the rest of the same file, or an error independent of the file."""
    if answer.status_code == BEYOND_END:
        return False
    if answer.status_code != PARTIAL:
        return True
    if _is_encoded(answer):
        return False
    offered = _describe(answer, part.url)
    if offered.validator not in (None, earlier.validator) or offered.length not in (None, earlier.length):
        return False
    return answer.headers.get("Content-Range", "").startswith(f"bytes {part.size()}-")


def _is_encoded(answer: Response) -> bool:
    """Return whether a response is compressed, although this was not requested; `requests` unpacks it."""
    return str(answer.headers.get("Content-Encoding", "identity")) != "identity"


def _describe(answer: Response, url: str) -> Record:
    """Read the address, validator and length of a file from the headers of a response.

    A weak ETag (`W/`) may remain the same although bytes change, and the length of an encoded response is not
    that of the file.
    """
    headers = answer.headers
    if _is_encoded(answer):
        return Record(url, None, None)
    tag = headers.get("ETag", "W/")
    validator = headers.get("Last-Modified") if tag.startswith("W/") else tag
    length = headers.get("Content-Length", "")
    if answer.status_code == PARTIAL:
        length = headers.get("Content-Range", "").rpartition("/")[2]
    return Record(url, validator, int(length) if re.fullmatch(r"\d{1,18}", length) else None)


def _require_size(listing: Listing, part: Part, length: int | None, size: int) -> None:
    """Raise if a file has another size than listed or exceeds the disk space, before it is transferred."""
    if length is None:
        return
    if listing.megabytes is not None and abs(length - listing.megabytes * MEGABYTE) > ROUNDING * MEGABYTE:
        raise MocapError(
            f"{listing.name()} has {length / MEGABYTE:.0f} MB, and {listing.megabytes} MB are listed: it is "
            f"another file. Try again later, or get the set from its authors."
        )
    _require_bound(listing, length)
    require_space(part.target, length - size)


def _require_bound(listing: Listing, size: int) -> None:
    """Raise if a file is larger than its listed size, or than the limit without one."""
    bound = LARGEST if listing.megabytes is None else listing.megabytes + ROUNDING
    if size > bound * MEGABYTE:
        raise MocapError(
            f"{listing.name()} has more than {bound} MB, so it is another file, and nothing of it is kept: "
            f"get the set from its authors."
        )


def _append(listing: Listing, part: Part, answer: Response, progress: Progress) -> None:
    """Append the body of a response to the part, piece by piece."""
    record = part.record()
    missing = record.length - part.size() if record and record.length else 0
    shown = iter(progress(range(-(-missing // PIECE))))
    with part.path.open("ab", buffering=0) as file:  # if the process is killed, written pieces are not lost
        for piece in answer.iter_content(PIECE):
            _require_bound(listing, file.tell() + len(piece))
            _write_all(file, piece)
            next(shown, None)
    for _ in shown:  # completes a progress bar
        pass
    if record and record.length is None:
        part.write(record._replace(length=part.size()))


def _write_all(file: BinaryIO, data: bytes) -> None:
    """Write all data to an unbuffered file, which may accept only a part of it at a time."""
    remaining = memoryview(data)
    while remaining:
        remaining = remaining[file.write(remaining) :]
