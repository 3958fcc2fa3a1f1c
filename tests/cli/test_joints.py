"""Limbs under unknown names: found, printed by `mocap info --joints`, and corrected by `--joints`."""

import tomllib
from dataclasses import replace

import pytest

from mocap import datasets
from mocap.body import Skeleton, find_legs
from mocap.body.limbs import roles
from mocap.cli.main import main
from mocap.files import load_save
from tests.editing.bodies import renamed

WALK = datasets.sample("walk_straight")[:360:2]
NUMBERS = {name: f"bone{number:02d}" for number, name in enumerate(WALK.skeleton.names)}
LEFT_HIP = NUMBERS["lfemur"]
BALLS = {"left ball": NUMBERS["ltoes_end"], "right ball": NUMBERS["rtoes_end"]}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Stand in a folder with a clip whose joints have numbers for names, a usual clip, and a line."""
    load_save.save(renamed(WALK, NUMBERS), tmp_path / "numbers.bvh")
    load_save.save(WALK, tmp_path / "usual.bvh")
    (tmp_path / "line.csv").write_text("0,0\n0,1\n0.5,2\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def roles_of(text):
    """Read the roles that were printed."""
    return tomllib.loads(text)


def test_roles_that_are_printed_are_those_of_the_same_walk_with_known_names(folder, run):
    found = roles_of(run("info numbers.bvh --joints").out)
    known = roles_of(run("info usual.bvh --joints").out)
    numbered = {role: NUMBERS.get(name, "") for role, name in known.items()}
    differing = {role for role in known if numbered[role] != found[role]}
    assert differing == {"left wrist", "right wrist", "left tip", "right tip"}  # by names there are no tips


def test_roles_given_back_change_nothing(folder, run):
    (folder / "map.toml").write_text(run("info numbers.bvh --joints").out)
    run("bend numbers.bvh --along line.csv -o without.bvh")
    run("bend numbers.bvh --along line.csv --joints map.toml -o with.bvh")
    assert (folder / "with.bvh").read_bytes() == (folder / "without.bvh").read_bytes()


def test_commands_take_the_roles_that_are_given(folder, run):
    lines = [f'"{role}" = "{name}"' for role, name in BALLS.items()]
    (folder / "map.toml").write_text("\n".join(lines))
    usual = load_save.load("numbers.bvh")
    longer = load_save.load("numbers.bvh", roles="map.toml")
    assert longer.skeleton == load_save.load("numbers.bvh", roles=BALLS).skeleton
    assert [leg.ball for leg in find_legs(longer.skeleton)] == [
        longer.skeleton.index(name) for name in BALLS.values()
    ]
    assert {**roles(usual.skeleton), **roles(longer.skeleton)} != roles(usual.skeleton)
    run("loop numbers.bvh --clean -o usual_loop.bvh")
    run("loop numbers.bvh --clean --joints map.toml -o loop.bvh")


def test_a_map_is_for_the_bodies_that_have_its_joints(folder, run):
    (folder / "numbers.toml").write_text(f'"left hip" = "{LEFT_HIP}"')
    (folder / "usual.toml").write_text('"left hip" = "lfemur"')
    done = run("retarget usual.bvh --to numbers.bvh --joints numbers.toml --joints usual.toml -o worn")
    assert "1 of 1" in done.out
    worn = load_save.load("worn/usual.bvh")
    assert worn.skeleton.names == tuple(NUMBERS.values())


def test_a_map_of_a_body_that_shares_joints_is_left_out_with_a_warning(folder, run):
    half = {
        name: number for name, number in NUMBERS.items() if name[1:] in ("femur", "tibia", "foot", "toes")
    }
    load_save.save(renamed(WALK, half), "half.bvh")
    (folder / "half.toml").write_text(run("info half.bvh --joints").out)
    told = run("retarget half.bvh --to usual.bvh --joints half.toml -o worn").err
    assert "half.toml: the clip has no joint" in told
    assert "are not used for it" in told


def test_a_map_works_where_a_graph_reads_the_clips(folder, run):
    (folder / "map.toml").write_text(run("info numbers.bvh --joints").out)
    run("graph numbers.bvh --joints map.toml --threshold 12 -o g.npz")
    run("walk g.npz --random 1s --clean --joints map.toml -o walk.bvh")
    run("page g.npz --joints map.toml -o walk.html")
    assert (folder / "walk.bvh").exists()


def test_a_graph_stores_the_roles_that_it_was_built_with(folder, run):
    lines = [f'"{role}" = "{name}"' for role, name in BALLS.items()]
    (folder / "map.toml").write_text("\n".join(lines))
    run("graph numbers.bvh --mirror --joints map.toml --threshold 12 -o graph.npz")
    run("graph numbers.bvh --mirror --threshold 12 -o found.npz")
    walks = {"stored": "graph.npz", "given": "found.npz --joints map.toml", "found": "found.npz"}
    walks["clips"] = "graph.npz --clips numbers.bvh"
    walks["replaced"] = "graph.npz --joints found.toml"
    (folder / "found.toml").write_text(run("info numbers.bvh --joints").out)
    for name, arguments in walks.items():
        run(f"walk {arguments} --random 1s --clean -o {name}.bvh")
    texts = {name: (folder / f"{name}.bvh").read_bytes() for name in walks}
    assert texts["stored"] == texts["given"] == texts["clips"]
    assert texts["found"] == texts["replaced"] != texts["stored"]


def test_a_file_that_cannot_store_roles_that_are_given_says_so(folder, run):
    (folder / "found.toml").write_text(run("info numbers.bvh --joints").out)
    lines = [f'"{role}" = "{name}"' for role, name in BALLS.items()]
    (folder / "map.toml").write_text("\n".join(lines))
    said = "a .bvh cannot store the roles of joints: commands that read it need --joints again."
    assert f"cut.bvh: {said}" in run("cut numbers.bvh --joints map.toml -o cut.bvh").err
    assert said in run("bend numbers.bvh --along line.csv --joints map.toml -o bent.bvh").err
    assert said not in run("cut numbers.bvh --joints map.toml -o cut.glb").err
    assert said not in run("cut numbers.bvh --joints found.toml -o cut.bvh").err
    assert said not in run("cut usual.bvh -o cut.bvh").err


def test_legs_that_are_not_found_have_the_option_as_remedy(folder, capsys):
    legless = Skeleton(["hips", "chest", "head"], [-1, 0, 1], [[0, 0, 0], [0, 0.5, 0], [0, 0.3, 0]])
    pole = replace(WALK, skeleton=legless, rotations=WALK.rotations[:, :3], contacts={})
    load_save.save(pole, "pole.bvh")
    assert main(["bend", "pole.bvh", "--along", "line.csv", "-o", "bent.bvh"]) == 2
    told = capsys.readouterr().err
    assert "No legs found among hips, chest, head" in told
    assert "name them by --joints" in told
    assert "roles=" not in told


WRONG = {
    "no_toml": ("left hip = bone02", "expected TOML, got"),
    "number": ("pelvis = 3", "got pelvis = 3"),
    "role": (f'"left foot" = "{LEFT_HIP}"', "No role 'left foot'; there are pelvis"),
    "joint": (f'"left hip" = "{LEFT_HIP}"\n"left knee" = "shin"', "map.toml: the clip has no joint 'shin'"),
}


@pytest.mark.parametrize("kind", WRONG)
def test_a_wrong_map_is_refused(folder, capsys, kind):
    text, sentence = WRONG[kind]
    (folder / "map.toml").write_text(text)
    assert main(["bend", "numbers.bvh", "--along", "line.csv", "--joints", "map.toml", "-o", "b.bvh"]) == 2
    assert sentence in capsys.readouterr().err
