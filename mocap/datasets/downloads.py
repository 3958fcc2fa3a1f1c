"""Downloads of small files, verified and cached.

`resumed_downloads` is for large files. The cache is the platform's cache folder, or that in the environment
variable `MOCAP_DATA`. A cached file needs no network. `MOCAP_OFFLINE` forbids downloads.
"""

import hashlib
import os
import sys
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

from mocap.errors import MocapError

RETRIES = 3  # after 1, 2 and 3 seconds
TIMEOUT = 30.0  # seconds without a response


def kept_in() -> Path:
    """Return the cache, the folder of all downloaded files."""
    import pooch

    return Path(os.environ.get("MOCAP_DATA") or pooch.os_cache("mocap"))


def fetch(name: str, url: str, sha256: str | None, terms: str) -> Path:
    """Find a file in the cache, or download it and print its terms of use.

    Parameters
    ----------
    name : the path relative to the cache, such as "16/16.asf".
    url : the address.
    sha256 : the checksum, if it is known. A file that differs only in its line ends is accepted.
    terms : the terms of use, printed once if something is downloaded.

    Raises
    ------
    MocapError : if it cannot be downloaded, has another checksum, or cannot be written. Then no part of it is
        stored. If the environment variable `MOCAP_OFFLINE` is set, for each file that is not cached.
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
    """Rewrite a text with line ends of Unix or of Windows, as its checksum requires."""
    unix = file.read_bytes().replace(b"\r\n", b"\n")
    for data in (unix, unix.replace(b"\n", b"\r\n")):
        if hashlib.sha256(data).hexdigest() == sha256:
            file.write_bytes(data)


@cache
def show_once(terms: str) -> None:
    """Print the terms of use of a dataset, at the first call only."""
    print(terms, file=sys.stderr)
