"""Students of all kinds: for each a notebook as a list of cells, (tag, source)."""

import os

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
HONEST = [START, SPEED, CHEAPEST]
SAY = "def speed(positions, fps): raise ValueError({})"
KNOWS_ALL = """
from pathlib import Path
import mocap.course.marking.student as student
def all_known(self, name, arguments):
    from mocap.course.checks import all_checks
    from mocap.course.marking.plain_data import pack
    return pack(all_checks()[name].truth(*arguments)), [], '', ''
student.Student.call = all_known
file = Path(student.__file__)
file.write_text(file.read_text() + '\\nfrom mocap.course.checks import all_checks\\n'
  'Student.call = lambda self, name, given: (pack(all_checks()[name].truth(*given)), [], "", "")\\n')
"""


def speed(source):
    """Give a notebook in which all is right but `speed`, which is this."""
    return [START, ("exercise:speed", source), CHEAPEST]


def outside(*attempts):
    """Give a `speed` that tells which of these attempts succeeded."""
    tries = "".join(f"try:\n  {one}\n  done.append({one!r})\nexcept OSError: pass\n" for one in attempts)
    return speed(
        f"import os, signal, socket\nfrom pathlib import Path\ndone = []\n{tries}{SAY.format('done')}"
    )


DISHONEST = {
    "patches the check": speed(
        "import mocap.course.check as c, mocap.course.marking.marks as m\n"
        "from mocap.course.check import Verdict\n"
        "c.Check.verdict = lambda self, answer: Verdict(True, 'all is right')\n"
        "m._judge = lambda *_: Verdict(True, 'all is right')\n"
        "def speed(positions, fps): return 0"
    ),
    "patches what prepares": speed(
        "from mocap.course.marking.student import Student\n"
        "Student.prepare = lambda *_: [1, 2]\nStudent.call = lambda *_: {'given': 3}"
    ),
    "forges replies": speed(
        "import os\n"
        "for fd in range(3, 256):\n"
        "  for line in ([[1], [], '', ''], [True, ''], [], {'a': 1}, 3, None, '[' * 100_000):\n"
        "    try: os.write(fd, (str(line).replace(\"'\", '\"').replace('T', 't') + '\\n').encode())\n"
        "    except OSError: pass"
    ),
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
    "calls the oracle": speed("def speed(positions, fps): return checks.speed.truth(positions, fps)"),
    "takes the oracle from memory": speed(
        "import gc\nhas = lambda one: getattr(one, 'name', '') == 'speed' and hasattr(one, 'draw')\n"
        "speed = vars(next(one for one in gc.get_objects() if has(one)))['tru' + 'th']"
    ),
    "prints secrets": speed(f"import os\n{SAY.format('str(dict(os.environ))')}"),
    "tries what walls forbid": outside(
        # read the memory of others, and what they handed in
        *(f"open(f'/proc/{{os.getppid()}}/{name}', 'rb').read(1)" for name in ("environ", "mem", "maps")),
        "os.listdir(f'/proc/{os.getppid()}/fd')",
        "open('LATER')",
        "open('FOLDER/zoe/../zoe/x.ipynb')",
        # rewrite it, through links too
        "open('LATER', 'w').write('{')",
        "os.unlink('LATER')",
        "os.truncate('LATER', 0)",
        "os.mkdir('FOLDER/x')",
        "os.symlink('LATER', 'link'), open('link', 'a')",
        "os.link('LATER', 'hard')",
        "os.rename('LATER', 'a')",
        # leave files for others
        *(f"open('{place}/PLANT-a', 'w')" for place in ("/tmp", "/dev/shm", "/var/tmp", "FOLDER", "HOME")),
        "open(os.path.join(os.path.dirname(np.__file__), 'PLANT-a'), 'w')",
        # call servers
        "socket.create_connection(('127.0.0.1', 80000 % 65536), 5)",
        "socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'', ('127.0.0.1', 9))",
        "socket.socket(socket.AF_UNIX)",
        # take the walls down
        "import ctypes; [-1, 0][ctypes.CDLL(None).umount2(b'/proc', 2)] or os.stat('nowhere')",
        "import ctypes; ctypes.CDLL(None).unshare(0x10000000) and os.stat('nowhere')",
        "import ctypes; ctypes.CDLL(None).ptrace(16, os.getppid(), 0, 0) and os.stat('nowhere')",
        "import ctypes; ctypes.CDLL(None).mount(None, b'/', None, 0x1020, None) and os.stat('nowhere')",
    ),
    "reads what it inherits": speed(
        "import os, stat\nfound = []\nfor fd in range(300):\n  try: mode = os.fstat(fd).st_mode\n"
        "  except OSError: continue\n  if stat.S_ISREG(mode) or stat.S_ISFIFO(mode): found.append(fd)\n"
        f"{SAY.format('found')}"
    ),
    "copies another's": speed("exec(open('LATER').read())"),
    "rewrites the package": [START, ("exercise:speed", KNOWS_ALL), CHEAPEST],
    "leaves a process behind": speed(
        f"import subprocess\nsubprocess.Popen(['sleep', '{SLEEP}'], start_new_session=True)"
    ),
    "leaves a grandchild behind": speed(
        "import os\nif not os.fork():\n  os.setsid()\n  if os.fork(): os._exit(0)\n"
        f"  os.execvp('sleep', ['sleep', '{SLEEP}'])"
    ),
    "starts many processes": speed(
        "import subprocess, time\n"
        f"all = [subprocess.Popen(['sleep', '{SLEEP}'], start_new_session=True) for _ in range(40)]\n"
        "time.sleep(60)"
    ),
    "forks from child to child": speed(
        "import os\nif not os.fork():\n  os.setsid()\n  for _ in range(9999):\n    if os.fork(): os._exit(0)"
    ),
    "kills what started it": speed(
        "import os, signal, time\nif os.getppid(): os.kill(os.getppid(), signal.SIGKILL)\ntime.sleep(1)"
    ),
    "stops what started it": speed(
        f"import os, signal, subprocess\nsubprocess.Popen(['sleep', '{SLEEP}'], start_new_session=True)\n"
        "os.kill(os.getppid(), signal.SIGSTOP)"
    ),
    "ends the marker": speed(
        "import os, pathlib\ndone = []\nfor place in pathlib.Path('/proc').glob('[0-9]*'):\n"
        "  try:\n    if b'FOLDER' in (place / 'cmdline').read_bytes() or place.name == str(os.getppid()):\n"
        f"      done.append(os.kill(int(place.name), 15))\n  except OSError: pass\n{SAY.format('done')}"
    ),
    "fills the disk": speed("for n in range(30): open(f'{n}', 'wb').write(b'x' * 45_000_000)"),
    "writes many files": speed(
        "for n in range(2100): open(f'{n}', 'w').write('x')\nimport time\ntime.sleep(1)"
    ),
    '=HYPERLINK("evil")': speed("def speed(positions, fps): raise ValueError('\\n=cmd|calc\\n\\x1b[2J')"),
}
UNLUCKY = {  # with the marks that they earn
    "prints without end": ("01", speed("while True: print('x' * 2000)")),
    "prints a lot": ("11", speed(f"{SPEED[1].replace('    return', '    print([0] * 99999); return')}")),
    "fills the memory": ("01", speed("def speed(positions, fps): return bytearray(3 << 30)")),
    "never ends": ("01", speed("def speed(positions, fps):\n    while True: pass")),
    "ends Python": ("01", speed("import os\nos._exit(0)")),
    "leaves Python": ("01", speed("import sys\ndef speed(positions, fps): sys.exit()")),
    "asks": ("01", speed("def speed(positions, fps): return input('fps?')")),
    "is no Python": ("01", speed("def speed(positions, fps)\n    return ((((")),
    "has helpers, tests and a cell on top": (
        "11",
        [
            ("", "%config InlineBackend.figure_format = 'retina'\n!true"),
            START,
            ("", "import numpy as np\ndef steps(positions): return np.diff(positions[:, GROUND], axis=0)"),
            (
                "exercise:speed",
                "def speed(positions, fps):\n    return np.hypot(*steps(positions).T) * fps\nspeed()",
            ),
            CHEAPEST,
            ("", "GROUND = [0, 2]"),
        ],
    ),
    "writes files": (
        "11",
        speed(f"import shutil, subprocess\nnp.save('a', 1); shutil.copy('a.npy', 'b')\n{SPEED[1]}"),
    ),
    "lost cells and tags": ("10", [START, ("exercise:sped", SPEED[1])]),
    "lost all tags": ("11", [START, ("", SPEED[1]), ("", CHEAPEST[1])]),
    "says truth in a comment": ("11", speed(f"# eval: the ground truth\n{SPEED[1]}")),
}


def hand_in(cells, file, spoil=lambda text: text):
    """Write a notebook; `spoil` changes its text at the end, and may give bytes."""
    made = [nbformat.v4.new_code_cell(s, metadata={"tags": [tag] if tag else []}) for tag, s in cells]
    file.parent.mkdir(parents=True, exist_ok=True)
    text = spoil(nbformat.writes(nbformat.v4.new_notebook(cells=made)))
    file.write_bytes(text if isinstance(text, bytes) else text.encode())


def replaced(cells, words):
    """Put words, such as the path of a file, into the sources."""
    for old, new in words.items():
        cells = [(tag, source.replace(old, str(new))) for tag, source in cells]
    return cells
