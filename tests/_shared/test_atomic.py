"""A file is written whole or not at all, whatever happens to process, disk or folder; so are archives."""

import errno
import os
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest

from mocap._shared import atomic
from mocap._shared.archives import ROOM, open_archive, pack
from mocap._shared.atomic import UNFINISHED, replacing, require_writable
from mocap.errors import FormatError, MocapError
from mocap.files.conversion import find_files
from tests.refusals import refused


@pytest.mark.parametrize("trouble", [KeyboardInterrupt, ZeroDivisionError, SystemExit, None])
def test_a_file_is_replaced_whole_or_stays(tmp_path, trouble):
    path = tmp_path / "walk.bvh"
    path.write_text("old")
    with pytest.raises(trouble or EOFError):
        with replacing(path) as beside:
            beside.write_text("new")
            assert path.read_text() == "old"
            if trouble:
                raise trouble
        raise EOFError
    assert path.read_text() == ("old" if trouble else "new")
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]


def test_a_full_disk_is_one_sentence_and_loses_nothing(tmp_path, monkeypatch):
    def full(number):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = tmp_path / "walk.bvh"
    path.write_text("old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(MocapError, match=r"Cannot write .*walk.bvh: No space left"), replacing(path) as new:
        new.write_text("new")
    assert path.read_text() == "old" and len(list(tmp_path.iterdir())) == 1


def test_a_file_is_on_the_disk_before_it_replaces_the_old_one_and_its_folder_after(tmp_path, monkeypatch):
    synced = []

    def sync(number):
        synced.append((os.fstat(number).st_ino, (tmp_path / "walk.bvh").exists()))

    monkeypatch.setattr(os, "fsync", sync)
    with replacing(tmp_path / "walk.bvh") as beside:
        beside.write_text("new")
    file, folder = (tmp_path / "walk.bvh").stat().st_ino, tmp_path.stat().st_ino
    assert synced == [(file, False), (folder, True)]


def test_a_new_file_has_ordinary_permissions_and_links_are_followed(tmp_path):
    (tmp_path / "plain").write_text("")
    (tmp_path / "link").symlink_to("new")
    for text in ("first", "second"):
        with replacing(tmp_path / "link") as beside:
            beside.write_text(text)
        assert (tmp_path / "link").is_symlink() and (tmp_path / "new").read_text() == text
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize(
    ("name", "reason"), [("no/walk.bvh", "No such file"), ("a", ""), ("loop", "Too many levels")]
)
def test_what_is_in_the_way_is_named(tmp_path, name, reason):
    (tmp_path / "a").mkdir()
    (tmp_path / "loop").symlink_to("loop")
    with (
        pytest.raises(MocapError, match=f"Cannot write .*{name}: {reason}"),
        replacing(tmp_path / name) as new,
    ):
        new.write_text("")
    assert {file.name for file in tmp_path.iterdir()} == {"a", "loop"}


KILLED = """
import os, signal, sys
from mocap._shared.atomic import replacing
with replacing(sys.argv[1]) as beside:
    beside.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""
POOL = """
import os, time
from concurrent.futures import ProcessPoolExecutor
from mocap._shared.tasks import serve
with ProcessPoolExecutor(2, initializer=serve) as pool:
    pool.submit(print, "up", flush=True).result()
    print(*pool._processes, flush=True)
    pool.submit(time.sleep, 99).result()
"""


def test_what_a_kill_leaves_is_no_clip_and_who_writes_a_day_later_removes_it(tmp_path):
    subprocess.run([sys.executable, "-c", KILLED, tmp_path / "walk.bvh"], check=False)
    (left,) = tmp_path.iterdir()
    assert left.name.startswith(UNFINISHED) and (left / "walk.bvh").exists()
    refused("holds no", find_files, [tmp_path])
    with replacing(tmp_path / "run.bvh") as beside:
        for seconds, stays in ((atomic.DAY - 60, True), (atomic.DAY + 60, False)):
            os.utime(left, times=(time.time() - seconds,) * 2)
            atomic._remove_unfinished.cache_clear()  # as in another process
            require_writable(tmp_path / "walk.bvh")
            assert left.exists() == stays and beside.parent.exists()  # who lives, keeps what it has
        beside.write_text("")
    assert [file.name for file in tmp_path.iterdir()] == ["run.bvh"]


def test_workers_die_with_their_parent():
    with subprocess.Popen([sys.executable, "-c", POOL], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout.readline() == "up\n"
        workers = [int(word) for word in parent.stdout.readline().split()]
        parent.send_signal(signal.SIGKILL)
    deadline = time.monotonic() + 60
    while workers and time.monotonic() < deadline:
        workers = [worker for worker in workers if Path(f"/proc/{worker}/fd/0").exists()]
        time.sleep(0.02)
    assert not workers


def test_a_missing_file_and_a_folder_are_one_sentence(tmp_path):
    for path in (tmp_path, tmp_path / "nothing.npz"):
        with pytest.raises(MocapError, match=r"Cannot read .*: "), open_archive(path, "some pairs"):
            pass


@pytest.mark.parametrize("kind", ["<i8", ">i8", "<i4"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_come_back_in_the_order_of_this_machine(tmp_path, kind, order):
    rows = np.arange(6).reshape(3, 2)
    pack(tmp_path / "pairs.npz", {"rows": rows.astype(kind, order)})
    with open_archive(tmp_path / "pairs.npz", "some pairs") as members:
        back = members["rows"].read()
    assert np.array_equal(back, rows) and back.dtype.isnative and back.flags.c_contiguous


def test_what_unpacks_to_too_much_is_written_as_it_is_and_refused_where_it_is_packed(tmp_path):
    zeros = {"zeros": np.zeros(ROOM)}
    pack(tmp_path / "ours.npz", zeros)
    with open_archive(tmp_path / "ours.npz", "ours") as members:
        assert not members["zeros"].read().any()
    np.savez_compressed(tmp_path / "theirs.npz", **zeros)
    with pytest.raises(FormatError, match="damaged"), open_archive(tmp_path / "theirs.npz", "zeros"):
        pass
    with zipfile.ZipFile(tmp_path / "many.npz", "w") as archive:
        for number in range(2**14 + 1):
            archive.writestr(str(number), "")
    with pytest.raises(FormatError, match="damaged"), open_archive(tmp_path / "many.npz", "a few"):
        pass
