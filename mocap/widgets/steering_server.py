"""A page of one's own machine on which a figure is steered: the local server that holds its character.

The page asks for the next frames, and the server walks them: every method stays in Python. A browser may show
pages of strangers beside this one. They can send requests to this server also, but cannot read its address:
the server listens on this machine alone, and answers only requests with the random token of its address, and
with the `Host` and `Origin` of its own page.
"""

from __future__ import annotations

import json
import secrets
import sys
import tempfile
from collections.abc import Callable, Sequence
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from socket import socket
from string import Template
from typing import Any

from mocap.body.motion import Motion
from mocap.errors import MocapError, Remedy
from mocap.files.load_save import save
from mocap.graphs.motion_graph import MotionGraph
from mocap.widgets.embedding import CANVAS, PAGE, PICTURE, SCENE, SHADED, joined, script_json
from mocap.widgets.steered_session import SteeredSession

HERE = Path(__file__).parent
OWN = ("steered_command", "steered_walker", "steer_link", "steer_hands", "steer_page")
SCRIPTS = (*SHADED, CANVAS, SCENE, PICTURE, PAGE, *(HERE / f"{part}.js" for part in OWN))
MACHINE = "127.0.0.1"
LARGEST_REQUEST = 4096  # bytes
PATIENCE = 10.0  # seconds that a request may pause while it is read
FRESH_TOKEN = 24  # random bytes
PAGE_RULES = (
    "default-src 'none'; script-src 'nonce-{}'; style-src 'unsafe-inline'; img-src data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


class SteeringServer(ThreadingHTTPServer):
    """A local server of a page on which a figure is steered through a motion graph, and recorded.

    Parameters
    ----------
    graph : a pruned graph of clips.
    labels : the kinds of motion to choose from. The first is that of the start, and the second that of the
        faster pace. By default these are any kind, and the one with the fastest clips.
    port : the port, 0 for a free one.
    recorded : a function that is called with each recording, and returns a sentence for the page, or "".

    Attributes
    ----------
    address : the address of the page, with a token that is new for each server.
    recordings : the number of recordings so far.

    Raises
    ------
    NoWalk : for a label that no clip has.
    MocapError : for a port that is in use, and clips whose legs are not found.

    Examples
    --------
    `serve_forever` serves the page until Ctrl-C. Here it runs in a thread.

    >>> import threading, urllib.request
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> with SteeringServer(graph) as server:
    ...     threading.Thread(target=server.serve_forever).start()
    ...     with urllib.request.urlopen(server.address) as page:
    ...         print(page.status, page.headers["Content-Type"])
    ...     server.shutdown()
    200 text/html; charset=utf-8
    """

    def __init__(
        self,
        graph: MotionGraph,
        labels: Sequence[str] = (),
        *,
        port: int = 0,
        recorded: Callable[[Motion], str] | None = None,
    ) -> None:
        self.session = SteeredSession(graph, labels)
        self.recorded = recorded or (lambda _motion: "")
        self.recordings = 0
        self.token = secrets.token_urlsafe(FRESH_TOKEN)
        try:
            super().__init__((MACHINE, port), SteeringRequest)
        except (OSError, OverflowError) as error:
            remedy = Remedy("choose another {}, or 0 for a free one", "port")
            raise MocapError(f"Port {port} of this machine cannot be used.", remedy=remedy) from error
        self.host = f"{MACHINE}:{self.server_port}"
        self.origin = f"http://{self.host}"
        self.address = f"{self.origin}/{self.token}/"

    def page(self, nonce: str) -> str:
        """Return the HTML of the page, whose script has a nonce."""
        parts = {"nonce": nonce, "script": joined(*SCRIPTS)}
        parts["scene"] = script_json(self.session.scene())
        return Template((HERE / "steer.html").read_text("utf-8")).substitute(parts)

    def record(self, request: dict[str, Any]) -> dict[str, str]:
        """Return a recording as the text of a .bvh file, with what `recorded` says of it."""
        motion = self.session.record(request)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "steered.bvh"
            save(motion, file)
            text = file.read_text("utf-8")
        with self.session.lock:  # one file after the other
            self.recordings += 1
            try:
                message = self.recorded(motion)
            except MocapError as error:  # the page still gets its file
                message = str(error)
        return {"bvh": text, "message": message}

    def server_close(self) -> None:
        """Close the server, after a recording that is being written."""
        super().server_close()
        with self.session.lock:
            pass

    def handle_error(self, request: socket | tuple[bytes, socket], client_address: object) -> None:
        """Ignore a connection that the browser has closed, and print all other errors."""
        if not isinstance(sys.exception(), ConnectionError | TimeoutError):
            super().handle_error(request, client_address)


class SteeringRequest(BaseHTTPRequestHandler):
    """A request of the page, or of a stranger, which is refused."""

    server: SteeringServer
    timeout = PATIENCE

    def do_GET(self) -> None:
        """Answer with the page."""
        if not self._is_own():
            return
        if self._word() != "":
            self._refuse(HTTPStatus.NOT_FOUND, "There is no such page.")
            return
        nonce = secrets.token_urlsafe(FRESH_TOKEN)
        rules = {"Content-Security-Policy": PAGE_RULES.format(nonce)}
        self._send(HTTPStatus.OK, "text/html; charset=utf-8", self.server.page(nonce), rules)

    def do_POST(self) -> None:
        """Answer with the next frames, or with a recording."""
        answers = {"walk": self.server.session.walk, "record": self.server.record}
        if not self._is_own():
            return
        answer = answers.get(self._word())
        if answer is None:
            self._refuse(HTTPStatus.NOT_FOUND, "There is no such request.")
            return
        try:
            reply = answer(self._read_request())
        except MocapError as error:
            self._refuse(HTTPStatus.BAD_REQUEST, str(error))
            return
        self._send_json(HTTPStatus.OK, reply)

    def log_message(self, *_: object) -> None:
        """Print nothing for a request."""

    def version_string(self) -> str:
        """Return the name of the server, without the versions of Python and of its library."""
        return "mocap"

    def _word(self) -> str:
        """Return the part of the address after the token."""
        return self.path.removeprefix(f"/{self.server.token}/")

    def _is_own(self) -> bool:
        """Return whether a request is one of the own page; otherwise refuse it.

        A page of a stranger has another origin, and a name that it lets point to this machine another host.
        """
        origin = self.headers.get("Origin", self.server.origin)
        token = self.path.split("/")[1:2]
        is_own_host = self.headers.get_all("Host") == [self.server.host] and origin == self.server.origin
        is_own_site = self.headers.get("Sec-Fetch-Site", "none") in ("none", "same-origin")
        has_token = bool(token) and secrets.compare_digest(token[0].encode(), self.server.token.encode())
        if is_own_host and is_own_site and has_token:
            return True
        self._refuse(HTTPStatus.FORBIDDEN, "Open the address that mocap steer has printed.")
        return False

    def _read_request(self) -> dict[str, Any]:
        """Return the JSON object that a request has, or raise `MocapError`."""
        length = self.headers.get("Content-Length", "")
        if self.headers.get_content_type() != "application/json" or not length.isdecimal():
            raise MocapError("A request is a JSON object, with its length.")
        if len(length) > len(str(LARGEST_REQUEST)) or int(length) > LARGEST_REQUEST:
            raise MocapError(f"A request has at most {LARGEST_REQUEST} bytes.")
        try:
            request = json.loads(self.rfile.read(int(length)))
        except (ValueError, RecursionError) as error:
            raise MocapError("The request is no JSON.") from error
        if not isinstance(request, dict):
            raise MocapError("A request is a JSON object.")
        return request

    def _refuse(self, status: HTTPStatus, reason: str) -> None:
        """Answer with the reason for which a request is refused."""
        self._send_json(status, {"why": reason})

    def _send_json(self, status: HTTPStatus, content: object) -> None:
        self._send(status, "application/json", json.dumps(content), {})

    def _send(self, status: HTTPStatus, kind: str, text: str, headers: dict[str, str]) -> None:
        """Send an answer that no other site may read and no browser keeps."""
        content = text.encode()
        self.send_response(status)
        always = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff"}
        always |= {"Cross-Origin-Resource-Policy": "same-origin", "Referrer-Policy": "same-origin"}
        content_headers = {"Content-Type": kind, "Content-Length": str(len(content))}
        for name, value in (always | content_headers | headers).items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)
