"""Downloads that break off, from a server whose file changes, or that does not do what it should."""

import errno
import hashlib
import os
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from requests.exceptions import InvalidSchema

from mocap.datasets import partial_files, resumed_downloads
from mocap.datasets.partial_files import alone_in
from mocap.datasets.resumed_downloads import Listing, download
from mocap.errors import MocapError
from tests.refusals import refused


@pytest.fixture
def target(tmp_path):
    return tmp_path / "walks.zip"


def left_over(target):
    """Return the names of all files beside the target."""
    return sorted(path.name for path in target.parent.iterdir())


def break_off(server, target):
    """Let a download end halfway. Return the number of bytes that are kept."""
    server.faults = ["breaks off", "forbids"]
    refused("answers 403", download, Listing(server.url), target)
    server.requests.clear()
    return target.with_name("walks.zip.part").stat().st_size


def test_a_whole_file_is_downloaded_by_one_request(ranges, target):
    digest = download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert digest == hashlib.sha256(ranges.body).hexdigest()
    assert ranges.requests == [(None, None)]
    assert left_over(target) == ["walks.zip"]


@pytest.mark.parametrize("validator", ["etag", "modified"])
def test_a_download_continues_where_it_broke_off(ranges, target, validator):
    setattr(ranges, {"etag": "modified", "modified": "etag"}[validator], None)
    size = break_off(ranges, target)
    assert 900 <= size <= 1000  # half of the file, but for a piece
    assert left_over(target) == ["walks.zip.part", "walks.zip.part.json"]
    download(Listing(ranges.url), target)
    assert ranges.requests == [(f"bytes={size}-", getattr(ranges, validator))]
    assert target.read_bytes() == ranges.body
    assert left_over(target) == ["walks.zip"]


def test_what_is_kept_and_how_to_continue_is_one_sentence(ranges, target, monkeypatch):
    monkeypatch.setattr(resumed_downloads, "MEGABYTE", 100)
    monkeypatch.setattr(partial_files, "MEGABYTE", 100)
    ranges.faults = ["breaks off", *["is busy"] * 4]
    kept = r"answers 503\. (9|10) of 20 MB are kept: fetch again to continue from there\.$"
    refused(kept, download, Listing(ranges.url), target)
    assert not target.exists()


def test_a_weak_etag_does_not_continue_a_download(ranges, target):
    ranges.etag = 'W/"first"'
    ranges.modified = None
    ranges.faults = ["breaks off", "forbids"]
    refused(r"No part of it can be continued: fetch again", download, Listing(ranges.url), target)
    assert left_over(target) == []
    ranges.requests.clear()
    download(Listing(ranges.url), target)
    assert ranges.requests == [(None, None)]
    assert target.read_bytes() == ranges.body


CHANGES = {
    "the condition fails": ([], 2000),
    "the server ignores the condition": (["ignores the condition"], 2000),
    "it is longer": (["ignores the condition"], 3000),
    "it is shorter than what is kept": (["ignores the condition"], 500),
    "the server ignores ranges": (["ignores ranges"], 2000),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_file_that_has_changed_starts_again(ranges, target, change):
    faults, length = CHANGES[change]
    break_off(ranges, target)
    ranges.faults = list(faults)
    ranges.body = bytes(range(250)) * (length // 250)
    ranges.etag = '"second"'
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body


def test_a_server_without_ranges_starts_again(ranges, target):
    break_off(ranges, target)
    ranges.faults = ["ignores ranges"]
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert len(ranges.requests) == 1


@pytest.mark.parametrize("fault", ["shifts the range", "encodes"])
def test_another_range_than_asked_for_is_not_added(ranges, target, fault):
    break_off(ranges, target)
    ranges.faults = [fault]
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert ranges.requests[1:] == [(None, None)]


def test_bytes_of_another_address_are_not_continued(ranges, target):
    break_off(ranges, target)
    download(Listing(f"{ranges.url}?version=2"), target)
    assert ranges.requests == [(None, None)]
    assert target.read_bytes() == ranges.body


@pytest.mark.parametrize("record", [None, "", "{", "[]", '{"url": 1}', '{"url": "x", "length": "y"}'])
def test_bytes_without_a_record_are_not_continued(ranges, target, record):
    break_off(ranges, target)
    record_path = target.with_name("walks.zip.part.json")
    record_path.unlink() if record is None else record_path.write_text(record)
    download(Listing(ranges.url), target)
    assert ranges.requests == [(None, None)]
    assert target.read_bytes() == ranges.body


def test_more_bytes_than_the_file_has_are_not_continued(ranges, target):
    break_off(ranges, target)
    target.with_name("walks.zip.part").write_bytes(bytes(2001))
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body


def test_a_process_that_ends_after_the_last_byte_needs_no_request(ranges, target, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(partial_files.Part, "finish", lambda part: os.close(-1))
        refused("Bad file descriptor", download, Listing(ranges.url), target, most=400)
    ranges.requests.clear()
    download(Listing(ranges.url), target)
    assert ranges.requests == []
    assert target.read_bytes() == ranges.body


def test_a_line_that_often_breaks_off_gets_there(ranges, target):
    ranges.body *= 20
    ranges.faults = ["breaks off"] * 7  # more than the tries without progress
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert len(ranges.requests) == 8


def test_a_server_that_sends_nothing_new_is_asked_four_times(ranges, target):
    ranges.faults = ["is busy"] * 9
    refused(
        r"answers 503\. Nothing has come: try again later, or put a copy of .*/walks\.zip into",
        download,
        Listing(ranges.url),
        target,
    )
    assert len(ranges.requests) == 1 + len(resumed_downloads.PAUSES)


@pytest.mark.parametrize(("fault", "status"), [("has lost it", 404), ("forbids", 403)])
def test_what_the_next_try_would_not_change_is_asked_once(ranges, target, fault, status):
    ranges.faults = [fault]
    refused(f"answers {status}", download, Listing(ranges.url), target)
    assert len(ranges.requests) == 1


def test_a_server_that_is_gone_is_one_sentence(target, monkeypatch):
    monkeypatch.setattr(resumed_downloads, "PAUSES", ())
    refused("breaks off or does not answer", download, Listing("http://127.0.0.1:9/walks.zip"), target)
    assert not target.exists()


@pytest.mark.parametrize("fault", ["leads to a file", "leads to another protocol", "leads to itself"])
def test_a_redirection_that_is_not_safe_is_refused(ranges, target, fault):
    ranges.faults = [fault] * 40
    refused(r"/walks\.zip leads to an address that is not safe", download, Listing(ranges.url), target)
    assert not target.exists()


def test_a_redirection_from_https_to_http_is_refused():
    def answer(*addresses):
        steps = [SimpleNamespace(url=address) for address in addresses]
        return SimpleNamespace(url=addresses[-1], history=steps[:-1])

    for fine in (["http://a"], ["http://a", "https://b"], ["https://a", "https://b"]):
        resumed_downloads._require_safe(answer(*fine))
    for unsafe in (["https://a", "http://b"], ["https://a", "http://b", "https://c"]):
        with pytest.raises(InvalidSchema):
            resumed_downloads._require_safe(answer(*unsafe))


def test_a_file_of_another_checksum_is_not_kept(ranges, target):
    listing = Listing(ranges.url, sha256="0" * 64)
    refused(
        r"is not the file listed: its checksum differs\. Nothing of it is kept", download, listing, target
    )
    assert left_over(target) == []


def test_a_file_of_another_size_is_refused_before_it_comes(ranges, target):
    refused("has 0 MB, and 144 MB are listed", download, Listing(ranges.url, 144), target)
    assert left_over(target) == []


def test_listed_sizes_are_rounded(ranges, target, monkeypatch):
    monkeypatch.setattr(resumed_downloads, "MEGABYTE", 100)
    monkeypatch.setattr(partial_files, "MEGABYTE", 100)
    for megabytes in (19, 20, 21):
        download(Listing(ranges.url, megabytes), target)
    for megabytes in (18, 22):
        refused(f"and {megabytes} MB are listed", download, Listing(ranges.url, megabytes), target)


@pytest.mark.parametrize("fault", [None, "gives no length"])
def test_a_file_without_a_listed_size_is_bounded(ranges, target, monkeypatch, fault):
    monkeypatch.setattr(resumed_downloads, "MEGABYTE", 100)
    monkeypatch.setattr(partial_files, "MEGABYTE", 100)
    monkeypatch.setattr(resumed_downloads, "LARGEST", 19)
    ranges.faults = [fault]
    refused("has more than 19 MB, so it is another file", download, Listing(ranges.url), target)
    assert left_over(target) == []


def test_a_file_whose_length_the_server_does_not_say_is_downloaded(ranges, target):
    ranges.faults = ["gives no length"]
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert left_over(target) == ["walks.zip"]


def test_a_file_that_comes_compressed_is_kept_as_it_was(ranges, target):
    ranges.faults = ["encodes"]
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert left_over(target) == ["walks.zip"]


def test_an_interruption_before_the_length_is_known_starts_again(ranges, target):
    def interrupt(pieces):
        raise KeyboardInterrupt

    ranges.faults = ["gives no length"]
    with pytest.raises(KeyboardInterrupt) as interruption:
        download(Listing(ranges.url), target, progress=interrupt)
    assert interruption.value.__notes__[0].startswith("Nothing has come: try again later, or put a copy of ")
    assert left_over(target) == []


def test_a_changed_file_of_another_size_than_listed_replaces_nothing(ranges, target, monkeypatch):
    monkeypatch.setattr(resumed_downloads, "MEGABYTE", 100)
    monkeypatch.setattr(partial_files, "MEGABYTE", 100)
    break_off(ranges, target)
    ranges.body *= 2
    ranges.etag = '"second"'
    refused("has 40 MB, and 20 MB are listed", download, Listing(ranges.url, 20), target)
    assert left_over(target) == []


def test_a_file_for_which_the_disk_has_no_space_is_refused_before_it_comes(ranges, target, monkeypatch):
    free = SimpleNamespace(free=1999)
    monkeypatch.setattr(partial_files.shutil, "disk_usage", lambda folder: free)
    refused(r"walks\.zip needs 0 MB in .* MB are free", download, Listing(ranges.url), target, most=400)
    assert left_over(target) == []
    free.free = 2000
    download(Listing(ranges.url), target)


def test_the_rest_of_a_file_needs_space_only_for_itself(ranges, target, monkeypatch):
    size = break_off(ranges, target)
    free = SimpleNamespace(free=len(ranges.body) - size)
    monkeypatch.setattr(partial_files.shutil, "disk_usage", lambda folder: free)
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body


def test_a_disk_that_fills_up_keeps_what_it_holds(ranges, target, monkeypatch):
    write_all = resumed_downloads._write_all

    def write_until_full(file, data):
        if file.tell() >= 600:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write_all(file, data)

    monkeypatch.setattr(resumed_downloads, "_write_all", write_until_full)
    space = r"Cannot keep walks\.zip in .* \(No space left on device\): free some space, and fetch again"
    refused(space, download, Listing(ranges.url), target, most=400)
    assert not target.exists()
    monkeypatch.setattr(resumed_downloads, "_write_all", write_all)
    ranges.requests.clear()
    download(Listing(ranges.url), target)
    assert ranges.requests == [("bytes=600-", '"first"')]
    assert target.read_bytes() == ranges.body


def test_a_system_that_writes_less_than_it_is_given_loses_nothing():
    class Narrow:
        written = b""

        def write(self, data):
            self.written += bytes(data[:3])
            return len(data[:3])

    file = Narrow()
    resumed_downloads._write_all(file, b"a short text")
    assert file.written == b"a short text"


def test_an_interruption_says_how_to_continue(ranges, target, monkeypatch):
    def interrupt_after_six(pieces):
        for piece in pieces:
            if piece == 6:
                raise KeyboardInterrupt
            yield piece

    with pytest.raises(KeyboardInterrupt) as interruption:
        download(Listing(ranges.url), target, progress=interrupt_after_six)
    assert interruption.value.__notes__ == ["0 of 0 MB are kept: fetch again to continue from there."]
    assert left_over(target) == ["walks.zip.part", "walks.zip.part.json"]
    shown = []
    ranges.requests.clear()
    download(Listing(ranges.url), target, progress=lambda pieces: map(shown.append, pieces))
    assert ranges.requests == [("bytes=700-", '"first"')]
    assert shown == list(range(13))  # pieces of the missing 1 300 bytes
    assert target.read_bytes() == ranges.body


def test_two_may_not_fetch_into_one_folder(tmp_path):
    pytest.importorskip("fcntl")
    with alone_in(tmp_path), alone_in(tmp_path.parent):
        refused("Another process fetches into .*: wait", lambda: alone_in(tmp_path).__enter__(), most=400)
    with alone_in(tmp_path):
        assert list(tmp_path.iterdir()) == []


FAULTS = [
    None,
    "breaks off",
    "encodes",
    "forbids",
    "gives no length",
    "ignores ranges",
    "ignores the condition",
    "is busy",
    "leads to a file",
    "shifts the range",
]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(st.sampled_from(FAULTS), st.booleans()), max_size=12))
def test_whatever_happens_the_file_is_whole_or_not_there(ranges, tmp_path_factory, events):
    """Change the file before some of the requests, and fetch until it is there."""
    target = tmp_path_factory.mktemp("sets") / "walks.zip"
    versions = [ranges.body]
    for fault, changes in events:
        if changes:
            versions.append(bytes([len(versions)]) * (500 * len(versions)))
            ranges.body = versions[-1]
            ranges.etag = f'"{len(versions)}"'
        ranges.faults = [fault, "forbids"]
        try:
            download(Listing(ranges.url), target)
        except MocapError:
            assert not target.exists()
        else:
            assert target.read_bytes() == ranges.body
            target.unlink()
    ranges.faults = []
    download(Listing(ranges.url), target)
    assert target.read_bytes() == ranges.body
    assert left_over(target) == ["walks.zip"]
