import numpy as np


def other_way_round(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    px, py, pz = points.T
    return np.column_stack([px * c - pz * s + x, py, pz * c + px * s + z])


def moved_and_then_turned(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return (points + np.array([x, 0, z])) @ matrix.T


def lifted(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    moved = points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    moved[:, 0] += x
    moved[:, 1] += z
    return moved


def turned_only(points, angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


def all_signs(angle, x, z):
    return -angle, -x, -z


def shift_turned_on(angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return -angle, -(x * c + z * s), -(z * c - x * s)


def shift_kept_its_sign(angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return -angle, x * c - z * s, z * c + x * s


def same_turn_again(angle, x, z):
    c, s = np.cos(angle), np.sin(angle)
    return angle, -(x * c - z * s), -(z * c + x * s)


def differences(moving, target):
    return tuple(np.array(target) - np.array(moving))


def the_target_moves(moving, target):
    turn = moving[0] - target[0]
    c, s = np.cos(turn), np.sin(turn)
    x, z = target[1] * c + target[2] * s, target[2] * c - target[1] * s
    return turn, moving[1] - x, moving[2] - z


def turned_away(moving, target):
    turn = moving[0] - target[0]
    c, s = np.cos(turn), np.sin(turn)
    x, z = moving[1] * c + moving[2] * s, moving[2] * c - moving[1] * s
    return turn, target[1] - x, target[2] - z


def the_whole_heading(moving, target):
    turn = target[0]
    c, s = np.cos(turn), np.sin(turn)
    x, z = moving[1] * c + moving[2] * s, moving[2] * c - moving[1] * s
    return turn, target[1] - x, target[2] - z


def with_the_height(roots, angle, spot):
    turned = move_about_origin(roots, angle)
    return turned - turned[0] + spot


def on_the_floor(roots, angle, spot):
    turned = move_about_origin(roots, angle)
    turned += spot - turned[0]
    turned[:, 1] = 0
    return turned


def first_root_on_the_floor(roots, angle, spot):
    turned = move_about_origin(roots, angle)
    return turned - turned[0] + [spot[0], 0, spot[2]]


def put_and_then_turned(roots, angle, spot):
    placed = roots - [roots[0, 0], 0, roots[0, 2]] + [spot[0], 0, spot[2]]
    return move_about_origin(placed, angle)


def put_the_other_way_round(roots, angle, spot):
    turned = move_about_origin(roots, -angle)
    return turned + np.array([spot[0] - turned[0, 0], 0, spot[2] - turned[0, 2]])


def put_without_turn(roots, angle, spot):
    return roots + np.array([spot[0] - roots[0, 0], 0, spot[2] - roots[0, 2]])


def put_in_place(roots, angle, spot):
    roots -= roots[0]
    return roots


def move_about_origin(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


WRONG = {
    "move_points": [
        (other_way_round, "sign of θ"),
        (moved_and_then_turned, "turn first"),
        (lifted, "the height"),
        (turned_only, "not moved"),
    ],
    "undo": [
        (all_signs, "wrong order"),
        (shift_turned_on, "turned the wrong way"),
        (shift_kept_its_sign, "sign of the shift"),
        (same_turn_again, "sign of the angle"),
    ],
    "lay_on": [
        (differences, "about the origin"),
        (the_target_moves, "`moving` that should move"),
        (turned_away, "sign of the angle"),
        (the_whole_heading, "a heading already"),
    ],
    "put_over": [
        (with_the_height, "bug one is still there"),
        (on_the_floor, "heights are lost"),
        (first_root_on_the_floor, "by that of the first root"),
        (put_and_then_turned, "away from the spot"),
        (put_the_other_way_round, "sign of the turn"),
        (put_without_turn, "not turned"),
        (put_in_place, "changes its arguments"),
    ],
}
