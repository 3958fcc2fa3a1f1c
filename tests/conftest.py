"""What the tests share."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).parents[1]

settings.register_profile("house", deadline=None)  # a busy machine is no failure
settings.load_profile("house")


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Return the folder of real clips, which the repository does not hold."""
    folder = Path(os.environ.get("MOCAP_REAL_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no real clips at {folder}; name their folder in MOCAP_REAL_DATA")
    return folder


ASKED_FOR = ("benchmark", "exhaustive")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what takes long, unless `-m` asks for it by name."""
    names = [name for name in ASKED_FOR if name not in config.option.markexpr]
    out = [item for item in items if any(item.get_closest_marker(name) for name in names)]
    items[:] = [item for item in items if item not in out]
    config.hook.pytest_deselected(items=out)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Measure no coverage inside the notebooks' kernels: nbval waits in vain for those that it starts."""
    session.config.option.cov_source = None
