"""Match a clip against itself, join it where two moments are most similar, and close a stride into a loop."""

import numpy as np

import mocap
from mocap import blending, datasets, editing, matching, quality

clip = mocap.resample(datasets.sample("walk_circle"), 30)
grid = matching.distance_grid(clip, clip, window=10)  # mean squared distance of all windows, m²
minima = matching.local_minima(grid, below=0.04**2)
apart = minima[np.abs(minima[:, 0] - minima[:, 1]) > 30]  # not a window and its neighbour
i, j = min(apart.tolist(), key=lambda pair: grid[tuple(pair)])
print(f"frames {i} and {j} are similar: {100 * np.sqrt(grid[i, j]):.1f} cm")

joined = blending.join(clip, i, clip, j, 10)  # blends frames i to i + 9 into j to j + 9
print(f"joined: worst measure {quality.judge(joined, against=[clip]).worst.name}")
mocap.save(joined, "joined.bvh")

loop = editing.loop(clip)  # the best cycle of the clip, closed by a blend
print(f"a loop of {loop.duration:.2f} s")
mocap.save(loop, "loop.bvh")
