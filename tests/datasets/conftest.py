"""Servers of our own that do all the things servers do."""

import gzip
import random
import threading
from collections import Counter
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from mocap.datasets import resumed_downloads


class Handler(BaseHTTPRequestHandler):
    def do_GET(self):
        name, server = self.path.removeprefix("/"), self.server
        server.asked[name] += 1
        how, body = server.how.get(name, "good"), server.files.get(name)
        if body is None or how == "missing" or (how == "busy at first" and server.asked[name] < 3):
            self.send_error(503 if how == "busy at first" else 404)
            return
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write({"wrong": body.upper(), "half": body[: len(body) // 2]}.get(how, body))

    def log_message(self, *_):
        pass


@pytest.fixture
def server(monkeypatch):
    """Serve `files` {name: bytes} at `url`; `how` names what goes wrong, `asked` counts the requests."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        server.files, server.how, server.asked = {}, {}, Counter()
        server.url = f"http://127.0.0.1:{server.server_port}"
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        monkeypatch.setattr("pooch.core.time.sleep", lambda seconds: None)
        monkeypatch.delenv("MOCAP_OFFLINE", raising=False)
        yield server
        server.shutdown()
        thread.join()


class RangeHandler(BaseHTTPRequestHandler):
    """Answer with one file or its ranges; `faults` names, request by request, what goes wrong."""

    def do_GET(self):
        server = self.server
        server.requests.append((self.headers.get("Range"), self.headers.get("If-Range")))
        fault = server.faults.pop(0) if server.faults else None
        if fault in STATUSES:
            self.send_error(STATUSES[fault])
            return
        if fault in server.redirections:
            self.send_response(302)
            self.send_header("Location", server.redirections[fault])
            self.send_header("Content-Length", "0")
            self.end_headers()
            return
        start = self.find_start(fault)
        if start and start >= len(server.body):
            self.send_response(416)
            self.send_header("Content-Range", f"bytes */{len(server.body)}")
            self.send_header("Content-Length", "0")
            self.end_headers()
            return
        self.send_from(start, fault)

    def find_start(self, fault):
        """Return the first byte that is asked for and may be sent; None for the whole file."""
        condition = self.headers.get("If-Range")
        fresh = (
            condition in (None, self.server.etag, self.server.modified) or fault == "ignores the condition"
        )
        if "Range" in self.headers and fresh and fault != "ignores ranges":
            return int(self.headers["Range"].removeprefix("bytes=").removesuffix("-"))
        return None

    def send_from(self, start, fault):
        body = self.server.body
        rest = body[start or 0 :]
        self.send_response(200 if start is None else 206)
        if start is not None:
            first = start + 1 if fault == "shifts the range" else start
            self.send_header("Content-Range", f"bytes {first}-{len(body) - 1}/{len(body)}")
        if self.server.etag:
            self.send_header("ETag", self.server.etag)
        if self.server.modified:
            self.send_header("Last-Modified", self.server.modified)
        if fault == "encodes":
            rest = gzip.compress(rest)
            self.send_header("Content-Encoding", "gzip")
        if fault != "gives no length":
            self.send_header("Content-Length", str(len(rest)))
        self.end_headers()
        self.wfile.write(rest[: len(rest) // 2] if fault in ("breaks off", "waits") else rest)
        if fault == "waits":
            self.wfile.flush()
            self.server.patience.wait()

    def log_message(self, *_):
        pass


STATUSES = {"forbids": 403, "is busy": 503, "has lost it": 404}
REDIRECTIONS = {
    "leads to a file": "file:///etc/hostname",
    "leads to another protocol": "ftp://127.0.0.1/walks.zip",
    "leads to itself": "/walks.zip",
}


@pytest.fixture(scope="module")
def range_server():
    """Serve `body` at `url` with `etag` and `modified`; `requests` lists what was asked for."""
    with ThreadingHTTPServer(("127.0.0.1", 0), RangeHandler) as server:
        server.daemon_threads = True
        server.url = f"http://127.0.0.1:{server.server_port}/walks.zip"
        server.redirections = REDIRECTIONS
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        yield server
        server.patience.set()
        server.shutdown()
        thread.join()


@pytest.fixture
def ranges(range_server, monkeypatch):
    """Give a server of ranges as it is at the beginning, without pauses, in pieces of 100 bytes."""
    range_server.body = bytes(random.Random(7).randbytes(2000))
    range_server.etag = '"first"'
    range_server.modified = "Sun, 02 Jul 2023 10:00:00 GMT"
    range_server.faults = []
    range_server.requests = []
    range_server.patience = threading.Event()
    monkeypatch.setattr(resumed_downloads, "PAUSES", (0.0, 0.0, 0.0))
    monkeypatch.setattr(resumed_downloads, "PIECE", 100)
    monkeypatch.delenv("MOCAP_OFFLINE", raising=False)
    yield range_server
    range_server.patience.set()
