"""The course in JupyterLite."""

import nbformat
import pytest

from mocap.cli.main import main
from mocap.course import lite
from mocap.course.opening import stored
from mocap.errors import MocapError


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


def test_without_jupyterlite_or_a_checkout_one_sentence_says_what_to_do(tmp_path, monkeypatch):
    with pytest.raises(
        MocapError, match="checkout" if lite.find_spec("jupyterlite_pyodide_kernel") else "\\.\\[lite\\]"
    ):
        lite.build_lite(tmp_path / "notebooks", tmp_path / "out")
    monkeypatch.setattr(lite, "find_spec", lambda name: None)
    with pytest.raises(MocapError, match="\\.\\[lite\\]"):
        lite.build_lite(tmp_path, tmp_path / "out")


def test_what_a_failing_build_says_is_cut_to_a_short_sentence(tmp_path):
    (tmp_path / "loud.py").write_text("raise SystemExit('x' * 5000)")
    with pytest.raises(MocapError, match="'loud build' failed: xxx") as raised:
        lite._call(str(tmp_path), ["loud", "build"])
    assert len(str(raised.value)) <= 200
