"""Whatever is in an archive, reading gives what it holds or a short sentence, in the memory that it takes."""

import contextlib
import io
import random
import re
import struct
import tracemalloc
import zipfile
from dataclasses import replace
from functools import cache, partial

import networkx as nx
import numpy as np
import pytest
from numpy.lib.format import write_array, write_array_header_1_0

from mocap._shared.archives import pack
from mocap.errors import MocapError
from mocap.files import load_save
from mocap.graphs import build, storage, summary
from mocap.methods.groups import GroupGraph, Scene, build_group, load_group, plan_group, save_group
from mocap.methods.match_webs import MotionSpace, load_web, save_web, search
from mocap.methods.match_webs.webs import MatchWeb
from mocap.methods.parametric_graphs import ParametricController, load_parametric, save_parametric
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.parametric_edges import ParametricEdge
from tests.conftest import SWEEP
from tests.files.test_fuzz import complaints
from tests.refusals import quietly
from tests.strategies import wave

CLIPS = [wave(90, name="a"), wave(70, phase=1.0, name="b", seed=1)]


def save_graph(path, size=1):
    graph = build(CLIPS, window=8, threshold=0.05)
    for a, b, edge in [*graph.graph.edges(data=True)]:
        for key in range(100, 100 + 150 * (size - 1)):
            graph.graph.add_edge(a, b, key, **edge)
    storage.save(graph, path)


def save_amass(path, size=1):
    numbers = np.random.default_rng(1).normal(size=(5, 159))
    numbers = np.tile(numbers, (1 + 400 * (size - 1), 1))
    facts = {"betas": np.zeros(16), "gender": "neutral", "mocap_framerate": 30.0}
    pack(path, {"poses": numbers[:, :156], "trans": numbers[:, 156:], **facts})


def save_motion(path, size=1):
    frames = 90 * (1 + 40 * (size - 1))
    clip = wave(frames, name="walk")
    marks = {name: np.arange(frames) % 3 == 0 for name in ("walk", "jump")}
    skeleton = replace(clip.skeleton, roles={"pelvis": "root"})
    load_save.save(replace(clip, skeleton=skeleton, labels=marks, contacts={"hand": marks["walk"]}), path)


def save_match_web(path, size=1):
    """A web of one path, which may come many times."""
    path_cells = np.stack([np.arange(20), np.arange(100, 120)], axis=1)
    cells = np.tile(path_cells, (9000 * size - 8999, 1))
    offsets = np.arange(0, len(cells) + 1, 20)
    save_web(MatchWeb(tuple(CLIPS), [0, 90, 160], 0.1, cells, np.full(len(cells), 0.05), offsets), path)


def use_match_web(path):
    return quietly(search, load_web(path, CLIPS), 0, slice(2, 18))


def save_spaces(path, size=1):
    """A space of strides that walk straight on, and follow themselves."""
    skeleton = CLIPS[0].skeleton
    grid = np.arange(-8, 29) / 20
    phases = np.ones((4 + 500 * (size - 1), len(grid)))
    poses = np.tile([1.0, 0, 0, 0], (*phases.shape, len(skeleton), 1))
    marks = np.ones((*phases.shape, 1), bool)
    rates = {"seconds": phases * grid, "speeds": 1j * phases, "turning": 0.1 * phases, "heights": phases}
    values = np.ones((len(phases), 2))
    names = skeleton.names[-1:]
    examples = Examples(
        skeleton, 30.0, grid, **rates, poses=poses, contacts=marks, contact_names=names, values=values
    )
    turns = np.linspace(-1, 1, 6)[:, None]
    space = MotionSpace(examples, np.full((6, len(phases)), 1 / len(phases)), turns, np.ones(1), ("turn",))
    graph = nx.DiGraph()
    graph.add_node("walk", space=space)
    edge = ParametricEdge(turns, turns - 1, turns + 1, np.ones(6), np.zeros(6), np.ones(1), 0.02)
    graph.add_edge("walk", "walk", edge=edge)
    save_parametric(graph, path)


def use_spaces(path):
    character = ParametricController(load_parametric(path))
    return np.isfinite([character.step(0.1, 1.0).root_position for _ in range(40)]).all()


@cache
def three():
    return build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)


def save_three(path, size=1):
    group = GroupGraph(three().nodes, three().clips[:6] * (1 + 99 * (size - 1)), 600)
    save_group(group, path)


def use_three(path):
    return plan_group(load_group(path), Scene((4 + 1j,), ((2 - 3j, 0.5),)), most=20).clips


KINDS = {
    "web": (save_match_web, use_match_web),
    "parametric": (save_spaces, use_spaces),
    "group": (save_three, use_three),
    "graph": (save_graph, lambda path: summary(storage.load(path, CLIPS).graph, fps=30).table()),
    "amass": (save_amass, partial(load_save.load, up="z")),
    "motion": (save_motion, load_save.load),
}


@pytest.fixture(scope="module")
def honest(tmp_path_factory):
    """Give the members of an honest file of each kind: {kind: {name: bytes}}."""
    files = {}
    for kind, (save, use) in KINDS.items():
        save(path := tmp_path_factory.mktemp(kind) / "a.npz")
        use(path)
        with zipfile.ZipFile(path) as archive:
            files[kind] = {name: archive.read(name) for name in archive.namelist()}
    return files


def npy(array):
    write_array(file := io.BytesIO(), np.asarray(array), allow_pickle=True)
    return file.getvalue()


def claim(array, data, chance):
    """Write another shape into a header."""
    sizes = [*array.shape, 1][: chance.randrange(1, 4)]
    shape = tuple(size * chance.choice([0, 1, 2, 10**6, 10**15]) for size in sizes)
    header = {"descr": array.dtype.str, "fortran_order": False, "shape": shape}
    write_array_header_1_0(file := io.BytesIO(), header)
    return file.getvalue() + data[128:]


NUMBERS = [0, 1, -1, 2, 7, -(2**63), 2**63 - 1, 2**31, 10**6]
LARGE = [*NUMBERS, np.nan, np.inf, -np.inf, 1e308, 0.5]
WORDS = ["", "a", "walk", "x\n\x1b[31m", "\udc80", '{"path": [0]}', "[" * 9000, "9" * 300]


def numbers(array, data, chance):
    """Change some numbers, or all of them."""
    flat = np.array(array).reshape(-1)
    values = {"U": WORDS, "f": LARGE, "c": LARGE}.get(flat.dtype.kind, NUMBERS)
    values = values if flat.dtype.kind != "O" else [{}]
    for at in chance.sample(range(len(flat)), min(len(flat), chance.choice([1, 1, 3, len(flat)]))):
        with np.errstate(all="ignore"):
            flat[at : at + 1] = np.array([chance.choice(values)]).astype(flat.dtype)
    return npy(flat.reshape(array.shape))


BROKEN = [b"", b"poses", npy({}), npy(np.array([{}, "x"], object)), npy("x"), npy(1), npy(np.zeros(0))]
CHANGES = [
    lambda array, data, chance: chance.choice(BROKEN),
    lambda array, data, chance: data[: chance.randrange(len(data))],
    lambda array, data, chance: chance.choice(
        [data + b"0" * 8, data[:9] + data, data[:8] + b"\xff\xff" + data]
    ),
    lambda array, data, chance: npy(
        np.ones(array.shape, chance.choice([">f8", "<i2", "U3", "c16", "?", "f2", "O"]))
    ),
    lambda array, data, chance: npy(
        chance.choice([np.asfortranarray(array), array[None], array.T, array.ravel()])
    ),
    lambda array, data, chance: npy(array.astype(array.dtype.newbyteorder(">"))),
    lambda array, data, chance: npy(np.repeat(np.atleast_1d(array), chance.choice([0, 2, 3]), axis=0)),
    lambda array, data, chance: npy(np.atleast_1d(array)[:: chance.choice([-1, 2])]),
    claim,
    numbers,
    numbers,
    numbers,
]


def changed(members, chance):
    """Drop, rename, swap or change a member."""
    name, other = chance.choice([*members]), chance.choice([*members])
    data, way = members[name], chance.randrange(10)
    if way == 0:
        return members | {name: members[other], other: data}
    if way == 1:
        return {k: part for k, part in members.items() if k != name} | {chance.choice(["a", other]): data}
    try:
        array = np.load(io.BytesIO(data), allow_pickle=True)
    except Exception:  # it was broken before
        return members
    return members | {name: chance.choice(CHANGES)(array, data, chance)}


def packed(members, compression=zipfile.ZIP_DEFLATED):
    """Zip members, given as pairs of name and data: a name may come twice."""
    with zipfile.ZipFile(file := io.BytesIO(), "w", compression, compresslevel=1) as archive:
        for name, data in members:
            archive.writestr(name, data)
    return bytearray(file.getvalue())


def tampered(honest, chance):
    """Change an archive: its members, how they are packed, its directory, or its bytes."""
    members, way = dict(honest), chance.randrange(16)
    for _ in range(0 if way < 6 else chance.choice([1, 1, 2, 3])):
        members = changed(members, chance)
    pairs = [*members.items()]
    twice = [chance.choice(pairs)] if way == 0 else []
    data = packed(pairs + twice, chance.choice([0, 12]) if way in (1, 6) else 8)
    places = [found.start() for found in re.finditer(rb"PK\x01\x02", data)]
    if way == 2:  # flags
        struct.pack_into("<H", data, chance.choice(places) + 8, 1)
    elif way in (3, 7):  # a packed size, a size, and where it is
        value = chance.choice([chance.randrange(len(data)), 2**32 - chance.randrange(1, 3)])
        struct.pack_into("<I", data, chance.choice(places) + chance.choice([20, 24, 42]), value)
    elif way == 4:
        data = data[: chance.randrange(len(data))]
    elif way == 5:
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return data


@pytest.mark.filterwarnings("error", "ignore:Duplicate name", "ignore:.*betas", "ignore:An older mocap")
@pytest.mark.parametrize("count", [500, pytest.param(20_000, marks=pytest.mark.exhaustive)])
def test_tampered_archives_are_read_or_refused_in_a_sentence(honest, tmp_path, count):
    for start, (kind, (_, use)) in enumerate(KINDS.items()):
        chances = map(random.Random, range(start, count, len(KINDS)))
        texts = (bytes(tampered(honest[kind], chance)) for chance in chances)
        refused = complaints(use, tmp_path / "a.npz", texts)
        assert 0.4 * count < len(KINDS) * refused < 0.98 * count, kind


UNREAD = {"betas.npy", "gender.npy"}  # of AMASS: whatever they claim, nothing is read of them


def peak(read, path, name=""):
    """Give the bytes that it takes to refuse a file, whose member of that name is wrong."""
    tracemalloc.start()
    try:
        with contextlib.suppress(MocapError) if name in UNREAD else pytest.raises(MocapError):
            read(path)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("kind", KINDS)
def test_what_claims_more_than_there_is_takes_no_memory(tmp_path, kind):
    save, use = KINDS[kind]
    save(path := tmp_path / "a.npz", 2)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    honest = sum(map(len, members.values()))
    for name in sorted(members, key=lambda name: -len(members[name]))[: 99 if SWEEP else 1]:
        array = np.atleast_1d(np.load(io.BytesIO(members[name])))
        if array.size:
            zeros = npy(np.zeros((10 * honest // array[:1].nbytes, *array.shape[1:]), array.dtype))
            for part in (zeros, zeros[:128] + members[name][128:]):  # it does, and it does not hold them
                path.write_bytes(packed([*(members | {name: part}).items()]))
                assert peak(use, path, name) < 4 * honest, name
