"""Blend two clips: register them in time and on the ground, then average their poses, and fade between them."""

import mocap
from mocap import blending, datasets, quality

names = ("walk_straight", "sneak")
walk, sneak = (mocap.resample(datasets.sample(name)[:480], 30) for name in names)

# Registration finds which frames belong together (a time warp), and aligns them on the ground.
registration = blending.register([walk, sneak])

for weight in (0.25, 0.5, 0.75):  # of the sneaking walk
    blend = blending.mix(registration, [1 - weight, weight])
    judged = quality.judge(blend, against=[walk, sneak])
    worst = judged.worst
    print(
        f"{weight:.2f} sneaking: {blend.duration:.1f} s; worst measure {worst.name}, {worst.ratio:.2f} × its limit"
    )
    mocap.save(blend, f"blend_{100 * weight:.0f}.bvh")

mocap.save(blending.crossfade(registration, seconds=1.0), "from_walk_to_sneak.bvh")
