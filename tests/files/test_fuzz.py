"""Whatever stands in a file, reading gives a motion or a sentence, and soon.

All 100 000: pytest -m exhaustive -n 0 tests/test_fuzz.py, about ten minutes.
"""

import random
import time

import pytest

from mocap.body.motion import Motion
from mocap.datasets import samples
from mocap.errors import FormatError, MocapError
from mocap.files import load_save

CHARACTERS = " \n\t\r{}#:.-+eE019,()\x0b\x85_\0\ufeff"
WORDS = ["nan", "inf", "1e999", "9" * 30, "-", "1_0", "end\n", "begin\n", "root ", "JOINT x\n{\n", "}\n", "٣"]
WORDS += [
    "CHANNELS 0\n",
    "End Site\n",
    "Frames: 9\n",
    ":root\n",
    "dof rx\n",
    "\n7\n",
    "\u2028",
    "<<<<<<< a\n",
]


def mutated(text, chance):
    """Change a text in one to five places: cut, insert, repeat, or replace."""
    for _ in range(chance.choice([1, 1, 2, 5])):
        at, start = chance.randrange(len(text) + 1), chance.randrange(len(text) + 1)
        new = chance.choice(
            [
                "",
                chance.choice(CHARACTERS),
                chance.choice(WORDS),
                text[start : start + chance.choice([5, 50, 500])],
                str(chance.randrange(10 ** chance.randrange(1, 12))),
                chr(chance.randrange(1, 0x300)),
            ]
        )
        text = text[:at] + new + text[at + chance.choice([0, 1, 1, 3, 20, 200]) :]
    return text


def cut(path, lines):
    """Return a file's first lines, with the number of frames that they hold."""
    text = path.read_text(encoding="latin-1").replace("\r\n", "\n")
    rows = text.split("\n")
    if path.suffix == ".bvh":
        start = next(number for number, row in enumerate(rows) if row.startswith("Frames"))
        rows = [*rows[:start], f"Frames: {lines}", *rows[start + 1 : start + 2 + lines]]
        return "\n".join([*rows, ""])
    return "\n".join([*rows[:lines], ""])


@pytest.fixture
def bases(tmp_path, request):
    """Return pairs of a skeleton's and a clip's texts; real ones, too, where they are at hand."""
    walk = samples.sample("walk_straight")[:3]
    for name in ("a.amc", "a.bvh"):
        load_save.save(walk, tmp_path / name)
    made = {name: (tmp_path / name).read_text() for name in ("a.amc", "a.asf", "a.bvh")}
    pairs = [(made["a.asf"], made["a.amc"]), (None, made["a.bvh"])]
    try:
        data = request.getfixturevalue("real_data")
    except pytest.skip.Exception:
        return pairs
    pairs.append((cut(data / "cmu/16/16.asf", 999), cut(data / "cmu/16/16_15.amc", 93)))
    pairs.append((cut(data / "odd/encadyma/debug.asf", 999), "1\nroot 0 0 0 0 0 0\nrwrist 0 0\n"))
    for name in ("pymo/AV_8Walk_Meredith_HVHA_Rep1", "20tab/test_freebvh", "imusim/16_15"):
        pairs.append((None, cut(data / f"bvh/{name}.bvh", 3)))
    return pairs


def survive(folder, bases, seed):
    """Read one mutated file, or a clip with a mutated skeleton."""
    chance = random.Random(seed)
    skeleton, clip = chance.choice(bases)
    path, asf = folder / f"clip.{'amc' if skeleton else 'bvh'}", None
    if skeleton:
        asf = folder / "clip.asf"
        first = chance.random() < 0.5
        skeleton, clip = (mutated(skeleton, chance), clip) if first else (skeleton, mutated(clip, chance))
        asf.write_text(skeleton, encoding="utf-8", errors="surrogatepass")
    else:
        clip = mutated(clip, chance)
    path.write_text(clip, encoding="utf-8", errors="surrogatepass")
    start = time.perf_counter()
    try:
        assert isinstance(load_save.load(path, skeleton=asf), Motion)
        loaded = True
    except MocapError as error:
        assert "\n" not in str(error)
        assert not isinstance(error, FormatError) or error.path in (path, asf)
        loaded = False
    assert time.perf_counter() - start < 10
    return loaded


@pytest.mark.parametrize("part", range(3))
def test_a_thousand_broken_files(bases, tmp_path, part):
    loaded = [survive(tmp_path, bases, 1000 * part + number) for number in range(1000)]
    assert 50 < sum(loaded) < 950  # the mutations are neither harmless nor too rough


@pytest.mark.exhaustive
def test_a_hundred_thousand_broken_files(bases, tmp_path):
    assert 5_000 < sum(survive(tmp_path, bases, 10_000 + number) for number in range(100_000)) < 95_000
