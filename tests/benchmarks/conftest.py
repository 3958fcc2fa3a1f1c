"""The table of all ratios at the end of a run, and the option that appends them to a history."""

from pathlib import Path

import pytest

from tests.benchmarks import history, timing


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that records a run."""
    parser.addoption(
        "--record-benchmarks",
        metavar="FILE",
        type=Path,
        help="append the ratios of this run to a history, as tests/benchmarks/history.tsv; with -n 0",
    )


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Print all ratios beside their bounds and the last recorded ones, then record them if asked to."""
    if not timing.HELD:
        return
    file = config.getoption("record_benchmarks", default=None)
    terminalreporter.section("benchmarks")
    terminalreporter.write_line(history.compare(timing.HELD, history.read_history(file or history.HISTORY)))
    if file:
        history.record(timing.HELD, file, history.load_note())
