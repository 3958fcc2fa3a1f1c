"""What a public host reads: workflows, issue forms, the address of the repository; and the container."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

from tests.cli.listing import understood
from tests.test_house import ROOT

HOST = ROOT / ".github"
pytestmark = pytest.mark.skipif(not HOST.is_dir(), reason="only a checkout has what a host reads")

WORKFLOWS = sorted((HOST / "workflows").glob("*.yml"))
FORMS = [path for path in sorted((HOST / "ISSUE_TEMPLATE").glob("*.yml")) if path.stem != "config"]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
SCHEMAS = {
    "vendor.github-workflows": WORKFLOWS,
    "vendor.github-issue-forms": FORMS,
    "vendor.github-issue-config": [HOST / "ISSUE_TEMPLATE" / "config.yml"],
    "vendor.citation-file-format": [ROOT / "CITATION.cff"],
}


def load(path):
    return yaml.safe_load(path.read_text("utf-8"))


def steps(path):
    return [step for job in load(path)["jobs"].values() for step in job["steps"]]


def run(*command, folder=ROOT, **environment):
    inherited = {name: value for name, value in os.environ.items() if name != "PYTEST_ADDOPTS"}
    return subprocess.run(
        [*map(str, command)],
        cwd=folder,
        env=inherited | environment,
        capture_output=True,
        text=True,
        check=False,
    )


# ---- The files are what the host expects


@pytest.mark.tools
@pytest.mark.parametrize("schema", SCHEMAS)
def test_files_of_the_host_follow_their_schemas(schema):
    pytest.importorskip("check_jsonschema")
    done = run(sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema, *SCHEMAS[schema])
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.tools
def test_a_mistake_in_a_workflow_would_be_noticed(tmp_path):
    pytest.importorskip("check_jsonschema")
    wrong = WORKFLOWS[0].read_text("utf-8").replace("runs-on:", "runs_on:")
    (tmp_path / "wrong.yml").write_text(wrong)
    schema = next(iter(SCHEMAS))
    command = (sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema)
    assert run(*command, tmp_path / "wrong.yml").returncode == 1


@pytest.mark.tools
def test_actionlint_finds_nothing():
    if not shutil.which("actionlint"):
        pytest.skip("actionlint is not installed")
    done = run("actionlint", *WORKFLOWS)
    assert done.returncode == 0, done.stdout


def test_workflows_may_only_read_unless_a_job_says_more_and_all_jobs_end():
    for path in WORKFLOWS:
        workflow = load(path)
        assert workflow["permissions"] == {"contents": "read"}, path
        assert all(job["timeout-minutes"] <= 90 for job in workflow["jobs"].values()), path
        for step in steps(path):
            assert re.fullmatch(r"actions/[a-z-]+@v\d+", step.get("uses", "actions/none@v0")), step
            if "checkout" in step.get("uses", ""):
                assert step["with"] == {"persist-credentials": False}, path


def test_the_matrix_has_all_systems_and_each_python_from_the_lowest():
    matrix = load(HOST / "workflows" / "tests.yml")["jobs"]["tests"]["strategy"]["matrix"]
    assert [name.partition("-")[0] for name in matrix["system"]] == ["ubuntu", "macos", "windows"]
    assert matrix["python"] == [f"3.{minor}" for minor in range(11, 15)]
    assert PROJECT["requires-python"] == f">={matrix['python'][0]}"


# ---- Their steps are the project's own commands


def test_each_extra_that_is_installed_exists():
    texts = [path.read_text("utf-8") for path in (*WORKFLOWS, ROOT / ".devcontainer" / "devcontainer.json")]
    extras = {extra for text in texts for extra in re.findall(r"\.\[(\w+)\]", text)}
    assert extras >= {"test", "site", "ci"}
    assert extras <= set(PROJECT["optional-dependencies"])


def test_each_command_of_a_step_has_its_options():
    lines = [line for path in WORKFLOWS for step in steps(path) for line in step.get("run", "").splitlines()]
    ours = [line.split()[1:] for line in lines if line.startswith("mocap ")]
    ours += [line.partition('mocap" ')[2].split() for line in lines if 'bin/mocap" ' in line]
    assert len(ours) == 2
    for words in ours:
        assert understood(words)


DRY = {  # what is slow, or tested elsewhere, is tried in its shortest form
    "python -m pytest": "python -m pytest -n0 --collect-only -q tests/body",
    "bash .ci/run": "bash -n .ci/run",
    "mocap course site -o site": "python -m mocap course site --help",
}


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """Clone the repository, with a Python that finds our libraries and installs without a network."""
    folder = tmp_path_factory.mktemp("host") / "clone"
    done = run("git", "clone", "--quiet", ROOT, folder)
    assert done.returncode == 0, done.stderr
    python = folder.parent / "python"
    assert run(sys.executable, "-m", "venv", "--without-pip", python).returncode == 0
    (site,) = python.glob("lib/*/site-packages")
    libraries = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    (site / "libraries.pth").write_text("\n".join(libraries))
    return folder, python


@pytest.mark.tools
@pytest.mark.skipif(os.name == "nt", reason="the steps are tried in a POSIX shell")
@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_each_step_runs_here(path, clone):
    folder, python = clone
    offline = {"PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1", "PIP_NO_BUILD_ISOLATION": "0"}
    offline |= {"PATH": f"{python / 'bin'}{os.pathsep}{os.environ['PATH']}", "GITHUB_WORKSPACE": f"{folder}"}
    tried = 0
    for step in steps(path):
        command = step.get("run", "")
        if not command or command.startswith("git config --global"):
            continue
        command = command.replace("python -m venv alone", f"python -m venv alone; {lend(folder)}")
        done = run("bash", "-euo", "pipefail", "-c", DRY.get(command, command), folder=folder, **offline)
        assert done.returncode == 0, f"{command}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
        tried += 1
    assert tried >= 2


def lend(folder):
    """Write a line of shell that lends our libraries, but not our package, to the environment `alone`."""
    libraries = folder.parent / "python" / "lib"
    return f"cp {libraries}/*/site-packages/libraries.pth alone/lib/*/site-packages/"


# ---- One line names the home of the project


def home(folder, *options):
    return run(sys.executable, ".ci/home.py", *options, folder=folder)


def test_all_mentions_of_the_repository_agree():
    done = home(ROOT, "--check")
    assert done.returncode == 0, done.stdout
    assert "repository.invalid" not in PROJECT["urls"]["Repository"] or "date-released" not in (
        ROOT / "CITATION.cff"
    ).read_text("utf-8"), "a release needs a home: edit `Repository` in pyproject.toml"


def test_one_line_fills_them_all(tmp_path):
    mentions = [".ci/home.py", "pyproject.toml", "CITATION.cff", "SECURITY.md", "CODE_OF_CONDUCT.md"]
    mentions.append(".github/ISSUE_TEMPLATE/config.yml")
    for name in mentions:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    project = tmp_path / "pyproject.toml"
    line = re.compile(r'^Repository = ".*"$', re.MULTILINE)
    new = line.sub('Repository = "https://code.example/us/motion"', project.read_text("utf-8"))
    project.write_text(new, "utf-8")
    assert home(tmp_path, "--check").returncode == len(mentions) - 1
    assert home(tmp_path).returncode == 0
    assert home(tmp_path, "--check").returncode == 0
    urls = tomllib.loads(project.read_text("utf-8"))["project"]["urls"]
    assert urls["Issues"] == "https://code.example/us/motion/issues"
    old = PROJECT["urls"]["Repository"]
    assert not [name for name in mentions[1:] if old in (tmp_path / name).read_text("utf-8")]


def test_no_other_file_mentions_the_placeholder():
    if not (ROOT / ".git").exists():
        pytest.skip("not a checkout")
    found = run("git", "grep", "--untracked", "-lF", "repository.invalid").stdout.split()
    allowed = {"pyproject.toml", "CITATION.cff", "SECURITY.md", "CODE_OF_CONDUCT.md", ".ci/home.py"}
    allowed |= {".github/ISSUE_TEMPLATE/config.yml", "tests/test_hosting.py"}
    assert set(found) <= allowed


# ---- The container is Binder's


def test_the_container_has_binders_python_and_more_than_its_packages():
    container = json.loads((ROOT / ".devcontainer" / "devcontainer.json").read_text("utf-8"))
    version = (ROOT / ".binder" / "runtime.txt").read_text("utf-8").strip().removeprefix("python-")
    assert container["image"] == f"python:{version}"
    (binder,) = re.findall(r"\.\[(\w+)\]", (ROOT / ".binder" / "requirements.txt").read_text("utf-8"))
    (extra,) = re.findall(r"\.\[(\w+)\]", container["postCreateCommand"])
    (whole,) = [need for need in PROJECT["optional-dependencies"][extra] if need.startswith("motion-graphs[")]
    assert binder in re.split(r"[\[\],]", whole)


def test_each_form_asks_for_what_is_needed():
    asked = {path.stem: path.read_text("utf-8") for path in FORMS}
    assert set(asked) == {"bug", "clip", "course"}
    assert "`mocap info FILE`" in asked["bug"] and "`mocap --version`" in asked["bug"]
    assert "`mocap info FILE`" in asked["clip"]
    assert all("required: true" in text for text in asked.values())
    assert "CHANGELOG.md" in (HOST / "pull_request_template.md").read_text("utf-8")


def test_the_paths_that_the_policies_name_exist():
    for name in ("SECURITY.md", "CODE_OF_CONDUCT.md"):
        text = Path(ROOT / name).read_text("utf-8")
        for path in re.findall(r"`((?:mocap|notebooks)/[^`]+)`", text):
            assert (ROOT / path).exists(), path
