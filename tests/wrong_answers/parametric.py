"""Notebook 17. Each mistake shows in all random draws; units compared as they are, in 63 % of them."""

import numpy as np


def walk(speed, turning, dt, late=False):
    places, heading = [0j], 0.0
    for v, w in zip(speed, turning, strict=True):
        heading += w * dt if late else 0
        places.append(places[-1] + v * np.exp(1j * heading) * dt)
        heading += 0 if late else w * dt
    return np.array(places)


def places_mixed(speeds, turnings, weights, dt):
    return sum(w * walk(v, t, dt) for w, v, t in zip(weights, speeds, turnings, strict=True))


def world_velocities(speeds, turnings, weights, dt):
    heading = np.cumsum(turnings * dt, axis=1) - turnings * dt
    return np.concatenate([[0], np.cumsum(weights @ (speeds * np.exp(1j * heading)) * dt)])


def turned_first(speeds, turnings, weights, dt):
    return walk(weights @ speeds, weights @ turnings, dt, late=True)


def never_turned(speeds, turnings, weights, dt):
    return np.concatenate([[0], np.cumsum(weights @ speeds) * dt])


def one_clip(speeds, turnings, weights, dt):
    best = weights.argmax()
    return walk(speeds[best], turnings[best], dt)


def without_start(speeds, turnings, weights, dt):
    return walk(weights @ speeds, weights @ turnings, dt)[1:]


def whole_box(good, bad, scale, eps):
    return good.min(axis=0), good.max(axis=0)


def cut(good, bad, scale, eps, unit=1.0, sides=1, largest=False, keep=1.0):
    low, high = good.min(axis=0).copy(), good.max(axis=0).copy()
    for x in bad:
        room = keep * eps * scale
        if np.all(x > low - room) and np.all(x < high + room):
            lost = [(x[a] - low[a]) / unit[a] for a in (0, 1)] + [(high[a] - x[a]) / unit[a] for a in (0, 1)]
            order = np.argsort(lost)[::-1] if largest else np.argsort(lost)
            axes = set()
            for side in order:
                if len(axes) < sides and side % 2 not in axes:
                    axes.add(side % 2)
                    if side < 2:
                        low[side % 2] = x[side % 2] + room[side % 2]
                    else:
                        high[side % 2] = x[side % 2] - room[side % 2]
    return low, high


def both_axes(good, bad, scale, eps):
    return cut(good, bad, scale, eps, unit=scale, sides=2)


def mixed_units(good, bad, scale, eps):
    return cut(good, bad, scale, eps, unit=np.ones(2))


def on_the_edge(good, bad, scale, eps):
    return cut(good, bad, scale, eps, unit=scale, keep=0.0)


def loses_most(good, bad, scale, eps):
    return cut(good, bad, scale, eps, unit=scale, largest=True)


def looked_up(asked, at, low, high, k, shares):
    gaps = np.abs(at - asked)
    near = np.argsort(gaps)[:k]
    weights = shares(gaps[near])
    return weights @ low[near], weights @ high[near]


def kth_counts(asked, at, low, high, k):
    return looked_up(asked, at, low, high, k, lambda g: (1 / g) / (1 / g).sum())


def nearest_off(asked, at, low, high, k):
    return looked_up(asked, at, low, high, k, lambda g: (1 / g - 1 / g[0]) / (1 / g - 1 / g[0]).sum())


def not_divided(asked, at, low, high, k):
    return looked_up(asked, at, low, high, k, lambda g: 1 / g - 1 / g[-1])


def gaps_themselves(asked, at, low, high, k):
    return looked_up(asked, at, low, high, k, lambda g: g / g.sum())


def nearest_only(asked, at, low, high, k):
    best = np.abs(at - asked).argmin()
    return low[best], high[best]


WRONG = {
    "mixed_way": [
        (places_mixed, "walks to opposite sides cancel"),
        (world_velocities, "walks to opposite sides cancel"),
        (turned_first, "the heading of frame 0 is 0"),
        (never_turned, "the way never turns"),
        (one_clip, "largest weight alone"),
        (without_start, "one place more than steps"),
    ],
    "shrink_box": [
        (whole_box, "bad ones are still inside"),
        (both_axes, "one side is enough"),
        (mixed_units, "divide each loss by its scale"),
        (on_the_edge, "keep eps · scale off it"),
        (loses_most, "the one that loses least"),
    ],
    "box_at": [
        (kth_counts, "take 1/ε_k off"),
        (nearest_off, "take the farthest one's"),
        (not_divided, "divide by their sum"),
        (gaps_themselves, "take 1/ε, not ε"),
        (nearest_only, "the nearest sample's box"),
    ],
}
