"""The right reader and skeleton for every file, text and table; and every real file at hand."""

import contextlib
import csv
import random
import tracemalloc
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from mocap.errors import FormatError, MocapWarning
from mocap.files import conversion, formats, load_save
from mocap.files.asf import read_skeleton
from mocap.files.text import lines, load_rows, read_text, to_numbers
from tests.conftest import SWEEP
from tests.files.acclaim_clips import SPINE
from tests.refusals import refusals, refused, refused_texts
from tests.strategies import wave

AMC = "1\nroot 0 0 0 0 0 0\nspine 0\n"


@pytest.fixture
def folder(tmp_path):
    """Write a clip 16_15.amc of one bone, and the skeletons asked for, {name: (bone, length)}."""

    def fill(**skeletons):
        (tmp_path / "16_15.amc").write_text(AMC)
        for name, (bone, length) in skeletons.items():
            text = SPINE.replace("spine", bone).replace("length 1", f"length {length}")
            (tmp_path / f"{name.strip('_')}.ASF").write_text(text)
        return tmp_path / "16_15.amc"

    return fill


FITTING = [
    ({"other": ("spine", 1)}, 1),
    ({"other": ("tail", 1), "another": ("spine", 2)}, 2),
    ({"other": ("spine", 1), "_16": ("spine", 2)}, 2),
    ({"other": ("spine", 1), "_16": ("spine", 2), "_16_15": ("spine", 3)}, 3),
    ({"_16_15": ("tail", 1), "_16": ("spine", 2)}, 2),
]


@pytest.mark.parametrize(("skeletons", "length"), FITTING)
def test_the_skeleton_that_fits_is_found(folder, skeletons, length):
    motion = load_save.load(folder(**skeletons))
    assert np.allclose(motion.skeleton.offsets[-1], [0, length * 0.0254, 0])
    assert motion.name == "16_15"


CANDIDATES = [
    ({}, r"its .asf file beside it, got none: name it by skeleton=$"),
    ({"a": ("tail", 1), "b": ("tail", 1)}, r"none that fits \(a.ASF has no bone 'spine'\)"),
    ({"a": ("spine", 1), "b": ("spine", 2)}, r"several that fit \(a.ASF, b.ASF\)"),
]


@pytest.mark.parametrize(("skeletons", "message"), CANDIDATES)
def test_the_candidates_are_named(folder, skeletons, message):
    refused(message, load_save.load, folder(**skeletons))


def test_the_skeleton_whose_name_begins_the_clip_s_name_is_found(folder):
    folder(_HDM=("spine", 1), _HDM_bd=("spine", 2), _HDM_bk=("spine", 3), _HDM_b=("spine", 4))
    for name, length in {"HDM_bd_walk_001_120.amc": 2, "hdm_bk.amc": 3, "HDM_mm_walk.amc": 1}.items():
        motion = load_save.load(folder().with_name("16_15.amc").rename(folder().with_name(name)))
        assert np.allclose(motion.skeleton.offsets[-1], [0, length * 0.0254, 0])


ARMS = """spine thumb
begin
name thumb
direction 1 0 0
length 1
axis 0 0 0 XYZ
dof rx ry
end
"""


def two_bones(folder):
    """Write a clip, and a skeleton of a spine and a thumb."""
    path = folder(a=("spine", 1))
    line, bone = ARMS.split("\n", 1)
    text = path.with_name("a.ASF").read_text()
    head, tree = text.split(":hierarchy")
    path.with_name("a.ASF").write_text(f"{head}{bone}:hierarchy{tree}  {line}\n")
    return path


@pytest.mark.parametrize("comment", ["", "# by hand\n"])
def test_bones_that_no_frame_has_keep_their_rest_pose_and_that_is_said(folder, comment):
    path = two_bones(folder)
    path.write_text(f"{comment}{AMC}2\nroot 0 0 0 0 0 0\nspine 9\n")
    with pytest.warns(MocapWarning, match="no numbers for thumb: they keep their rest pose"):
        motion = load_save.load(path)
    assert np.allclose(motion.rotations[:, motion.skeleton.index("thumb")], [1, 0, 0, 0])
    path.write_text(f"{AMC}2\nroot 0 0 0 0 0 0\nspine 9\nthumb 0 0\n")
    refused("line 7: expected another bone of the skeleton, got 'thumb'", load_save.load, path)


def test_the_skeleton_with_the_fewest_missing_bones_is_taken(folder):
    path = two_bones(folder)
    path.with_name("b.ASF").write_text(SPINE)
    motion = load_save.load(path)
    assert "thumb" not in motion.skeleton.names


DIFFERENT = [
    (f"{AMC}tail 0\n", "a.ASF has no bone 'tail'"),
    (AMC.replace("spine 0", "spine 0 0"), "a.ASF has 1 numbers for 'spine', not 2"),
    ("1\nspine 0\n", "a.ASF has also root"),
]


@pytest.mark.parametrize(("text", "reason"), DIFFERENT)
def test_a_skeleton_that_does_not_fit_is_named_with_the_difference(folder, text, reason):
    path = folder(a=("spine", 1))
    path.write_text(text)
    refused(reason, load_save.load, path)


def test_options(folder):
    path = folder(a=("spine", 1), b=("spine", 2))
    motion = load_save.load(path, skeleton=path.with_name("b.ASF"), fps=60, scale=0.5)
    assert motion.fps == 60.0
    assert np.allclose(motion.skeleton.offsets[-1], [0, 1, 0])
    alone = read_skeleton(path.with_name("b.ASF")).skeleton
    alone.require_same(load_save.load(path, skeleton=path.with_name("b.ASF")).skeleton)


@pytest.mark.parametrize("name", ["gone.amc", "gone.bvh", "folder.bvh", "folder.amc"])
def test_a_missing_file_or_a_folder_is_refused(tmp_path, name):
    (tmp_path / "folder.bvh").mkdir()
    (tmp_path / "folder.amc").mkdir()
    refused(f"Cannot read .*{name}: (No such file|Is a dir)", load_save.load, tmp_path / name)


def test_the_suffix_decides(tmp_path):
    load_save.save(wave(5), tmp_path / "a.glb")
    assert (tmp_path / "a.glb").read_bytes()[:4] == b"glTF"
    np.savez(tmp_path / "a", poses=np.zeros((2, 66)), trans=np.zeros((2, 3)), mocap_framerate=60.0)
    (tmp_path / "a.npz").rename(tmp_path / "a.NPZ")
    assert len(load_save.load(tmp_path / "a.NPZ", scale=1.0)) == 2
    assert load_save.read_angles(tmp_path / "a.NPZ") == {}


test_other_formats_and_options_that_make_no_sense_are_refused = refusals(
    (r"mocap reads .amc .with .asf., .bvh", load_save.load, "walk.mp4"),
    ("files.asf.read_skeleton reads it", load_save.load, "walk.asf"),
    (r"mocap writes .bvh, .glb, .npz and .csv", load_save.save, wave(3), "b.fbx"),
    (r"Cannot read walk.GLB: mocap only writes it; in Blender", load_save.load, "walk.GLB"),
    (
        "in metres, got a scale of 2 for walk.npz: leave out scale=.",
        partial(load_save.load, "walk.npz", scale=2.0),
    ),
    ("y up, got z up for walk.amc: leave out up=.", partial(load_save.load, "walk.amc", up="z")),
    ("holds 1 body, as all .amc files do, got 2: leave out body=.", partial(load_save.load, "a.amc", body=2)),
    ("holds 1 body, as all .npz files do, got 2: leave out body=.", partial(load_save.load, "a.npz", body=2)),
    *(
        (f"{option} must be a number above 0", partial(load_save.load, "walk.bvh", **{option: value}))
        for option in ("fps", "scale")
        for value in (0, -1.0, np.nan, np.inf)
    ),
)


ODD = [
    ("blender_export_16_11/16_11.amc", "cmu/16/16.asf", "line 5: expected 0 numbers for 'lhipjoint'"),
    ("crlf_16/16_12.amc", None, 441),
    ("crlf_16/16_15.amc", None, 471),
    ("csci520/131_04-dance.amc", "cmu/16/16.asf", 1086),
    ("csci520/131_04-dance-lq-N20.amc", "cmu/16/16.asf", "line 7: expected 1 numbers for 'ltibia' .*got 3"),
    ("encadyma/null.amc", "odd/golf.asf", 1),
    ("fairmotion/01_01_merge_conflict.amc", "cmu/16/16.asf", "line 1: expected one version of the file"),
    ("fairmotion/01_01_truncated.amc", "cmu/16/16.asf", "line 46747: .*after 1558 complete frames"),
    ("fairmotion/11_01_fb_comment.amc", None, 597),
    (
        "fairmotion/11_01_fb_comment.amc",
        "odd/fairmotion/01_merge_conflict.asf",
        "merge_conflict.asf, line 1: ",
    ),
    ("golf_01.amc", None, "line 13313: .*after 443 complete frames"),
]


@pytest.mark.parametrize(("name", "skeleton", "result"), ODD)
def test_odd_files_load_or_say_why_not(real_data, name, skeleton, result):
    skeleton = skeleton and real_data / skeleton
    if isinstance(result, int):
        assert len(load_save.load(real_data / "odd" / name, skeleton=skeleton)) == result
    else:
        refused(result, load_save.load, real_data / "odd" / name, skeleton=skeleton, kind=FormatError)


def listed(real_data):
    """Return all clips that are not odd, and how many frames their list says they have."""
    with (real_data / "MANIFEST.tsv").open(encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file, delimiter="\t")
        clips = {row["path"]: int(row["frames"]) for row in rows if row["frames"]}
    return {path: frames for path, frames in clips.items() if not path.startswith("odd/")}


def test_some_other_real_files_load(real_data):
    """Forty small ones, or in a sweep all."""
    clips = listed(real_data)
    small = sorted(path for path in clips if (real_data / path).stat().st_size < 600_000)
    for path in clips if SWEEP else random.Random(3).sample(small, 40):
        assert len(load_save.load(real_data / path)) == clips[path], path


@pytest.mark.parametrize(
    "name", ["cmu/16/16_17.amc", "bvh/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", "odd/golf_01.amc"]
)
def test_memory_stays_within_twenty_times_the_file(real_data, name):
    tracemalloc.start()
    with contextlib.suppress(FormatError):
        load_save.load(real_data / name)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20 * (real_data / name).stat().st_size


def test_few_numbers_do_not_fill_the_memory(tmp_path):
    joints = "".join(f"JOINT j{i}\n{{\nOFFSET 0 1 0\nCHANNELS 0\n}}\n" for i in range(1000))
    head = f"HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 1 Yrotation\n{joints}}}\nMOTION\n"
    (tmp_path / "a.bvh").write_text(f"{head}Frames: 20000\nFrame Time: 0.1\n" + "1\n" * 20000)
    few = "numbers for at least a tenth of the joints, got 20000 for 20020000"
    refused(few, load_save.load, tmp_path / "a.bvh", kind=FormatError)


@pytest.mark.parametrize("count", ["999999999", "1e8"])
def test_a_huge_count_of_frames_does_not_allocate(tmp_path, count):
    load_save.save(wave(3), tmp_path / "a.bvh")
    text = (tmp_path / "a.bvh").read_text().replace("Frames: 3", f"Frames: {count}")
    (tmp_path / "a.bvh").write_text(text)
    tracemalloc.start()
    with pytest.warns(MocapWarning, match=r"the header says \d+ frames, and 3 whole ones follow"):
        assert len(load_save.load(tmp_path / "a.bvh")) == 3
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1_000_000


TEXTS = [
    (b"a\r\nb\r\n", "a\nb\n"),
    (b"a\rb", "a\nb"),
    (b"\xef\xbb\xbfa\n", "a\n"),
    ("Hüfte".encode(), "Hüfte"),
    ("Hüfte".encode("latin-1"), "Hüfte"),
]


@pytest.mark.parametrize(("data", "text"), TEXTS)
def test_read_text(tmp_path, data, text):
    (tmp_path / "file").write_bytes(data)
    assert read_text(tmp_path / "file") == text


test_what_is_no_text_is_refused = refused_texts(
    read_text,
    "file",
    ("a\nb\0c", "line 2: expected text, got a zero byte"),
    (" \r\n", "got an empty file"),
    ("a\n<<<<<<< HEAD\nb", "line 2: .*merge"),
    kind=FormatError,
)


def test_lines_keep_their_numbers():
    assert list(lines("# all\n\na b\t c # d\n")) == [(3, ["a", "b", "c"])]


@pytest.mark.parametrize(
    "words", [["1"], ["1", "x"], ["1", "nan"], ["1", "inf"], ["1", "-1e9"], ["1", "2", "3"]]
)
def test_numbers_that_are_none_are_refused(words):
    refused(r"a.bvh, line 3: expected a pair", to_numbers, "a.bvh", 3, words, "a pair", 2, kind=FormatError)


@pytest.mark.parametrize("text", ["1,2,3\n4,5,6\n", "x;z;r\n1; 2 ;3\n\n4 5 6 # a stone", "1\t2\t3\r\n4,5,6"])
def test_rows_are_read(tmp_path, text):
    file = tmp_path / "t.csv"
    file.write_text(text, newline="")
    np.testing.assert_array_equal(load_rows(file, ("x", "z", "radius")), [[1, 2, 3], [4, 5, 6]])


test_a_wrong_line_is_named = refused_texts(
    load_rows,
    "t.csv",
    ("1,2\n3\n", "line 2: expected x and z in each line, such as '1.5, 2', got"),
    ("1,2,3\n", "line 1: expected x and z"),
    ("1,2\nfive,6\n", "line 2"),
    ("0,0\n1,nan", "line 2: expected x and z"),
    ("x,z\n", "got no numbers"),
    kind=FormatError,
)


def test_graphs_and_other_archives_in_a_folder_are_no_clips_but_damaged_ones_are_reported(tmp_path):
    load_save.save(wave(3), tmp_path / "b.bvh")
    np.savez(tmp_path / "c.npz", poses=np.zeros((2, 66)), trans=np.zeros((2, 3)), mocap_framerate=60.0)
    np.savez(tmp_path / "graph.npz", nodes=np.zeros(3))
    (tmp_path / "broken.npz").write_bytes(b"PK")
    (tmp_path / "notes.txt").write_text("")
    names = ["b.bvh", "broken.npz", "c.npz"]
    assert [path.name for path in conversion.find_files([tmp_path])] == names
    assert [path.name for path, _ in conversion.plan(tmp_path, tmp_path / "out")] == names
    refused("broken.npz", load_save.load, tmp_path / "broken.npz")


def test_folders_in_folders_are_searched_but_for_hidden_ones(tmp_path):
    for name in ("b.bvh", "deep/deeper/a.bvh", "deep/.hidden.bvh", ".cache/c.bvh", ".home/set/d.bvh"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        load_save.save(wave(3), tmp_path / name)
    found = conversion.find_files([tmp_path, tmp_path / ".home"])
    names = [path.relative_to(tmp_path).as_posix() for path in found]
    assert names == ["b.bvh", "deep/deeper/a.bvh", ".home/set/d.bvh"]


@pytest.mark.parametrize("suffix", formats.OTHERS)
def test_files_of_other_formats_are_refused_with_a_way_to_read_them(tmp_path, suffix):
    message = r"Cannot read .*: .*(first|export)"
    refused(message, load_save.load, tmp_path / f"walk{suffix.upper()}")


def test_an_empty_folder_is_refused(tmp_path):
    refused(r"holds no \.amc \(with \.asf\), \.bvh.* file\.", conversion.find_files, [tmp_path])


def test_a_name_without_end_is_refused_in_a_sentence():
    refused(r"Cannot read a+: File name too long", conversion.find_files, [Path("a" * 5000)], most=6000)
