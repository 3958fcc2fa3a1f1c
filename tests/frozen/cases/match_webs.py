"""Match webs and the spaces of motions that they find."""

import numpy as np

from mocap import blending, datasets
from mocap.methods import match_webs
from mocap.methods.match_webs.local_alignment import apart
from tests.frozen.cases.feet import WALK
from tests.frozen.cases.strides import hands
from tests.frozen.quantities import case, numbers


@case("apart")
def paths_apart():
    paths = [np.stack([np.arange(20) + start] * 2, axis=1) for start in (0, 12, 14)]
    return {
        f"path {number}": numbers(path, "cell", "side") for number, path in enumerate(apart(paths, near=1))
    }


@case("web")
def web():
    parts = [WALK[:20], datasets.sample("sneak")[:1300], datasets.sample("jog")[:700], WALK[:700]]
    web = match_webs.build_web(parts, below=0.05)
    matches = match_webs.search(web, 3, slice(240, 370))
    quantities = {"cells": numbers(web.cells, "cell", "side")}
    for number, match in enumerate(matches):
        rows_and_frames = np.hstack([match.rows, match.frames])
        quantities[f"match {number}, rows and frames"] = numbers(rows_and_frames, "sample")
    return quantities


@case("space of walks")
def space_of_walks():
    walks = [WALK[start : start + 400] for start in (0, 90, 233, 370)]
    space = hands(blending.register(walks), 10)
    wanted = space.values[5:9] + 0.001
    weights = {
        f"weights, {method}": numbers(match_webs.weights_for(space, wanted, method=method), "target", "walk")
        for method in ("convex", "neighbours")
    }
    values = {
        "values": numbers(space.values, "sample", "parameter"),
        "scale": numbers(space.scale, "parameter"),
    }
    return weights | values
