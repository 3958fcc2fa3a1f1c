from itertools import pairwise

import numpy as np


def summed(track, path, along, step):
    cost, s = 0.0, along
    for before, here in pairwise(track):
        s += step(np.linalg.norm(here - before))
        cost += ((here - path(s)) ** 2).sum()
    return cost, s


def may_stand(track, path, along, least):
    return summed(track, path, along, lambda step: step)


def floor_added(track, path, along, least):
    return summed(track, path, along, lambda step: step + least)


def from_zero(track, path, along, least):
    return summed(track, path, 0, lambda step: max(step, least))


def averaged(track, path, along, least):
    cost, s = summed(track, path, along, lambda step: max(step, least))
    return cost / len(track[1:]), s


def not_squared(track, path, along, least):
    cost, s = 0.0, along
    for before, here in pairwise(track):
        s = max(s + np.linalg.norm(here - before), s + least)
        cost += np.linalg.norm(here - path(s))
    return cost, s


def one_each(stand, costs, order, columns=slice(None)):
    kept = {}
    for walk in order:
        kept.setdefault(tuple(stand[walk][columns]), walk)
    return list(kept.values())


def only_cheap(stand, costs, width):
    return sorted(range(len(costs)), key=lambda walk: costs[walk])[:width]


def only_dominance(stand, costs, width):
    return one_each(stand, costs, np.argsort(costs))


def cut_too_soon(stand, costs, width):
    return one_each(stand, costs, np.argsort(costs)[:width])


def whoever_came_first(stand, costs, width):
    return sorted(one_each(stand, costs, range(len(costs))), key=lambda walk: costs[walk])[:width]


def never_mind_the_heading(stand, costs, width):
    return one_each(stand, costs, np.argsort(costs), slice(3))[:width]


def by_number(stand, costs, width):
    return sorted(one_each(stand, costs, np.argsort(costs))[:width])


def longer(walk, edges, path, least, wrong=""):
    turn, move, along, cost = walk
    found = []
    for end, track, edge_turn, edge_move, price in edges:
        placed = track if wrong == "unplaced" else track * turn + move
        rows = np.column_stack(
            [placed.real, placed.imag] if wrong == "swapped" else [placed.imag, placed.real]
        )
        more, s = summed(rows, path, 0.0 if wrong == "start" else along, lambda step: max(step, least))
        new_turn = turn if wrong == "turn" else edge_turn * turn
        new_move = move + edge_move if wrong == "move" else edge_move * turn + move
        total = more + (wrong != "alone") * cost + (wrong != "free") * price
        found.append((end, new_turn, new_move, s - along if wrong == "difference" else s, total))
    return found


def wrongly(how):
    return lambda walk, edges, path, least: longer(walk, edges, path, least, how)


WRONG = {
    "edge_cost": [
        (may_stand, "stand for ever"),
        (floor_added, "it is a minimum"),
        (from_zero, "continue from `along`"),
        (averaged, "that is a mean"),
        (not_squared, "sums their squares"),
    ],
    "survivors": [
        (only_cheap, "the beam alone"),
        (only_dominance, "dominance alone"),
        (cut_too_soon, "apply dominance first"),
        (whoever_came_first, "the first in the list"),
        (never_mind_the_heading, "turned differently"),
        (by_number, "the cheapest first"),
    ],
    "lengthen": [
        (wrongly("unplaced"), "in the coordinates of its clip"),
        (wrongly("swapped"), "x and z are swapped"),
        (wrongly("move"), "add turn · move"),
        (wrongly("turn"), "the turn stays as it was"),
        (wrongly("alone"), "the edge alone"),
        (wrongly("free"), "price of the edge"),
        (wrongly("start"), "not at its beginning"),
        (wrongly("difference"), "not the difference"),
    ],
}
