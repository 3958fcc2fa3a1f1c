"""The CMU database, against a server of its own that does all the things servers do."""

import hashlib

import numpy as np
import pytest

from mocap.body import find_legs, joint_positions, resample
from mocap.datasets import cmu_database, downloads
from mocap.editing.stances import stance_of
from mocap.errors import SkeletonMismatch
from mocap.graphs.motion_graph import build
from tests.files.acclaim_clips import SPINE
from tests.refusals import refused

AMC = "1\nroot 0 0 0 0 0 0\nspine 0\n2\nroot 0 0 1 0 0 0\nspine 9\n"
FILES = {"07/07.asf": SPINE, "07/07_01.amc": AMC, "07/07_02.amc": AMC}
FILES |= {"08/08.asf": SPINE, "08/08_01.amc": AMC}


@pytest.fixture
def server(monkeypatch, tmp_path, server):
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


def test_a_trial_is_fetched_once(server, tmp_path, capsys):
    downloads.show_once.cache_clear()
    motion = cmu_database.cmu("07_01")
    assert (motion.name, len(motion), motion.fps) == ("07_01", 2, 120.0)
    assert np.allclose(motion.root_positions[1], [0, 0, 0.0254])
    assert kept(tmp_path) == ["07/07.asf", "07/07_01.amc"]
    cmu_database.cmu("07_01")
    assert server.asked == {"07/07.asf": 1, "07/07_01.amc": 1}
    told = capsys.readouterr()
    assert told.err.count("may not resell") == 1
    assert told.out == ""


def test_a_subject_and_a_kind(server):
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
def test_what_goes_wrong_is_said_and_not_kept(server, tmp_path, how, message):
    server.how["07/07_01.amc"] = how
    refused(message, cmu_database.cmu, "07_01")
    assert kept(tmp_path) == ["07/07.asf"]
    assert server.asked["07/07_01.amc"] == 1 + downloads.RETRIES
    server.how.clear()
    assert len(cmu_database.cmu("07_01")) == 2


def test_a_busy_server_is_asked_again(server):
    server.how["07/07_01.amc"] = "busy at first"
    assert len(cmu_database.cmu("07_01")) == 2
    assert server.asked["07/07_01.amc"] == 3


def test_a_server_that_is_gone(server, tmp_path, monkeypatch):
    cmu_database.cmu("07_01")
    monkeypatch.setattr(cmu_database, "BASE_URL", "http://127.0.0.1:9/subjects")
    assert len(cmu_database.cmu("07_01")) == 2  # what is in the cache needs no network
    refused(r"127.0.0.1:9/.../07_02.amc breaks off or does not answer", cmu_database.cmu, "07_02")
    assert kept(tmp_path) == ["07/07.asf", "07/07_01.amc"]


def test_a_file_that_broke_in_the_cache_is_fetched_again(server, tmp_path):
    cmu_database.cmu("07_01")
    (tmp_path / "cache/07/07_01.amc").write_text(AMC[:20])
    assert len(cmu_database.cmu("07_01")) == 2
    assert server.asked["07/07_01.amc"] == 2


def test_line_ends_make_no_difference(server, tmp_path, monkeypatch):
    server.files["07/07_01.amc"] = AMC.replace("\n", "\r\n").encode()
    assert len(cmu_database.cmu("07_01")) == 2
    assert (tmp_path / "cache/07/07_01.amc").read_bytes() == AMC.encode()


def test_a_folder_that_is_none(server, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path / "file"))
    refused(r"Cannot keep 07/07.asf in .*file .*: let MOCAP_DATA name a folder", cmu_database.cmu, "07_01")


def test_an_interruption_leaves_nothing(server, tmp_path, monkeypatch):
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
