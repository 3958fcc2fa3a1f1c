"""What all tests share, those of the notebooks too: the real clips, which the repository does not hold.

They lie in the folder that MOCAP_REAL_DATA names, or in ../shared/data: the CMU trials in `cmu`, as their
site names them, the homework's in `hw3`. Where they are missing, tests of them are skipped, and say so; no
test asks the network for them.
"""

import os
from pathlib import Path

import pytest

REAL = Path(os.environ.get("MOCAP_REAL_DATA", Path(__file__).parents[1] / "shared" / "data")).resolve()
THERE = all((REAL / folder).is_dir() for folder in ("cmu", "hw3"))
MISSING = None if THERE else f"no real clips at {REAL}; name their folder in MOCAP_REAL_DATA"

if not MISSING:
    os.environ["MOCAP_DATA"] = str(REAL / "cmu")  # for the kernels of the notebooks, which inherit it


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Return the folder of real clips."""
    if MISSING:
        pytest.skip(MISSING)
    return REAL


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip the one notebook whose outputs are of real clips, where there are none to compare with."""
    for item in items:
        if MISSING and item.path.name == "10-real-data.ipynb":
            item.add_marker(pytest.mark.skip(reason=MISSING))
