"""Names of earlier versions say their new names, each of which exists."""

import importlib
import subprocess
import sys

import pytest

import mocap
from mocap import body, plain
from mocap._shared import renamed
from mocap.course import checks


def exists(name):
    try:
        importlib.import_module(name)
    except ImportError:
        room, _, function = name.rpartition(".")
        return hasattr(importlib.import_module(room), function)
    return True


@pytest.mark.parametrize(("old", "new"), [*renamed.NAMES.items(), *renamed.MODULES.items()])
def test_the_new_name_exists_and_the_old_one_says_it_in_one_sentence(old, new):
    assert exists(new)
    room, _, name = old.rpartition(".")
    message = f"{room} has no '{name}': it is {new} now."
    assert len(message) <= 200
    with pytest.raises((AttributeError, ModuleNotFoundError)) as caught:
        getattr(importlib.import_module(room), name)
    assert str(caught.value) in (message, renamed.sentence(*room.rpartition(".")[::2]))


def test_each_way_to_import_an_old_module_says_the_new_one():
    sentence = "mocap has no 'lab': it is mocap.course.lab now."
    for line in ("import mocap.lab", "from mocap import lab", "from mocap.lab import mine", "mocap.lab"):
        code = f"import mocap\ntry:\n    {line}\nexcept Exception as error:\n    print(error)"
        said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert said.stdout.strip() == sentence, line


def test_other_names_get_the_sentences_that_they_had():
    with pytest.raises(AttributeError, match="has no attribute 'lays'"):
        plain.lays  # noqa: B018
    with pytest.raises(AttributeError, match="do you mean"):
        body.concatenat  # noqa: B018
    with pytest.raises(ModuleNotFoundError, match=r"No module named 'mocap\.labb'"):
        importlib.import_module("mocap.labb")
    with pytest.raises(AttributeError, match=r"it is mocap\.course\.checks\.cheapest_walk now"):
        checks.cheapest_way  # noqa: B018
    assert mocap.plain is plain
