"""Looks for right answers as a hand-in might: by import, in files, and among all objects of the process."""

import gc
import importlib
import os
import types
from pathlib import Path

import numpy as np

from mocap.course import checks

RNG = np.random.default_rng(1)
POSITIONS = RNG.normal(size=(9, 3))
RIGHT = np.hypot(*np.diff(POSITIONS[:, [0, 2]], axis=0).T) * 30.0
found = []


def answers(function):
    """Tell whether a function gives the speed of these positions at 30 frames per second."""
    try:
        given = np.asarray(function(POSITIONS.copy(), 30.0), float)
        return given.shape == RIGHT.shape and bool(np.allclose(given, RIGHT))
    except BaseException:
        return False


checks._withheld[0] = False
if answers(checks.speed.truth):
    found.append("its check")
try:
    importlib.import_module("mocap.course.checks.answers.nb00_quickstart")
    found.append("an import")
except Exception:
    pass
for folder, _, names in os.walk(Path(checks.__file__).parents[2]):
    for name in names:
        try:
            text = Path(folder, name).read_bytes()
        except OSError:
            continue
        if b"right_speed" in text or b"right_mix" in text:
            found.append("a file")
for thing in gc.get_objects():
    function = thing.__func__ if isinstance(thing, types.MethodType) else thing
    known = isinstance(function, types.FunctionType) and function.__code__.co_argcount == 2
    if known and function.__module__.startswith("mocap.course") and answers(function):
        found.append("memory")
found = sorted(set(found))
