"""`mocap demo`, `graph`, `walk` and `crowd`, as a person types them."""

import re

import numpy as np
import pytest
from PIL import Image

from mocap.body import Motion, Skeleton, joint_positions, resample, rotations
from mocap.cli.crowd import _plan
from mocap.datasets import samples
from mocap.datasets.clip_origins import Origin, find_again, is_origin
from mocap.errors import NoWalk
from mocap.files import load_save
from mocap.graphs import storage
from mocap.methods.groups.planning import Scene
from mocap.steering.path_search import watching
from tests.bundled import bundled
from tests.files.glb_reader import Glb


def rows(told):
    return dict(line.split(maxsplit=1) for line in told.splitlines() if line[0] != " ")


@pytest.fixture
def unseen(monkeypatch):
    """Draw no film."""
    monkeypatch.setattr("mocap.widgets.save_animation", lambda walk, path, **_: path.write_text(""))


def test_a_demo_writes_a_walk_and_tells(clips, run):
    told = run("demo a.bvh b.bvh -o new/walk --threshold 5 --seconds 1 --fps 20")
    assert sorted(path.name for path in (clips / "new" / "walk").iterdir()) == [
        "walk.bvh",
        "walk.gif",
        "walk.html",
    ]
    assert [line.split()[1] for line in told.out.splitlines() if line.startswith("wrote")] == [
        "new/walk/walk.html:",
        "new/walk/walk.bvh",
        "new/walk/walk.gif",
    ]
    walk, table = load_save.load("new/walk/walk.bvh"), rows(told.out)
    assert len(walk) >= 20 and walk.fps == 20
    assert (table["clips"], table["frames"]) == ("2: a, b", "140 at 20 Hz, 7.0 s")
    whole, pruned = map(int, table["nodes"].split())
    assert whole > pruned > 0
    assert table["new"].startswith(f"walk     {walk.duration:.1f} s, ")
    assert told.out.splitlines()[-1] == "wrote        new/walk/walk.gif" and told.err == ""


@pytest.mark.usefixtures("unseen")
def test_a_threshold_that_leaves_no_cycle_is_told_with_one_that_does(clips, run):
    said = run("demo a.bvh b.bvh -o out --threshold 0.01", 2).err
    assert "at a threshold of 0.01 cm; these clips need at least" in said
    run(f"demo a.bvh b.bvh -o out --seconds 2 --no-film --threshold {float(said.split()[-2]) + 1e-6}")
    assert not (clips / "out" / "walk.gif").exists()


def test_thresholds_are_proposed_for_a_graph_that_plays_few_of_its_frames(clips, run):
    load_save.save(resample(samples.sample("sneak"), 30)[:300], clips / "sneak.bvh")
    told = rows(run("graph sneak.bvh -o g.npz --threshold 0.8").out)
    shares = [int(share) for share in re.findall(r"(\d+)%", told["playable"])]
    assert shares == sorted(shares) and len(shares) == 4
    assert shares[0] < 50 <= shares[-1]
    better = re.search(r"try --threshold ([\d.]+)$", told["playable"])[1]
    assert f"% at {better}" in told["playable"]
    assert "playable" not in rows(run(f"graph sneak.bvh -o g.npz --threshold {better}").out)


def test_a_graph_is_built_saved_and_told_about(clips, run):
    built = run("graph . -o g.npz --threshold 5 --graphml g.graphml")
    assert built.out.splitlines()[-2:] == ["wrote        g.npz", "wrote        g.graphml"]
    assert built.err == ""
    told = run("graph info g.npz").out.splitlines()
    assert told[:3] == [
        "clip         a: 120 frames at 30 Hz, 4.0 s",
        "clip         b: 90 frames at 30 Hz, 3.0 s",
        "window       10 frames, 0.33 s",
    ]
    licence, *table = built.out.splitlines()[:-2]
    assert licence.startswith("licence      unknown for 2 of 2 clips") and told[3:] == table
    loaded = storage.load("g.npz", [load_save.load(f"{name}.bvh") for name in "ab"])
    assert loaded.graph.number_of_nodes() == int(told[4].split()[1].rstrip(","))


def test_a_whole_graph_ends_somewhere(clips, run):
    assert "none before the end of some clip" in run("graph . -o g.npz --whole").out


def test_a_folder_of_clips_named_info_is_built(clips, tmp_path, run):
    (tmp_path / "info").symlink_to(clips)
    for words in ("graph build info", "graph ./info"):
        run(f"{words} -o g.npz")


def test_a_graph_with_mirror_images_finds_its_clips_again(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    load_save.save(resample(samples.sample("walk_circle"), 30)[:400], "a.bvh")
    run("graph a.bvh --mirror -o graph.npz")
    assert storage.read("graph.npz").names == ["a", "a_mirrored"]
    clip, image = storage.load("graph.npz").clips
    assert np.allclose(joint_positions(image)[:, 0], joint_positions(clip)[:, 0] * [-1, 1, 1])
    for more in ("", "--clips a.bvh"):
        run(f"walk graph.npz --random 5s -o out.bvh {more}")
    assert "a_mirrored: " in run("graph info graph.npz").out


def lopsided(name, rate):
    """Swing both legs, `rate` radians a frame."""
    names = ["root", "lfemur", "ltibia", "rfemur", "rtibia"]
    places = [[0, 0.9, 0], [0.1, 0, 0], [0, -0.4, 0], [-0.1, 0, 0], [0, -0.45, 0]]
    body = Skeleton(names, [-1, 0, 1, 0, 3], places)
    angles = 0.5 * np.sin(rate * np.arange(60))
    turned = np.tile(rotations.IDENTITY, (60, 5, 1))
    swing = angles[:, None] * [1, 0, 0]
    turned[:, 1] = rotations.from_rotvec(swing)
    turned[:, 3] = rotations.from_rotvec(-swing)
    roots = np.stack([0 * angles, 0 * angles + 0.9, np.arange(60) / 60], axis=1)
    return Motion(body, roots, turned, 30.0, name)


def test_one_warning_says_that_a_body_is_lopsided(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    for name, rate in (("a", 0.25), ("b", 0.27)):
        load_save.save(lopsided(name, rate), f"{name}.bvh")
    (told,) = run("graph a.bvh b.bvh --mirror -o graph.npz").err.splitlines()
    assert "left and right bones differ by up to 50 mm" in told
    assert told.endswith("So it is with 1 more.") and len(told) <= 200
    for more in ("", "--clips a.bvh b.bvh"):
        assert run(f"walk graph.npz --random 1s -o new.bvh {more}").err == ""


def test_a_mirrored_origin_is_checked(tmp_path):
    (tmp_path / "a.bvh").write_text("")
    text = Origin(tmp_path / "a.bvh", mirrored=True).text(tmp_path)
    assert is_origin(text) and find_again(text, tmp_path).mirrored
    assert not is_origin(text.replace("true", "1")) and not is_origin("[]")


def test_an_origin_remembers_the_use_of_the_offset_of_the_root(tmp_path):
    (tmp_path / "a.bvh").write_text("")
    text = Origin(tmp_path / "a.bvh", root_offset="add").text(tmp_path)
    assert is_origin(text) and find_again(text, tmp_path).root_offset == "add"
    assert not is_origin(text.replace('"add"', '"both"'))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    storage.save(bundled("walk_circle", "walk_curve_1"), tmp_path / "graph.npz")
    (tmp_path / "path.csv").write_text("0,0\n0,3\n0.5,5\n")
    (tmp_path / "points.csv").write_text("x, z\n1, 7\n")
    (tmp_path / "discs.csv").write_text("x, z, radius\n-3, 5, 0.5\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_it_wanders_and_writes_gltf_for_engines(folder, run):
    assert "at random" in run("walk graph.npz --random 0.1min -o out.glb --clean").out
    read = Glb((folder / "out.glb").read_bytes())
    assert read.nodes[0]["name"] == "root"
    assert max(times[-1] for times, _ in read.curves().values()) > 5.9


def test_a_path_shorter_than_a_step_is_doubted(folder, run):
    (folder / "short.csv").write_text("0,0\n0,0.003\n0.0005,0.005\n")
    said = run("walk graph.npz --path short.csv -o out.bvh").err
    assert "short.csv is 0.0051 m long, shorter than a step: is its unit right? --unit" in said


def test_a_deadline_ends_the_search_with_the_best_walk_so_far(folder, run, monkeypatch):
    clock = iter(range(10**9))  # a second goes by whenever the search reads the clock
    monkeypatch.setattr("mocap._shared.deadlines.monotonic", lambda: float(next(clock)))
    said = run("walk graph.npz --path path.csv --deadline 0.2min -o short.bvh")
    assert "mocap: The deadline of 12 s ended the search: the walk covers " in said.err
    said = run("walk graph.npz --path path.csv --deadline 24h -o whole.bvh")
    assert "deadline" not in said.err
    short, whole = load_save.load("short.bvh"), load_save.load("whole.bvh")
    assert len(short) < 0.9 * len(whole)


def test_ctrl_c_ends_the_search_with_another_status_than_a_deadline(folder, run):
    rounds = iter(range(10**9))

    def stop(search, walks):
        if next(rounds) == 8:
            raise KeyboardInterrupt

    token = watching.set(stop)
    try:
        run("walk graph.npz --path path.csv --deadline 24h -o short.bvh", 130)
    finally:
        watching.reset(token)
    assert 0 < load_save.load("short.bvh").duration < 4


def test_clips_are_found_beside_the_graph(clips, run):
    run("graph a.bvh b.bvh -o graph.npz --threshold 5")
    storage.save(storage.load("graph.npz"), "graph.npz")  # without origins
    run("walk graph.npz --random 5s -o out.bvh")
    run("walk graph.npz --random 5s -o out.bvh --clips a.bvh b.bvh")
    (clips / "b.bvh").unlink()
    run("walk graph.npz --random 5s -o out.bvh", 2)


CROWD = "crowd --members 3 --through points.csv --around discs.csv -o crowd"


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_motion_for_each_member_a_plan_and_a_film(folder, run, monkeypatch):
    monkeypatch.setattr("mocap.cli.crowd.find_spec", lambda name: None)  # no imageio-ffmpeg
    asked = {}

    def film(motions, path, **settings):
        asked.update(settings, frames=[len(motion) for motion in motions])
        Image.new("RGB", (9, 9)).save(path)

    monkeypatch.setattr("mocap.widgets.save_animation", film)
    said = run(CROWD).out
    assert "for 3 members" in said and "3 characters" in said and "m apart at least" in said
    members = [f"member-0{number}.bvh" for number in (1, 2, 3)]
    assert names(folder / "crowd") == ["crowd.gif", *members, "plan.png"]
    assert [len(load_save.load(folder / "crowd" / name)) for name in members] == asked["frames"]
    assert len({*asked["frames"]}) == 1
    assert np.allclose(asked["discs"], [[-3, 5, 0.5]]) and asked["fps"] == 12.5


def test_a_graph_of_one_s_own_walks_as_glb_and_other_files_stay(folder, run):
    for name in ("walk_curve_1", "walk_curve_2"):
        load_save.save(resample(samples.sample(name), 30), f"{name}.bvh")
    run("graph walk_curve_1.bvh walk_curve_2.bvh -o own.npz")
    (folder / "crowd").mkdir()
    (folder / "crowd" / "notes.txt").write_text("one's own")
    run(f"{CROWD} --graph own.npz --to glb --no-film")
    members = [f"member-0{number}.glb" for number in (1, 2, 3)]
    assert names(folder / "crowd") == [*members, "notes.txt", "plan.png"]


def test_where_the_way_is_closed_it_sets_out_to_a_side_but_does_not_search_there_for_long(monkeypatch):
    asked = []

    def refuse(group, scene, *, start, most=4000):
        asked.append((most, round(float(np.angle(start.rotation / 1j)), 6)))
        raise NoWalk(f"refused {len(asked)}")

    monkeypatch.setattr("mocap.methods.groups.lead_group", refuse)
    with pytest.raises(NoWalk, match="refused 1"):
        _plan(None, Scene((20j,)))
    assert asked == [(4000, 0.0), (400, 0.5), (400, -0.5), (400, 1.0), (400, -1.0)]


@pytest.mark.parametrize("opens", [True, False])
def test_a_page_without_a_graph_is_that_of_the_bundled_clips_and_opens(tmp_path, run, monkeypatch, opens):
    monkeypatch.chdir(tmp_path)
    small = bundled("walk_circle")  # the whole graph takes seconds
    monkeypatch.setattr("mocap.widgets.walking_page.bundled_graph", lambda: small)
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda page: opened.append(page) or opens)
    said = run("page")
    assert opened == [(tmp_path / "walk.html").as_uri()]
    assert ("open that page yourself" in said.err) == (not opens)
    run("page -o other.html --address https://example.org/a/walk.html")
    assert len(opened) == 1  # only where it is asked for by no option
    page = (tmp_path / "other.html").read_text("utf-8")
    assert '<meta property="og:image" content="https://example.org/a/other.png">' in page
    assert Image.open(tmp_path / "other.png").size == (1200, 630)
