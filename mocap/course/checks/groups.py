"""Checks of notebook 19."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Array, Indices, Points
from mocap.course.check import Check, Mistake


def _squares(a: Points, b: Points) -> Array:
    return np.abs(a[:, None] - b) ** 2


def _assign(a: Points, b: Points) -> Indices:
    return np.asarray(linear_sum_assignment(_squares(a, b))[1])


def _greedy(a: Points, b: Points) -> Indices:
    squares, order = _squares(a, b), np.zeros(len(a), int)
    for _ in a:
        i, j = divmod(int(squares.argmin()), len(b))
        order[i] = j
        squares[i], squares[:, j] = np.inf, np.inf
    return order


def _in_turn(a: Points, b: Points) -> Indices:
    squares, order = _squares(a, b), np.zeros(len(a), int)
    for i in range(len(a)):
        order[i] = squares[i].argmin()
        squares[:, order[i]] = np.inf
    return order


def _draw_assign(rng: np.random.Generator) -> tuple[Points, Points]:
    """Draw two groups that overlap, so that who is nearest to whom is often disputed."""
    a, b = rng.normal(0, 1.5, (2, int(rng.integers(8, 13)), 2)) @ [1, 1j]
    return a, b


assign = Check(
    name="assign",
    asks="for each member of a the number of its member of b, (N,), so that the sum of squares is least",
    start="make the table of squared distances, (N, N), and give it to linear_sum_assignment.",
    draw=_draw_assign,
    truth=_assign,
    mistakes=[
        Mistake(
            lambda a, b: np.argmin(_squares(a, b), axis=1),
            "you give each its nearest; then two may share one, and somebody is left over.",
        ),
        Mistake(
            lambda a, b: np.arange(len(a)),
            "you keep the numbers; but numbers are names, and any member may stand for any other.",
        ),
        Mistake(
            lambda a, b: np.argsort(_assign(a, b)),
            "that is the way back, from b to a: the rows of the table are the members of a.",
        ),
        Mistake(_greedy, "you take the nearest pair again and again; the last pairs must take what is left."),
        Mistake(_in_turn, "the first takes its nearest, and the last must take what is left."),
        Mistake(
            lambda a, b: linear_sum_assignment(np.sqrt(_squares(a, b)))[1],
            "you add up distances; add up their squares.",
        ),
        Mistake(
            lambda a, b: linear_sum_assignment(_squares(a, b), maximize=True)[1],
            "that is the order with the greatest sum, not the least.",
        ),
    ],
)

Laid = tuple[complex, complex]


def _lay(  # noqa: PLR0913 (what mistakes leave out)
    pa: Points, va: Points, pb: Points, vb: Points, *, centred: bool = True, moving: float = 0.49
) -> complex:
    ca, cb = (pa.mean(), pb.mean()) if centred else (0, 0)
    cross = ((pa - ca) * (pb - cb).conj()).sum() + moving * (va * vb.conj()).sum()
    return complex(cross / abs(cross))


def _with_move(turn: complex, pa: Points, pb: Points) -> Laid:
    return turn, complex(pa.mean() - turn * pb.mean())


def _lay_group(pa: Points, va: Points, pb: Points, vb: Points) -> Laid:
    return _with_move(_lay(pa, va, pb, vb), pa, pb)


def _unturned_move(pa: Points, va: Points, pb: Points, vb: Points) -> Laid:
    return _lay(pa, va, pb, vb), complex(pa.mean() - pb.mean())


def _both_centred(pa: Points, va: Points, pb: Points, vb: Points) -> Laid:
    return _with_move(_lay(pa, va - va.mean(), pb, vb - vb.mean()), pa, pb)


def _long(pa: Points, va: Points, pb: Points, vb: Points) -> Laid:
    cross = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum() + 0.49 * (va * vb.conj()).sum()
    return complex(cross), complex(pa.mean() - cross * pb.mean())


def _draw_lay(rng: np.random.Generator) -> tuple[Points, Points, Points, Points]:
    """Draw a group, and the same one turned, moved and shaken."""
    count, turn = int(rng.integers(5, 10)), np.exp(1j * rng.uniform(-3, 3))
    pa = np.asarray(rng.normal(0, 1.5, (count, 2)) @ [1, 1j] + complex(*rng.normal(0, 5, 2)), complex)
    va = np.asarray(1.1 + rng.normal(0, 0.3, (count, 2)) @ [1, 1j], complex)
    shaken = rng.normal(0, 0.5, (2, count, 2)) @ [1, 1j]
    move = complex(*rng.normal(0, 6, 2))
    return pa, va, (pa + shaken[0]) * turn + move, (va + shaken[1]) * turn


lay_group = Check(
    name="lay_group",
    asks="a pair: the turn, a complex number of length 1, and the move",
    start="centre the places of both groups; add up first * conjugate of second, for places and velocities.",
    draw=_draw_lay,
    truth=_lay_group,
    same=lambda given, wanted: bool(
        np.shape(given) == (2,) and np.allclose(np.asarray(given, complex), wanted, rtol=1e-8, atol=1e-9)
    ),
    mistakes=[
        Mistake(
            lambda pa, va, pb, vb: _with_move(_lay(pa, va, pb, vb, centred=False), pa, pb),
            "your places are not centred: subtract each group's mean place before you multiply.",
        ),
        Mistake(
            lambda pa, va, pb, vb: _with_move(_lay(pa, va, pb, vb).conjugate(), pa, pb),
            "you turn the wrong way: the conjugate belongs to the second group.",
        ),
        Mistake(
            lambda pa, va, pb, vb: _with_move(_lay(pa, va, pb, vb, moving=0.0), pa, pb),
            "the velocities are left out: groups may stand alike and walk apart.",
        ),
        Mistake(
            lambda pa, va, pb, vb: _with_move(_lay(pa, va, pb, vb, moving=0.7), pa, pb),
            "the velocities weigh τ², not τ: 0.49.",
        ),
        Mistake(
            lambda pa, va, pb, vb: _with_move(_lay(pa, va, pb, vb, moving=1.0), pa, pb),
            "the velocities weigh τ² = 0.49, not 1.",
        ),
        Mistake(
            _unturned_move,
            "turn the second group's middle before you subtract it: it moves when the group turns.",
        ),
        Mistake(
            _both_centred,
            "do not centre velocities: their mean is the way that the group goes, and that must fit.",
        ),
        Mistake(_long, "a turn has the length 1: divide the sum by its length."),
    ],
)


def _slots(orders: Indices) -> Indices:
    slots = np.arange(orders.shape[1])
    for order in orders:
        slots = order[slots]
    return slots


def _other_way(orders: Indices) -> Indices:
    slots = np.arange(orders.shape[1])
    for order in orders:
        slots = slots[order]
    return slots


def _draw_slots(rng: np.random.Generator) -> tuple[Indices]:
    members, clips = int(rng.integers(5, 9)), int(rng.integers(2, 5))
    return (np.array([rng.permutation(members) for _ in range(clips)]),)


slots = Check(
    name="slots",
    asks="for each member the slot in which it stands after all clips, (N,)",
    start="at first member m stands in slot m; a clip takes whoever stands in slot s to slot order[s].",
    draw=_draw_slots,
    truth=_slots,
    mistakes=[
        Mistake(
            lambda orders: np.argsort(_slots(orders)),
            "that says who stands in each slot; say in which slot each member stands.",
        ),
        Mistake(
            _other_way,
            "that goes through the clips from the last to the first: look each order up by the slot.",
        ),
        Mistake(
            lambda orders: _slots(np.argsort(orders, axis=1)),
            "you go each clip backwards: who starts in slot s ends in slot order[s].",
        ),
        Mistake(lambda orders: orders[-1], "that is the last clip alone; the others renumber members, too."),
        Mistake(lambda orders: orders[0], "that is the first clip alone; go on from there."),
        Mistake(lambda orders: np.arange(orders.shape[1]), "nobody has moved yet: go through the clips."),
    ],
)
