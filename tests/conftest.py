"""What the tests share."""

import os
import shlex
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

collect_ignore = [
    "windows/sitecustomize.py",  # it changes the Python that imports it
    "course/marking/looking_for_answers.py",  # a hand-in, which runs while it is marked
]
SWEEP = bool(os.environ.get("MOCAP_SWEEP"))  # .ci/run tries more of everything

# Gates try the same examples on every machine and in every run. `--hypothesis-profile=random` tries others,
# and prints how to repeat what fails. `few` is for other versions of libraries: that a call has gone shows at
# once. A busy machine is no failure.
EXAMPLES = {"house": 50 if SWEEP else 20, "few": 5, "random": 50}
for profile, count in EXAMPLES.items():
    settings.register_profile(
        profile,
        max_examples=count,
        deadline=None,
        derandomize=profile != "random",
        print_blob=True,
        suppress_health_check=[HealthCheck.too_slow],
    )
settings.load_profile("house")

# What takes a second or more, by `pytest --durations=0`, and the longest notebooks: a sweep runs them.
LONG = frozenset(Path(__file__).with_name("long.txt").read_text("utf-8").splitlines())
ASKED_FOR = ("benchmark", "exhaustive", *(() if SWEEP else ("sweep", "tools")))
ACCEPTED = pytest.StashKey[dict]()  # changes of each case of test_same_results.py that are accepted


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--accept-results",
        action="store_true",
        help="store what the cases of tests/test_same_results.py give now, and print what has changed",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Run only the cases of stored results where these are to be accepted, in this process."""
    if not config.option.accept_results:
        return
    if getattr(config.option, "numprocesses", None) or hasattr(config, "workerinput"):
        raise pytest.UsageError("--accept-results writes files in one process: leave -n away, or give -n 0")
    config.stash[ACCEPTED] = {}
    if config.args_source is not pytest.Config.ArgsSource.ARGS:
        config.args = [str(Path(__file__).with_name("test_same_results.py"))]


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Print what has been accepted, the cases with changes in a table."""
    cases = config.stash.get(ACCEPTED, None)
    if cases is None:
        return
    from tests.frozen.store import FOLDER, show_table

    rows = [(case, change) for case, changes in cases.items() for change in changes]
    terminalreporter.section("accepted results")
    for line in show_table(rows) if rows else ():
        terminalreporter.line(line)
    changed = sum(map(bool, cases.values()))
    terminalreporter.line(f"{changed} of {len(cases)} cases have changed and are stored in {FOLDER}")


@pytest.fixture(scope="session")
def accepted_results(pytestconfig: pytest.Config) -> dict | None:
    """Return where the changes of accepted cases are collected; None where nothing is to be accepted."""
    return pytestconfig.stash.get(ACCEPTED, None)


class DrawWithoutDisplay:
    """Choose matplotlib's backend as soon as its pyplot is imported.

    A variable of the environment would reach the kernels of the notebooks too, whose figures would not show.
    """

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> None:
        if name == "matplotlib.pyplot":
            sys.modules["matplotlib"].use("agg")


sys.meta_path.insert(0, DrawWithoutDisplay)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what takes long, unless `-m` or a sweep asks for it."""
    for item in items:
        file, function, case = item.nodeid.partition("::")[0], item.nodeid.partition("[")[0], item.nodeid
        if LONG & {file, function, case}:
            item.add_marker(pytest.mark.sweep)
    names = [name for name in ASKED_FOR if name not in config.option.markexpr]
    out = [item for item in items if any(item.get_closest_marker(name) for name in names)]
    items[:] = [item for item in items if item not in out]
    config.hook.pytest_deselected(items=out)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Measure no coverage of what draws examples or takes long, nor of its fixtures.

    It would be half as slow again, and reaches few lines that quick tests do not; but in the course it does.
    """
    drawn = getattr(getattr(item, "obj", None), "is_hypothesis_test", "/test_fuzz" in item.nodeid)
    long = item.get_closest_marker("sweep") and ("/course/" not in item.nodeid or "/teaching/" in item.nodeid)
    coverage = sys.modules.get("coverage")  # which nothing imports if nothing is measured
    measured = coverage.Coverage.current() if coverage and (drawn or long) else None
    if measured:
        measured.stop()
    done = yield
    if measured:
        measured.start()
    return done


def pytest_collection_finish(session: pytest.Session) -> None:
    """Measure no coverage inside the notebooks' kernels: nbval waits in vain for those that it starts."""
    session.config.option.cov_source = None


@pytest.fixture(autouse=True, scope="session")
def nothing_waits_for_the_disk() -> Iterator[None]:
    """Let no file be synced: thousands are written, and none has to outlast a power cut."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda number: None)
        yield


@pytest.fixture(autouse=True)
def no_figure_stays_open() -> Iterator[None]:
    """Close what a test drew: matplotlib warns of more than twenty figures, in whichever test comes next."""
    yield
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")


@pytest.fixture
def run(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path_factory: pytest.TempPathFactory,
) -> Callable:
    """Type a line after `mocap`, which gives a status; return what it says."""
    # A page that a command opens stays for its reader, but not that of a test.
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path_factory.mktemp("opened")))
    from mocap.cli.main import main  # not before coverage is measured

    def typed(line: str, status: int = 0) -> object:
        assert main(shlex.split(line)) == status, capsys.readouterr()
        return capsys.readouterr()

    return typed
