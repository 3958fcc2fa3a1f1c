"""The limits of a student's process: no network, where the system can do that."""

import os
import socket
import subprocess
import sys

import pytest

import mocap.course.marking
from mocap.cli.course import NETWORK
from mocap.cli.main import main
from mocap.course.marking import keeper, sealed

CALL = "import socket\nwith socket.create_connection(('127.0.0.1', {}), 5): pass"
needs_namespaces = pytest.mark.skipif(
    not sealed.offline(), reason="this system does not let us leave the network"
)


@pytest.fixture
def server():
    """Listen on this machine; a connection that nobody asked for waits in the queue."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(0.2)
        yield listening


def first_cell(source):
    """Run a cell as a student's first; give its error and what came back from an exercise."""
    with sealed.sealed() as student:
        student.allow(60)
        student.ask("begin", [((), source), (("f",), "def f(a): return a")])
        return student.ask("prepare", "f")["error"], student.ask("call", "f", (4,))


def is_called(server):
    try:
        server.accept()[0].close()
    except TimeoutError:
        return False
    return True


@needs_namespaces
def test_a_notebook_cannot_call_a_server_is_who_it_was_and_writes_in_its_home(server):
    who = "import os, pathlib\n(pathlib.Path.home() / 'mine').write_text('')\nassert os.getuid() == "
    error, reply = first_cell(f"{who}{os.getuid()}\n{CALL.format(server.getsockname()[1])}")
    assert "OSError: [Errno 101]" in error
    assert reply["given"] == 4
    assert not is_called(server)


def test_without_namespaces_it_can_and_the_marker_says_so(server, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(mocap.course.marking, "offline", lambda: False)
    monkeypatch.setattr(sealed, "offline", lambda: False)
    assert first_cell(CALL.format(server.getsockname()[1]))[0] == ""
    assert is_called(server)
    assert main(["course", "mark", str(tmp_path), "-o", str(tmp_path / "marks.csv")]) == 2
    assert capsys.readouterr().err.startswith(NETWORK[False])


def test_where_it_is_not_linux_it_is_an_error(monkeypatch):
    monkeypatch.setattr(keeper, "LINUX", False)
    with pytest.raises(OSError, match="no namespaces here"):
        keeper.cut_off()


def test_a_process_that_should_be_offline_and_cannot_be_does_not_run():
    """`cut_off` fails: the process ends before it reads a request."""
    ours, theirs = socket.socketpair()
    code = (
        "import sys; from mocap.course.marking import keeper; keeper.LINUX = False; "
        "keeper.keep(int(sys.argv[1]), offline=True)"
    )
    with ours, theirs:
        number = theirs.fileno()
        command = [sys.executable, "-c", code, str(number)]
        done = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            pass_fds=[number],
        )
        theirs.close()
        ours.settimeout(20)
        assert ours.recv(10) == b""
        assert done.communicate(timeout=20)[0] == b""
