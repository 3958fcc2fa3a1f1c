"""Forty-four honest hand-ins: a right `speed`, and lines beside it as students write them."""

from tests.course.marking.students import CHEAPEST, SPEED, START

BODY = "return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps"
HEAD = "def speed(positions, fps):"


def in_cell(*lines):
    """Put lines above the right function."""
    return [START, ("exercise:speed", "\n".join([*lines, SPEED[1]])), CHEAPEST]


def in_body(*lines):
    """Put lines into the right function."""
    return [START, ("exercise:speed", "\n    ".join([HEAD, *lines, BODY])), CHEAPEST]


def notes(*lines):
    """Put a cell of notes before the right function."""
    return [START, ("", "\n".join(lines)), SPEED, CHEAPEST]


LINE_CLASS = ("class Line:", "    def eval(self, angle): return angle", "line = Line()")

HONEST_HAND_INS = {
    "a comment: checks": in_cell("# this checks that the entry is inside"),
    "a comment: sanity checks": in_cell("# sanity checks"),
    "a comment: double-checks": in_body("# double-checks the shape"),
    "a comment: truth": in_cell("# eval: the ground truth about mistakes"),
    "a comment: exec(": in_cell("# exec( and eval( are evil"),
    "a comment: importlib": in_cell("# importlib.reload did not help"),
    "a docstring": in_body('"""Return the speeds; checks all frames."""'),
    "a docstring: truth": in_body('"""Tell the truth, as __import__ would."""'),
    "a dictionary: truth": in_cell("labels = {'truth': 1, 'mistakes': 2}"),
    "a method called eval": in_cell(*LINE_CLASS, "angle = line.eval(0.5)"),
    "a table's eval": in_cell("try:\n    df.eval('a + b')\nexcept NameError:\n    pass"),
    "a polynomial's compile": in_cell("import re", "pattern = re.compile('a+')"),
    "an own function called evaluate": in_cell("def evaluate(x): return x", "evaluate(3)"),
    "an own variable called checks": in_cell("checks_done = 0", "checks_done += 1"),
    "an own count called truth": in_cell("truth = 3", "print(truth)"),
    "an attribute called truth": in_cell("class Case: truth = 1", "print(Case().truth)"),
    "the fields of an object": in_cell("class Case: pass", "print(Case().__dict__)"),
    "a text with checks in it": in_cell("print('all checks passed')"),
    "an assertion": in_cell("assert np.allclose(1, 1), 'it checks out'"),
    "notes: checks failed": notes("# my notes: the checks below failed twice"),
    "notes: a text": notes("'''checks.speed.truth is not for me'''"),
    "notes: a trial": notes("x = np.arange(5)", "x.mean()"),
    "notes: a plot": notes("import matplotlib.pyplot as plt", "plt.plot([1, 2])"),
    "notes: help": notes("help(checks.speed)"),
    "notes: print": notes("print(checks)", "type(checks.speed)"),
    "a check called": [*in_cell(), ("check:speed", "checks.speed(speed)")],
    "a check called in notes": [*in_cell(), ("", "checks.speed(speed)")],
    "a check's verdict printed": [*in_cell(), ("", "print(checks.speed.verdict(speed))")],
    "an own place": [*in_cell(), ("", "from mocap.course import lab\nspeed = lab.mine(speed)")],
    "another import of checks": [("", "import numpy as np\nfrom mocap.course import checks, lab"), SPEED],
    "checks under another name": [("", "import numpy as np\nfrom mocap.course import checks as c\n"), SPEED],
    "an import of sys": in_cell("import sys", "print(sys.version)"),
    "a path to helpers": in_cell("import sys", "sys.path.append('.')"),
    "a module read again": in_cell("import importlib", "importlib.reload(np)"),
    "gc after a plot": in_cell("import gc", "gc.collect()"),
    "a name looked up": in_cell("if 'speed' in globals(): print('again')"),
    "getattr with a name": in_cell("print(getattr(np, 'pi'))"),
    "getattr in a loop": in_cell("for name in ('sin', 'cos'): print(getattr(np, name)(0.0))"),
    "a file of data": in_cell("try: data = np.load('walk.npy')", "except OSError: data = None"),
    "a text file": in_cell("with open('notes.txt', 'w') as file: file.write('checks')"),
    "IPython's commands": in_cell("%matplotlib inline", "!ls"),
    "IPython asked for a command": in_cell("get_ipython().run_line_magic('matplotlib', 'inline')"),
    "a package installed": in_cell("%pip install -q seaborn", "# I had to pip install numpy again"),
    "a helper with a parameter": in_cell("def at(checks): return checks + 1", "at(3)"),
}
