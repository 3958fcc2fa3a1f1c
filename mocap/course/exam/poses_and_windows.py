"""Questions 1 to 9 of the exam: rotations, windows, grids, transforms and blends, by hand."""

from __future__ import annotations

import numpy as np

from mocap import plain
from mocap.course.exam.drawing import Draws, Question
from mocap.course.exam.wording import complex_number, formula, number, table, texts, vector

AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
SIDES = ("behind", "in front of")
QUARTERS = {90: 1j, -90: -1j}  # rotations on the ground, by their degrees
ROWS = 5  # of the grid
COLUMNS = 6  # of the grid
MINIMA = 2  # of the grid
FRACTIONS = {3: "one third", 4: "one quarter", 5: "one fifth"}
BELOW = 4  # cm: minima are lower
GRID_VALUES = range(2, 8)  # cm
STEEPEST = 1.5  # slope of the cubic weights in the middle, of that of a line
FPS = 30  # frames per second
FULL_TURN = 360  # degrees


def multiplied_quaternion(draws: Draws) -> Question:
    """Question 1: the square of a quaternion, and its power that is a full rotation."""
    degrees = draws.choice("degrees", (60, 90, 120)) * draws.choice("sign", (1, -1))
    axis_name, vector_name, _ = draws.shuffled("axes", list(AXES))
    half = np.radians(degrees) / 2
    quaternion = np.array([np.cos(half), *np.sin(half) * np.array(AXES[axis_name])])
    square = plain.multiply(quaternion, quaternion)
    rotated = plain.rotate(square, np.array(AXES[vector_name], dtype=float))
    power = formula(f"q^{FULL_TURN // abs(degrees)}")
    values = texts(degrees=degrees, axis=axis_name, vector=vector(AXES[vector_name]), power=power)
    values["quaternion"] = formula(f"q = {vector(quaternion)}")
    product = f"$q\\,q$ is {vector(square)}, a rotation by {number(2 * degrees)}° (2)"
    image = f"it rotates {values['vector']} to {vector(rotated)} (1)"
    full_turn = f"{power} is (−1, 0, 0, 0) (1)"
    return Question(values, [product, image, full_turn], ["why it is not (1, 0, 0, 0) (1)"])


def bent_leg(draws: Draws) -> Question:
    """Question 2: the ankle of a leg whose hip and knee are bent."""
    thigh = draws.integer("thigh", 36, 46)  # cm
    shank = draws.integer("shank", 36, 46)  # cm
    hip = thigh + shank + draws.integer("foot", 8, 12)  # cm
    forwards = draws.integer("forwards", 20, 40, 5)  # degrees
    backwards = forwards + draws.integer("backwards", 10, 40, 5)  # degrees
    swing = np.radians(forwards)  # of the thigh from the vertical
    lean = np.radians(backwards - forwards)  # of the shank from the vertical
    height = hip - thigh * np.cos(swing) - shank * np.cos(lean)  # cm
    ahead = thigh * np.sin(swing) - shank * np.sin(lean)
    values = texts(hip=hip, thigh=thigh, shank=shank, forwards=forwards, backwards=backwards)
    side = SIDES[int(ahead > 0)]
    leaning = f"the shank leans {backwards - forwards}° backwards (1)"
    raised = f"the ankle is {number(height, 1)} cm above the ground (2)"
    shifted = f"and {number(abs(ahead), 1)} cm {side} the hip (2)"
    return Question(values, [leaning, raised, shifted], [])


def _pairs(draws: Draws, stretch: float) -> tuple[np.ndarray, np.ndarray]:
    """Draw two pairs of points on the ground, of which the second is longer by `stretch`."""
    length = draws.integer("length", 2, 6, 2)
    start = draws.integer("start", 3, 8) + draws.integer("sideways", 0, 3) * 1j
    turned = QUARTERS[draws.choice("rotation", list(QUARTERS))]
    return np.array([0, length]), np.array([start, start + (length + stretch) * turned])


def _points(ground: np.ndarray) -> np.ndarray:
    """Return points of the ground as x, y and z."""
    return np.stack([ground.imag, np.zeros(len(ground)), ground.real], axis=1)


def _formula(name: str, ground: np.ndarray) -> str:
    """Write the points of a window, as complex numbers."""
    points = ",\\ ".join(complex_number(point) for point in ground)
    return formula(f"{name} = {points}")


def aligned_windows(draws: Draws) -> Question:
    """Question 3: the transform that aligns two windows of equal size."""
    g, h = _pairs(draws, stretch=0)
    rotation, translation = map(complex, plain.align(_points(g), _points(h)))
    values = {"g": _formula("g", g), "h": _formula("h", h)}
    rotated = f"the rotation is {number(np.degrees(np.angle(rotation)))}° (2)"
    coordinates = f"x₀ is {number(translation.imag)} and z₀ is {number(translation.real)}"
    translated = f"the translation is {complex_number(translation)}: {coordinates} (2)"
    return Question(values, [rotated, translated, "the distance is 0 (1)"], [])


def larger_person(draws: Draws) -> Question:
    """Question 4: the distance that remains if the second window is larger."""
    stretch = draws.integer("stretch", 1, 4)
    same_pairs = Draws(draws.key, draws.question - 1)  # those of question 3
    g, h = _pairs(same_pairs, stretch)
    rotation, _ = map(complex, plain.align(_points(g), _points(h)))
    distance = float(plain.window_distance(_points(g), _points(h)))
    values = {"h_larger": _formula("h", h)}
    results = [
        f"the rotation is {number(np.degrees(np.angle(rotation)))}° (2)",
        f"the RMS distance is {number(distance, 2)} m (2)",
    ]
    return Question(values, results, ["why no rotation and no translation remove it (1)"])


def minima_of_grid(draws: Draws) -> Question:
    """Question 5: local minima of a grid, and an entry that would make one disappear."""
    attempt = 0
    grid = _grid(draws, attempt)
    while not _is_clear(grid):
        attempt += 1
        grid = _grid(draws, attempt)
    minima = _minima(grid)
    changes = [f"a neighbour of {cell} to {grid[cell]} or less" for cell in minima]
    changes += [f"{cell} itself to {BELOW} or more" for cell in minima]
    listed = f"the cells are {' and '.join(map(str, minima))}, where the first number is the row (3)"
    to_more = "or itself to a value that is not below all its neighbours"
    changed = f"one of: {'; '.join([*changes, to_more])} (2)"
    return Question({"grid": f"\n\n{table(grid.tolist())}\n\n"}, [listed, changed], [])


def _grid(draws: Draws, attempt: int) -> np.ndarray:
    """Draw a grid."""
    cells = [draws.choice(f"cell {attempt} {cell}", GRID_VALUES) for cell in range(ROWS * COLUMNS)]
    return np.array(cells).reshape(ROWS, COLUMNS)


def _minima(grid: np.ndarray) -> list[tuple[int, int]]:
    """List the inner cells below the threshold of which no neighbour is lower."""
    minima = []
    for row in range(1, ROWS - 1):
        for column in range(1, COLUMNS - 1):
            is_lowest = (_block(grid, row, column) >= grid[row, column]).all()
            if grid[row, column] < BELOW and is_lowest:
                minima.append((row, column))
    return minima


def _block(grid: np.ndarray, row: int, column: int) -> np.ndarray:
    """Return a cell with its eight neighbours."""
    return grid[row - 1 : row + 2, column - 1 : column + 2]


def _is_clear(grid: np.ndarray) -> bool:
    """Return whether a grid has two minima without an equal neighbour, and a low cell that is none."""
    minima = _minima(grid)
    shares_value = [(_block(grid, *cell) == grid[cell]).sum() > 1 for cell in minima]
    low_cells = int((grid[1:-1, 1:-1] < BELOW).sum())
    return len(minima) == MINIMA and not any(shares_value) and low_cells > MINIMA


def moved_root(draws: Draws) -> Question:
    """Question 6: a transform of a clip, and its inverse."""
    ahead = draws.integer("ahead", 2, 6)  # metres
    degrees = draws.choice("degrees", list(QUARTERS))
    rotation = QUARTERS[degrees]
    translation = complex(draws.integer("forward", 1, 4), draws.integer("sideways", 1, 4))
    root = rotation * ahead + translation
    back, shift = plain.inverse(rotation, translation)
    minus_shift = formula(complex_number(-translation))
    values = texts(ahead=ahead, turned=degrees, minus_shift=minus_shift)
    values["factor"] = formula(f"e^{{i\\theta}} = {complex_number(rotation)}")
    values["shift"] = formula(f"m = {complex_number(translation)}")
    coordinates = f"x = {number(root.imag)} m, z = {number(root.real)} m"
    moved = f"the root is at {complex_number(root)}: {coordinates} (2)"
    rotated = f"the inverse rotates by {number(np.degrees(np.angle(back)))}° (1)"
    translated = f"and translates by {complex_number(shift)} (1)"
    return Question(values, [moved, rotated, translated], [f"why its translation is not {minus_shift} (1)"])


def weight_of_blend(draws: Draws) -> Question:
    """Question 7: the weight of a frame in a blend."""
    length = draws.integer("length", 8, 20, 2)  # frames
    frame = draws.integer("frame", 1, length - 3)
    t = (frame + 1) / length
    weight = 2 * t**3 - 3 * t**2 + 1
    values = texts(length=length, frame=formula(f"p = {frame}"))
    weighed = f"$t$ = {number(t)}, and the weight is {number(weight)} (2)"
    steep = f"{number(STEEPEST)} times as steep (2)"
    return Question(values, [weighed, steep], ["the advantage of this curve (1)"])


def slerp_and_line(draws: Draws) -> Question:
    """Question 8: the rotation by linear interpolation of quaternions."""
    angle = draws.integer("apart", 80, 160, 10)  # degrees
    parts = draws.choice("fraction", list(FRACTIONS))
    half = np.radians(angle) / 2
    target = np.array([np.cos(half), np.sin(half)])
    blended = np.array([1, 0]) + (target - [1, 0]) / parts
    rotation = 2 * np.degrees(np.arctan2(blended[1], blended[0]))
    values = texts(apart=angle, fraction=FRACTIONS[parts], slerped=number(angle / parts, 1))
    halves = f"the half angles are 0° and {number(angle / 2)}°, and the line is at {vector(blended)} (2)"
    rotated = f"it has rotated by {number(rotation, 1)}° (2)"
    return Question(values, [halves, rotated, "they agree at one half, and at both ends (1)"], [])


def sliding_foot(draws: Draws) -> Question:
    """Question 9: the foot sliding speed of a blend."""
    gap = draws.integer("gap", 4, 9)  # cm
    frames = draws.integer("frames", 10, 30, 2)
    speed = STEEPEST * gap / (frames / FPS)  # cm per second
    values = texts(gap=gap, frames=frames, twice=2 * frames)
    fastest = f"the maximum speed is {number(speed, 1)} cm per second (2)"
    halved = f"{2 * frames} frames halve it, to {number(speed / 2, 1)} cm per second (1)"
    return Question(
        values, [fastest, halved], ["how it follows from the weights (1)", "what it does not change (1)"]
    )


QUESTIONS = {
    1: multiplied_quaternion,
    2: bent_leg,
    3: aligned_windows,
    4: larger_person,
    5: minima_of_grid,
    6: moved_root,
    7: weight_of_blend,
    8: slerp_and_line,
    9: sliding_foot,
}
"""The functions that draw questions, by their numbers in `exam.md`."""
