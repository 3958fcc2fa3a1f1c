"""The walls as a teacher has them who is no administrator: the same tests, and notebooks that reach out."""

import csv
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from mocap.course.marking import bubblewrap, walls
from tests.course.marking.ordinary import as_ordinary_user, give
from tests.course.marking.students import CHEAPEST, HONEST, SPEED, START, hand_in

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has these walls")
ROOT = Path(__file__).parents[3]
COMMAND = """
import sys
from mocap.cli.main import main
from mocap.course.marking import marks, sealed
marks.SECONDS, sealed.WANTED = 10, sys.argv[1].split()
sys.exit(main(["course", "mark", *sys.argv[2:]]))
"""

# A folder that may be entered and written to, but not listed: `rm -rf` leaves it. The second notebook would
# import the module in it instead of pandas; the third looks for what the second has left.
PLANT = """
import os
os.umask(0)
os.mkdir("pandas", 0o300)
open("pandas/__init__.py", "w").write("stolen = True")
os.makedirs("deep/er", 0o300)
"""
IMPORT = """
import sys
sys.path[:0] = [f"{os.path.dirname(os.getcwd())}/{name}" for name in ("home", "keeper", "student")]
try: import pandas; stolen = getattr(pandas, "stolen", False)
except ImportError: stolen = False
assert not stolen, "another student's code"
"""
LIST = """
found = []
for place in (".", "..", "../keeper", "/tmp", "/dev/shm", "/var/tmp", "/proc/1", os.environ["TMPDIR"]):
    try: found += [name for name in os.listdir(place) if name not in (".ipython", ".config", ".cache")]
    except OSError: pass
assert found == [], found
"""


@pytest.fixture
def place():
    """Make a folder for the ordinary user, who cannot enter those of root's tests."""
    folder = Path(tempfile.mkdtemp(prefix="ordinary-"))
    try:
        yield folder
    finally:
        shutil.rmtree(folder)


def run(command, place):
    give(place)
    environment = os.environ | {"HOME": str(place), "TMPDIR": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        as_ordinary_user(command), cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300
    )


def test_the_walls_hold_for_an_ordinary_user(place):
    if os.geteuid() != 0:
        pytest.skip("this is one, and runs these tests anyway")
    options = ["-q", "-n0", "-p", "no:cacheprovider", "--basetemp", str(place / "tests")]
    tests = str(Path(__file__).with_name("test_walls.py"))
    done = run([sys.executable, "-m", "pytest", *options, tests], place)
    assert done.returncode == 0, done.stdout[-3000:]
    assert " passed" in done.stdout


def cell(source):
    return [START, ("exercise:speed", f"import os\n{source.strip()}\n{SPEED[1]}"), CHEAPEST]


THREE = (bubblewrap.NAME, *walls.ALL)


@pytest.mark.parametrize("behind", [walls.ALL, pytest.param(THREE, marks=pytest.mark.sweep)], ids=len)
def test_nothing_of_a_notebook_reaches_the_next_one(behind, place):
    students = {"a": PLANT, "b": IMPORT, "c": LIST, "d": PLANT, "e": LIST + IMPORT}
    for name, source in students.items():
        hand_in(cell(source), place / "in" / name / "x.ipynb")
    hand_in(HONEST, place / "in" / "zoe" / "x.ipynb")
    marks = place / "marks.csv"
    line = [sys.executable, "-c", COMMAND, " ".join(behind), str(place / "in"), "-o", str(marks)]
    done = run(line, place)
    if f"marking behind {', '.join(behind)}:" not in done.stderr:
        pytest.skip(f"this system raises fewer walls: {done.stderr[:100]}")
    rows = list(csv.DictReader(marks.read_text("utf-8").splitlines()))
    assert [row["said"] for row in rows if row["right"] != "1"] == []
    assert len(rows) == 12 and done.returncode == 0, done.stderr
    assert [*place.glob("marking-*")] == []
