"""Constants of long random walks that trials chose; `figures/tune/synthesis.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    margin: float = 5.0  # seconds cleaned twice. Longer than footplants, and than corrections reach
    piece: float = 30.0  # seconds of a piece at least. Shorter ones take longer, longer ones more memory


TUNED = Tuned()
