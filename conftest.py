"""What all tests share, those of the notebooks too: the real clips, which the repository does not hold.

They lie in the folder that MOCAP_REAL_DATA names, or in ../shared/data: the CMU trials in `cmu`, as their
site names them, the homework's in `hw3`. Where they are missing, tests of them are skipped, and say so; no
test asks the network for them.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:  # nbformat and nbval are imported only when a notebook is collected: they take seconds
    from nbformat import NotebookNode
    from nbval.plugin import IPyNbCell, IPyNbFile

collect_ignore = ["notebooks/examples"]  # programs: `tests/test_examples.py` runs them
# They wait most, while others compute, or take minutes, and no worker shall end the run alone.
FIRST = ("test_lab", "test_release", "test_house", "test_mistakes_seen", "test_windows")
LONG = (Path(__file__).parent / "tests" / "long.txt").read_text("utf-8")  # then files that are named here

FEW_FILES = 8  # so many run sooner in one process: each worker imports everything again
NBVAL_OPTIONS = {  # the options of the plugin nbval, which pyproject.toml blocks because of its imports
    "nbval_cell_timeout": 120,  # seconds
    "nbval_current_env": True,
    "nbval_kernel_name": None,
    "nbval_kernel_startup_timeout": 60,  # seconds
    "nbval_lax": False,
    "nbval_sanitize_with": str(Path(__file__).parent / "tests" / "nbval.cfg"),
    "nbdime": False,
}

REAL = Path(os.environ.get("MOCAP_REAL_DATA", Path(__file__).parents[1] / "shared" / "data")).resolve()
THERE = all((REAL / folder).is_dir() for folder in ("cmu", "hw3"))
NEED_CLIPS = ("mocap.course.real_clips.collections",)  # examples of docstrings that ask for captured clips
MISSING = None if THERE else f"no real clips at {REAL}; name their folder in MOCAP_REAL_DATA"

os.environ["MOCAP_MINE"] = ""  # nobody has solved anything: no test reads a file beside the notebooks
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")  # workers and kernels share the cores: threads of each would wait
# For the kernels of the notebooks, which inherit it: the clips, or no download of them.
os.environ.update({"MOCAP_OFFLINE": "1"} if MISSING else {"MOCAP_DATA": str(REAL / "cmu")})


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Start one worker more than there are cores: while browsers and kernels let one wait, one computes.

    A few files run in this process, as do the results that are to be accepted.
    """
    if config.option.accept_results:
        return 0
    paths = [Path(config.invocation_params.dir, arg.partition("::")[0]) for arg in config.args]
    files = sum(sum(1 for _ in path.rglob("*.py")) if path.is_dir() else 1 for path in paths)
    files += sum(sum(1 for _ in path.rglob("*.ipynb")) for path in paths)
    return 0 if files <= FEW_FILES else 1 + (os.cpu_count() or 1)


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> IPyNbFile | None:
    """Collect the cells of a notebook by nbval."""
    if file_path.suffix != ".ipynb":
        return None
    from nbval.plugin import IPyNbFile

    vars(parent.config.option).update(NBVAL_OPTIONS)
    return IPyNbFile.from_parent(parent, path=file_path)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Iterator[None]:
    """Add cells to each notebook that nbval runs.

    The first one, and the last, drive its experiments. The two before the last compare the marked numbers in
    its text with their values: those of any text, and those that come from captured clips. Without the clips
    the latter are skipped, and no output that needs clips is compared.
    """
    report = yield
    if collector.path.suffix == ".ipynb" and report.passed:
        if MISSING:
            for item in report.result:
                if _needs_clips(item.cell):
                    item.options["check"] = False
        report.result.insert(0, _cell(collector, "experiments, before", -1, _watching(collector.nb)))
        last = len(report.result) - 1
        texts = [cell for cell in collector.nb.cells if cell.cell_type == "markdown"]
        everywhere = [cell.source for cell in texts if not _needs_clips(cell)]
        of_clips = [cell.source for cell in texts if _needs_clips(cell)]
        report.result.append(_cell(collector, "numbers in the text", last, _comparing(everywhere)))
        if of_clips:
            numbers = _cell(collector, "numbers from captured clips", last + 1, _comparing(of_clips))
            if MISSING:
                numbers.add_marker(pytest.mark.skip(reason=MISSING))
            report.result.append(numbers)
        report.result.append(_cell(collector, "experiments", last + 2, "driving.drive_all()"))
    return report


def _needs_clips(cell: NotebookNode) -> bool:
    return "real" in cell.metadata.get("tags", ())


def _watching(notebook: NotebookNode) -> str:
    """Return the code of a cell that keeps what the experiments of a notebook show."""
    tags = [(cell.source, tag) for cell in notebook.cells for tag in cell.metadata.get("tags", ())]
    names = {source: tag for source, tag in tags if tag.startswith("experiment:")}
    return (
        f"import sys\nsys.path.append({str(Path(__file__).parent)!r})\n"
        f"from tests.course import driving\ndriving.watch({names!r})"
    )


def _comparing(texts: list[str]) -> str:
    """Return the code of a cell that compares the marked numbers of some texts with their values."""
    return f"from mocap.course import marked_values\nmarked_values.compare({texts!r}, globals())"


def _cell(notebook: IPyNbFile, name: str, number: int, source: str) -> IPyNbCell:
    from nbformat.v4 import new_code_cell
    from nbval.plugin import IPyNbCell

    options = defaultdict(bool)  # whatever the cell prints is right
    cell = new_code_cell(source)
    return IPyNbCell.from_parent(notebook, name=name, cell_num=number, cell=cell, options=options)


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Return the folder of real clips."""
    if MISSING:
        pytest.skip(MISSING)
    return REAL


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the longest first, then notebooks, from the last, and the browser; skip one without its clips."""
    notebooks = [item for item in items if item.path.suffix == ".ipynb"]
    notebooks.sort(key=lambda item: item.path.name, reverse=True)  # keeps the order of a notebook's cells
    first = [item for name in FIRST for item in items if item.path.stem == name]
    browser = [item for item in items if item.path.parent.name == "browser"]
    long = [item for item in items if item.nodeid.partition("::")[0] in LONG]
    items[:] = dict.fromkeys([*first, *notebooks, *browser, *long, *items])
    for item in items:
        if MISSING and (item.path.name == "10-real-data.ipynb" or item.name in NEED_CLIPS):
            item.add_marker(pytest.mark.skip(reason=MISSING))
