"""A copy of the notebooks to work in."""

from mocap.course import opening


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
