"""Students of all kinds: for each a notebook as a list of cells, (tag, source)."""

import os
import sys

import nbformat

SLEEP = f"4242.{os.getpid()}"  # seconds, by which the tests find the process, and no other run's
START = ("", "import numpy as np\nfrom mocap.course import checks")
SPEED = (
    "exercise:speed",
    "def speed(positions, fps):\n    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps",
)
CHEAPEST = (
    "exercise:cheapest",
    "def cheapest(grid, minima):\n    return minima[np.argmin(grid[minima[:, 0], minima[:, 1]])]",
)
ENDS = (
    "exercise:dead_ends",
    "def dead_ends(edges):\n    return {b for _, b in edges} - {a for a, _ in edges}",
)
WRONG = ("exercise:dead_ends", "def dead_ends(edges):\n    return set()")
HONEST = [START, SPEED, CHEAPEST, ENDS]


def speed(source):
    """Give a notebook in which all is right but `speed`, which is this."""
    return [START, ("exercise:speed", source), CHEAPEST, ENDS]


DISHONEST = {
    "patches the check": [
        START,
        (
            "exercise:speed",
            "import mocap.course.check as c, mocap.course.marking.marks as m\n"
            "from mocap.course.check import Verdict\n"
            "c.Check.verdict = lambda self, answer: Verdict(True, 'all is right')\n"
            "m._judge = lambda *_: Verdict(True, 'all is right')\n"
            "def speed(positions, fps): return 0",
        ),
        CHEAPEST,
        WRONG,
    ],
    "answers with what equals all": speed(
        "class Yes(str):\n"
        "    def __eq__(self, other): return True\n"
        "    def __float__(self): return 1.0\n"
        "    __hash__ = None\n"
        "def speed(positions, fps): return Yes()"
    ),
    "answers with a pickle that runs": speed(
        "import os\n"
        "class Bomb:\n"
        "    def __reduce__(self): return os.system, ('touch PLANTED',)\n"
        "def speed(positions, fps): return Bomb()"
    ),
    "remembers the inputs of the notebook": speed(
        "rng = np.random.default_rng(0)\n"
        "inputs = [checks.speed.draw(rng) for _ in range(40)]\n"
        "known = {positions.tobytes(): checks.speed.truth(positions, fps) for positions, fps in inputs}\n"
        "def speed(positions, fps): return known.get(positions.tobytes())"
    ),
    "prints secrets": speed("import os\ndef speed(positions, fps): raise ValueError(str(dict(os.environ)))"),
    "lists and plants files": speed(
        "import os, pathlib\n"
        "pathlib.Path.home().joinpath('planted').write_text('')\n"
        "files = [str(path) for path in pathlib.Path().rglob('*.ipynb')]\n"
        "def speed(positions, fps): raise ValueError(f'{files}')"
    ),
    "rewrites what others handed in": speed("open('LATER', 'w').write('{')"),
    "leaves a process behind": speed(
        f"import subprocess\nsubprocess.Popen(['sleep', '{SLEEP}'], start_new_session=True)"
    ),
    "starts many processes": speed(
        "import subprocess, time\n"
        f"all = [subprocess.Popen(['sleep', '{SLEEP}'], start_new_session=True) for _ in range(40)]\n"
        "time.sleep(60)"
    ),
    "kills what started it": speed(
        "import os, signal, time\nos.kill(os.getppid(), signal.SIGKILL)\ntime.sleep(60)"
    ),
    '=HYPERLINK("evil")': speed("def speed(positions, fps): raise ValueError('\\n=cmd|calc\\n\\x1b[2J')"),
}
UNLUCKY = {
    "prints without end": speed("while True: print('x' * 2000)"),
    "fills the memory": speed("def speed(positions, fps): return bytearray(3 << 30)"),
    "ends Python": speed("import os\nos._exit(0)"),
    "has helpers, tests and a cell on top": [
        ("", "%config InlineBackend.figure_format = 'retina'\n!true"),
        START,
        ("", "import numpy as np\ndef steps(positions): return np.diff(positions[:, GROUND], axis=0)"),
        (
            "exercise:speed",
            "def speed(positions, fps):\n    return np.hypot(*steps(positions).T) * fps\nspeed()",
        ),
        CHEAPEST,
        ("", "GROUND = [0, 2]"),
        ENDS,
    ],
    "lost cells and tags": [START, ("exercise:sped", SPEED[1]), ("", ENDS[1])],
}


def hand_in(cells, file):
    """Write a notebook."""
    made = [nbformat.v4.new_code_cell(s, metadata={"tags": [tag] if tag else []}) for tag, s in cells]
    file.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(nbformat.v4.new_notebook(cells=made), file)


def replaced(cells, words):
    """Put words, such as the path of a file, into the sources."""
    for old, new in words.items():
        cells = [(tag, source.replace(old, str(new))) for tag, source in cells]
    return cells


LINUX = sys.platform == "linux"
