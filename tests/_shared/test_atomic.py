"""A file is written whole or not at all, whatever happens to the process, the disk or the folder."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from mocap._shared import atomic
from mocap._shared.atomic import UNFINISHED, replacing, require_writable
from mocap.errors import MocapError
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
    refused("holds no", find_files, [tmp_path], deep=True)
    with replacing(tmp_path / "run.bvh") as beside:
        for seconds, stays in ((atomic.DAY - 60, True), (atomic.DAY + 60, False)):
            os.utime(left, times=(time.time() - seconds,) * 2)
            atomic._tidy.cache_clear()  # as in another process
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
