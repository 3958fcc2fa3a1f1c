"""Small files from the network, fetched once and kept, each whole or refused.

`resumed_downloads` is for large ones. All are kept in the platform's cache folder, or in the one that the
environment variable `MOCAP_DATA` names. A file that is there needs no network; with `MOCAP_OFFLINE` nothing
else is asked for.
"""

import hashlib
import os
import sys
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

from mocap.errors import MocapError

RETRIES = 3  # after 1, 2 and 3 seconds
TIMEOUT = 30.0  # seconds without an answer


def kept_in() -> Path:
    """Return the folder of all fetched files."""
    import pooch

    return Path(os.environ.get("MOCAP_DATA") or pooch.os_cache("mocap"))


def fetch(name: str, url: str, sha256: str | None, terms: str) -> Path:
    """Find a file in the folder of fetched files, or download it and print the terms of its use.

    Parameters
    ----------
    name : its path relative to that folder, such as "16/16.asf".
    url : its address.
    sha256 : its checksum, if it is known. A file that differs only in its line ends is accepted.
    terms : the terms, printed once when something is downloaded.

    Raises
    ------
    MocapError : if it cannot be downloaded, is not the file listed, or cannot be written; then no part of it
        is kept. If the environment variable `MOCAP_OFFLINE` is set, for each file that is not there.
    """
    import pooch
    from requests import RequestException

    hint = f"put a copy of {name} into a folder that MOCAP_DATA names"
    if os.environ.get("MOCAP_OFFLINE") and not (kept_in() / name).exists():
        raise MocapError(f"{name} is not here, and MOCAP_OFFLINE forbids downloads: unset it, or {hint}.")

    def download(url: str, output_file: str, store: pooch.Pooch) -> None:
        pooch.HTTPDownloader(progressbar=sys.stderr.isatty(), timeout=TIMEOUT)(url, output_file, store)
        show_once(terms)
        if name.endswith((".asf", ".amc")):
            _restore_line_ends(Path(output_file), sha256)

    place = f"{urlsplit(url).netloc}/.../{url.rpartition('/')[2]}"
    pooch.get_logger().setLevel("WARNING")
    listing = {"registry": {name: sha256}, "urls": {name: url}}
    store = pooch.create(kept_in(), base_url="", **listing, retry_if_failed=RETRIES)
    try:
        return Path(store.fetch(name, downloader=download))
    except RequestException as error:
        status = error.response.status_code if error.response is not None else None
        answer = f"answers {status}" if status else "breaks off or does not answer"
        raise MocapError(f"{place} {answer}: try again later, or {hint}.") from error
    except ValueError as error:  # the checksum
        raise MocapError(f"{place} is not the file listed: its checksum differs; {hint}.") from error
    except OSError as error:
        problem = f"Cannot keep {name} in {store.abspath} ({error.strerror or error})"
        raise MocapError(f"{problem}: let MOCAP_DATA name a folder you may write to.") from error


def _restore_line_ends(file: Path, sha256: str | None) -> None:
    """Rewrite a text with the line ends, of Unix or of Windows, that its checksum belongs to."""
    unix = file.read_bytes().replace(b"\r\n", b"\n")
    for data in (unix, unix.replace(b"\n", b"\r\n")):
        if hashlib.sha256(data).hexdigest() == sha256:
            file.write_bytes(data)


@cache
def show_once(terms: str) -> None:
    """Print the terms of a set's use, at the first call."""
    print(terms, file=sys.stderr)
