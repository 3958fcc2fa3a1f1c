"""The workers of a Dask cluster, to which `mocap graph --cluster` sends its work."""

import logging
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mocap
from mocap.errors import MocapError, missing, shortened

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from distributed import Client

ADDRESS = r"(tcp|tls|ws|wss)://[^\s:/]+:\d{1,5}"  # as a scheduler prints it when it starts
PATIENCE = 5.0  # seconds in which a scheduler must answer and have a worker
RETRIES = 3  # number of times that a block is computed again if its worker fails


@contextmanager
def connect(address: str) -> "Iterator[Executor]":
    """Connect to a Dask scheduler, and yield an executor that works on its workers.

    Parameters
    ----------
    address : as in tcp://10.0.0.5:8786.

    Raises
    ------
    MocapError : for a malformed address, if distributed is not installed, if no scheduler answers within
        `PATIENCE`, if it has no worker or its workers have another version of this package, and if the
        cluster fails later.
    """
    if not re.fullmatch(ADDRESS, address):
        raise MocapError(f"Where is the cluster '{address[:40]}'? Write tcp://HOST:PORT, as dask prints it.")
    from concurrent.futures import CancelledError  # not imported for the help

    try:
        import distributed
    except ImportError:
        raise missing("A cluster needs distributed", "distributed") from None
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # its errors are also raised here
    shown = shortened(address, 60)
    try:
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError):  # TimeoutError is an OSError
        text = f"No scheduler answers at {shown} within {PATIENCE:g} s: start one there by `dask scheduler`."
        raise MocapError(text) from None
    with client:
        _require_workers(client, shown)
        try:
            yield client.get_executor(retries=RETRIES)
        except (CancelledError, distributed.KilledWorker):
            raise MocapError(
                f"The cluster at {shown} broke down: its workers or its scheduler ended."
            ) from None


def _require_workers(client: "Client", address: str) -> None:
    """Raise if there is no worker in time, or if a worker lacks this version of the package."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        text = f"The scheduler at {address} has no workers: start some by `dask worker {address}`."
        raise MocapError(text) from None
    versions = set(client.run(_version_reader()).values())
    if versions != {mocap.__version__}:
        listed = ", ".join(sorted(versions))
        raise MocapError(f"Workers at {address} have mocap {listed}: install {mocap.__version__} there.")


def _version_reader() -> Callable[[], str]:
    """Return a function that reads the version of this package on a worker.

    A nested function is sent as code, so that a worker without the package can also run it.
    """

    def read() -> str:
        try:
            import mocap
        except ImportError:
            return "missing"
        return mocap.__version__

    return read
