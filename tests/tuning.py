"""Other values of tuned constants, for the time of a test."""

from dataclasses import replace
from types import ModuleType

import pytest


def tune(patch: pytest.MonkeyPatch, module: ModuleType, **values: object) -> None:
    """Let one module read other values of its room's `TUNED`."""
    patch.setattr(module, "TUNED", replace(module.TUNED, **values))
