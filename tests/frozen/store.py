"""Compare quantities with stored ones, and store new ones: a file of a few kilobytes for each case.

Stored are samples: numbers at regular steps along the axes without labels, as near to each other as SPACE
allows, in whole multiples of a resolution. What changes between samples is noticed by weighted sums, or by
checksums of whole numbers: of each block of rows, and of each place on the labelled axes (each joint and
direction), so that the sums too say where.

Two numbers are the same if they differ by no more than RESOLUTIONS resolutions, or by RELATIVE of the stored
number; two sums, if they differ by no more than RELATIVE of the sum, or OF_SIZES of the sum of all absolute
values. So much is left to the arithmetic of another processor. Whole numbers are compared exactly.
"""

import json
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from tests.frozen.quantities import Quantity

FOLDER = Path(__file__).with_name("results")
SPACE = 4_500  # bytes of compressed samples of one case
MOST_BLOCKS = 60  # sums along the rows of a quantity
METRES = 1e-6  # the resolution of lengths
OF_LARGEST = (
    1e-6  # the resolution of other numbers, as a fraction of the largest, rounded up to a power of ten
)
OF_SIZES = 1e-7  # tolerance of a sum, as a fraction of the sum of absolute values
RELATIVE = 1e-6  # tolerance, as a fraction of the stored number
RESOLUTIONS = 2.0  # tolerance of a sample, half of it for rounding
SUM_STEPS = 1e8  # a sum is stored in multiples of the sum of absolute values, divided by this
LARGEST = 2**31 - 4  # of a stored whole number; the three above it stand for the numbers below
SPECIAL = {np.inf: LARGEST + 1, -np.inf: LARGEST + 2, np.nan: LARGEST + 3}
MILLIMETRES_PER_METRE = 1000


@dataclass(frozen=True)
class Change:
    """The difference of a quantity that shows best where a result has changed."""

    quantity: str
    place: str
    expected: str
    found: str
    difference: str
    extent: str  # how many numbers differ, and in which rows

    def __str__(self) -> str:
        return (
            f"{self.quantity}, {self.place}: expected {self.expected}, found {self.found}, "
            f"difference {self.difference}; {self.extent}"
        )


@dataclass(frozen=True)
class Stored:
    """What is stored of a quantity."""

    shape: tuple[int, ...]
    steps: tuple[int, ...]  # from sample to sample along each axis
    exact: bool
    resolution: float
    size: float  # the sum of absolute values
    samples: np.ndarray  # whole multiples of the resolution
    total: np.ndarray  # one sum
    blocks: np.ndarray  # a sum, or a checksum, of each block of rows
    margins: np.ndarray  # a sum of each place on the labelled axes

    @property
    def rows_per_block(self) -> int:
        return rows_per_block(self.shape)


def rows_per_block(shape: tuple[int, ...]) -> int:
    return max(1, -(-(shape[0] if shape else 1) // MOST_BLOCKS))


def resolution_of(quantity: Quantity) -> float:
    if quantity.exact:
        return 1
    largest = np.abs(finite(quantity.values)).max(initial=0)
    if quantity.unit == "m":
        return max(METRES, 10.0 ** np.ceil(np.log10(max(largest, METRES) / LARGEST)))
    return OF_LARGEST * 10.0 ** np.ceil(np.log10(largest)) if largest else OF_LARGEST


def finite(values: np.ndarray) -> np.ndarray:
    return np.nan_to_num(values.astype(float), posinf=0, neginf=0)


def quantise(values: np.ndarray, resolution: float) -> np.ndarray:
    """Round numbers to whole multiples of a resolution; infinities and nan have their own codes."""
    whole = np.array(np.rint(finite(values) / resolution), np.int64)
    assert np.abs(whole).max(initial=0) <= LARGEST
    for number, code in SPECIAL.items():
        same = np.isnan(values) if np.isnan(number) else values == number
        whole[same] = code
    return whole.astype(np.int32)


def restore(whole: np.ndarray, resolution: float) -> np.ndarray:
    """Return the numbers that were rounded to whole multiples of a resolution."""
    values = np.array(whole * float(resolution))
    for number, code in SPECIAL.items():
        values[whole == code] = number
    return values


def sampled(values: np.ndarray, steps: tuple[int, ...]) -> np.ndarray:
    return values[tuple(slice(None, None, step) for step in steps)]


def summarise(quantity: Quantity, space: int) -> Stored:
    """Compute what is stored of a quantity, with samples that take no more than some bytes."""
    values = quantity.values
    resolution = resolution_of(quantity)
    whole = quantise(values, resolution)
    steps = np.ones(values.ndim, int)
    while packed_size(sampled(whole, tuple(steps))) > space:
        lengths = np.array(sampled(whole, tuple(steps)).shape)
        free = [
            number for number, axis in enumerate(quantity.axes) if not axis.labels and lengths[number] > 1
        ]
        chosen = max(free or range(values.ndim), key=lambda number: lengths[number])
        steps[chosen] = max(steps[chosen] + 1, int(steps[chosen] * 1.25))
    size = float(np.abs(finite(values)).sum())
    total, blocks, margins = sums_of(quantity, size)
    samples = sampled(whole, tuple(steps))
    if samples.size == values.size:  # nothing is between the samples
        blocks, margins = blocks[:0], margins[:0]
    shape = tuple(map(int, values.shape))
    each = tuple(map(int, steps))
    return Stored(shape, each, quantity.exact, resolution, size, samples, total, blocks, margins)


def sums_of(quantity: Quantity, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sum up a quantity: all of it, each block of rows, and each place on the labelled axes."""
    values = np.atleast_1d(quantity.values)
    starts = range(0, len(values), rows_per_block(values.shape))
    parts = [values[start : start + rows_per_block(values.shape)] for start in starts]
    none = np.zeros(0, np.int32)
    if quantity.exact:
        checksums = [zlib.crc32(part.astype("<i8").tobytes()) for part in parts]
        return none, np.array(checksums, np.uint32).view(np.int32), none
    weighted = finite(values) * np.cos(np.arange(values.size) ** 2).reshape(values.shape)
    step = max(size, np.finfo(float).tiny) / SUM_STEPS
    blocks = [weighted[start : start + rows_per_block(values.shape)].sum() for start in starts]
    free = tuple(number for number, axis in enumerate(quantity.axes) if not axis.labels)
    margins = weighted.sum(axis=free).ravel() if free and len(free) < values.ndim else none
    return tuple(quantise(np.asarray(row), step) for row in ([weighted.sum()], blocks, margins))


def pack(samples: np.ndarray) -> bytes:
    """Write whole numbers so that they compress well: changes along the rows, byte by byte."""
    rows = samples.reshape(len(samples), -1) if samples.ndim else samples.reshape(1, 1)
    changes = np.diff(rows.astype(np.int32), axis=0, prepend=np.int32(0))  # may wrap around, and back
    return np.ascontiguousarray(changes, "<i4").view(np.uint8).reshape(-1, 4).T.tobytes()


def unpack(packed: bytes, shape: tuple[int, ...]) -> np.ndarray:
    """Return the whole numbers of a shape that `pack` has written."""
    octets = np.frombuffer(packed, np.uint8).reshape(4, -1).T
    changes = np.ascontiguousarray(octets).view("<i4").astype(np.int32)
    rows = changes.reshape(shape[0] if shape else 1, -1)
    return np.cumsum(rows, axis=0, dtype=np.int32).reshape(shape)


def packed_size(samples: np.ndarray) -> int:
    return len(zlib.compress(pack(samples)))


def path_of(case: str, folder: Path = FOLDER) -> Path:
    return folder / f"{case.replace(',', '').replace(' ', '-')}.npz"


def summarise_all(quantities: dict[str, Quantity]) -> dict[str, Stored]:
    """Share the space of a case among its quantities; small ones leave theirs to the others."""
    stored, space = {}, SPACE
    in_order = sorted(quantities, key=lambda name: quantities[name].values.size)
    for count, name in enumerate(in_order):
        stored[name] = summarise(quantities[name], space // (len(in_order) - count))
        space -= packed_size(stored[name].samples)
    return {name: stored[name] for name in quantities}


def write(file: Path, quantities: dict[str, Quantity]) -> None:
    """Store quantities, in the same bytes for the same numbers."""
    stored = summarise_all(quantities)
    facts = {
        name: {
            "shape": part.shape,
            "steps": part.steps,
            "exact": part.exact,
            "resolution": part.resolution,
            "size": float(f"{part.size:.9g}"),
            "sums": [len(part.total), len(part.blocks), len(part.margins)],
        }
        for name, part in stored.items()
    }
    samples = b"".join(pack(part.samples) for part in stored.values())
    sums = np.hstack([row for part in stored.values() for row in (part.total, part.blocks, part.margins)])
    file.parent.mkdir(exist_ok=True)
    members = {
        "facts": np.frombuffer(json.dumps(facts).encode(), np.uint8),
        "samples": np.frombuffer(samples, np.uint8),
        "sums": sums.astype("<i4"),
    }
    np.savez_compressed(file, **members)


def read(file: Path) -> dict[str, Stored]:
    """Return what is stored of each quantity of a case."""
    with np.load(file) as members:
        facts = json.loads(members["facts"].tobytes())
        samples = members["samples"].tobytes()
        sums = members["sums"].astype(np.int32)
    stored = {}
    for name, part in facts.items():
        shape, steps = tuple(part["shape"]), tuple(part["steps"])
        lengths = tuple(-(-length // step) for length, step in zip(shape, steps, strict=True))
        size_in_bytes = 4 * int(np.prod(lengths))
        whole = unpack(samples[:size_in_bytes], lengths)
        samples = samples[size_in_bytes:]
        *rows, sums = np.split(sums, np.cumsum(part["sums"]))
        stored[name] = Stored(shape, steps, part["exact"], part["resolution"], part["size"], whole, *rows)
    return stored


def compare(stored: dict[str, Stored], found: dict[str, Quantity]) -> list[Change]:
    """List the changes of a case, at most one a quantity."""
    changes = [only_on_one_side(name, "stored", "nothing") for name in stored if name not in found]
    for name, quantity in found.items():
        if name in stored:
            changes += compare_one(name, stored[name], quantity)
        else:
            changes.append(only_on_one_side(name, "nothing", "a new quantity"))
    return changes


def only_on_one_side(name: str, expected: str, found: str) -> Change:
    return Change(name, "all of it", expected, found, "all", "a name has come or gone")


def compare_one(name: str, stored: Stored, quantity: Quantity) -> list[Change]:
    """Compare the samples that both have, then, if these are the same, shapes and sums."""
    if quantity.values.ndim != len(stored.shape) or quantity.exact != stored.exact:
        return [
            Change(name, "all of it", str(stored.shape), str(quantity.values.shape), "all", "other numbers")
        ]
    changes = compare_samples(name, stored, quantity)
    if stored.shape != quantity.values.shape:
        if not changes:
            expected, found = map(show_shape, (stored.shape, quantity.values.shape))
            changes = [Change(name, "shape", expected, found, "", "what both have is the same where sampled")]
        return [with_shape(change, stored, quantity) for change in changes]
    return changes or compare_sums(name, stored, quantity)


def show_shape(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape)) or "one number"


def with_shape(change: Change, stored: Stored, quantity: Quantity) -> Change:
    shapes = f"{show_shape(quantity.values.shape)} instead of {show_shape(stored.shape)} numbers"
    return Change(**(vars(change) | {"extent": f"{change.extent}; {shapes}"}))


def compare_samples(name: str, stored: Stored, quantity: Quantity) -> list[Change]:
    """Describe the largest difference of the samples; of whole numbers the first."""
    lengths = np.minimum(stored.samples.shape, sampled(quantity.values, stored.steps).shape).astype(int)
    common = tuple(slice(length) for length in lengths)
    expected = restore(stored.samples[common], stored.resolution)
    found = np.asarray(sampled(quantity.values, stored.steps)[common], float)
    with np.errstate(invalid="ignore"):
        differences = np.abs(found - expected)
    tolerance = np.maximum(RESOLUTIONS * stored.resolution, RELATIVE * np.abs(finite(expected)))
    tolerance = np.zeros_like(tolerance) if stored.exact else tolerance
    same = (differences <= tolerance) | (found == expected) | (np.isnan(found) & np.isnan(expected))
    same = np.asarray(same)
    if same.all():
        return []
    differing = np.argwhere(~same)
    amounts = np.asarray(np.nan_to_num(differences, nan=np.inf))[~same]
    sample = differing[0 if stored.exact else int(amounts.argmax())]
    index = tuple(sample)
    return [
        Change(
            name,
            describe_place(quantity, sample * np.array(stored.steps, int)),
            show(expected[index], quantity),
            show(found[index], quantity),
            show_difference(found[index] - expected[index], quantity),
            extent_of(differing, same.size, stored, quantity),
        )
    ]


def describe_place(quantity: Quantity, index: np.ndarray) -> str:
    """Name a number by its place on each axis: joint, frame, direction."""
    axes = [(axis, int(number)) for axis, number in zip(quantity.axes, index, strict=True)]
    axes.sort(key=lambda pair: (not pair[0].name, not pair[0].labels))
    return ", ".join(axis.describe(number) for axis, number in axes) or "the number"


def extent_of(differing: np.ndarray, count: int, stored: Stored, quantity: Quantity) -> str:
    text = f"{len(differing)} of {count} stored numbers differ"
    if not quantity.axes or quantity.axes[0].labels:
        return text
    first, last = (int(row) * stored.steps[0] for row in (differing[:, 0].min(), differing[:, 0].max()))
    return f"{text}, {quantity.axes[0].name}s {first} to {last}"


def show(number: float, quantity: Quantity) -> str:
    if quantity.exact:
        return str(bool(number) if quantity.values.dtype.kind == "b" else int(number))
    return f"{number:.7g} {quantity.unit}".rstrip()


def show_difference(difference: float, quantity: Quantity) -> str:
    if quantity.unit == "m":
        return f"{difference * MILLIMETRES_PER_METRE:+.3g} mm"
    return f"{difference:+.3g} {quantity.unit}".rstrip()


def compare_sums(name: str, stored: Stored, quantity: Quantity) -> list[Change]:
    """Describe a change between the samples by the sums that show it."""
    size = float(np.abs(finite(quantity.values)).sum())
    step = max(stored.size, np.finfo(float).tiny) / SUM_STEPS
    total, blocks, margins = sums_of(quantity, stored.size)
    if quantity.exact:
        different = np.flatnonzero(stored.blocks != blocks[: len(stored.blocks)])
        amount = "not known"
    else:
        different = differing_sums(stored.blocks, blocks)
        amount = f"{(total[0] - stored.total[0]) * step:+.3g}"
    places = [labelled_places(quantity)[number] for number in differing_sums(stored.margins, margins)]
    whole = [] if quantity.exact else differing_sums(stored.total, total)
    grown = abs(size - stored.size) > RELATIVE * stored.size
    if not (len(different) or places or len(whole) or grown):
        return []
    row = quantity.axes[0].name if quantity.axes else "number"
    where = f"between the stored {row}s"
    if len(different):
        last = min((different[-1] + 1) * stored.rows_per_block, stored.shape[0]) - 1
        where = f"{row}s {different[0] * stored.rows_per_block} to {last}, between the stored ones"
    if places:
        where = f"{'; '.join(places[:3])}{' and others' if len(places) > 3 else ''}, {where}"
    expected, found = (f"absolute values of {number:.9g} in all" for number in (stored.size, size))
    extent = f"{len(different)} of {len(stored.blocks)} sums of rows differ"
    return [Change(name, where, expected, found, f"{amount} in the weighted sum", extent)]


def differing_sums(stored: np.ndarray, found: np.ndarray) -> np.ndarray:
    """List the sums that differ by more than the tolerance, in steps of the size of all by SUM_STEPS."""
    if not len(stored):
        return np.zeros(0, int)
    expected = stored.astype(float)
    tolerance = np.maximum(RELATIVE * np.abs(expected), OF_SIZES * SUM_STEPS) + 1  # rounded twice by a half
    return np.flatnonzero(np.abs(found - expected) > tolerance)


def labelled_places(quantity: Quantity) -> list[str]:
    labels = [axis for axis in quantity.axes if axis.labels]
    return [
        ", ".join(axis.describe(place) for axis, place in zip(labels, places, strict=True))
        for places in product(*(range(len(axis.labels)) for axis in labels))
    ]


def show_table(rows: Iterable[tuple[str, Change]]) -> list[str]:
    """Lay changes of several cases out in columns."""
    heads = ("case", "quantity", "largest difference (first of whole numbers)", "difference", "extent")
    cells = [(case, c.quantity, c.place, c.difference, c.extent) for case, c in rows]
    widths = [max(map(len, column)) for column in zip(heads, *cells, strict=True)]
    lines = [heads, tuple("-" * width for width in widths), *cells]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    ]


def accept(case: str, found: dict[str, Quantity], folder: Path = FOLDER) -> list[Change]:
    """Store a case that is new or has changed, and list its changes; another's file stays as it is."""
    file = path_of(case, folder)
    changes = compare(read(file), found) if file.exists() else [Change("all", "", "", "", "", "new")]
    if changes:
        write(file, found)
    return changes
