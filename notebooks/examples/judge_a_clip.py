"""Judge clips: which measures stand out beyond captured people, in a clip, a cut, and a body that glides."""

from dataclasses import replace

import mocap
from mocap import datasets
from mocap.quality import judge
from mocap.quality.judging import judgement_table

walk = datasets.sample("walk_straight")[:600]
clips = {
    "as it is": walk,
    "cut": mocap.concatenate([walk[:200], walk[260:]]),  # half a second is missing: a jolt
    "gliding": replace(walk, root_positions=walk.root_positions * [0.7, 1.0, 0.7]),  # feet slide
}
judgements = [judge(replace(clip, name=name), against=[walk]) for name, clip in clips.items()]

print(judgement_table(judgements))  # each measure over its limit: above 1 it stands out
for judged in judgements:
    for measure in judged.measures:
        if measure.ratio > 1:
            print(f"{judged.name}: {measure.name} {measure.value:.3g} {measure.unit} ({measure.where})")
