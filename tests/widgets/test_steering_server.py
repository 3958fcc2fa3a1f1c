"""The server of the page on which a figure is steered: its answers, and the requests that it refuses."""

import http.client
import json
import math
import socket
import threading
from dataclasses import replace

import numpy as np
import pytest

from mocap import datasets, load
from mocap.body.motion import resample
from mocap.errors import MocapError, NoWalk
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.quality.seam_measures import foot_sliding
from mocap.widgets.steered_session import SteeredSession
from mocap.widgets.steering_server import LARGEST_REQUEST, SteeringServer

AHEAD = [0.0, 1.0, ""]


@pytest.fixture(scope="module")
def graph():
    clips = [resample(datasets.sample(name), 30) for name in ("walk_curve_1", "stop_and_go")]
    return prune(build(clips, window=10, threshold=0.04))


@pytest.fixture
def session(graph):
    return SteeredSession(graph)


@pytest.fixture(scope="module")
def server(graph):
    with SteeringServer(graph) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server
        server.shutdown()
        thread.join()


@pytest.fixture
def send(server):
    """Return a function that sends a request, and returns the status, headers and text of its answer."""

    def send(method, word="", body=None, token=None, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
        own = {"Host": server.host, "Content-Type": "application/json"} | headers
        connection.request(method, f"/{token or server.token}/{word}", body, own)
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, answer.headers, text

    return send


def walk(session, seconds, command=AHEAD):
    return session.walk({"seconds": seconds, "command": command})


def test_frames_go_on_where_the_last_ones_ended(session):
    first = walk(session, 0.5)
    second = walk(session, 0.5)
    assert (first["first"], second["first"], len(second["positions"])) == (1, 16, 15)
    joints = session.scene()["member"]["joints"]
    before, after = (np.reshape(reply["positions"], (-1, joints, 3)) for reply in (first, second))
    assert 0 < np.linalg.norm(after[0, 0] - before[-1, 0]) < 0.06  # metres of the root in a frame


def test_a_recording_has_the_frames_that_were_sent(session):
    replies = [walk(session, 0.5) for _ in range(4)]
    motion = session.record({"first": 16, "last": 45})
    roots = np.concatenate([reply["positions"] for reply in replies])[15:45, :3]
    np.testing.assert_allclose(motion.root_positions, roots, atol=1e-4)
    assert set(motion.contacts) == {"lfoot", "ltoes", "rfoot", "rtoes"}


def test_it_obeys_with_held_feet_and_stands_when_no_direction_is_asked(session):
    walk(session, 1.0)
    for _ in range(3):
        walk(session, 1.0, [math.pi / 2, 1.0, ""])
    motion = session.record({"first": 61, "last": 120})
    moved = motion.root_positions[-1] - motion.root_positions[0]
    assert abs(math.atan2(moved[0], moved[2]) - math.pi / 2) < math.radians(20)
    assert max(slide.distance for slide in foot_sliding(motion)) < 1.0
    for _ in range(5):
        walk(session, 1.0, [math.pi / 2, 0.0, ""])
    stood = session.record({"first": 240, "last": 270})
    assert np.ptp(stood.root_positions[:, [0, 2]], axis=0).max() < 0.1


def test_clips_without_contacts_are_marked(graph):
    bare = replace(graph, clips=tuple(replace(clip, contacts={}) for clip in graph.clips))
    session = SteeredSession(bare)
    assert walk(session, 0.5)["notes"] == []
    assert session.record({"first": 1, "last": 9}).contacts


def test_labels_and_paces_are_those_of_the_clips(graph):
    scene = SteeredSession(graph).scene()
    assert scene["labels"] == ["", "stand", "walk"] and scene["stands"]
    low, high = scene["speeds"]
    assert scene["fast"] == ["", high]  # no label is faster than the usual pace
    assert low < scene["paces"][""] < high
    chosen = SteeredSession(graph, ["walk", "stand"]).scene()
    assert chosen["labels"] == ["walk", "stand"] and chosen["fast"] == ["stand", chosen["paces"]["stand"]]
    assert SteeredSession(graph, ["walk"]).scene()["fast"] == ["walk", high]


def test_the_page_is_sent_with_its_rules(send):
    status, headers, text = send("GET")
    assert status == 200 and "<canvas" in text and "class SteerPage" in text
    rules = headers["Content-Security-Policy"]
    nonce = rules.partition("'nonce-")[2].partition("'")[0]
    assert f'nonce="{nonce}"' in text and "default-src 'none'" in rules
    assert headers["Server"] == "mocap" and headers["Cache-Control"] == "no-store"


def test_frames_and_recordings_are_answered(server, send, tmp_path):
    status, _, text = send("POST", "walk", json.dumps({"seconds": 0.5, "command": AHEAD}))
    first = json.loads(text)["first"]
    assert status == 200 and len(json.loads(text)["positions"]) == 15
    told = []
    server.recorded = lambda motion: told.append(motion) or "Written."
    status, _, text = send("POST", "record", json.dumps({"first": first, "last": first + 14}))
    answer = json.loads(text)
    assert status == 200 and answer["message"] == "Written." and len(told[0]) == 15
    file = tmp_path / "steered.bvh"
    file.write_text(answer["bvh"], "utf-8")
    np.testing.assert_allclose(load(file).root_positions, told[0].root_positions, atol=1e-5)


def test_a_recording_that_cannot_be_written_is_still_offered(server, send):
    def full(_):
        raise MocapError("Cannot write a.bvh: No space left on device.")

    first = json.loads(send("POST", "walk", json.dumps({"seconds": 0.5, "command": AHEAD}))[2])["first"]
    server.recorded = full
    answer = json.loads(send("POST", "record", json.dumps({"first": first, "last": first + 9}))[2])
    server.recorded = lambda _: ""
    assert answer["bvh"].startswith("HIERARCHY") and "No space left" in answer["message"]


STRANGERS = {
    "another host": {"Host": "evil.example"},
    "another port": {"Host": "127.0.0.1:1"},
    "a name of this machine": {"Host": "localhost"},
    "another origin": {"Origin": "http://evil.example"},
    "the origin of a file": {"Origin": "null"},
    "another site": {"Sec-Fetch-Site": "cross-site"},
    "another token": {"token": "guessed"},
    "a token in other letters": {"token": "%C3%A9"},
}


@pytest.mark.parametrize("change", STRANGERS.values(), ids=STRANGERS)
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_strangers_are_refused_and_nobody_moves(server, send, method, change):
    steps = server.session.member.steps
    status, headers, text = send(method, "walk", json.dumps({"seconds": 1, "command": AHEAD}), **change)
    assert status == 403 and server.token not in text
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
    assert "Access-Control-Allow-Origin" not in headers
    assert server.session.member.steps == steps


GARBAGE = {
    "no JSON": "{",
    "no object": "[]",
    "nothing": "",
    "deep JSON": "[" * 3000,
    "no text": b"\xff\xfe\x00",
    "no command": '{"seconds": 1}',
    "a short command": '{"seconds": 1, "command": [0]}',
    "words": '{"seconds": 1, "command": "abc"}',
    "no heading": '{"seconds": 1, "command": [NaN, 1, ""]}',
    "no number": '{"seconds": NaN, "command": [0, 1, ""]}',
    "a long time": '{"seconds": 1e9, "command": [0, 1, ""]}',
    "a negative speed": '{"seconds": 1, "command": [0, -1, ""]}',
    "an endless speed": '{"seconds": 1, "command": [0, Infinity, ""]}',
    "a speed that no clip has": '{"seconds": 1, "command": [0, 300, ""]}',
    "a long body": '{"a": "' + LARGEST_REQUEST * "a" + '"}',
}


@pytest.mark.parametrize("body", GARBAGE.values(), ids=GARBAGE)
def test_garbage_is_refused_in_a_sentence_and_nobody_moves(server, send, body):
    steps = server.session.member.steps
    status, _, text = send("POST", "walk", body)
    why = json.loads(text)["why"]
    assert status == 400 and why.endswith(".") and len(why) <= 200
    assert server.session.member.steps == steps


def test_other_requests_are_refused(send):
    body = json.dumps({"seconds": 1, "command": AHEAD})
    assert send("POST", "walk", body, **{"Content-Type": "text/plain"})[0] == 400
    assert send("POST", "walk", body, **{"Content-Length": "-1"})[0] == 400
    assert send("POST", "walk", body, **{"Content-Length": 400 * "9"})[0] == 400
    assert send("POST", "steal", body)[0] == send("GET", "walk/../..")[0] == 404
    assert send("OPTIONS", "walk")[0] == send("PUT", "walk", body)[0] == 501


def test_an_unknown_label_makes_it_stand_until_the_command_changes(send):
    unknown = json.dumps({"seconds": 0.2, "command": [0, 1, "fly"]})
    assert (
        "No clip of the graph bears the label 'fly'" in json.loads(send("POST", "walk", unknown)[2])["fault"]
    )
    ahead = json.dumps({"seconds": 0.2, "command": AHEAD})
    assert json.loads(send("POST", "walk", ahead)[2])["fault"] == ""


def test_it_listens_on_this_machine_alone_and_each_server_has_a_token_of_its_own(graph, server):
    assert server.server_address[0] == "127.0.0.1"
    with SteeringServer(graph) as other:
        assert other.token != server.token and len(other.token) >= 32


def test_a_port_in_use_is_refused(graph):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(MocapError, match=f"Port {port} .* choose another port="):
            SteeringServer(graph, port=port)


def test_an_unknown_label_is_refused(graph):
    with pytest.raises(NoWalk, match="'fly'; there are: stand, walk"):
        SteeringServer(graph, ["fly"])


@pytest.mark.parametrize(
    ("frames", "why"),
    [
        ({"first": 1}, "first and its last frame"),
        ({"first": "a", "last": 3}, "first and its last frame"),
        ({"first": math.inf, "last": 3}, "first and its last frame"),
        ({"first": 0, "last": 9}, "Frames 1 to 15 can be recorded, got 0 to 9"),
        ({"first": 9, "last": 5}, "can be recorded"),
        ({"first": 9, "last": 99}, "can be recorded"),
        ({"first": 9, "last": 10}, "3 frames to 300 s, got 2 frames"),
    ],
)
def test_frames_that_cannot_be_recorded_are_refused(session, frames, why):
    walk(session, 0.5)
    with pytest.raises(MocapError, match=why):
        session.record(frames)
