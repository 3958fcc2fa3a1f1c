"""`mocap find`, as a person types it."""

import pytest

from mocap import datasets, files
from mocap.cli.main import main
from tests.cli.refused import check_refused


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("clips")
    for name in ("walk_straight", "stop_and_go"):
        files.save(datasets.sample(name)[:1200], path / f"{name}.bvh")
    return path


def test_matches_are_listed_and_cut_out_as_files(folder, tmp_path, capsys):
    out = tmp_path / "found"
    query = f"{folder / 'walk_straight.bvh'}:240-370"
    assert main(["find", query, str(folder), "--below", "4", "-o", str(out)]) == 0
    told = capsys.readouterr()
    head, *rows, found, wrote = told.out.splitlines()
    assert head.split() == ["clip", "frames", "seconds", "cm", "step"]
    assert found == f"found        {len(rows)} in 2 clips" and len(rows) >= 6
    assert wrote == f"wrote        {len(rows)} files to {out}"
    names = set()
    for row in rows:
        clip, frames, seconds, cost, step = row.split()
        first, last = map(int, frames.split("-"))
        assert float(seconds) == pytest.approx((last - first) / 120, abs=0.01)
        assert 0 < float(cost) <= 4 and int(step) >= 1
        names.add(f"{clip}_{frames}.bvh")
        assert len(files.load(out / f"{clip}_{frames}.bvh")) == last - first
    assert {path.name for path in out.iterdir()} == names
    assert told.err == ""


def test_the_shortest_query_lasts_as_long_as_a_path(folder, capsys):
    assert main(["find", f"{folder / 'walk_straight.bvh'}:240-276", str(folder)]) == 0
    assert "walk_straight" in capsys.readouterr().out


def test_a_query_from_elsewhere_is_not_among_its_matches(folder, capsys):
    query = f"{folder / 'walk_straight.bvh'}:240-370"
    assert main(["find", query, str(folder / "stop_and_go.bvh"), "--steps", "1", "--any-length"]) == 0
    told = capsys.readouterr().out
    assert "walk_straight" not in told and "stop_and_go" in told and "wrote" not in told


@pytest.mark.parametrize(
    ("query", "options", "message"),
    [
        ("{folder}/walk_straight.bvh:9-", [], "Write CLIP:FROM-TO, as in walk.amc:120-250"),
        ("{folder}/walk_straight.bvh:a-b", [], "Write CLIP:FROM-TO"),
        ("{folder}/walk_straight.bvh:240-241", [], "A query must last 0.3 s or more"),
        ("{folder}/walk_straight.bvh:240-99999", [], "has frames 0 to"),
        ("{folder}/nothing.bvh:240-300", [], "nothing.bvh"),
        ("{folder}/walk_straight.bvh:240-300", ["--below", "0"], "--below: '0' is not a number"),
        ("{folder}/walk_straight.bvh:240-300", ["--steps", "0"], "--steps: '0' is not a whole number"),
        ("{folder}/walk_straight.bvh:240-300", ["-o", "{folder}/stop_and_go.bvh"], "Cannot make the folder"),
    ],
)
def test_what_cannot_be_found_is_one_sentence(folder, capsys, query, options, message):
    words = [text.format(folder=folder) for text in (query, str(folder), *options)]
    check_refused(folder, capsys, ["find", *words], message)


def test_a_query_that_finds_nothing_says_so(folder, capsys):
    query = f"{folder / 'walk_straight.bvh'}:240-370"
    assert main(["find", query, str(folder), "--below", "0.01"]) == 0
    told = capsys.readouterr()
    assert told.out.splitlines()[-1] == "found        0 in 0 clips"
    assert "only itself" in told.err


@pytest.mark.parametrize("below", ["6", "12"])
def test_a_stricter_limit_still_finds_the_near_ones(real_data, tmp_path, capsys, below):
    clip = tmp_path / "punches.bvh"
    files.save(datasets.cmu("02_05"), clip)
    assert main(["find", f"{clip}:614-704", str(clip), "--below", below]) == 0
    _, *rows, _ = capsys.readouterr().out.splitlines()
    assert rows[0].split()[1] == "796-876" and float(rows[0].split()[3]) < 4
    assert len(rows) >= 2 and rows[1].split()[1].startswith("97")
