"""Questions 16 to 27 of the exam: inputs with known results, by which a submitted function is judged.

Each input is built around its result, such as a rotation about a point that is drawn, or a graph whose walks
have drawn durations. A program that would answer the question is therefore not needed here.

A case is the source of a test in Python: it ends in `assert`, and uses `np`, `nx`, `mocap` and `plain`.
"""

from __future__ import annotations

from collections.abc import Iterator

from mocap.course.exam.drawing import Draws

Case = tuple[str, str]
"""A kind of input in words, and the source of its test."""

CLIP = """clip = mocap.Motion(
    mocap.Skeleton({names}, {parents}, {offsets}),
    {roots},
    {rotations},
    30,
)
"""
LATE = 250  # frames: transitions enter clips later than all leave
AXES = ([1, 0, 0], [0, 1, 0], [0, 0, 1], [0.6, 0, 0.8])  # axes of rotations

Cases = Iterator[Case]
Transition = tuple[int, int, int, int, float, tuple[int, int]]


def farthest(draws: Draws) -> Cases:
    """Question 16: an arm is folded in all frames but one, when the hand is farther away than the foot."""
    upper = draws.integer("upper", 25, 35) / 100  # metres
    lower = draws.integer("lower", 20, 24) / 100  # metres
    leg = draws.integer("leg", 40, 44) / 100  # metres
    frames = draws.integer("frames", 5, 12)
    offsets = [[0, 0, 0], [upper, 0, 0], [lower, 0, 0], [0, -leg, 0]]
    body = {"names": ["root", "arm", "hand", "foot"], "parents": [-1, 0, 1, 0], "offsets": offsets}
    roots = f"np.linspace([3, 1, 0], [9, 1, 5], {frames})"
    clip = CLIP.format(**body, roots=roots, rotations="rotations")
    folded = f"rotations = np.tile([1.0, 0, 0, 0], ({frames}, 4, 1))\nrotations[:, 1] = [0, 0, 1, 0]\n"
    stretched = f"rotations[{draws.integer('straight', 1, frames - 1)}, 1] = [1, 0, 0, 0]\n"
    test = "name, metres = farthest(clip)\nassert name == {!r} and np.isclose(metres, {:.2f})"
    yield "always folded, and far from the origin", folded + clip + test.format("foot", leg)
    yield "stretched in one frame", folded + stretched + clip + test.format("hand", upper + lower)


def thinned_error(draws: Draws) -> Cases:
    """Question 17: the root goes straight on, but for one frame that is dropped."""
    step = draws.integer("every", 3, 6)
    count = draws.integer("count", 4, 8)
    spike = draws.integer("spike", 0, count - 1) * step + draws.integer("within", 1, step - 1)
    height = draws.integer("height", 10, 40) / 100  # metres
    rotations = "np.tile([1.0, 0, 0, 0], (len(roots), 1, 1))"
    point = {"names": ["root"], "parents": [-1], "offsets": [[0, 0, 0]]}
    clip = CLIP.format(**point, roots="roots", rotations=rotations)
    straight = f"roots = np.linspace([0, 1, 0], [2, 1, 7], {count * step + 1})\n"
    displaced = f"{straight}roots[{spike}, 1] += {height}\n"
    test = "assert np.isclose(thinned_error(clip, {}), {}, atol=1e-9)"
    yield "a straight line", straight + clip + test.format(step, 0)
    yield "one frame displaced", displaced + clip + test.format(step, height)
    yield "no frame dropped", displaced + clip + test.format(1, 0)


def distance_unturned(draws: Draws) -> Cases:
    """Question 18: points are translated, then displaced in pairs, and all are raised."""
    along_x = draws.integer("x", 10, 50) / 100  # metres
    along_z = draws.integer("z", 10, 50) / 100  # metres
    up = draws.integer("up", 10, 50) / 100  # metres
    east = draws.integer("east", 2, 9)  # metres
    north = draws.integer("north", 2, 9)  # metres
    seed = draws.integer("seed", 0, 999)
    points = f"p = np.random.default_rng({seed}).normal(size=(4, 3))\n"
    moved = f"{points}q = p + [{east}, 0, {north}]\n"
    offsets = [[along_x, 0, 0], [-along_x, 0, 0], [0, 0, along_z], [0, 0, -along_z]]
    rms = ((along_x**2 + along_z**2) / 2 + up**2) ** 0.5
    test = "assert np.isclose(distance_unturned(p, q), {:.9f}, atol=1e-8)"
    yield "translated on the ground", moved + test.format(0)
    yield "raised, which no translation on the ground removes", f"{moved}q[:, 1] += {up}\n" + test.format(up)
    yield "displaced and raised", f"{moved}q += {offsets}\nq[:, 1] += {up}\n" + test.format(rms)
    reversed_points = f"{points}q = p[::-1]\n"
    bound = "assert distance_unturned(p, q) >= plain.window_distance(p, q) - 1e-9"
    yield "not below the distance of the course", reversed_points + bound


def spread_out(draws: Draws) -> Cases:
    """Question 19: one minimum hides its neighbour, which therefore does not hide a third one."""
    reach = draws.integer("apart", 2, 5)
    row = draws.integer("row", 1, 6)
    column = draws.integer("column", 1, 6)
    best = (row, column)
    hidden = (row + reach, column)
    third = (row + 2 * reach, column)
    fourth = (row, column + reach + 1)
    in_order = [best, hidden, third, fourth]
    entries = [f"grid[{cell}] = {cost}\n" for cost, cell in enumerate(in_order, 1)]
    grid = "".join(["grid = np.full((30, 30), 9.0)\n", *entries])
    test = grid + "assert [tuple(map(int, cell)) for cell in spread_out({}, grid, {})] == {}"
    minima = draws.shuffled("order", in_order)
    yield "one alone", test.format([best], reach, [best])
    kept = [best, third, fourth]
    yield "near in rows and in columns, and near a removed one", test.format(minima, reach, kept)
    yield "all apart, the best first", test.format(minima, 0, in_order)


def centre(draws: Draws) -> Cases:
    """Question 20: a rotation about a point that is drawn."""
    point = complex(draws.integer("z", -5, 5), draws.integer("x", 1, 5))
    degrees = draws.integer("degrees", 20, 160, 10)
    rotation = f"rotation = np.exp(1j * np.radians({degrees}))\n"
    translation = f"translation = {point} - rotation * {point}\n"
    yield "a rotation", f"{rotation}{translation}assert np.isclose(centre(rotation, translation), {point})"
    yield "a translation", f"assert centre(1, {draws.integer('shift', 1, 5)}j) is None"


def halfway(draws: Draws) -> Cases:
    """Question 21: rotations about one axis, by angles that are drawn, with either sign."""
    first = draws.integer("first", 0, 60)  # degrees
    second = first + 2 * draws.integer("apart", 20, 80)  # degrees
    axis = draws.choice("axis", AXES)
    quaternion = f"[np.cos(np.radians(degrees) / 2), *np.sin(np.radians(degrees) / 2) * np.array({axis})]"
    rotation = f"def rotation(degrees):\n    return np.array({quaternion})\n\n\n"
    mixed = rotation + "mixed = halfway(rotation({}), {}rotation({}))\n"
    test = "assert np.isclose(abs(mixed @ rotation({})), 1) and np.isclose(np.linalg.norm(mixed), 1)"
    middle = test.format((first + second) / 2)
    yield "less than half a turn apart", mixed.format(first, "", second) + middle
    yield "one with the other sign", mixed.format(first, "-", second) + middle
    yield "equal rotations", mixed.format(first, "", first) + test.format(first)


def longest_wait(draws: Draws) -> Cases:
    """Question 22: transitions leave two clips after drawn gaps."""
    shorter = draws.integer("shorter", 20, 50)  # frames
    longer = shorter + draws.integer("longer", 5, 40)  # frames
    between = _leaving([(0, shorter), (0, shorter + longer), (1, shorter)])
    at_start = _leaving([(0, longer), (0, longer + shorter), (1, shorter)])
    graph = "graph = plain.cut_and_join([range(300), range(300)], {})\n"
    test = f"assert longest_wait(graph) == {longer}"
    yield "the longest wait between two transitions", graph.format(between) + test
    yield "the longest wait from the start of a clip", graph.format(at_start) + test


def _leaving(places: list[tuple[int, int]]) -> list[Transition]:
    """Return transitions that leave two clips at some frames, and enter late in the other clip."""
    return [(clip, frame, 1 - clip, LATE + n, 0.0, (1, 0)) for n, (clip, frame) in enumerate(places)]


def costliest_transition(draws: Draws) -> Cases:
    """Question 23: a loop through two clips, and a small loop in one of them."""
    early = draws.integer("early", 10, 20)
    leave = draws.integer("leave", 60, 80)
    enter = draws.integer("enter", 10, 30)
    back = enter + draws.integer("back", 30, 50)
    ring = [(0, leave, 1, enter, 0.0, (1, 0)), (1, back, 0, early, 0.0, (1, 0))]
    small = (0, leave - 20, 0, early + 5, 0.0, (1, 0))
    graph = f"graph = plain.cut_and_join([range(120), range(120)], {[*ring, small]})\n"
    test = f"assert tuple(costliest_transition(graph)[0]) in {[(0, leave), (1, back)]}"
    yield "without one half of the large loop, only the small one is left", graph + test


def lifetimes(draws: Draws) -> Cases:
    """Question 24: graphs in which every walk has a known duration."""
    seconds = draws.integer("seconds", 20, 40)
    seeds = draws.integer("seeds", 10, 30)
    leave = draws.integer("leave", 60, 90, 10)
    loop = f"plain.prune(plain.cut_and_join([range(120)], [(0, {leave}, 0, 0, 0.0, (1, 0))]))"
    walks = f"walks = lifetimes({{}}, {seconds}, range({seeds}))\nassert len(walks) == {seeds}\n"
    yield "no walk ends", walks.format(loop) + f"assert np.allclose(walks, {seconds})"
    clip = "plain.cut_and_join([range(60)], [])"  # 2 s; a walk that starts at its end has 0 s
    yield "all walks end", walks.format(clip) + "assert set(np.round(walks, 9)) == {0.0, 2.0}"


def within(draws: Draws) -> Cases:
    """Question 25: a chain of drawn durations, with a shorter way round its middle."""
    first = draws.integer("first", 1, 3)  # seconds
    second = draws.integer("second", 4, 6)  # seconds
    shorter = first + second - draws.integer("shorter", 1, 2)  # seconds, from a to c
    edges = [("a", "b", 30 * first), ("b", "c", 30 * second), ("a", "c", 30 * shorter)]
    loop = f"for a, b, frames in {edges}:\n    graph.add_edge(a, b, frames=frames)\n"
    test = f"graph = nx.MultiDiGraph()\n{loop}assert set(within(graph, {{!r}}, {{}})) == {{}}"
    yield "the node itself", test.format("a", 0, "{'a'}")
    yield "exactly as long as an edge", test.format("b", second, "{'b', 'c'}")
    yield "the node of a longer edge is left out", test.format("a", first, "{'a', 'b'}")
    yield "the shorter of two ways", test.format("a", shorter, "{'a', 'b', 'c'}")


def off_line(draws: Draws) -> Cases:
    """Question 26: points at drawn distances from a line with a corner."""
    length = draws.integer("length", 4, 9)  # metres
    width = draws.integer("width", 4, 9)  # metres
    distances = [draws.integer(f"off {place}", 2, 15) / 10 for place in range(4)]  # metres
    first, second, third, fourth = distances
    points = {"between two corners": complex(length / 2, -first), "before the start": complex(-second, 0)}
    points["beside the second part"] = complex(length + third, width / 2)
    points["beyond the end"] = complex(length, width + fourth)
    line = [0, length, complex(length, width)]
    test = "assert np.allclose(off_line({}, {}), {})"
    for (place, point), distance in zip(points.items(), distances, strict=True):
        yield place, test.format([point], line, [distance])
    yield "all points at once", test.format([*points.values()], line, distances)


def steps_to_live(draws: Draws) -> Cases:
    """Question 27: walks that continue with the same probability everywhere, and walks along a chain."""
    tenths = draws.integer("tenths", 5, 9)
    part = draws.integer("part", 1, tenths - 1)
    other_part = tenths - part
    rows = [[part / 10, other_part / 10], [other_part / 10, part / 10]]
    steps = round(tenths / (10 - tenths), 9)  # of a geometric series
    chance = draws.integer("chance", 2, 9) / 10
    chain = [[0, 1, 0], [0, 0, chance], [0, 0, 0]]
    test = "assert np.allclose(steps_to_live(np.array({})), {})"
    yield "the same probability everywhere", test.format(rows, [steps, steps])
    yield "a chain", test.format(chain, [1 + chance, chance, 0])


QUESTIONS = {
    16: farthest,
    17: thinned_error,
    18: distance_unturned,
    19: spread_out,
    20: centre,
    21: halfway,
    22: longest_wait,
    23: costliest_transition,
    24: lifetimes,
    25: within,
    26: off_line,
    27: steps_to_live,
}
"""The functions that build the inputs of questions, by their numbers in `exam.md`."""
