"""The notebooks: what each has, that its code is the package's, and that its exercises work."""

import ast
import html
import json
import re
from functools import cache
from operator import attrgetter

import nbformat
import pytest
import requests
from IPython.core.interactiveshell import InteractiveShell

import mocap
from mocap.cli.main import main
from mocap.course import checks, notebooks
from mocap.course.lab.adopting import slots
from tests.course.stored_notebooks import FOLDER, NAMES, PAGES, ROOT, every_notebook, markdown, read
from tests.loops import for_each
from tests.refusals import refused_texts


def code(name):
    return [cell.source for cell in read(name).cells if cell.cell_type == "code"]


def prose(text):
    return re.sub(r"```.*?```|<!--.*?-->", "", text, flags=re.DOTALL)


# What every notebook has, in its order


def test_the_course_is_whole():
    numbers = sorted({name[:2] for name in NAMES})
    assert numbers == [f"{n:02}" for n in range(20)]
    for name in NAMES:  # the second part of a notebook follows the first
        assert re.fullmatch(r"\d\d[bc]?-[a-z-]+", name)
        assert name[2] == "-" or any(re.match(rf"{name[:2]}-", other) for other in NAMES)


@every_notebook
def test_a_notebook_opens_with_a_picture_objectives_and_the_time(name):
    text = markdown(name)
    first = read(name).cells[0]
    assert re.match(r"# \S.*\n\n!\[[^\]]{20,}\]\(attachment:(\S+)\)\n\n\S", first.source)
    for picture, data in first.attachments.items():
        stored = notebooks.base64.b64decode(data["image/png"])
        stale = stored != (ROOT / "figures" / picture).read_bytes()  # no difference of megabytes
        assert not stale, f"{picture} is stale"
    aims = re.search(r"\*\*You will be able to\*\*\n\n((?:- .*\n?)+)", text)
    assert 3 <= aims.group(1).count("- ") <= 5
    for wanted in aims.group(1).splitlines():
        assert re.search(r"\*\w+\*", wanted), f"no verb in {wanted}"
    marks = ["You will be able to**", "**Before you start**", "**About ", "\n## "]
    marks += ["## What you learnt", "## Read on"]
    assert sorted(map(text.index, marks)) == [text.index(mark) for mark in marks]
    assert re.search(r"\*\*About \d+ minutes", text)


@every_notebook
def test_a_notebook_ends_with_links_along_its_sequence(name):
    """The main sequence leads along itself, and from each number to its further parts."""
    is_main = name[2] == "-"
    sequence = [other for other in NAMES if other[2] == "-"] if is_main else NAMES
    at = sequence.index(name)
    expected = [*sequence[max(at - 1, 0) : at], *sequence[at + 1 : at + 2]]
    if is_main:
        expected += [other for other in NAMES if other[:2] == name[:2] and other != name]
    last_line = read(name).cells[-1].source.splitlines()[-1]
    assert re.findall(r"\]\(([\w-]+)\.ipynb\)", last_line) == expected
    assert last_line.count("→") == (at + 1 < len(sequence)) and last_line.count("←") == (at > 0)


@every_notebook
def test_cells_are_short_and_told_in_words(name):
    cells = code(name)
    assert max(len(cell.splitlines()) for cell in cells) <= 26
    lines = sum(bool(line.strip()) for cell in cells for line in cell.splitlines())
    assert 7.5 <= len(prose(markdown(name)).split()) / lines <= 30


@every_notebook
def test_every_picture_is_told_in_words(name):
    for cell in read(name).cells:
        for alt in re.findall(r"!\[(.*?)\]\(", cell.source) if cell.cell_type == "markdown" else ():
            assert len(alt) >= 20, f"{cell.id}: '{alt}'"
        for output in cell.get("outputs", ()):
            for kind in output.get("data", {}):
                if kind.startswith("image/"):
                    alt = output.metadata.get(kind, {}).get("alt", "")
                    assert len(alt) >= 20, cell.id
                    assert alt in html.unescape(output.data["text/html"])  # where JupyterLab looks for it


@every_notebook
def test_a_notebook_is_stored_with_its_outputs_and_without_what_varies(name):
    notebook = read(name)
    assert "widgets" not in notebook.metadata
    for cell in notebook.cells:
        if cell.cell_type != "code":
            continue
        assert cell.execution_count, f"{cell.id} was not run"
        for output in cell.outputs:
            assert output.output_type != "error", cell.id
            assert output.get("name") != "stderr", cell.id
            assert notebooks.WIDGET not in output.get("data", {}), cell.id
    assert any("image/png" in o.get("data", {}) for c in notebook.cells for o in c.get("outputs", ()))
    text = "\n".join(code(name))
    for unwanted in ("sys.path", "default_rng()", "np.random.seed", "%", "!pip"):
        assert not re.search(rf"^{re.escape(unwanted)}|{re.escape(unwanted)}$", text, re.MULTILINE)


def slug(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


@for_each([*NAMES, *PAGES])
def test_links_within_the_course_resolve(page):
    text = markdown(page) if page in NAMES else (FOLDER / page).read_text("utf-8")
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"https?:|attachment:", link):
            continue
        file, _, anchor = link.partition("#")
        target = (FOLDER / page).parent / file if file else FOLDER / page
        assert target.exists(), link
        if anchor and target.suffix == ".md":
            assert anchor in map(slug, re.findall(r"^#+ (.*)", target.read_text("utf-8"), re.MULTILINE)), link


def test_the_instructors_table_tells_the_notebooks_minutes():
    table = (FOLDER / "README.md").read_text("utf-8")
    for name in NAMES:
        minutes = re.search(r"\*\*About (\d+) minutes", markdown(name))[1]
        assert f"]({name}.ipynb) | {minutes} |" in table


# The code that is seen is the code that runs


@every_notebook
def test_code_shown_is_the_packages_own(name):
    shown = list(notebooks.tagged(read(name), "source"))
    halves = [half for half in NAMES if half[:2] == name[:2]]
    assert name[:2] in ("00", "09", "10") or any(list(notebooks.tagged(read(h), "source")) for h in halves)
    for function, cell in shown:
        assert ast.dump(ast.parse(cell.source)) == ast.dump(ast.parse(notebooks.shown_source(function))), (
            function
        )


# Exercises


EXERCISES = [
    pytest.param(name, check, cell, id=f"{name}-{check}")
    for name in NAMES
    for check, cell in notebooks.tagged(read(name), "exercise")
]


@every_notebook
def test_each_exercise_has_its_parts_in_order(name):
    tags = [tag for cell in read(name).cells for tag in cell.metadata.get("tags", ())]
    found = [check for check, _ in notebooks.tagged(read(name), "exercise")]
    assert len(found) >= 2
    for check in found:
        at = tags.index(f"exercise:{check}")
        assert tags[at - 1 : at + 3] == [f"{p}:{check}" for p in ("ask", "exercise", "check", "solution")]
        assert check in checks.all_checks()


@cache
def opened(name):
    """Run the imports of a notebook's first code cell."""
    whole = ast.parse(code(name)[0])
    whole.body = [node for node in whole.body if isinstance(node, ast.Import | ast.ImportFrom)]
    space = {"__name__": "__main__"}
    exec(compile(whole, name, "exec"), space)
    return space


def namespace(name, check):
    """Give what an exercise may use: what the first code cell imports, and the exercises before it."""
    asked = [other for other, _ in notebooks.tagged(read(name), "exercise")]
    return {slot.name: slot for slot in slots(*asked[: asked.index(check)])} | opened(name)


@pytest.mark.parametrize(("name", "check", "cell"), EXERCISES)
def test_the_stub_fails_with_a_hint_and_the_solution_passes(name, check, cell, monkeypatch):
    monkeypatch.chdir(FOLDER)
    space = namespace(name, check)
    exec(cell.source, space)
    verdict = checks.all_checks()[check].verdict(space[check])
    assert not verdict.right
    assert "not there yet" in verdict.message
    ((_, folded),) = [(n, c) for n, c in notebooks.tagged(read(name), "solution") if n == check]
    exec(notebooks.solution(folded), space)
    verdict = checks.all_checks()[check].verdict(space[check])
    assert verdict.right, verdict.message


# Experiments


@every_notebook
def test_each_experiment_is_opened_by_a_prediction(name):
    cells = read(name).cells
    found = list(notebooks.tagged(read(name), "experiment"))
    assert found
    for experiment, cell in found:
        before = cells[cells.index(cell) - 1]
        if "answer" in before.metadata.get("tags", ()):  # a bet stands between the question and its answer
            prediction, bet = cells[cells.index(cell) - 3 : cells.index(cell) - 1]
            assert bet.source.startswith("lab.bet("), experiment
            assert before.source.startswith("<details>")
        else:
            prediction = before
        assert "prediction" in prediction.metadata.get("tags", ()), experiment
        assert "<details><summary>Answer</summary>\n\n" in before.source
        data = [output.data for output in cell.outputs if "data" in output]
        assert any("image/png" in d for d in data), (
            f"{experiment} has no picture to show where no kernel runs"
        )


def used(name, functions):
    """List the names that a function, and the functions that it calls, use from other cells."""
    found, todo = set(), [name]
    while todo:
        if source := functions.pop(todo.pop(), ""):
            new = notebooks.names_of(source)[1]
            todo += new
            found |= new
    return found


@every_notebook
def test_no_later_cell_binds_a_name_that_an_experiment_draws_with(name):
    cells = [cell for cell in read(name).cells if cell.cell_type == "code"]
    trees = [ast.parse(cell.source) for cell in cells]
    every = {n.name: ast.unparse(n) for t in trees for n in t.body if isinstance(n, ast.FunctionDef)}
    for at, tree in enumerate(trees):
        for call in (n for n in ast.walk(tree) if isinstance(n, ast.Call)):
            if getattr(call.func, "id", "") in ("explore", "draw_path"):
                mine = used(ast.unparse(call.args[0]), dict(every))
                for other in cells[at + 1 :]:
                    assert not mine & notebooks.names_of(other.source)[0], f"{cells[at].id}, {other.id}"


def test_without_clips_and_network_real_data_steps_aside_in_one_sentence(monkeypatch, tmp_path, capsys):
    def unplugged(*_):
        raise requests.ConnectionError

    monkeypatch.setattr("pooch.HTTPDownloader.__call__", unplugged)
    monkeypatch.setattr("pooch.core.time.sleep", lambda seconds: None)
    monkeypatch.setenv("MOCAP_DATA", str(tmp_path))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    shell = InteractiveShell.instance()
    try:
        assert all(shell.run_cell(cell).success for cell in code("10-real-data"))
    finally:
        InteractiveShell.clear_instance()
    said = capsys.readouterr()
    assert re.fullmatch(r"The cells below do nothing until .*: .* MOCAP_DATA names\.\n", said.out)
    assert said.err == ""


# Reading and running


def test_running_a_notebook_refreshes_its_code_and_settles_its_outputs(tmp_path, capfd):
    new = nbformat.v4
    cells = [
        new.new_code_cell("old", metadata={"tags": ["source:body.rotations.about_y"], "scrolled": True}),
        new.new_code_cell("for i in range(3):\n    print(i, flush=True)"),
        new.new_code_cell(
            "import ipywidgets\nfrom mocap.widgets import explore\nimport matplotlib.pyplot as plt\n"
            "explore(lambda x=1: plt.figure(), alt='Nothing.', x=(0, 2))"
        ),
        new.new_code_cell(
            "from mocap import datasets, widgets\nwidgets.play(datasets.sample('walk_straight')[:9])",
            metadata={"tags": ["real"]},
        ),
        new.new_code_cell(
            "import warnings\n\ndef seven():\n    warnings.warn('beside the number')\n    return 7"
        ),
        new.new_markdown_cell("It is 1<!--= seven() -->."),
    ]
    path = tmp_path / "n.ipynb"
    nbformat.write(new.new_notebook(cells=cells, metadata={"widgets": {"big": 1}}), path)
    assert main(["course", "run", str(path)]) == 0
    assert "IPKernelApp" not in capfd.readouterr().err
    notebook = notebooks.read(path)
    assert notebook.metadata == {"kernelspec": notebooks.KERNEL, "language_info": {"name": "python"}}
    assert notebook.cells[0].source == notebooks.shown_source("body.rotations.about_y")
    assert notebook.cells[0].metadata == {"tags": ["source:body.rotations.about_y"]}
    (stream,) = notebook.cells[1].outputs
    assert stream.text == "0\n1\n2\n"
    (shown,) = notebook.cells[2].outputs
    assert set(shown.data) == {"image/png", "text/html", "text/plain"}
    (still,) = notebook.cells[3].outputs
    assert re.fullmatch("<img [^>]*>", still.data["text/html"])
    assert notebook.cells[-1].source == "It is 7<!--= seven() -->."


@every_notebook
def test_no_captured_motion_is_stored(name):
    for cell in read(name).cells:
        if "real" in cell.metadata.get("tags", ()):
            assert not any("application/json" in str(output) for output in cell.get("outputs", ())), cell.id


test_what_is_no_notebook_is_told = refused_texts(
    notebooks.read, "n.ipynb", *((text, "is not a notebook") for text in ("{", '{"cells": 1}', "[]", ""))
)


def test_a_notebook_whose_cells_have_no_ids_is_read_in_silence(tmp_path, recwarn):
    cell = {"cell_type": "code", "source": "1", "metadata": {}, "outputs": [], "execution_count": None}
    notebook = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    (tmp_path / "n.ipynb").write_text(json.dumps(notebook))
    assert notebooks.read(tmp_path / "n.ipynb").cells[0].source == "1"
    assert not recwarn.list


# Glossary and formulas


def test_the_glossary_is_in_order_and_every_word_is_linked_from_a_notebook():
    words = re.findall(r"^## (.*)", (FOLDER / "GLOSSARY.md").read_text("utf-8"), re.MULTILINE)
    assert words == sorted(words, key=str.lower)
    linked = set(re.findall(r"\(GLOSSARY\.md#([\w-]+)\)", "".join(map(markdown, NAMES))))
    assert {slug(word) for word in words} - linked == set()


def test_the_formula_sheet_names_code_that_exists():
    named = re.findall(r"`(\w+\.[\w.]+)` \|$", (FOLDER / "FORMULAS.md").read_text("utf-8"), re.MULTILINE)
    assert len(named) > 20
    for name in named:
        assert callable(attrgetter(name)(mocap)), name
