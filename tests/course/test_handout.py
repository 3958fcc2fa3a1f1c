"""The course handed out, to students and to nbgrader, copied to work in, and in JupyterLite."""

import json
import os
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

import mocap
from mocap.cli.main import main
from mocap.course import opening
from mocap.course.copies import progress
from mocap.course.handout import PAGES, TELLING, WHEEL, _merged, hand_out
from mocap.course.notebooks import notebooks_in, read, solution, tagged
from mocap.course.opening import stored
from mocap.course.written import questions_of
from tests.refusals import refused

COURSE = {file.stem: read(file) for file in notebooks_in(stored())}
NAME = f"motion_graphs-{mocap.__version__}-py3-none-any.whl"
INSTALLS = f'"./{NAME}[notebooks]"'


@pytest.fixture(scope="module")
def copies(tmp_path_factory):
    return hand_out((), tmp_path_factory.mktemp("handout") / "course", WHEEL)


def test_a_handout_has_everything_but_solutions_hints_and_outcomes(copies):
    for copy, whole in zip(copies, COURSE.values(), strict=True):
        notebook = read(copy)
        nbformat.validate(notebook)
        assert list(tagged(notebook, "solution")) == []
        solutions = len(list(tagged(whole, "solution")))
        words = len(list(questions_of(whole)))
        assert len(notebook.cells) == 1 + len(whole.cells) - solutions + words
        assert "<summary>Solution" not in copy.read_text("utf-8")
        assert f"%pip install -q {INSTALLS}" in notebook.cells[0].source
        outputs = json.dumps([cell.get("outputs") for cell in notebook.cells])
        assert "Hint:" not in outputs and "mocap-question" not in outputs  # where bets and answers are
        shown = [c.outputs for c in whole.cells if c.cell_type == "code" and not TELLING.match(c.source)]
        assert [c.outputs for c in notebook.cells if c.get("outputs")] == [out for out in shown if out]
    beside = {path.name: path for path in copies[0].parent.iterdir()}
    assert {*beside} == {*PAGES, "requirements.txt", "runtime.txt", NAME, *(copy.name for copy in copies)}
    assert beside["requirements.txt"].read_text() == f"./{NAME}[notebooks]\n"
    assert beside["runtime.txt"].read_text() == (stored().parent / ".binder" / "runtime.txt").read_text()


def test_a_handout_replaces_nothing(copies):
    before = copies[0].read_text("utf-8")
    said = r"00-quickstart.ipynb exists already; choose another folder"
    refused(said, hand_out, (), copies[0].parent, WHEEL)
    assert copies[0].read_text("utf-8") == before


def test_the_first_cell_installs_only_where_the_package_is_missing(copies, monkeypatch):
    from IPython.core.interactiveshell import InteractiveShell

    shell, installed = InteractiveShell(), []
    monkeypatch.setattr(shell, "run_line_magic", lambda name, line, **_: installed.append(f"{name} {line}"))
    for there in (sys.modules["mocap"], None):
        monkeypatch.setitem(sys.modules, "mocap", there)
        assert shell.run_cell(read(copies[0]).cells[0].source, silent=True).success
    assert installed == [f"pip install -q {INSTALLS}"]


@pytest.mark.parametrize("command", ["handout", "site"])
def test_a_folder_that_cannot_be_made_is_told(command, tmp_path, run):
    if command == "site":
        pytest.importorskip("myst_nb", reason="pip install '.[site]'")
    (tmp_path / "file").write_text("")
    said = run(f"course {command} -o {tmp_path / 'file'}", 2).err
    assert f"Cannot make the folder {tmp_path / 'file'}: " in said


@pytest.mark.parametrize(
    ("line", "missing", "extra"),
    [
        ("course handout -o out", "nbformat", "notebooks"),
        ("course mark .", "nbformat", "notebooks"),
        ("course run n.ipynb", "nbformat", "notebooks"),
        ("course site -o out", "nbformat", "notebooks"),
        ("course site -o out", "sphinx", "site"),
        ("course slides -o out", "sphinx_revealjs", "slides"),
        ("course lite -o out", "jupyterlite_pyodide_kernel", "lite"),
        ("lab", "jupyterlab", "notebooks"),
    ],
)
def test_without_a_library_one_sentence_says_what_to_install(
    line, missing, extra, tmp_path, monkeypatch, run
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, missing, None)
    monkeypatch.setattr("subprocess.Popen", None)  # nor is anything started
    assert f'pip install ".[{extra}]"' in run(line, 2).err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("line", ["course slides -o out", "course film 06-pruning.ipynb -o out.mp4"])
def test_without_docutils_one_sentence_says_what_to_install(line, tmp_path):
    code = (
        f"import sys; sys.modules['docutils'] = None; from mocap.cli.main import main; main({line.split()})"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert 'pip install ".[slides]"' in done.stderr and len(done.stderr.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("stem", COURSE)
def test_a_solution_without_what_is_marked_is_the_stub_again(stem):
    """As nbgrader cuts it out, with our stub and with its own, which raises an error."""
    clear = pytest.importorskip("nbgrader.preprocessors", reason="pip install '.[ci]'").ClearSolutions
    right = {name: solution(cell) for name, cell in tagged(COURSE[stem], "solution")}
    for name, cell in tagged(COURSE[stem], "exercise"):
        merged = nbformat.v4.new_code_cell(_merged(cell.source, right[name]))
        compile(merged.source, name, "exec")
        for stub in ("return ...", "# YOUR CODE HERE\nraise NotImplementedError()"):
            cut, cutter = merged.copy(), clear()
            cutter.code_stub = {"python": stub}
            assert cutter._replace_solution_region(cut, "python")
            compile(cut.source, name, "exec")
            if stub == "return ..." and name != "tarjan":  # whose stub shows where its cases go
                assert cut.source == cell.source


def test_nbgrader_gives_full_marks_for_right_answers_and_none_for_wrong_or_empty_ones(tmp_path, monkeypatch):
    """It makes the assignment, grades three students and writes feedback, as at a university."""
    pytest.importorskip("nbgrader", reason="pip install '.[ci]'")
    import alembic
    from nbgrader.apps.api import NbGraderAPI
    from traitlets.config import Config

    small = COURSE["00-quickstart"].copy()
    wanted = ("ask", "exercise", "check", "solution")
    kept = [cell for kind in wanted for name, cell in tagged(small, kind) if name in ("speed", "cheapest")]
    imports = "import numpy as np\n\nfrom mocap.course import checks, lab"
    small.cells = [nbformat.v4.new_code_cell(imports), *(cell for cell in small.cells if cell in kept)]
    nbformat.write(small, tmp_path / "small.ipynb")
    (tmp_path / "points.toml").write_text("speed = 2.5")
    line = ["handout", tmp_path / "small.ipynb", "--nbgrader", "--wheel", "-o", tmp_path / "course"]
    assert main(["course", *map(str, line), "--points", str(tmp_path / "points.toml")]) == 0

    at = Path(alembic.__file__).parents[4]  # where nbgrader finds commands and templates
    monkeypatch.setenv("PATH", os.pathsep.join([str(at / "bin"), os.environ["PATH"]]))
    monkeypatch.setenv("JUPYTER_PATH", str(at / "share" / "jupyter"))
    monkeypatch.chdir(tmp_path / "course")
    config = Config()
    exec((tmp_path / "course" / "nbgrader_config.py").read_text(), {"get_config": lambda: config})
    config.CourseDirectory.root = str(tmp_path / "course")
    api = NbGraderAPI(config=config)
    assert api.generate_assignment("small")["success"]
    source, release = (
        read(tmp_path / "course" / kind / "small" / "small.ipynb") for kind in ("source", "release")
    )
    assert "require" not in str(release) and "SOLUTION" not in str(release) and "return ..." in str(release)
    right = {
        name: f"import sys\nsys.stderr.write('slow')\n{cell.source}"
        for name, cell in tagged(source, "exercise")
    }
    students = {
        "right": lambda name, _: right[name].replace("steps =", "print('!', file=sys.stderr)\n    steps ="),
        "wrong": lambda name, stub: (
            stub.replace("...", "7") if name == "speed" else f"{name} = lab.mine('{name}')"
        ),
        "empty": lambda _, stub: stub,
    }
    for student, answer in students.items():
        sent = nbformat.reads(nbformat.writes(release), 4)
        for name, cell in tagged(sent, "exercise"):
            cell.source = answer(name, cell.source)
        (folder := tmp_path / "course" / "submitted" / student / "small").mkdir(parents=True)
        nbformat.write(sent, folder / "small.ipynb")
        assert api.autograde("small", student)["success"]
    done = api.generate_feedback("small", "wrong")
    assert done["success"], done
    with api.gradebook as book:
        scores = {one.student.id: (one.score, one.max_score) for one in book.assignment_submissions("small")}
    assert scores == {"right": (3.5, 3.5), "wrong": (0, 3.5), "empty": (0, 3.5)}
    page = (tmp_path / "course" / "feedback" / "wrong" / "small" / "small.html").read_text("utf-8")
    assert "your answer has the shape (); it should be" in page


def test_notebooks_are_copied_and_edited_ones_are_kept(monkeypatch, tmp_path):
    package = tmp_path / "site" / "mocap"
    (package / "notebooks").mkdir(parents=True)
    for name in ("00-quickstart.ipynb", "01-next.ipynb"):
        (package / "notebooks" / name).write_text("{}")
    monkeypatch.setattr(opening, "PACKAGE", package)
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "01-next.ipynb").write_text("edited")
    assert opening.course_folder(mine) == mine
    assert (mine / "00-quickstart.ipynb").read_text() == "{}"
    assert (mine / "01-next.ipynb").read_text() == "edited"


def test_copies_of_notebooks_have_no_outputs_of_checks_and_are_else_the_same(tmp_path):
    opening.course_folder(tmp_path)
    count = 0
    for file in sorted(stored().glob("0*.ipynb")):
        original = nbformat.read(file, 4)
        copied = nbformat.read(tmp_path / file.name, 4)
        for kept, cell in zip(original.cells, copied.cells, strict=True):
            if any(tag.startswith("check:") for tag in kept.metadata.get("tags", [])):
                assert kept.outputs and not cell.outputs
                kept.outputs = []
                kept.execution_count = None
                count += 1
        assert original == copied
    assert count >= 22


@pytest.mark.sweep
def test_jupyterlite_is_built_with_the_package_inside(tmp_path, capsys):
    pytest.importorskip("jupyterlite_pyodide_kernel", reason="pip install '.[lite]'")
    assert main(["course", "lite", "-o", str(tmp_path / "lite")]) == 0
    assert (tmp_path / "lite" / "lab" / "index.html").exists()
    assert not (stored().parent / ".jupyterlite.doit.db").exists()
    (wheel,) = (tmp_path / "lite" / "pypi").glob("motion_graphs-*.whl")
    assert wheel.stat().st_size > 1e5
    first = nbformat.read(tmp_path / "lite" / "files" / "00-quickstart.ipynb", 4)
    assert first.cells[1].source.startswith("%pip install -q motion-graphs")


def test_jupyterlite_is_built_of_a_checkout_only(tmp_path, monkeypatch):
    monkeypatch.setattr(opening, "find_spec", lambda name: True)
    refused("checkout", opening.build_lite, tmp_path / "notebooks", tmp_path / "out")


def test_what_a_failing_build_says_is_cut_to_a_short_sentence(tmp_path):
    (tmp_path / "loud.py").write_text("raise SystemExit('x' * 5000)")
    refused("'loud build' failed: xxx", opening._call, str(tmp_path), ["loud", "build"])


def edited_copy(folder, changes):
    """Change cells of a notebook by their tags; return the notebook's file."""
    file = folder / "03-transforms.ipynb"
    notebook = nbformat.read(file, 4)
    for cell in notebook.cells:
        for tag in cell.metadata.get("tags", []):
            cell.source = changes.get(tag, cell.source)
    nbformat.write(notebook, file)
    return file


MY_UNDO = "def undo(angle, x, z):\n    return -angle, -x, -z\n"


def test_a_copy_knows_what_has_changed_since(tmp_path, monkeypatch):
    shipped, copy = tmp_path / "shipped", tmp_path / "copy"
    shipped.mkdir()
    for name in ("00-quickstart", "03-transforms"):
        opening.copy_file(stored() / f"{name}.ipynb", shipped / f"{name}.ipynb")
    monkeypatch.setattr(opening, "stored", lambda: shipped)
    opening.course_folder(copy)
    assert "changes" not in opening.news(copy)
    file = edited_copy(copy, {"exercise:undo": MY_UNDO})
    assert "changes" not in opening.news(copy)  # by the reader
    edited_copy(shipped, {"title": "# Transforms, told anew"})
    assert "copy: 03. `mocap lab --reset 03`" in opening.news(copy)
    (copy / ".course.json").unlink()  # as an earlier version left it
    assert "copy: 03. `mocap lab --reset 03`" in opening.news(copy)
    said = opening.news(copy, "03")
    assert "the old one is earlier" in said and "Your answers are in it: undo." in said
    cells = nbformat.read(file, 4).cells
    assert cells[0].source == "# Transforms, told anew" and MY_UNDO in [cell.source for cell in cells]
    assert MY_UNDO in [cell.source for cell in nbformat.read(copy / "earlier" / file.name, 4).cells]
    assert "changes" not in opening.news(copy)
    refused("There is no notebook '3': give reset= the number of one, such as 03", opening.news, copy, "3")


def test_progress_counts_what_is_kept_and_names_what_is_next(tmp_path):
    file = tmp_path / "my_graph.py"
    assert progress(file).splitlines()[-1] == "Next: `speed` in notebook 00."
    file.write_text("# ---- speed (notebook 00) ----\n\ndef speed(): ...\n")
    lines = progress(file).splitlines()
    assert lines[0] == "00 ●○ cheapest"
    assert lines[-1] == "Next: `cheapest` in notebook 00."
    assert len(lines) == 10
