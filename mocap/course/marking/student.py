"""The student's side: it runs the cells of a notebook, and calls functions with arguments from the marker.

Whatever the notebook changes in this process stays in it: the marker reads answers, never verdicts.
"""

from __future__ import annotations

import copy
import json
import pickle
import sys
from typing import Any, BinaryIO

from IPython.core.interactiveshell import InteractiveShell
from traitlets.config import Config

from mocap.course.check import place_of, written
from mocap.course.checks import withhold
from mocap.course.checks.inputs import noted_requests
from mocap.course.comparisons import altered
from mocap.course.marking.cells import Cell, needed
from mocap.course.marking.plain_data import pack


class Student:
    """A notebook that runs: each request of the marker is the name of a method here, and its arguments.

    Examples
    --------
    >>> Student.__doc__.startswith("A notebook")
    True
    """

    def __init__(self) -> None:
        config = Config()
        config.HistoryManager.enabled = False
        self.shell = InteractiveShell.instance(config=config)
        self.shell.enable_gui = lambda gui=None: None  # type: ignore[method-assign]  # it opens no windows
        self.shell.system = self.shell.system_raw  # type: ignore[method-assign]  # `!ls` gets no terminal
        self.cells: list[Cell] = []
        self.failed: dict[int, str] = {}
        self.ran: set[int] = set()

    def begin(self, cells: list[tuple[tuple[str, ...], str]]) -> tuple[()]:
        """Take the cells, and run the first."""
        self.cells = [Cell(*cell) for cell in cells]
        if cells:
            self._run(0)
        return ()

    def prepare(self, exercise: str) -> tuple[bool, str]:
        """Run the cells of an exercise; return whether there are any, and the first error."""
        numbers = needed(self.cells, exercise, self.shell.transform_cell)
        for number in numbers:
            if number not in self.ran:
                self._run(number)
        if 0 in self.failed:  # without its imports, what follows fails too
            return bool(numbers), f"the first cell raises {self.failed[0]}"
        errors = [f"its cells raise {self.failed[number]}" for number in numbers if number in self.failed]
        return bool(numbers), errors[0] if errors else ""

    def _run(self, number: int) -> None:
        self.ran.add(number)
        result = self.shell.run_cell(self.cells[number].source)  # type: ignore[no-untyped-call,unused-ignore]
        if error := result.error_before_exec or result.error_in_exec:
            self.failed[number] = f"{type(error).__name__}: {error}".removesuffix(": ")

    def call(self, name: str, arguments: tuple[Any, ...]) -> tuple[Any, list[Any], str, str]:
        """Call a function; return its answer and what it changed, or what it raised and said.

        A change is the number of an argument with the new array, or with the requests that it has noted.
        """
        if name not in self.shell.user_ns:
            return None, [], "NameError", f"no cell defines `{name}`; write `def {name}`"
        function = written(self.shell.user_ns[name])
        copies = copy.deepcopy(arguments)
        try:
            answer = pack(function(*arguments))
        except BaseException as error:  # a student's function may raise anything
            line = place_of(error, function)
            return None, [], type(error).__name__, f"{error} ({line})" if line else f"{error}"
        pairs = enumerate(zip(copies, arguments, strict=True))
        changes = [[number, pack(new)] for number, (old, new) in pairs if altered(old, new)]
        requests = enumerate(map(noted_requests, arguments))
        changes += [[number, pack(noted)] for number, noted in requests if noted]
        return answer, changes, "", ""


def serve(requests: BinaryIO, replies: BinaryIO) -> None:
    """Answer the marker until it closes its end."""
    withhold()
    student = Student()
    while True:
        try:
            method, *arguments = pickle.load(requests)
        except EOFError:
            return
        reply = getattr(student, method)(*arguments)
        replies.write(json.dumps(reply).encode() + b"\n")
        replies.flush()
        sys.stdout.flush()
