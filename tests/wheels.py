"""The archives of a release, and an environment that has the package from its wheel alone."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HIDDEN = ("PYTHONPATH", "PYTEST_ADDOPTS")  # variables that would lead back to the checkout


def call(*command, folder, **environment):
    """Run a program that must succeed, and return what it prints."""
    kept = {name: value for name, value in os.environ.items() if name not in HIDDEN}
    done = subprocess.run(
        [*map(str, command)], cwd=folder, env=kept | environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def build(folder, *options):
    """Build the archives into a folder, or skip where the tools for that are missing."""
    for tool in ("build", "hatchling"):
        pytest.importorskip(tool, reason="pip install '.[ci]'")
    call(sys.executable, "-m", "build", "--no-isolation", *options, "--outdir", folder, ROOT, folder=folder)


def install(wheel, folder):
    """Install a wheel into a new environment, which finds the libraries of this one; return its folder."""
    environment = folder / "env"
    call(sys.executable, "-m", "venv", "--without-pip", environment, folder=folder)
    options = ("--quiet", "--no-deps", "--no-index")
    python = environment / "bin" / "python"
    call(sys.executable, "-m", "pip", "--python", python, "install", *options, wheel, folder=folder)
    (site,) = environment.glob("lib/*/site-packages")
    libraries = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    (site / "libraries.pth").write_text("\n".join(libraries))
    return environment
