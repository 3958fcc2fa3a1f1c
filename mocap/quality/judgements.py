"""What `judge` says of a motion: numbers over their limits, and a table of many motions."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from mocap.errors import shortened


class Measure(NamedTuple):
    """Something measured, its limit in the same unit, and where it is worst.

    Examples
    --------
    >>> Measure("slide", 5.0, 2.5, "cm", "'lfoot', frame 30").ratio
    2.0
    """

    name: str
    value: float
    limit: float
    unit: str
    where: str = ""

    @property
    def ratio(self) -> float:
        """How many times its limit it is."""
        return self.value / self.limit


class Judgement(NamedTuple):
    """What was measured of a motion; `left_out` says what could not be, and why.

    `height` is the body's vertical extent, the median over the frames, and `bones` the length of each joint's
    bone, from its parent to it; both in metres.

    Examples
    --------
    >>> from mocap.datasets.generated import generate
    >>> from mocap.quality.judging import judge
    >>> judged = judge(generate("walk_straight"))
    >>> judged.worst.ratio < 1, judged.stand_out
    (True, [])
    """

    name: str
    frames: int
    fps: float
    measures: tuple[Measure, ...]
    left_out: tuple[str, ...]
    height: float
    bones: Mapping[str, float]

    @property
    def worst(self) -> Measure:
        """The measure that is most times its limit."""
        return max(self.measures, key=lambda measure: measure.ratio)

    @property
    def score(self) -> float:
        """How many times the measures must be halved, in all, to be within their limits; 0 is best."""
        return float(sum(np.log2(max(measure.ratio, 1.0)) for measure in self.measures))

    @property
    def stand_out(self) -> list[Measure]:
        """The measures beyond their limits, the worst first."""
        return sorted((m for m in self.measures if m.ratio > 1), key=lambda m: -m.ratio)

    def as_dict(self) -> dict[str, Any]:
        """Give plain numbers and texts, for JSON."""
        rows = [measure._asdict() | {"ratio": measure.ratio} for measure in self.measures]
        more = {"left_out": list(self.left_out), "worst": self.worst.name, "score": self.score}
        return self._asdict() | {"measures": rows} | more


def judgement_table(judgements: Sequence[Judgement]) -> str:
    """Write a line for each motion, the best first: score, height, each measure over its limit, the worst.

    Examples
    --------
    >>> from mocap.datasets.generated import generate
    >>> from mocap.quality.judging import judge
    >>> for line in judgement_table([judge(generate("walk_straight"))]).splitlines():
    ...     print(line[:60])
    name          score  height    jolt tremble    sunk    turn
    walk_straight   0.0  1.69 m    0.38    0.05    0.00    0.23

    Notebook: 10-real-data
    """
    names = list(dict.fromkeys(measure.name for judged in judgements for measure in judged.measures))
    width = max([4, *(len(shortened(judged.name, 40)) for judged in judgements)])
    heads = " ".join(f"{name:>7}" for name in ["height", *names])
    rows = [f"{'name':<{width}} {'score':>5} {heads}  worst"]
    for judged in sorted(judgements, key=lambda judged: (judged.score, judged.worst.ratio)):
        ratios = {measure.name: f"{measure.ratio:.2f}" for measure in judged.measures}
        worst = judged.worst
        cells = [f"{ratios.get(name, '-'):>{max(7, len(name))}}" for name in names]
        numbers = " ".join([f"{f'{judged.height:.3g} m':>7}", *cells])
        said = f"{worst.name} {worst.value:.3g} {worst.unit} {worst.where and f'({worst.where})'}".rstrip()
        rows.append(f"{shortened(judged.name, 40):<{width}} {judged.score:>5.1f} {numbers}  {said}")
    return "\n".join(rows)
