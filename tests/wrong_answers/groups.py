import numpy as np
from scipy.optimize import linear_sum_assignment


def table(a, b):
    return np.array([[abs(one - other) for other in b] for one in a])


def nearest_of_each(a, b):
    return [row.argmin() for row in table(a, b)]


def same_numbers(a, b):
    return list(range(len(a)))


def from_b(a, b):
    return linear_sum_assignment(table(b, a) ** 2)[1]


def in_turn(a, b):
    """The first takes its nearest, the next one the nearest that is left."""
    free, order = set(range(len(b))), []
    for one in a:
        order.append(min(free, key=lambda k: abs(one - b[k])))
        free.remove(order[-1])
    return order


def closest_pair_first(a, b):
    pairs = sorted((far, i, j) for i, row in enumerate(table(a, b)) for j, far in enumerate(row))
    order = {}
    for _, i, j in pairs:
        if i not in order and j not in order.values():
            order[i] = j
    return [order[i] for i in range(len(a))]


def not_squared(a, b):
    return linear_sum_assignment(table(a, b))[1]


def farthest(a, b):
    return linear_sum_assignment(-(table(a, b) ** 2))[1]


def laid(turn, pa, pb):
    turn = turn / abs(turn)
    return turn, pa.mean() - turn * pb.mean()


def cross(pa, va, pb, vb, moving=0.49):
    a, b = pa - pa.mean(), pb - pb.mean()
    return np.sum(a * np.conj(b)) + moving * np.sum(va * np.conj(vb))


def not_centred(pa, va, pb, vb):
    return laid(np.sum(pa * np.conj(pb)) + 0.49 * np.sum(va * np.conj(vb)), pa, pb)


def wrong_way(pa, va, pb, vb):
    return laid(np.conj(cross(pa, va, pb, vb)), pa, pb)


def places_only(pa, va, pb, vb):
    return laid(cross(pa, va, pb, vb, 0), pa, pb)


def seconds_not_squared(pa, va, pb, vb):
    return laid(cross(pa, va, pb, vb, 0.7), pa, pb)


def unweighted(pa, va, pb, vb):
    return laid(cross(pa, va, pb, vb, 1), pa, pb)


def middles_apart(pa, va, pb, vb):
    turn, _ = laid(cross(pa, va, pb, vb), pa, pb)
    return turn, pa.mean() - pb.mean()


def centred_velocities(pa, va, pb, vb):
    return laid(cross(pa, va - va.mean(), pb, vb - vb.mean()), pa, pb)


def not_a_turn(pa, va, pb, vb):
    turn = cross(pa, va, pb, vb)
    return turn, pa.mean() - turn * pb.mean()


def who_stands_there(orders):
    here = list(range(len(orders[0])))
    for order in orders:
        there = list(here)
        for slot, member in enumerate(here):
            there[order[slot]] = member
        here = there
    return here


def last_to_first(orders):
    slots = np.arange(len(orders[0]))
    for order in reversed(list(orders)):
        slots = order[slots]
    return slots


def each_backwards(orders):
    slots = list(range(len(orders[0])))
    for order in orders:
        slots = [list(order).index(slot) for slot in slots]
    return slots


def last_only(orders):
    return orders[len(orders) - 1]


def first_only(orders):
    return list(orders[0])


def unmoved(orders):
    return list(range(orders.shape[1]))


WRONG = {
    "assign": [
        (nearest_of_each, "two may share one"),
        (same_numbers, "numbers are names"),
        (from_b, "the way back, from b to a"),
        (closest_pair_first, "the nearest pair again and again"),
        (in_turn, "the first takes its nearest"),
        (not_squared, "add up their squares"),
        (farthest, "the greatest sum"),
    ],
    "lay_group": [
        (not_centred, "not centred"),
        (wrong_way, "turn the wrong way"),
        (places_only, "velocities are left out"),
        (seconds_not_squared, "τ², not τ"),
        (unweighted, "τ² = 0.49, not 1"),
        (middles_apart, "turn the second group's middle"),
        (centred_velocities, "do not centre velocities"),
        (not_a_turn, "a turn has the length 1"),
    ],
    "slots": [
        (who_stands_there, "in which slot each member stands"),
        (last_to_first, "from the last to the first"),
        (each_backwards, "each clip backwards"),
        (last_only, "the last clip alone"),
        (first_only, "the first clip alone"),
        (unmoved, "nobody has moved yet"),
    ],
}
