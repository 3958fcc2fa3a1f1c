"""What is in a folder of hand-ins: notebooks, archives of them, and everything else by name."""

import io
import zipfile

import pytest

from mocap.course.marking import hand_ins, mark
from mocap.course.marking.hand_ins import collect, sent_by
from mocap.errors import MocapError
from tests.course.marking.students import HONEST, hand_in
from tests.refusals import refused


def write(folder, files):
    for name, data in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


def archive(members):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as made:
        for name, text in members.items():
            made.writestr(name, text)
    return data.getvalue()


def paths(folder):
    return [sent.path for sent in collect(folder).notebooks]


def test_suffixes_are_read_without_case_and_archives_are_folders(tmp_path):
    write(tmp_path, {"ada/02.IPYNB": b"a", "bob/hw.ZIP": archive({"x/02.ipynb": "b", "x/notes.txt": "c"})})
    assert paths(tmp_path) == ["ada/02.IPYNB", "bob/hw.ZIP/x/02.ipynb"]
    assert [sent.read() for sent in collect(tmp_path).notebooks] == [b"a", b"b"]


def test_who_sent_no_notebook_is_listed_with_the_files(tmp_path):
    write(tmp_path, {"ada/1.ipynb": b"", "bob/hw.py": b"", "bob/a.html": b"", "dan.pdf": b""})
    write(tmp_path, {"eve/hw.zip": archive({"readme": "x"}), "roster.csv": b"", "points.toml": b""})
    (tmp_path / "cyn").mkdir()
    assert collect(tmp_path).without_notebook == {
        "bob": ["a.html", "hw.py"],
        "cyn": [],
        "dan.pdf": ["dan.pdf"],
        "eve": ["hw.zip"],
    }


def test_the_text_beside_a_notebook_in_moodle_is_not_missed(tmp_path):
    write(tmp_path, {"Ada_7_assignsubmission_file/1.ipynb": b""})
    write(tmp_path, {"Ada_7_assignsubmission_onlinetext/onlinetext.html": b""})
    write(tmp_path, {"Bob_8_assignsubmission_onlinetext/onlinetext.html": b""})
    assert list(collect(tmp_path).without_notebook) == ["Bob_8_assignsubmission_onlinetext"]


def test_what_a_system_put_there_is_left_out(tmp_path):
    names = (".ipynb_checkpoints/1.ipynb", ".DS_Store", "__MACOSX/b.ipynb")
    write(tmp_path, {f"ada/{name}": b"" for name in names})
    write(tmp_path, {"bob/hw.zip": archive({"__MACOSX/._1.ipynb": "", "a.ipynb": "1"})})
    assert paths(tmp_path) == ["bob/hw.zip/a.ipynb"]


@pytest.mark.parametrize(
    "name", ["../../evil.ipynb", "/etc/evil.ipynb", "..\\..\\evil.ipynb", "C:/evil.ipynb"]
)
def test_no_name_in_an_archive_leads_out_of_it(name, tmp_path):
    write(tmp_path, {"ada/hw.zip": archive({name: "1"})})
    (path,) = paths(tmp_path)
    assert path.startswith("ada/hw.zip/") and ".." not in path
    assert sent_by(path) == ("ada", "")
    assert [sent.read() for sent in collect(tmp_path).notebooks] == [b"1"]
    assert sorted(file.name for file in tmp_path.rglob("*")) == ["ada", "hw.zip"]


def test_archives_are_bounded(tmp_path, monkeypatch):
    def wrong(members):
        write(tmp_path, {"ada/hw.zip": archive(members)})
        (sent,) = collect(tmp_path).notebooks
        refused("is an archive of more than", sent.read)

    monkeypatch.setattr(hand_ins, "MOST_NOTEBOOKS", 3)
    wrong({f"{n}.ipynb": "" for n in range(4)})
    monkeypatch.setattr(hand_ins, "MOST_MEMBERS", 5)
    wrong({"1.ipynb": "", **{f"{n}.txt": "" for n in range(6)}})
    monkeypatch.setattr(hand_ins, "LARGEST", 1000)
    wrong({"1.ipynb": " " * 1001})


def test_an_archive_that_states_a_smaller_size_gives_no_more(tmp_path):
    data = bytearray(archive({"a.ipynb": "x" * 100_000}))
    for signature, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        at = data.rindex(signature)
        data[at + offset : at + offset + 4] = (10).to_bytes(4, "little")
    write(tmp_path, {"ada/hw.zip": bytes(data)})
    (sent,) = collect(tmp_path).notebooks
    try:
        assert len(sent.read()) <= 10
    except MocapError as error:
        assert "cannot be read from its archive" in str(error)


def test_archives_that_cannot_be_read_and_those_of_several_students_are_told(tmp_path):
    write(tmp_path, {"ada/hw.zip": b"PK no archive", "bob/hw.zip": archive({"a.ipynb": "1"})[:-30]})
    both = {f"{name}_{n}_assignsubmission_file/1.ipynb": "" for n, name in enumerate(("Ada", "Bob"))}
    write(tmp_path, {"all.zip": archive(both)})
    (tmp_path / "cyn.zip").symlink_to(tmp_path / "bob")
    wanted = ["is an archive that cannot"] * 2 + ["of several students: unpack it", "is no plain file"]
    found = {sent.path: sent for sent in collect(tmp_path).notebooks}
    for path, words in zip(("ada/hw.zip", "bob/hw.zip", "all.zip", "cyn.zip"), wanted, strict=True):
        refused(words, found[path].read)


def test_nothing_vanishes(tmp_path):
    """Each student has a line of each exercise, and what a person has to look at is told."""
    folder = tmp_path / "in"
    hand_in(HONEST, folder / "ada" / "00.IPYNB")
    hand_in([*HONEST, ("exercise:dead_ends", "x = 1")], folder / "dan" / "00.ipynb")
    hand_in(HONEST, tmp_path / "one.ipynb")
    write(folder, {"eve/hw.zip": archive({"a.ipynb": (tmp_path / "one.ipynb").read_text()})})
    write(folder, {"bob/hw.py": b""})
    (folder / "cyn").mkdir()
    marks = [one for some in mark(folder) for one in some]
    right = {
        name: [m.right for m in marks if m.handed_in.startswith(name) and m.exercise]
        for name in ("ada", "bob", "cyn", "dan", "eve")
    }
    assert right == {name: [name in ("ada", "dan", "eve")] * 2 for name in right}
    problems = {(m.handed_in.split("/")[0], m.problem, m.note) for m in marks if m.problem}
    assert problems == {
        ("bob", "not a notebook", "hw.py"),
        ("cyn", "nothing handed in", ""),
        ("dan", "exercises that this version does not know", "dead_ends"),
    }
