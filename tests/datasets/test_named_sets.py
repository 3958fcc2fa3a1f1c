"""Named sets and the CMU database: a copy of one's own, or fetched from a server that does all they do."""

import hashlib
import io
import os
import re
import signal
import subprocess
import sys
import time
import zipfile
from contextlib import contextmanager
from typing import get_args

import numpy as np
import pytest

from mocap.body import Motion, Skeleton, find_legs, joint_positions, resample
from mocap.cli.data import SetName
from mocap.datasets import cmu_database, downloads, named_sets, resumed_downloads
from mocap.datasets.named_sets import HASHES, SETS, clips_of, fetch_set, from_set
from mocap.editing.stances import stance_of
from mocap.errors import SkeletonMismatch
from mocap.files import load_save
from mocap.graphs.motion_graph import build
from tests.files.acclaim_clips import SPINE
from tests.refusals import refused, told, unwarned


def body_of(known):
    """Return a body with the joints that a set's legs and hips are said to have."""
    right = [name.replace("Left", "Right").replace("_L", "_R") for name in known.legs]
    parents = [-1, 0, 1, 2, 3, 0, 5, 6, 7]
    offsets = [[0, 0, 0], *[[x, -0.4, 0.1] for x in (0.1, 0, 0, 0, -0.1, 0, 0, 0)]]
    return Skeleton([known.hips, *known.legs, *right], parents, offsets)


def still(known, at=1.0):
    return Motion(body_of(known), at * np.ones((3, 3)), np.tile([1.0, 0, 0, 0], (3, 9, 1)), known.fps)


def test_the_command_offers_each_named_set_and_no_other():
    assert sorted(get_args(SetName)) == sorted(SETS)


@pytest.fixture
def data(tmp_path, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path / "data"))
    downloads.show_once.cache_clear()
    return tmp_path / "data"


def bvh(tmp_path, name, at=1.0):
    load_save.save(still(SETS[name], at), tmp_path / "one.bvh")
    return (tmp_path / "one.bvh").read_bytes()


def packed(clips):
    """Zip clips as archives do, with folders, other files, and what macOS adds; the bytes tell no time."""
    file = io.BytesIO()
    contents = {f"lafan1/deep/{name}.bvh": content for name, content in clips.items()}
    contents |= {"__MACOSX/lafan1/._walk.bvh": b"rubbish", "lafan1/README.txt": b"read me"}
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in contents.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return file.getvalue()


@pytest.fixture
def sets(monkeypatch, tmp_path, data, server):
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


def test_a_set_is_fetched_once_with_its_terms(sets, data, capsys):
    assert fetch_set("lafan1") == ["run1", "run2", "walk1", "walk2"]
    assert "CC BY-NC-ND 4.0: free with the authors' names, but not for" in capsys.readouterr().err
    files = {path.name for path in (data / "lafan1").iterdir()}
    assert files == {"walk1.bvh", "walk2.bvh", "run1.bvh", "run2.bvh", "TERMS.txt"}
    assert fetch_set("lafan1") == sorted(clips_of("lafan1"))
    assert sum(sets.asked.values()) == 1
    assert from_set("lafan1", "run2").root_positions[0, 0] == pytest.approx(2)


def files_of(data, name):
    """Return the names of all files that are kept of a set."""
    return sorted(path.name for path in (data / name).rglob("*"))


def test_another_archive_a_damaged_one_and_an_empty_one_are_refused(sets, data):
    sets.files["set.zip"] = b"a page that says sorry"
    refused(r"set\.zip is not the file listed: its checksum differs", fetch_set, "lafan1")
    assert files_of(data, "lafan1") == []
    refused(r"bandai_namco\.zip is damaged, or no \.zip file: get it anew", fetch_set, "bandai_namco")
    sets.files["set.zip"] = packed({})
    refused(r"bandai_namco\.zip holds no \.bvh file", fetch_set, "bandai_namco")
    assert files_of(data, "bandai_namco") == []
    sets.files["set.zip"] = packed({"walk": b"HIERARCHY"})
    assert fetch_set("bandai_namco") == ["walk"]


def test_an_archive_that_claims_gigabytes_is_refused_by_the_command(sets, data, run):
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("walk.bvh", bytes(20_000_000))
    sets.files["set.zip"] = bomb.getvalue()
    said = run("data fetch bandai_namco --accept", 2).err.splitlines()[-1]
    assert said.startswith(
        "mocap: bandai_namco.zip claims to unpack to 20 MB, but clips of its size unpack to 1"
    )
    assert files_of(data, "bandai_namco") == []


def test_without_a_listed_checksum_those_of_all_downloads_are_noted(sets, data):
    digests = []
    for pose, says in enumerate([unwarned, told, unwarned]):
        sets.files["set.zip"] = packed({"walk": f"HIERARCHY {pose % 2}".encode()})
        sentence = [r"bandai_namco\.zip is not the file downloaded before: its host"] * (says is told)
        assert says(*sentence, fetch_set, "bandai_namco") == ["walk"]
        digests.append(hashlib.sha256(sets.files["set.zip"]).hexdigest())
        assert files_of(data, "bandai_namco") == ["TERMS.txt", "bandai_namco.zip.sha256", "walk.bvh"]
        (data / "bandai_namco" / "TERMS.txt").unlink()
    noted = (data / "bandai_namco" / "bandai_namco.zip.sha256").read_text("utf-8")
    assert noted == "".join(f"{digest}  bandai_namco.zip\n" for digest in digests[:2])
    assert digests[0] == digests[2] != digests[1]


def test_a_copy_of_ones_own_is_unpacked_without_a_network(sets, data, monkeypatch):
    monkeypatch.setenv("MOCAP_OFFLINE", "1")
    missing = r"lafan1/lafan1\.zip is not here, and MOCAP_OFFLINE forbids downloads: unset it, or put a copy"
    refused(missing, fetch_set, "lafan1")
    copy = data / "lafan1" / "lafan1.zip"
    copy.write_bytes(packed({"walk": b"HIERARCHY"}))
    differs = r"lafan1\.zip is not the file listed: its checksum differs\. Delete it, and fetch again"
    refused(differs, fetch_set, "lafan1", most=400)
    assert files_of(data, "lafan1") == ["lafan1.zip"]
    (data / "bandai_namco").mkdir()
    (data / "bandai_namco" / "bandai_namco.zip").write_bytes(b"rubbish")
    refused("is damaged", fetch_set, "bandai_namco")
    assert files_of(data, "bandai_namco") == ["bandai_namco.zip"]  # it is not ours to remove
    copy.write_bytes(sets.files["set.zip"])
    assert fetch_set("lafan1") == ["run1", "run2", "walk1", "walk2"]
    assert not sets.asked


def test_an_interrupted_unpacking_needs_no_second_download(sets, data):
    def interrupt(items):
        if isinstance(items, list):  # of clips, not a range of pieces
            raise KeyboardInterrupt
        return items

    with pytest.raises(KeyboardInterrupt) as interruption:
        fetch_set("lafan1", progress=interrupt)
    assert interruption.value.__notes__ == ["The archive is kept: fetch again to unpack it."]
    assert files_of(data, "lafan1") == ["lafan1.zip"]
    assert len(fetch_set("lafan1")) == 4
    assert sum(sets.asked.values()) == 1


def test_what_cannot_be_fetched_or_kept_is_one_sentence(sets, data, monkeypatch, run):
    monkeypatch.setattr(resumed_downloads, "PAUSES", ())
    monkeypatch.setitem(SETS, "lafan1", SETS["lafan1"]._replace(archive="http://127.0.0.1:9/set.zip"))
    said = run("data fetch lafan1 --accept", 2).err.splitlines()[-1]
    assert said.startswith("mocap: 127.0.0.1:9/.../set.zip breaks off or does not answer") and len(said) < 200
    (data / "100style").write_text("a file")
    refused(r"Cannot keep 100style\.zip in .*: let MOCAP_DATA name", fetch_set, "100style", most=400)


NOBODY = 65534  # a user without rights


@pytest.fixture
def ordinary_user(sets, data):
    """Give a block in which the folder of all sets cannot be written into, even if root runs the tests."""
    import requests.exceptions  # noqa: F401 (an ordinary user may not read root's Python)

    if os.name == "nt":
        pytest.skip("Windows has no such permissions")
    root = os.geteuid() == 0
    closed = {
        folder: folder.stat().st_mode for folder in data.parents if root and not folder.stat().st_mode & 1
    }
    for folder, mode in closed.items():
        folder.chmod(mode | 0o055)
    data.mkdir()

    @contextmanager
    def block():
        data.chmod(0o555)
        if root:
            os.seteuid(NOBODY)
        try:
            yield
        finally:
            if root:
                os.seteuid(0)
            data.chmod(0o755)

    yield block
    for folder, mode in closed.items():
        folder.chmod(mode)


def test_without_permission_to_write_nothing_is_asked_for(sets, data, ordinary_user, run):
    permission = (
        r"Cannot keep lafan1\.zip in .*lafan1 \(Permission denied\): let MOCAP_DATA name a folder you may"
    )
    with ordinary_user():
        refused(permission, fetch_set, "lafan1", most=400)
        said = run("data fetch lafan1 --accept", 2).err
    assert re.search(permission, said)
    (data / "lafan1").mkdir()
    (data / "lafan1").chmod(0o555)
    with ordinary_user():
        refused(permission, fetch_set, "lafan1", most=400)
    assert not sets.asked


def test_without_permission_to_write_a_whole_set_is_read(sets, data, ordinary_user, run):
    fetch_set("lafan1")
    (data / "lafan1").chmod(0o555)
    with ordinary_user():
        assert len(fetch_set("lafan1")) == 4
        assert "4 clips are at hand" in run("data fetch lafan1 --accept").out
        assert len(from_set("lafan1", "run2")) == 3


FETCH = """
import signal
import sys
from mocap.cli.main import main
from mocap.datasets import resumed_downloads
from mocap.datasets.named_sets import SETS
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell lets its background jobs ignore it
resumed_downloads.PIECE = 100
SETS["lafan1"] = SETS["lafan1"]._replace(archive=sys.argv[1], megabytes=None, sha256=sys.argv[2])
sys.exit(main(["data", "fetch", "lafan1", "--accept"]))
"""


def size_of(part):
    """Return the bytes of a file, 0 while another process makes it anew."""
    try:
        return part.stat().st_size
    except FileNotFoundError:
        return 0


KEPT = "0 of 0 MB are kept: fetch again to continue from there."
INTERRUPTED = f"mocap: interrupted; no half-written file is left. {KEPT}"


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no such signals")
@pytest.mark.parametrize(
    ("ending", "status", "said"),
    [("SIGINT", 130, INTERRUPTED), ("SIGTERM", 130, INTERRUPTED), ("SIGKILL", -9, None)],  # minus its number
)
def test_a_process_that_is_ended_continues_at_the_next_call(ranges, data, ending, status, said):
    ranges.body = packed({"walk": bytes(range(200)) * 30})
    command = [sys.executable, "-c", FETCH, ranges.url, hashlib.sha256(ranges.body).hexdigest()]
    ranges.faults = ["waits"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        part = data / "lafan1" / "lafan1.zip.part"
        while size_of(part) < len(ranges.body) // 2 - 100:
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(getattr(signal, ending))
        last_line = process.communicate()[1].splitlines()[-1:]
    assert process.returncode == status
    if said:
        assert last_line == [said]
    assert files_of(data, "lafan1") == ["lafan1.zip.part", "lafan1.zip.part.json"]
    size = part.stat().st_size
    ranges.requests.clear()
    again = subprocess.run(command, capture_output=True, text=True, check=True)
    assert again.stdout == "1 clips are at hand\n"
    assert ranges.requests == [(f"bytes={size}-", ranges.etag)]
    assert files_of(data, "lafan1") == ["TERMS.txt", "walk.bvh"]


def test_the_command_shows_the_licence_before_it_fetches(sets, data, run):
    said = run("data fetch lafan1", 2)
    assert "under CC BY-NC-ND 4.0" in said.out
    assert said.err == "mocap: If you accept this licence, add --accept: 1 MB to download.\n"
    assert not sets.asked
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


AMC = "1\nroot 0 0 0 0 0 0\nspine 0\n2\nroot 0 0 1 0 0 0\nspine 9\n"
FILES = {"07/07.asf": SPINE, "07/07_01.amc": AMC, "07/07_02.amc": AMC}
FILES |= {"08/08.asf": SPINE, "08/08_01.amc": AMC}


@pytest.fixture
def database(monkeypatch, tmp_path, server):
    kinds = ["walk", "Run, walk", "sleepwalking"]
    server.files |= {name: text.encode() for name, text in FILES.items()}
    rows = {
        name: {"sha256": hashlib.sha256(text).hexdigest(), "frames": "2", "description": kinds[index % 3]}
        for index, (name, text) in enumerate(server.files.items())
    }
    monkeypatch.setattr(cmu_database, "_registry", lambda: rows)
    monkeypatch.setattr(cmu_database, "BASE_URL", server.url)
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path / "cache"))
    return server


def kept(tmp_path):
    return sorted(str(p.relative_to(tmp_path / "cache")) for p in tmp_path.rglob("*") if p.is_file())


def test_a_trial_is_fetched_once(database, tmp_path, capsys):
    downloads.show_once.cache_clear()
    motion = cmu_database.cmu("07_01")
    assert (motion.name, len(motion), motion.fps) == ("07_01", 2, 120.0)
    assert np.allclose(motion.root_positions[1], [0, 0, 0.0254])
    assert kept(tmp_path) == ["07/07.asf", "07/07_01.amc"]
    cmu_database.cmu("07_01")
    assert database.asked == {"07/07.asf": 1, "07/07_01.amc": 1}
    told = capsys.readouterr()
    assert told.err.count("may not resell") == 1
    assert told.out == ""


def test_a_subject_and_a_kind(database):
    assert [motion.name for motion in cmu_database.cmu(subject=7)] == ["07_01", "07_02"]
    assert [motion.name for motion in cmu_database.cmu(kind="run")] == ["07_01", "08_01"]
    where = "in its description is listed; the subjects are 07, 08"
    refused(f"No trial of subject 8 with 'swim' {where}", lambda: cmu_database.cmu(subject=8, kind="swim"))
    refused(f"No trial with 'zzz' {where}", lambda: cmu_database.cmu(kind="zzz"))
    refused("Which trials", cmu_database.cmu)
    refused(r"No trial '../../x_1' is listed; `mocap data list`", cmu_database.cmu, "../../x_1")


WRONG = [
    ("missing", r"07_01.amc answers 404: try again later, or put a copy of .*MOCAP_DATA"),
    ("half", r"07_01.amc breaks off or does not answer: try again later, or put a copy"),
    ("wrong", r"07_01.amc is not the file listed: its checksum differs; put a copy"),
]


@pytest.mark.parametrize(("how", "message"), WRONG)
def test_what_goes_wrong_is_said_and_not_kept(database, tmp_path, how, message):
    database.how["07/07_01.amc"] = how
    refused(message, cmu_database.cmu, "07_01")
    assert kept(tmp_path) == ["07/07.asf"]
    assert database.asked["07/07_01.amc"] == 1 + downloads.RETRIES
    database.how.clear()
    assert len(cmu_database.cmu("07_01")) == 2


def test_a_busy_server_is_asked_again(database):
    database.how["07/07_01.amc"] = "busy at first"
    assert len(cmu_database.cmu("07_01")) == 2
    assert database.asked["07/07_01.amc"] == 3


def test_a_server_that_is_gone(database, tmp_path, monkeypatch):
    cmu_database.cmu("07_01")
    monkeypatch.setattr(cmu_database, "BASE_URL", "http://127.0.0.1:9/subjects")
    assert len(cmu_database.cmu("07_01")) == 2  # what is in the cache needs no network
    refused(r"127.0.0.1:9/.../07_02.amc breaks off or does not answer", cmu_database.cmu, "07_02")
    assert kept(tmp_path) == ["07/07.asf", "07/07_01.amc"]


def test_without_leave_nothing_is_downloaded_and_what_is_kept_is_read(database, monkeypatch):
    cmu_database.cmu("07_01")
    requests = dict(database.asked)
    monkeypatch.setenv("MOCAP_OFFLINE", "1")
    assert len(cmu_database.cmu("07_01")) == 2
    refused("07/07_02.amc is not here, and MOCAP_OFFLINE forbids downloads", cmu_database.cmu, "07_02")
    assert database.asked == requests


def test_a_file_that_broke_in_the_cache_is_fetched_again(database, tmp_path):
    cmu_database.cmu("07_01")
    (tmp_path / "cache/07/07_01.amc").write_text(AMC[:20])
    assert len(cmu_database.cmu("07_01")) == 2
    assert database.asked["07/07_01.amc"] == 2


def test_line_ends_make_no_difference(database, tmp_path, monkeypatch):
    database.files["07/07_01.amc"] = AMC.replace("\n", "\r\n").encode()
    assert len(cmu_database.cmu("07_01")) == 2
    assert (tmp_path / "cache/07/07_01.amc").read_bytes() == AMC.encode()


def test_a_folder_that_is_none(database, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path / "file"))
    refused(r"Cannot keep 07/07.asf in .*file .*: let MOCAP_DATA name a folder", cmu_database.cmu, "07_01")


def test_an_interruption_leaves_nothing(database, tmp_path, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(downloads.hashlib, "sha256", interrupt)
    with pytest.raises(KeyboardInterrupt):
        cmu_database.cmu("07_01")
    assert kept(tmp_path) == []


def test_every_listed_file_is_found_without_a_network(real_data, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(real_data / "cmu"))
    monkeypatch.setattr("pooch.HTTPDownloader.__call__", lambda *_: pytest.fail("no network"))
    listed = sorted(cmu_database._registry())
    assert listed == sorted(str(p.relative_to(real_data / "cmu")) for p in (real_data / "cmu").rglob("*.a*"))
    for name in listed:
        assert cmu_database.fetch_listed(name) == real_data / "cmu" / name
    walks = cmu_database.cmu(subject=16, kind="walk")
    assert len(walks) == 26
    lengths = {trial.name: trial.frames for trial in cmu_database.trials(16)}
    assert all(len(walk) == lengths[walk.name] for walk in walks)


@pytest.mark.filterwarnings("ignore:.*let go|.*off its pin")
def test_one_body_wears_the_clips_of_another_person(real_data, monkeypatch):
    monkeypatch.setenv("MOCAP_DATA", str(real_data / "cmu"))
    own = stance_of(cmu_database.cmu("16_15"))
    worn = cmu_database.cmu("02_01", skeleton=own)
    assert worn.skeleton is own.skeleton
    assert (worn.name, len(worn), worn.fps) == ("02_01", 343, 120.0)
    feet = find_legs(worn.skeleton)
    balls = [(worn.skeleton.names[leg.ball], leg.ball) for leg in feet]
    stands = [joint_positions(worn)[worn.contacts[name], ball, 1] for name, ball in balls]
    assert [float(np.median(height)) for height in stands] == pytest.approx(
        [own.heights["left ball"], own.heights["right ball"]], abs=1e-6
    )
    everyone = [cmu_database.cmu("16_15"), worn, cmu_database.cmu("49_01", skeleton=own)]
    graph = build([resample(clip, 30) for clip in everyone], window=10, threshold=0.08)
    assert graph.count("transition") > 0
    with pytest.raises(SkeletonMismatch):
        build([everyone[0], cmu_database.cmu("02_01")], window=10, threshold=0.08)
    runs = cmu_database.cmu(subject=2, kind="walk", skeleton=own.skeleton)
    assert {clip.skeleton for clip in runs} == {own.skeleton}
