"""The scripts of pages and widgets: style, lint and types, by the tools of `tests/javascript`."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from mocap.course.lab.blind_tests import BlindTest
from mocap.course.lab.showing import Inspector
from mocap.widgets.embedding import joined
from mocap.widgets.player import Player
from mocap.widgets.steering_server import SCRIPTS
from mocap.widgets.walking_page import HERE, PARTS

ROOT = Path(__file__).parents[1]
TOOLS = ROOT / "tests" / "javascript"
PROGRAMS = TOOLS / "node_modules" / ".bin"
MODULES = ("player", "inspector", "blind test", "walking page", "steering", "dragging", "naming", "served")
# Their pictures have no light, so that they shade no body, and leave out the scripts that do.
UNSHADED = {"inspector": {"Shading", "rgb"}, "blind test": {"Shading", "rgb"}}


def run(program, *arguments, text=None, cwd=ROOT):
    """Run a tool, or skip where it is not installed; return its code and what it prints."""
    if not shutil.which("node") or not (PROGRAMS / program).exists():
        pytest.skip("no tools for JavaScript here: npm install --prefix tests/javascript")
    done = subprocess.run(
        [PROGRAMS / program, *arguments], cwd=cwd, input=text, capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout + done.stderr


@pytest.mark.tools
def test_style():
    code, text = run(
        "prettier", "--config", TOOLS / ".prettierrc", "--check", "mocap/**/*.js", "tests/**/*.js"
    )
    assert code == 0, text


@pytest.mark.tools
def test_lint():
    code, text = run(
        "eslint", "--config", TOOLS / "eslint.config.js", "--max-warnings", "0", "mocap", "tests"
    )
    assert code == 0, text


@pytest.mark.tools
def test_types():
    code, text = run("tsc", "--project", TOOLS)
    assert code == 0, text


def module(name):
    """Join the module of a page or a widget."""
    if name in ("steering", "dragging", "naming"):
        pytest.importorskip("anywidget")
        from mocap.widgets.pointing import Handles
        from mocap.widgets.shared_traits import Naming
        from mocap.widgets.steered_widget import Steered

        return {"steering": Steered, "dragging": Handles, "naming": Naming}[name]._esm
    pages = {"player": Player.scripts, "inspector": Inspector.scripts, "blind test": BlindTest.scripts}
    pages["served"] = SCRIPTS
    return joined(*pages.get(name, (HERE / f"{part}.js" for part in PARTS)))


@pytest.mark.tools
@pytest.mark.parametrize("name", MODULES)
def test_a_joined_module_declares_each_name_once_and_lacks_none(name):
    config = ("--config", TOOLS / "joined.config.js", "--stdin", "--stdin-filename", "joined.js")
    _, text = run("eslint", *config, text=module(name))
    assert "Parsing error" not in text, text
    assert set(re.findall(r"'(\w+)' is not defined", text)) == UNSHADED.get(name, set()), text


def test_a_joined_module_has_no_comments_imports_or_exports(tmp_path):
    file = tmp_path / "part.js"
    imports = 'import { a } from "./a.js";\nimport {\n  b,\n  c,\n} from "./b.js";\n\n'
    comments = "// A comment.\n/**\n * A ** type.\n */\n"
    code = "export const d = a; // which stays\n  /** @type {number} */ (b).e();\nexport default {};\n"
    file.write_text(imports + comments + code)
    stays = "\nconst d = a; // which stays\n  /** @type {number} */ (b).e();\nexport default {};\n"
    assert joined(file) == stays
