import numpy as np


def both_ways(grid):
    wide = np.pad(grid.astype(float), 1, constant_values=np.inf)
    low = (grid <= wide[1:-1, :-2]) & (grid <= wide[1:-1, 2:])
    return low & (grid <= wide[:-2, 1:-1]) & (grid <= wide[2:, 1:-1])


def strictly(grid):
    wide = np.pad(grid.astype(float), 1, constant_values=np.inf)
    row = (grid < wide[1:-1, :-2]) & (grid < wide[1:-1, 2:])
    return row | ((grid < wide[:-2, 1:-1]) & (grid < wide[2:, 1:-1]))


def rows_only(grid):
    wide = np.pad(grid.astype(float), 1, constant_values=np.inf)
    return (grid <= wide[1:-1, :-2]) & (grid <= wide[1:-1, 2:])


def columns_only(grid):
    return rows_only(grid.T).T


def eight(grid):
    wide = np.pad(grid.astype(float), 1, constant_values=np.inf)
    n, m = grid.shape
    return np.all([grid <= wide[i : i + n, j : j + m] for i in range(3) for j in range(3)], axis=0)


def endless(query, matches_of, same):
    found = [query]
    for match in found:
        found += [other for _, other in sorted(matches_of(match))]
    return found


def one_step(query, matches_of, same):
    found = [query]
    for _, match in sorted(matches_of(query)):
        if not any(same(match, other) for other in found):
            found.append(match)
    return found


def all_steps(query, matches_of, same, found, nearest=True):
    asking = [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), reverse=not nearest)
        asking = []
        for _, match in new:
            if not any(same(match, other) for other in found):
                found.append(match)
                asking.append(match)
    return found


def without_query(query, matches_of, same):
    return all_steps(query, matches_of, same, [query])[1:]


def query_twice(query, matches_of, same):
    return [query, *all_steps(query, matches_of, same, [])]


def farthest_first(query, matches_of, same):
    return all_steps(query, matches_of, same, [query], nearest=False)


def inverse(distances):
    raw = 1 / np.maximum(distances, 1e-12)
    return raw / raw.sum()


def inverse_guarded(distances):
    if distances[0] == 0:
        return np.eye(len(distances))[0]
    return (1 / distances) / (1 / distances).sum()


def squared(distances):
    if distances[0] == 0:
        return np.eye(len(distances))[0]
    return distances**-2 / (distances**-2).sum()


def not_divided(distances):
    if distances[0] == 0:
        return np.eye(len(distances))[0]
    return 1 / distances - 1 / distances[-1]


def no_hit(distances):
    with np.errstate(all="ignore"):
        raw = 1 / distances - 1 / distances[-1]
        return raw / raw.sum()


def straight(distances):
    if distances[0] == 0:
        return np.eye(len(distances))[0]
    raw = distances[-1] - distances
    return raw / raw.sum()


WRONG = {
    "is_minimum": [
        (both_ways, "one of them is enough"),
        (strictly, "'no higher' is <=, not <"),
        (rows_only, "along the rows only"),
        (columns_only, "along the columns only"),
        (eight, "all eight neighbours"),
    ],
    "spread": [
        (endless, "does not end"),
        (one_step, "what was found is a query, too"),
        (without_query, "as its first item"),
        (query_twice, "in the list twice"),
        (farthest_first, "the farther one was kept"),
    ],
    "neighbour_weights": [
        (inverse, "that is 1 / d:"),
        (inverse_guarded, "that is 1 / d:"),
        (squared, "that is 1 / d²"),
        (not_divided, "do not add up to one"),
        (no_hit, "the weights are NaN"),
        (straight, "that is d_k - d"),
    ],
}
