"""A server of our own that does all the things servers do."""

import threading
from collections import Counter
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest


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
