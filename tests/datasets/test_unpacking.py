"""Archives that claim too much, lead elsewhere or are damaged: nothing of them is unpacked."""

import io
import stat
import struct
import zipfile
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import mocap
from mocap.datasets import partial_files, unpacking
from mocap.datasets.unpacking import BadArchive, unpack
from mocap.errors import MocapError
from tests.refusals import refused

CLIP = b"HIERARCHY\n" + bytes(range(256)) * 8
ENTRY = b"PK\x01\x02"  # begins a member's entry in the directory
FLAGS = 8  # bytes from there to the flags,
SIZE = 24  # to the size of what is packed,


def member(name, mode=0, method=zipfile.ZIP_DEFLATED):
    """Describe a member; `mode` is that of Unix, with its kind."""
    info = zipfile.ZipInfo(name)
    info.external_attr = mode << 16
    info.compress_type = method
    return info


def zipped(*members):
    """Zip pairs (member or name, content)."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return file.getvalue()


def forged(data, offset, form, value, entry=0):
    """Overwrite a number in an entry of the directory of an archive."""
    at = -1
    for _ in range(entry + 1):
        at = data.index(ENTRY, at + 1)
    place = at + offset
    return data[:place] + struct.pack(form, value) + data[place + struct.calcsize(form) :]


@pytest.fixture
def archive(tmp_path):
    (tmp_path / "clips").mkdir()
    return tmp_path / "set.zip"


def refused_archive(sentence, archive, data, kind=BadArchive):
    """Check that an archive is refused, and that nothing of it is unpacked."""
    folder = archive.parent / "clips"
    (folder / "walk.bvh").write_bytes(b"mine")
    archive.write_bytes(data)
    refused(sentence, unpack, archive, folder, kind=kind)
    assert [path.name for path in archive.parent.rglob("*") if path.is_file()] == ["set.zip", "walk.bvh"]
    assert (folder / "walk.bvh").read_bytes() == b"mine"


def test_clips_are_unpacked_without_the_folders_of_the_archive(archive):
    archive.write_bytes(
        zipped(
            ("set/", b""),
            ("set/deep/walk.bvh", CLIP),
            (member("run.BVH", stat.S_IFREG | 0o644), CLIP[:900]),
            ("windows\\jog.bvh", CLIP[:800]),
            ("__MACOSX/set/deep/._walk.bvh", b"rubbish"),
            ("set/README.txt", b"read me"),
            ("copies/walk.bvh", CLIP),
        )
    )
    folder = archive.parent / "clips"
    (folder / "walk.bvh").write_bytes(b"an earlier version")
    counted = []
    assert unpack(archive, folder, lambda names: map(counted.append, names) and names) == [
        "jog.bvh",
        "run.BVH",
        "walk.bvh",
    ]
    contents = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert contents == {"walk.bvh": CLIP, "run.BVH": CLIP[:900], "jog.bvh": CLIP[:800]}


def test_an_archive_that_unpacks_to_a_thousand_times_its_size_is_refused(archive):
    bomb = zipped(("walk.bvh", bytes(30_000_000)))
    assert len(bomb) < 30_000
    refused_archive(r"set\.zip claims to unpack to 30 MB, but clips .* to 1 MB at most", archive, bomb)


def test_the_claims_of_all_members_count(archive):
    bomb = zipped(*((f"walk{number}.txt", bytes(400_000)) for number in range(9)), ("walk.bvh", CLIP))
    refused_archive("claims to unpack to 4 MB", archive, bomb)


def test_a_member_that_unpacks_to_more_than_it_claims_is_refused(archive):
    bomb = zipped(("run.bvh", CLIP), ("walk.bvh", bytes(30_000_000)))
    refused_archive("is damaged", archive, forged(bomb, SIZE, "<I", 1000, entry=1))


def test_a_claim_of_gigabytes_is_refused_whatever_is_in_it(archive):
    refused_archive(
        "claims to unpack to 4295 MB", archive, forged(zipped(("walk.bvh", CLIP)), SIZE, "<I", 2**32 - 2)
    )


OUTSIDE = ["../walk.bvh", "set/../../walk.bvh", "/etc/walk.bvh", "..\\walk.bvh", "\\\\host\\walk.bvh"]
OUTSIDE += ["C:\\walk.bvh", "c:walk.bvh", "walk.bvh:hidden.bvh", "../notes.txt", ".."]


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_path_that_leads_out_of_the_folder_is_refused(archive, name):
    data = zipped(("run.bvh", CLIP), (name, CLIP))
    refused_archive(r"set\.zip holds '.*', which leads out of the folder", archive, data)


def test_a_name_that_ends_early_is_refused(archive):
    data = zipped(("run.bvh", CLIP), ("walk.bvhX.bvh", CLIP)).replace(b"bvhX.bvh", b"bvh\0.bvh")
    refused_archive("which leads out of the folder", archive, data)


def test_a_name_with_control_characters_is_refused(archive):
    refused_archive(r"holds 'a\\x1b\[2J\.bvh', which is no name", archive, zipped(("a\x1b[2J.bvh", CLIP)))


@pytest.mark.parametrize("kind", ["S_IFLNK", "S_IFIFO", "S_IFCHR", "S_IFBLK", "S_IFSOCK"])
@pytest.mark.parametrize("name", ["walk.bvh", "set"])
def test_links_and_devices_are_refused(archive, name, kind):
    special = member(name, getattr(stat, kind) | 0o777)
    data = zipped(("run.bvh", CLIP), (special, b"/etc/passwd"))
    refused_archive(f"holds '{name}', which is a link or a device", archive, data)


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_methods_than_deflate_are_refused(archive, method):
    data = zipped((member("walk.bvh", method=method), CLIP))
    refused_archive("is packed by a method other than deflate", archive, data)


def test_an_encrypted_member_is_refused(archive):
    refused_archive("which is encrypted", archive, forged(zipped(("walk.bvh", CLIP)), FLAGS, "<H", 1))


def test_too_many_members_are_refused_before_the_directory_is_read(archive, monkeypatch):
    monkeypatch.setattr(unpacking, "MEMBERS", 5)
    names = [f"{number}.bvh" for number in range(6)]
    archive.write_bytes(zipped(*((name, CLIP) for name in names[:5])))
    assert unpack(archive, archive.parent / "clips") == names[:5]
    for name in names[:5]:
        (archive.parent / "clips" / name).unlink()
    crowded = zipped(*((name, CLIP) for name in names))
    monkeypatch.setattr(unpacking.zipfile, "ZipFile", lambda path: pytest.fail("read"))
    refused_archive("has more than 5 files", archive, crowded)


@pytest.mark.parametrize("piece", [4, 5, 7, 2**20])
def test_members_are_counted_in_pieces(archive, monkeypatch, piece):
    monkeypatch.setattr(unpacking, "PIECE", piece)
    archive.write_bytes(zipped(*((f"{number}.bvh", CLIP[:30]) for number in range(9))))
    monkeypatch.setattr(unpacking, "MEMBERS", 9)
    unpacking._require_few_members(archive)
    monkeypatch.setattr(unpacking, "MEMBERS", 8)
    refused("has more than 8 files", unpacking._require_few_members, archive)


def test_two_clips_of_one_name_are_refused_if_they_differ(archive):
    for name in ("b/walk.bvh", "b/WALK.bvh"):
        data = zipped(("a/walk.bvh", CLIP), (name, CLIP[:-1]))
        refused_archive(r"holds two clips '(walk|WALK)\.bvh' that differ", archive, data)


def test_an_archive_that_is_none_is_refused(archive):
    whole = zipped(("run.bvh", CLIP), ("walk.bvh", CLIP))
    for data in (b"", b"a page that says sorry", whole[:-30], whole[: len(whole) // 2]):
        refused_archive(r"^set\.zip is damaged, or no \.zip file: get it anew\.$", archive, data)
    refused_archive(r"set\.zip holds no \.bvh file", archive, zipped(("README.txt", b"read me")))


def test_a_directory_that_leads_before_the_beginning_of_the_file_is_refused(archive):
    data = zipped(("walk.bvh", CLIP))
    end = data.rindex(b"PK\x05\x06")
    offset = struct.unpack_from("<I", data, end + 16)[0]
    forged_end = data[: end + 16] + struct.pack("<I", offset + 100) + data[end + 20 :]
    refused_archive("is damaged", archive, forged_end)


def test_an_archive_whose_last_clip_is_damaged_is_refused(archive):
    data = zipped(("run.bvh", CLIP), (member("walk.bvh", method=zipfile.ZIP_STORED), CLIP))
    place = data.rindex(CLIP)
    refused_archive("is damaged", archive, data[:place] + b"X" + data[place + 1 :])


def test_clips_for_which_the_disk_has_no_space_are_refused(archive, monkeypatch):
    free = SimpleNamespace(free=len(CLIP) - 1)
    monkeypatch.setattr(partial_files.shutil, "disk_usage", lambda folder: free)
    with pytest.raises(MocapError, match="and 0 MB are free"):
        archive.write_bytes(zipped(("walk.bvh", CLIP)))
        unpack(archive, archive.parent / "clips")
    assert list((archive.parent / "clips").iterdir()) == []
    free.free += 1
    assert unpack(archive, archive.parent / "clips") == ["walk.bvh"]


def test_what_a_killed_process_has_unpacked_is_removed(archive):
    unfinished = archive.parent / "clips" / ".mocap-unfinished-abc"
    unfinished.mkdir()
    (unfinished / "walk.bvh").write_bytes(CLIP)
    archive.write_bytes(zipped(("walk.bvh", CLIP)))
    unpack(archive, archive.parent / "clips")
    assert [path.name for path in (archive.parent / "clips").iterdir()] == ["walk.bvh"]


def test_an_interruption_leaves_no_clip(archive):
    def interrupt_at_second(names):
        yield names[0]
        raise KeyboardInterrupt

    archive.write_bytes(zipped(("run.bvh", CLIP), ("walk.bvh", CLIP)))
    with pytest.raises(KeyboardInterrupt):
        unpack(archive, archive.parent / "clips", interrupt_at_second)
    assert list((archive.parent / "clips").iterdir()) == []


# Name, bytes of the archive, clips, and bytes of each: frames and channels of the published sets, 10 letters
# for each number. Where the archive's size is not published, a quarter of that.
HONEST = {
    "lafan1": (144_051_503, 77, 496_672 * 69 * 10 // 77),
    "100style": (1_468_515_354, 810, 4_779_750 * 87 * 10 // 810),
    "bandai_namco": (421_604 * 132 * 10 // 4, 3077, 421_604 * 132 * 10 // 3077),
}


@pytest.mark.parametrize("name", HONEST)
def test_sets_as_large_as_the_named_ones_fit(archive, name):
    size, count, length = HONEST[name]
    with archive.open("wb") as file:
        file.truncate(size)  # takes no space
    members = [member(f"set/{number}.bvh") for number in range(count)]
    for clip in members:
        clip.file_size = 2 * length  # with room for longer numbers
        clip.CRC = 0
    assert len(unpacking._check_members(archive, members)) == count < unpacking.MEMBERS


def test_real_rows_of_numbers_fit(archive):
    clip = archive.parent / "walk.bvh"
    mocap.save(mocap.datasets.sample("walk_straight"), clip)
    content = clip.read_bytes()
    archive.write_bytes(zipped(*((f"{number}.bvh", content[number:]) for number in range(8))))
    assert 8 * len(content) < unpacking.RATIO / 2 * archive.stat().st_size
    assert len(unpack(archive, archive.parent / "clips")) == 8


WHOLE = zipped(("set/run.bvh", CLIP), ("walk.bvh", bytes(5000)))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(st.integers(0, len(WHOLE) - 1), st.integers(0, 255)), min_size=1, max_size=4))
def test_a_damaged_archive_is_refused_or_gives_the_same_clips(tmp_path_factory, changes):
    folder = tmp_path_factory.mktemp("sets")
    data = bytearray(WHOLE)
    for place, value in changes:
        data[place] = value
    (folder / "set.zip").write_bytes(data)
    (folder / "clips").mkdir()
    try:
        unpack(folder / "set.zip", folder / "clips")
    except MocapError:
        assert list((folder / "clips").iterdir()) == []
    for path in (folder / "clips").iterdir():
        assert path.read_bytes() in (CLIP, bytes(5000))
