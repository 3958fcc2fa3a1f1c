"""Do the numeric tests pass with the arithmetic of other processors?

    python tests/arithmetic.py
    python tests/arithmetic.py --quick
    python tests/arithmetic.py --legs "two threads" lowest -- tests/feet

A leg is one run of the tests, in two processes of one thread each: as this machine computes, with other last
bits (tests/rounding.py), without the vector instructions that NumPy chooses, with each kernel of OpenBLAS,
with two threads, beside four busy processes, with the lowest and the newest NumPy and SciPy that
pyproject.toml allows (in a temporary folder). A leg that this machine cannot run is skipped, with the reason.
The exit code is 1 if a test fails.
"""

import argparse
import multiprocessing
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
ROOMS = [
    "body",
    "matching",
    "feet",
    "blending",
    "quality",
    "editing",
    "graphs",
    "synthesis",
    "steering",
    "methods",
]
TESTS = [f"{folder}/{room}" for room in ROOMS for folder in ("mocap", "tests")] + [
    "tests/test_same_results.py"
]
# No plots, notebooks or coverage; the same few examples of each property in all legs.
OPTIONS = [
    "-oaddopts=",
    "--numprocesses=2",
    "--dist=loadfile",
    "--doctest-modules",
    "--tb=line",
    "--quiet",
    "-rfE",
    "-pno:cacheprovider",
]
OPTIONS += ["--hypothesis-profile=few", "--hypothesis-seed=1"]

# Kernels of OpenBLAS, from old to new, by what `platform.machine` returns.
X86_64 = ["Prescott", "Nehalem", "Sandybridge", "Haswell", "Zen", "SkylakeX", "Cooperlake", "Sapphirerapids"]
ARM = ["ARMV8", "NEOVERSEN1", "NEOVERSEV1", "VORTEX"]
KERNELS = {"x86_64": X86_64, "AMD64": X86_64, "aarch64": ARM, "arm64": ARM}
BUSY = 4  # processes beside the tests
PROBE = """
import numpy as np
from scipy import linalg

matrix = np.random.default_rng(0).random((200, 200))
symmetric = matrix @ matrix.T
for library in (np.linalg, linalg):
    library.eigh(symmetric)
    library.svd(matrix)
"""
FEATURES = """
from numpy._core import _multiarray_umath as numpy_c

print(*(name for name in numpy_c.__cpu_dispatch__ if numpy_c.__cpu_features__[name]))
"""


class Leg(NamedTuple):
    """One run of the tests."""

    name: str
    environment: Mapping[str, str] = MappingProxyType({})
    libraries: tuple[str, ...] = ()  # requirements, installed for this leg
    busy: int = 0  # processes beside the tests
    skipped: str = ""  # the reason


def python(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run code in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def find_kernel(name: str = "") -> tuple[str, str]:
    """Ask OpenBLAS for a kernel; return the one that it takes, and the reason if that does not work."""
    wanted = {"OPENBLAS_CORETYPE": name} if name else {}
    probe = python(PROBE, OPENBLAS_VERBOSE="2", **wanted)
    taken = re.findall(r"^Core: (\w+)", probe.stdout + probe.stderr, re.MULTILINE)
    if probe.returncode < 0:
        return name, f"this processor ends it by {signal.Signals(-probe.returncode).name}"
    if probe.returncode > 0:
        return name, f"linear algebra fails: {probe.stderr.strip().splitlines()[-1]}"
    return (taken[0], "") if taken else (name, "NumPy does not use OpenBLAS here")


def kernel_legs() -> Iterator[Leg]:
    """Yield a leg for each kernel of OpenBLAS; skip those that do not work here or repeat an earlier one."""
    default, _ = find_kernel()
    tried = {default: "the leg as it is"}
    for name in KERNELS.get(platform.machine(), []):
        taken, reason = find_kernel(name)
        if not reason and taken in tried:
            reason = f"OpenBLAS takes {taken}, as in {tried[taken]}"
        tried.setdefault(taken, f"kernel {name}")
        yield Leg(f"kernel {name}", {"OPENBLAS_CORETYPE": name}, skipped=reason)


def feature_leg() -> Leg:
    """Return the leg without the vector instructions that NumPy chooses when it is imported."""
    features = python(FEATURES).stdout.strip()
    reason = "" if features else "NumPy has no instructions to choose from here"
    return Leg(f"without {features or 'vectors'}", {"NPY_DISABLE_CPU_FEATURES": features}, skipped=reason)


def version_legs() -> Iterator[Leg]:
    """Yield the legs with the lowest and the newest NumPy and SciPy."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    needs = [need for need in map(Requirement, project["dependencies"]) if need.name in ("numpy", "scipy")]
    floors = [next(s.version for s in need.specifier if s.operator == ">=") for need in needs]
    lowest = [f"{need.name}=={floor}.*" for need, floor in zip(needs, floors, strict=True)]
    yield Leg("lowest " + " ".join(lowest), libraries=tuple(lowest))
    yield Leg("newest numpy scipy", libraries=tuple(str(need) for need in needs))


def all_legs() -> Iterator[Leg]:
    """Yield the legs; the first is the arithmetic that users of this machine have."""
    yield Leg("as it is")
    yield Leg("other last bits", {"MOCAP_ROUNDING": "1"})
    yield feature_leg()
    yield from kernel_legs()
    yield Leg("two threads", dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "2"))
    yield Leg(f"beside {BUSY} busy processes", busy=BUSY)
    yield from version_legs()


@contextmanager
def busy_processes(count: int) -> Iterator[None]:
    """Keep the cores busy in the meantime."""
    processes = [multiprocessing.Process(target=loop_for_ever, daemon=True) for _ in range(count)]
    for process in processes:
        process.start()
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


def loop_for_ever() -> None:
    while True:
        pass


def install(libraries: tuple[str, ...], folder: str) -> str:
    """Install libraries into a folder; return why that fails, if it does."""
    pip = ["uv", "pip", "install", "--python", sys.executable] if shutil.which("uv") else []
    pip = pip or [sys.executable, "-m", "pip", "install"]
    command = [*pip, "--quiet", "--upgrade", "--target", folder, *libraries]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stderr.strip()[-200:] if done.returncode else ""


def run_leg(leg: Leg, tests: list[str]) -> tuple[str, bool]:
    """Run the tests in a leg; return the line to print, and whether they pass."""
    if leg.skipped:
        return f"skipped: {leg.skipped}", True
    with tempfile.TemporaryDirectory() as folder, busy_processes(leg.busy):
        environment = {"OPENBLAS_NUM_THREADS": "1"} | os.environ | leg.environment
        if leg.libraries:
            if reason := install(leg.libraries, folder):
                return f"not installed: {reason}", False
            environment |= {"PYTHONPATH": folder}
        command = [sys.executable, "-m", "pytest", "-ptests.rounding", *OPTIONS, *tests]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    failed = re.findall(r"^(?:FAILED|ERROR) .*", done.stdout, re.MULTILINE)
    summary = (done.stdout.strip() or done.stderr.strip()).splitlines()[-1]
    return "\n    ".join([summary, *failed]), done.returncode == 0


def main() -> None:
    """Run the legs, print a line for each, and exit with 1 if a test fails."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="only the first leg: the arithmetic of this machine"
    )
    parser.add_argument("--legs", nargs="+", metavar="NAME", help="only legs whose name holds one of these")
    parser.add_argument("tests", nargs="*", default=TESTS, help="which tests (those of the numeric rooms)")
    wanted = parser.parse_args()
    legs = (leg for leg in all_legs() if any(name in leg.name for name in wanted.legs or [""]))
    all_pass = True
    for leg in islice(legs, 1 if wanted.quick else None):
        line, passes = run_leg(leg, wanted.tests)
        all_pass &= passes
        print(f"{leg.name:32} {line}", flush=True)
    sys.exit(0 if all_pass else 1)


if __name__ == "__main__":
    main()
