"""Named sets: a copy of one's own, or fetched from a server that does all the things servers do."""

import hashlib
import io
import zipfile

import numpy as np
import pytest

from mocap.body import Motion, Skeleton, find_legs
from mocap.datasets import downloads, named_sets
from mocap.datasets.named_sets import HASHES, SETS, clips_of, fetch_set, from_set
from mocap.files import load_save
from tests.refusals import refused


def body_of(known):
    """Return a body with the joints that a set's legs and hips are said to have."""
    right = [name.replace("Left", "Right").replace("_L", "_R") for name in known.legs]
    parents = [-1, 0, 1, 2, 3, 0, 5, 6, 7]
    offsets = [[0, 0, 0], *[[x, -0.4, 0.1] for x in (0.1, 0, 0, 0, -0.1, 0, 0, 0)]]
    return Skeleton([known.hips, *known.legs, *right], parents, offsets)


def still(known, at=1.0):
    return Motion(body_of(known), at * np.ones((3, 3)), np.tile([1.0, 0, 0, 0], (3, 9, 1)), known.fps)


@pytest.fixture
def data(tmp_path, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path / "data"))
    downloads.show_once.cache_clear()
    return tmp_path / "data"


def bvh(tmp_path, name, at=1.0):
    load_save.save(still(SETS[name], at), tmp_path / "one.bvh")
    return (tmp_path / "one.bvh").read_bytes()


def packed(clips):
    """Zip clips as archives do, with folders, other files, and what macOS adds."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in clips.items():
            archive.writestr(f"lafan1/deep/{name}.bvh", content)
        archive.writestr("__MACOSX/lafan1/._walk.bvh", b"rubbish")
        archive.writestr("lafan1/README.txt", b"read me")
    return file.getvalue()


@pytest.fixture
def server(monkeypatch, tmp_path, data, server):
    clips = {f"{n}{number}": bvh(tmp_path, "lafan1", number) for n in ("walk", "run") for number in (1, 2)}
    server.files["set.zip"] = packed(clips)
    known = {"archive": f"{server.url}/set.zip", "megabytes": 1}
    digest = hashlib.sha256(server.files["set.zip"]).hexdigest()
    monkeypatch.setitem(SETS, "lafan1", SETS["lafan1"]._replace(**known, sha256=digest))
    monkeypatch.setitem(SETS, "bandai_namco", SETS["bandai_namco"]._replace(**known))
    return server


@pytest.mark.parametrize("name", SETS)
def test_a_clip_is_read_wherever_it_lies_in_the_set(data, capsys, name):
    known = SETS[name]
    (data / name / "deep").mkdir(parents=True)
    load_save.save(still(known), data / name / "deep" / "walk.bvh")
    assert list(clips_of(name)) == ["walk"]
    clip = from_set(name, "walk")
    assert clip.fps == known.fps
    assert known.licence in capsys.readouterr().err
    from_set(name, "walk")
    assert capsys.readouterr().err == ""  # once is enough
    assert [clip.skeleton.names[joint] for joint in find_legs(clip.skeleton)[0]] == known.legs


def test_a_clip_that_is_not_there_and_a_set_that_is_not_known_are_refused(data):
    refused(
        r"No clip 'x' in .*100style: `mocap data fetch 100style` gets the set",
        from_set,
        "100style",
        "x",
        most=400,
    )
    refused(r"No clip '\.\./x' in", from_set, "bandai_namco", "../x", most=400)
    refused("No set 'x' is known; there are: bandai_namco, lafan1, 100style", clips_of, "x")
    assert clips_of("lafan1") == {}


def test_a_file_that_is_not_the_one_listed_is_refused(data, monkeypatch):
    (data / "lafan1").mkdir(parents=True)
    (data / "lafan1" / "walk.bvh").write_text("HIERARCHY")
    monkeypatch.setitem(HASHES, "walk", hashlib.sha256(b"another").hexdigest())
    refused(r"walk\.bvh is not the file listed: its checksum differs", from_set, "lafan1", "walk")


def test_without_a_folder_of_ones_own_the_cache_is_taken(monkeypatch):
    monkeypatch.delenv("MOCAP_DATA", raising=False)
    assert named_sets.folder_of("lafan1").parent.name == "mocap"


def test_a_set_is_fetched_once_with_its_terms(server, data, capsys):
    assert fetch_set("lafan1") == ["run1", "run2", "walk1", "walk2"]
    assert "CC BY-NC-ND 4.0: free with the authors' names, but not for" in capsys.readouterr().err
    files = {path.name for path in (data / "lafan1").iterdir()}
    assert files == {"walk1.bvh", "walk2.bvh", "run1.bvh", "run2.bvh", "TERMS.txt"}
    assert fetch_set("lafan1") == sorted(clips_of("lafan1"))
    assert sum(server.asked.values()) == 1
    assert from_set("lafan1", "run2").root_positions[0, 0] == pytest.approx(2)


def test_another_archive_a_damaged_one_and_an_empty_one_are_refused(server, data):
    server.files["set.zip"] = b"a page that says sorry"
    refused(r"set\.zip is not the file listed: its checksum differs", fetch_set, "lafan1")
    assert list((data / "lafan1").iterdir()) == []
    refused(r"bandai_namco\.zip is damaged, or no \.zip file: delete it", fetch_set, "bandai_namco")
    (data / "bandai_namco" / "bandai_namco.zip").unlink()
    server.files["set.zip"] = packed({})
    refused(r"bandai_namco\.zip holds no \.bvh file", fetch_set, "bandai_namco")
    assert clips_of("bandai_namco") == {}


def test_what_cannot_be_fetched_or_kept_is_one_sentence(server, data, monkeypatch, run):
    monkeypatch.setitem(SETS, "lafan1", SETS["lafan1"]._replace(archive="http://127.0.0.1:9/set.zip"))
    said = run("data fetch lafan1 --accept", 2).err.splitlines()[-1]
    assert said.startswith("mocap: 127.0.0.1:9/.../set.zip breaks off or does not answer") and len(said) < 200
    (data / "100style").write_text("a file")
    refused(r"Cannot keep 100style/100style\.zip in .*: let MOCAP_DATA name", fetch_set, "100style")


def test_the_command_shows_the_licence_before_it_fetches(server, data, run):
    said = run("data fetch lafan1", 2)
    assert "under CC BY-NC-ND 4.0" in said.out
    assert said.err == "mocap: If you accept this licence, add --accept: 1 MB to download.\n"
    assert not server.asked
    assert "4 clips are at hand" in run("data fetch lafan1 --accept").out


def test_the_sets_are_listed_with_their_licences(data, run):
    told = run("data sets").out
    for known in SETS.values():
        shown = (known.licence, known.allows, known.address, known.size(), known.hips, ", ".join(known.legs))
        assert all(text in told for text in shown)
    assert "at hand  0 clips" in told


def test_a_real_copy(real_data, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(real_data / "bvh"))
    clips = sorted(clips_of("bandai_namco"))
    assert set(clips) == set(HASHES)
    for name in clips:
        clip = from_set("bandai_namco", name)
        assert clip.fps == SETS["bandai_namco"].fps
        legs = [clip.skeleton.names[joint] for joint in find_legs(clip.skeleton)[0]]
        assert legs == SETS["bandai_namco"].legs
