"""What a command cannot do is one sentence, status 2, and a folder as it was; hostile values too."""

import ast
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mocap._shared.archives import pack
from mocap.body.motion import resample
from mocap.cli.main import main
from mocap.datasets import samples
from mocap.editing.pose_copying import copied
from mocap.files import load_save
from mocap.graphs import build, prune, storage
from tests.bundled import bundled
from tests.cli.listing import LEAVES, options
from tests.editing.bodies import adult, along_x, child, rested, walk
from tests.files.acclaim_clips import write_acclaim
from tests.strategies import wave

HOSTILE = ["", " ", "-1", "0", "1", "3", "nan", "inf", "-inf", "1e999", "1e-300", "0x10", "é°", "a" * 5000]
HOSTILE += ["/dev/null/x", "/proc/x", ".", "..", "nowhere/x.npz", "x.bvh"]
HOSTILE += ["\n", "--", "-o", "%s", "{0}", "5:", ":"]
NEVER = {"course", "lab", "data", "completion"}  # these start programs, or are tested with theirs


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("refused")
    for text, names in {
        "0,0\n0,3\n3,3\n3,9\n": ["l.csv", "discs.csv"],
        "1, 7\n": ["goal.csv"],
        "0,0\n0,oops\n": ["bad.csv"],
        "-3, 5, 0.5\n": ["disc.csv"],
        "0, 0.1, 0.5\n": ["on-us.csv"],
        "x, z, t\n0, 0, 0\n0, 4, 5\n": ["scene.csv"],
        "0, 9, -1\n": ["small.csv"],
        "at 30 hand 0 0.1 0": ["k.txt"],
    }.items():
        for name in names:
            (place / name).write_text(text)
    ring = 3.5 * np.exp(2j * np.pi * np.arange(16) / 16)
    (place / "ring.csv").write_text("\n".join(f"{at.real:.3f}, {at.imag:.3f}, 0.8" for at in ring))
    straight = resample(samples.sample("walk_straight"), 30)
    flat = rested(walk(), along_x(walk().skeleton))[:4]
    clips = {"walk": straight, "stands": straight[:9], "flat": flat, "in/a": walk()[:200], "in/b": wave(30)}
    (place / "in").mkdir()
    for name, clip in {"a": wave(60, name="a"), **clips}.items():
        load_save.save(clip, place / f"{name}.bvh")
    write_acclaim(copied(walk(), adult(), child())[:1], place / "child.amc")
    clip = load_save.load(place / "a.bvh")
    storage.save(prune(build([clip], window=10, threshold=0.05)), place / "g.npz")
    storage.save(bundled("walk_circle", "walk_curve_1"), place / "walks.npz")
    for kind, name in {"a match web": "web.npz", "a group motion graph": "group.npz"}.items():
        pack(place / name, {"format": np.array(f"mocap: {kind}"), "version": np.array(1)})
    pack(place / "amass.npz", {"poses": np.zeros((2, 66)), "trans": np.zeros((2, 3))})
    return place


def contents(folder):
    return {path: path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


ROOT = Path(__file__).parents[2]
PYTHON = re.compile(r"\b[a-z_]{2,}=|\b(mocap|np)\.(?!npz)[a-z]\w*|\b[a-z_]{2,}\(|\.load")  # names, calls
OPTION = re.compile(r"(^|\s)--?[a-z]")
RAISED = ("MocapError", "FormatError", "NoWalk", "SkeletonMismatch", "Remedy", "missing", "warn")
REFUSED = tomllib.loads(Path(__file__).with_name("refused.toml").read_text("utf-8"))["REFUSED"]


@pytest.mark.parametrize(("line", "message"), REFUSED)
def test_what_cannot_be_is_one_sentence_and_leaves_nothing(folder, monkeypatch, run, line, message):
    monkeypatch.chdir(folder)
    before = contents(folder)
    told = run(line, 2).err
    assert message in told
    assert told.startswith("mocap: ") and told.count("\n") == 1 and len(told) <= 300
    assert not PYTHON.search(told)
    assert contents(folder) == before


def texts_of_errors(path):
    """Yield the texts in what a file raises or warns of."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Raise) or (isinstance(node, ast.Call) and ast.unparse(node.func) in RAISED):
            parts = (part.value for part in ast.walk(node) if isinstance(part, ast.Constant))
            yield from (part for part in parts if isinstance(part, str))


def test_no_error_in_python_names_an_option():
    rooms = [path for path in (ROOT / "mocap").rglob("*.py") if path.parent.name != "cli"]
    texts = {text: path for path in rooms for text in texts_of_errors(path)}
    assert len(texts) > 500
    assert {text for text in texts if OPTION.search(text)} == set()
    commands = {text for path in (ROOT / "mocap" / "cli").glob("*.py") for text in texts_of_errors(path)}
    assert any(OPTION.search(text) for text in commands)  # it would be noticed


def test_no_error_of_a_command_names_a_parameter():
    texts = {text for path in (ROOT / "mocap" / "cli").glob("*.py") for text in texts_of_errors(path)}
    assert {text for text in texts if PYTHON.search(text)} == set()
    shown = ["no rate: give fps=.", "see mocap.load", "call name_leg(skeleton, hip)", "give legs=[...]"]
    for told in [*shown, "graphs.load reads it", "write np.radians for it"]:
        assert PYTHON.search(told)


COMMANDS = {
    name: [option for option in options(name) if option != "--debug"]
    for name in LEAVES
    if name.split()[0] not in NEVER
}
FILES = {
    "graph info": "g.npz",
    "walk": "g.npz --random 1s",
    "convert": "a.bvh c.glb",
    "cut": "a.bvh -o w.bvh",
    "bend": "a.bvh --along l.csv -o w.bvh",
    "blend": "a.bvh a.bvh",
    "retarget": "a.bvh --to a.bvh -o r",
    "inbetween": "a.bvh --gap 10-15 -o w.bvh",
    "warp": "a.bvh --keys k.txt -o w.bvh --loose-feet",
}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    command=st.sampled_from(sorted({*COMMANDS} - {"demo"})),
    values=st.lists(st.tuples(st.integers(0, 99), st.sampled_from(HOSTILE)), min_size=1, max_size=2),
)
def test_an_option_gets_an_answer_or_one_sentence(folder, monkeypatch, capfd, command, values):
    monkeypatch.chdir(folder)
    monkeypatch.setattr("webbrowser.open", lambda page: True)
    before, known = {path: path.read_bytes() for path in folder.glob("[ag].*")}, COMMANDS[command]
    given_options = [part for at, value in values for part in (known[at % len(known)], value)]
    status = main([*command.split(), *FILES.get(command, "a.bvh").split(), *given_options])
    said = "".join(capfd.readouterr())  # what `convert` could not convert is part of its answer
    assert status in (0, 2)
    assert status == 0 or ("Traceback" not in said and len(said.splitlines()[-1]) <= 300)
    assert all(path.read_bytes() == content for path, content in before.items())


@pytest.mark.parametrize(
    "command", sorted({*COMMANDS} - {"demo", "info", "view", "graph info", "graph build"})
)
def test_each_command_gives_an_example(capsys, command):
    assert main([command, "--help"]) == 0
    assert f"Example: mocap {command} " in " ".join(capsys.readouterr().out.split())


LINES = ["graph a.bvh -o g2.npz", "loop a.bvh -o x.bvh", "blend a.bvh a.bvh", "find a.bvh:0-30 a.bvh"]
LINES += ["bend walk.bvh --along short.csv -o x.bvh", "retarget walk.bvh --to walk.bvh -o worn"]


@pytest.mark.parametrize("line", LINES)
def test_a_body_of_millimetres_is_doubted(line, folder, capsys, monkeypatch, tmp_path):
    """A file in metres is read as centimetres, and then all that is measured in metres is small enough."""
    for name in ("a.bvh", "walk.bvh"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    monkeypatch.chdir(tmp_path)
    (tmp_path / "short.csv").write_text("0,0\n0,0.01\n")
    main([*line.split(), "--to-scale" if "--to" in line else "--scale", "0.0001"])
    assert "m tall: is its scale right?" in capsys.readouterr().err


def test_an_interruption_leaves_nothing(clips, monkeypatch, run):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("mocap.graphs.build", interrupt)
    monkeypatch.setattr("mocap.files.save", interrupt)
    load_save.save(walk()[:200], "walk.bvh")
    for line in ("demo a.bvh -o out", "retarget walk.bvh --to walk.bvh -o worn"):
        assert "interrupted; no half-written file" in run(line, 130).err
    assert sorted(path.name for path in clips.rglob("*") if path.is_file()) == ["a.bvh", "b.bvh", "walk.bvh"]


def test_a_walk_may_bear_the_name_of_a_clip_elsewhere(clips, run):
    (clips / "work").mkdir()
    run("graph a.bvh b.bvh -o work/graph.npz")
    for _ in range(2):  # and it replaces an old result
        run("walk work/graph.npz --random 2s -o work/a.bvh")


def test_an_archive_of_poses_is_not_replaced_by_its_graph(tmp_path, run):
    poses, file = np.random.default_rng(0).normal(0, 0.01, (60, 66)), tmp_path / "walk.npz"
    np.savez(file, poses=poses, trans=np.zeros((60, 3)), mocap_framerate=30.0)
    before = file.read_bytes()
    assert "is one of the files to read" in run(f"graph {file} -o {file}", 2).err
    assert file.read_bytes() == before
