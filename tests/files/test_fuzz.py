"""Whatever is in a file, reading gives a motion or a short sentence."""

import random
import re
from dataclasses import replace
from functools import partial

import pytest

from mocap.datasets import samples
from mocap.errors import FormatError, MocapError
from mocap.files import load_save, path_files
from mocap.files.asf import read_skeleton
from tests.files.acclaim_clips import AMC, ASF
from tests.strategies import wave

CHARACTERS = " \n\t\r{}#:.-+eE019,()\x0b\x85_\0\ufeff"
WORDS = ["nan", "inf", "1e999", "9" * 30, "-", "1_0", "end\n", "begin\n", "root ", "JOINT x\n{\n", "}\n", "٣"]
WORDS += ["CHANNELS 0\n", "End Site\n", "Frames: 9\n", ":root\n"]
WORDS += ["dof rx\n", "\n7\n", "\u2028", "<<<<<<< a\n"]


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
    load_save.save(samples.sample("walk_straight")[:3], tmp_path / "a.bvh")
    pairs = [(ASF, AMC), (None, (tmp_path / "a.bvh").read_text())]
    try:
        data = request.getfixturevalue("real_data")
    except pytest.skip.Exception:
        return pairs
    pairs.append((cut(data / "cmu/16/16.asf", 999), cut(data / "cmu/16/16_15.amc", 93)))
    pairs.append((cut(data / "odd/encadyma/debug.asf", 999), "1\nroot 0 0 0 0 0 0\nrwrist 0 0\n"))
    for name in ("pymo/AV_8Walk_Meredith_HVHA_Rep1", "20tab/test_freebvh", "imusim/16_15"):
        pairs.append((None, cut(data / f"bvh/{name}.bvh", 3)))
    return pairs


def complaints(read, path, texts):
    """Read a file again and again with other texts, and count the refusals.

    All are one line of 200 characters at most, besides the paths in it, and quote no long line.
    """
    count, skeleton = 0, path.with_suffix(".asf")
    for number, text in enumerate(texts):
        path.write_bytes(text if isinstance(text, bytes) else text.encode(errors="surrogatepass"))
        try:
            assert read(path)
        except MocapError as error:
            told = str(error).replace(str(path), "").replace(str(skeleton), "")
            assert "\n" not in told and len(told) <= 200, (number, told)
            assert not any(row in told for row in str(text).split("\n") if len(row) > 80)
            assert not isinstance(error, FormatError) or error.path in (path, skeleton)
            count += 1
        except BaseException as error:
            raise AssertionError(f"text {number}: {text[:500]!r}") from error
    return count


def mutants(skeleton, clip, asf, seeds):
    """Change a clip, or the skeleton beside it."""
    for chance in map(random.Random, seeds):
        first = skeleton and chance.random() < 0.5
        if skeleton:
            asf.write_text(mutated(skeleton, chance) if first else skeleton, "utf-8", errors="surrogatepass")
        yield clip if first else mutated(clip, chance)


def test_many_broken_files(bases, tmp_path):
    count, refused, asf = 500, 0, tmp_path / "clip.asf"
    for number, (skeleton, clip) in enumerate(bases):
        texts = mutants(skeleton, clip, asf, range(number, count, len(bases)))
        read = partial(load_save.load, skeleton=asf if skeleton else None)
        refused += complaints(read, tmp_path / f"clip.{'amc' if skeleton else 'bvh'}", texts)
    assert 0.05 * count < refused < 0.95 * count  # the mutations are neither harmless nor too rough


LONG = ["x" * 17_000, "9" * 17_000, f"0.{'0' * 17_000}", "1 " * 9_000, "{" * 9_000, ":" * 17_000]
DRAWING = """<svg>
<g transform="rotate ( 5 )">
<path transform="scale ( 2 ) translate ( 3 , 4 )" d="M 0 0 L 1 1 C 1 2 3 4 5 6 Z" />
<polyline points=" 0 0 1 1 " />
<line x1=" 1 " />
</g>
</svg>"""


def long_ones(text):
    """Give a text with each of its words in turn replaced by long ones."""
    for number, word in enumerate(re.finditer(r"\S+", text)):
        for long in LONG[number % 2 :: 2]:
            yield f"{text[: word.start()]}{long}{text[word.end() :]}"


def broken(text):
    """Give a text with each of its lines in turn without its last word, or with another one there."""
    rows = text.split("\n")
    for number, row in enumerate(rows):
        for end in ("", " nan", " x"):
            yield "\n".join([*rows[:number], row.rpartition(" ")[0] + end, *rows[number + 1 :]])


@pytest.mark.parametrize("long", ["words", "names"])
@pytest.mark.parametrize("suffix", [".amc", ".asf", ".bvh"])
def test_long_words_and_names_make_no_long_messages(tmp_path, suffix, long):
    load_save.save(wave(2), tmp_path / "a.bvh")
    (tmp_path / "a.asf").write_text(ASF)
    (tmp_path / "a.amc").write_text(AMC)
    for path in tmp_path.iterdir() if long == "names" else ():
        path.write_text(re.sub(r"elbow|hand|side|thigh|arm", lambda name: name[0] * 5_000, path.read_text()))
    path = tmp_path / f"a{suffix}"
    read = read_skeleton if suffix == ".asf" else load_save.load
    texts = (broken if long == "names" else long_ones)(path.read_text())
    assert complaints(read, path, texts) > 20


@pytest.mark.filterwarnings("error", "ignore:.* the longest, is read")
@pytest.mark.parametrize(
    ("suffix", "text"), [(".csv", "x,z\n0 , 0\n0 ; 5\n5 5\n" + "1 2\n" * 9), (".svg", DRAWING)]
)
def test_broken_paths_are_read_or_refused_in_a_short_sentence(tmp_path, suffix, text):
    """Of changed texts, and of texts with long words; of pictures also where a line, or both, are no path."""
    chance, variants = random.Random(suffix), (text, text.replace("<path", "<text"))
    texts = (mutated(text, chance) for _ in range(500))
    for some in (texts, *map(long_ones, (*variants, re.sub("<(path|polyline)", "<text", text)))):
        assert complaints(path_files.load_path, tmp_path / f"a{suffix}", some) > 20


def test_long_names_make_no_long_messages_in_writing(tmp_path):
    motion, long = wave(2, name="n" * 5_000), "j" * 5_000
    bones = [replace(motion.skeleton, names=["root", f"{long}{end}", "hand", "side"]) for end in ("{", "")]
    motions = [replace(motion, skeleton=skeleton) for skeleton in bones]
    motions += [replace(motion, root_positions=motion.root_positions + 1e12), replace(motion, fps=1e7)]
    refusals = 0
    for bad in motions:
        try:
            load_save.save(bad, tmp_path / "a.bvh")
        except MocapError as error:
            refusals += 1
            assert "\n" not in str(error) and len(str(error)) <= 200
    assert refusals > 1
