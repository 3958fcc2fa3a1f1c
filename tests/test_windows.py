"""Each command, a notebook and the tests themselves, without what Windows lacks and in its code pages.

`windows/sitecustomize.py` hides it, and says what this can tell of Windows and what it cannot.
"""

import contextlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook
from walking import generate_walk

from mocap.cli.main import main
from mocap.errors import MocapError
from mocap.files import conversion, load_save
from tests.cli.listing import LEAVES
from tests.strategies import wave

ROOT = Path(__file__).parents[1]
CODE_PAGES = ("cp1252", "cp950")  # of Western Europe and of Taiwan
LONGEST = 200  # characters of an error, which may name a file of a few

# Run commands one after the other; after each, its status and the command on both streams.
RUN = """
import shlex, sys
from mocap.cli.main import main
for line in sys.argv[1:]:
    try:
        status = main(shlex.split(line))
    except SystemExit as stop:
        status = stop.code or 0
    for stream in (sys.stdout, sys.stderr):
        print(f"\\n== {status}", file=stream, flush=True)
"""


COMMANDS = sorted(LEAVES)
NOWHERE = "'→²-é.bvh'"  # a file that is missing; cp1252 has no →, cp950 no é
REFUSED = {
    "demo": NOWHERE,
    "graph build": NOWHERE,
    "graph info": NOWHERE,
    "walk": f"{NOWHERE} --random 1s",
    "steer": NOWHERE,
    "page": NOWHERE,
    "blend": f"{NOWHERE} a.bvh",
    "info": NOWHERE,
    "judge": NOWHERE,
    "convert": "a.bvh x.glb --read-fps →",
    "cut": f"{NOWHERE} -o x.bvh",
    "warp": f"{NOWHERE} --keys k.txt -o x.bvh",
    "bend": f"{NOWHERE} --along line.csv -o x.bvh",
    "loop": f"{NOWHERE} -o x.bvh",
    "inbetween": f"{NOWHERE} --gap 1s-2s -o x.bvh",
    "find": f"{NOWHERE} a.bvh",
    "label": f"{NOWHERE} -o x.csv",
    "crowd": f"--through {NOWHERE} -o x",
    "retarget": f"{NOWHERE} --to a.bvh -o x",
    "data list": "--subject →",
    "data sets": "→",
    "data fetch": "→",
    "view": f"{NOWHERE} -o x.html",
    "course handout": f"{NOWHERE} -o x",
    "course site": "-o a.bvh/x",
    "course slides": "-o a.bvh/x",
    "course film": f"{NOWHERE} -o x.mp4",
    "course board": "-o a.bvh/x",
    "course lite": "→",
    "course exam": f"--key {NOWHERE}/key -o x",
    "course mark": "handed-in",
    "course run": NOWHERE,
    "lab": "a.bvh/x",
    "completion": "→",
}
HEAVY = {line for line in REFUSED if line.startswith("course ")} - {"course lite", "course mark"}  # imports
WORKS = {
    "demo": "a.bvh b.bvh --threshold 5 --seconds 1 --fps 10 --no-film -o demo",
    "graph build": "a.bvh b.bvh --threshold 5 --fps 20 -o new.npz --graphml new.graphml",
    "graph info": "graph.npz",
    "walk": "graph.npz --random 2s -o walk.bvh",
    "page": "graph.npz --address https://example.org/page.html -o page.html",
    "blend": "a.bvh a.bvh -o blended.bvh",
    "info": "clips --json",
    "judge": "a.bvh b.bvh",
    "convert": "clips out --to npz --plain-names",
    "cut": "a.bvh b.bvh --from 1 --rate 20 --home --plain-names -o both.glb",
    "warp": "a.bvh --keys keys.txt -o warped.bvh --loose-feet",
    "bend": "straight.bvh --along line.csv -o bent.bvh",
    "loop": "straight.bvh -o looped.bvh",
    "inbetween": "straight.bvh --gap 1s-1.2s -o filled.bvh",
    "find": "a.bvh:10-40 a.bvh b.bvh -o found",
    "label": "straight.bvh -o labels.csv",
    "crowd": "--members 2 --through points.csv --no-film -o crowd",
    "retarget": "straight.bvh --to straight.bvh -o worn",
    "data list": "--kind walk",
    "data sets": "",
    "view": "a.bvh -o a.html",
    "course handout": "-o handout --wheel",
    "course site": "-o site",
    "course slides": "-o slides",
    "course film": f"{ROOT / 'notebooks' / '06-pruning.ipynb'} --still -o pruning.mp4",
    "course board": "-o board",
    "course exam": "--key exam.key -o exam",
    "course run": "note.ipynb",
    "lab": "lab --reset 03 -- --version",
    "completion": "bash",
}
# What needs a network, JupyterLite, or the means of Linux, or does not end by itself; they are in REFUSED.
NEVER = {"data fetch", "course lite", "course mark", "steer"}
HIDDEN = """
import importlib, multiprocessing, os, pathlib, select, signal, socket, subprocess, sys, time
for name in ("resource", "fcntl", "pwd", "grp", "termios", "pty", "readline"):
    for start in (__import__, importlib.import_module):
        try:
            start(name)
        except ModuleNotFoundError:
            continue
        raise SystemExit(f"{name} is there")
for name in ("fork", "getuid", "geteuid", "sched_getaffinity", "O_DIRECTORY", "killpg", "mkfifo", "sysconf"):
    assert not hasattr(os, name), name
for name in ("SIGALRM", "SIGHUP", "SIGKILL", "SIGUSR1", "SIGCHLD", "setitimer", "alarm", "pause"):
    assert not hasattr(signal, name), name
assert not hasattr(socket, "send_fds") and not hasattr(select, "poll") and not hasattr(time, "tzset")
assert hasattr(os, "getpid") and hasattr(signal, "SIGTERM") and hasattr(socket, "socketpair")
assert multiprocessing.get_start_method() == "spawn" and os.name == "nt" and sys.platform == "win32"
try:
    multiprocessing.get_context("fork")
except ValueError:
    pass
else:
    raise SystemExit("fork is there")
file = pathlib.Path("written.txt")
for careless in (lambda: file.read_text(), lambda: file.write_text("")):
    try:
        careless()
    except EncodingWarning:
        continue
    raise SystemExit("a missing encoding is no error")
file.write_text("é\\n", encoding="locale")
assert file.read_bytes() == bytes.fromhex("e9 0d 0a"), file.read_bytes()
file.write_bytes(b"x")
with file.open("rb"):
    for careless in (file.unlink, lambda: file.replace("other.txt")):
        try:
            careless()
        except PermissionError:
            continue
        raise SystemExit("a file in use is free")
for careless in (lambda: file.replace("aux.txt"), lambda: pathlib.Path("a:b").write_bytes(b"")):
    try:
        careless()
    except OSError:
        continue
    raise SystemExit("any name is allowed")
pathlib.Path("there").write_bytes(b"")
try:
    file.rename("there")
except FileExistsError:
    print(subprocess.run(["echo", "done"], capture_output=True, check=True).stdout.decode())
"""
CLOSED = """
import io, sys
class Closed(io.StringIO):
    def write(self, text):
        raise OSError(22, "Invalid argument")
    def fileno(self):
        return 1
sys.stdout = Closed()
from mocap.cli.main import main
sys.exit(main(["data", "sets"]))
"""


def as_on_windows(folder, *words, code_page="cp1252"):
    """Run Python with the means and the code page of Windows, and return what it writes."""
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join([str(ROOT / "tests" / "windows"), str(ROOT)]),
        "PYTHONIOENCODING": code_page,
        "PYTHONWARNDEFAULTENCODING": "1",
    }
    command = [sys.executable, *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, check=False)


def parts(written, code_page):
    """Split what RUN wrote into the status and the text of each command."""
    first, *others = written.decode(code_page).replace("\r\n", "\n").split("\n== ")
    statuses, texts = zip(*(text.split("\n", 1) for text in others), strict=True)
    return list(zip(map(int, statuses), [first, *texts[:-1]], strict=True))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("windows")
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        load_save.save(clip, place / f"{clip.name}.bvh")
    mark = new_code_cell("import mocap\nimport os\nprint('→ é', os.name, hasattr(os, 'fork'))")
    for file in (place / "note.ipynb", place / "handed-in" / "ada" / "note.ipynb"):
        file.parent.mkdir(parents=True, exist_ok=True)
        nbformat.write(new_notebook(cells=[mark]), file)
    return place


@pytest.fixture(scope="module")
def more(folder):
    """Add what the commands read, of which a graph and a walk take a while."""
    load_save.save(generate_walk([[0, 0], [0, 5]]), folder / "straight.bvh")
    (folder / "clips").mkdir()
    for name in ("a.bvh", "b.bvh"):
        shutil.copy(folder / name, folder / "clips")
    texts = {"keys.txt": "at 1.5s hand 0 0.1 0", "line.csv": "0, 0\n0, 3\n1, 5", "points.csv": "1, 6"}
    for name, text in texts.items():
        (folder / name).write_text(text, "utf-8")
    with contextlib.chdir(folder):
        assert main(["graph", "a.bvh", "b.bvh", "--threshold", "5", "--fps", "20", "-o", "graph.npz"]) == 0
    return folder


def test_what_windows_lacks_is_hidden(folder):
    done = as_on_windows(folder, "-c", HIDDEN)
    assert (done.stdout.split(), done.stderr.decode()) == ([b"done"], "")


@pytest.mark.parametrize("code_page", CODE_PAGES)
def test_each_command_says_its_help(folder, code_page):
    done = as_on_windows(folder, "-c", RUN, *(f"{line} --help" for line in COMMANDS), code_page=code_page)
    assert done.returncode == 0, done.stderr.decode(code_page)
    told = parts(done.stdout, code_page)
    assert len(told) == len(COMMANDS)
    for line, (status, text) in zip(COMMANDS, told, strict=True):
        assert status == 0 and f"Usage: mocap {line}" in text.replace(" [build]", " build"), text


@pytest.mark.parametrize(
    ("code_page", "lines"),
    [
        ("cp1252", sorted({*COMMANDS} - HEAVY)),
        *(pytest.param(code_page, COMMANDS, marks=pytest.mark.sweep) for code_page in CODE_PAGES),
    ],
)
def test_each_command_refuses_in_one_sentence(folder, code_page, lines):
    assert sorted(REFUSED) == COMMANDS
    typed = [f"{line} {REFUSED[line]}" for line in lines]
    done = as_on_windows(folder, "-c", RUN, *typed, code_page=code_page)
    assert done.returncode == 0, done.stderr.decode(code_page)
    told = dict(zip(lines, parts(done.stderr, code_page), strict=True))
    for line, (status, text) in told.items():
        (sentence,) = text.strip().splitlines()
        assert status == 2 and sentence.startswith("mocap: ") and len(sentence) <= LONGEST, (line, text)
    assert told["course mark"][1].strip().endswith("on Linux or macOS, on Windows in WSL, or in a container.")


def test_a_pipe_that_is_closed_is_quiet(folder):
    done = as_on_windows(folder, "-c", CLOSED)
    assert (done.returncode, done.stderr) == (141, b"")


@pytest.mark.parametrize("line", ["demo", "course run"])
def test_a_demo_and_a_notebook_work(folder, line):
    done = as_on_windows(folder, "-m", "mocap", *line.split(), *WORKS[line].split(), code_page="cp950")
    assert done.returncode == 0, (done.stdout + done.stderr).decode("cp950")
    if line == "course run":
        (cell,) = nbformat.read(folder / "note.ipynb", 4).cells
        assert [output.text for output in cell.outputs] == ["→ é nt False\n"]


@pytest.mark.sweep
@pytest.mark.parametrize("code_page", CODE_PAGES)
@pytest.mark.parametrize("line", sorted({*COMMANDS} - NEVER))
def test_each_command_works(more, line, code_page, tmp_path):
    folder = shutil.copytree(more, tmp_path / "folder")  # some commands replace nothing that is there
    done = as_on_windows(folder, "-m", "mocap", *line.split(), *WORKS[line].split(), code_page=code_page)
    assert done.returncode == 0, (done.stdout + done.stderr).decode(code_page)


@pytest.mark.sweep
@pytest.mark.parametrize("name", ["00-quickstart", "01b-motion-files"])
def test_a_notebook_of_the_course_works(folder, name):
    shutil.copy(ROOT / "notebooks" / f"{name}.ipynb", folder)
    done = as_on_windows(folder, "-m", "mocap", "course", "run", f"{name}.ipynb", code_page="cp950")
    assert done.returncode == 0, done.stderr.decode("cp950")


@pytest.mark.sweep
def test_the_tests_are_collected(tmp_path):
    """Import each module and each test; tests that need what is hidden may skip, but not end the rest."""
    words = [
        "-m",
        "pytest",
        "-n0",
        "-q",
        "--collect-only",
        "-p",
        "no:cacheprovider",
        "-p",
        "no:nbval",
    ]
    words += ["-o", "addopts=--doctest-modules --strict-markers", "--rootdir", str(ROOT)]
    done = as_on_windows(tmp_path, *words, str(ROOT / "mocap"), str(ROOT / "tests"))
    assert done.returncode == 0, done.stdout.decode("cp1252")[-3000:]


def test_every_command_is_tried():
    assert sorted({*WORKS} | NEVER) == COMMANDS


def test_a_pool_has_no_more_processes_than_windows_can_wait_for(monkeypatch, tmp_path):
    asked = []

    def pool(workers, **_):
        asked.append(workers)
        raise MocapError("enough")

    monkeypatch.setattr(conversion.os, "cpu_count", lambda: 128)
    monkeypatch.setattr("concurrent.futures.ProcessPoolExecutor", pool)
    pairs = [(tmp_path / f"{n}.amc", tmp_path / f"{n}.bvh") for n in range(100)]
    with pytest.raises(MocapError, match="enough"):
        conversion.convert(pairs, load_save.load)
    assert asked == [61]
