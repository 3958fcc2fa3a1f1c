"""The pairs of a blind test, and what stands in the page."""

import base64
import zlib

import numpy as np
import pytest

from mocap import datasets
from mocap.body import joint_positions
from mocap.course import lab
from mocap.course.lab.blind_tests import STEP, BlindTest, Plan, choose, make_pairs, packed
from mocap.errors import MocapError
from mocap.matching import find_transitions
from mocap.plotting import bones
from tests.refusals import refused


@pytest.fixture(scope="module")
def material():
    clips = [datasets.sample(name)[:2400:4] for name in ("walk_circle", "walk_curve_1")]
    return clips, find_transitions(clips, window=10, below=0.06)


def test_the_same_seed_gives_the_same_pairs_and_another_one_others(material):
    first, again, other = (make_pairs(*material, Plan(seed=seed)) for seed in (1, 1, 2))
    assert [pair.on_left for pair in first] == [pair.on_left for pair in again]
    assert all(
        np.array_equal(a.seam.root_positions, b.seam.root_positions)
        for a, b in zip(first, again, strict=True)
    )
    assert [pair.match.leave for pair in first] != [pair.match.leave for pair in other]


def test_sides_and_controls_are_drawn(material):
    pairs = [pair for seed in range(5) for pair in make_pairs(*material, Plan(seed=seed))]
    assert 35 <= sum(pair.on_left for pair in pairs) <= 65
    clips = {clip.name for clip in material[0]}
    assert {pair.control.name for pair in pairs} == clips


def test_a_control_is_its_clip_and_shares_half_of_the_film_with_the_seam(material):
    clips, found = material
    for pair in make_pairs(clips, found, Plan(window=2)):
        assert len(pair.seam) == len(pair.control) == 78
        apart = np.linalg.norm(joint_positions(pair.seam) - joint_positions(pair.control), axis=-1).max(
            axis=1
        )
        same = apart < 1e-6
        assert same[:25].all() or same[-25:].all()
        assert not same.all()
        assert any(_is_part(pair.control, clip) for clip in clips)
        assert 0.75 * 0.04 < pair.match.cost <= 0.04


def _is_part(film, clip):
    """Whether a film is a piece of a clip, turned and moved: the heights of its joints are the clip's."""
    heights, of_clip = joint_positions(film)[..., 1], joint_positions(clip)[..., 1]
    starts = np.flatnonzero(np.abs(of_clip[: len(clip) - len(film) + 1] - heights[0]).max(axis=1) < 1e-9)
    return any(np.allclose(of_clip[s : s + len(film)], heights) for s in starts)


def test_only_the_film_with_the_seam_has_the_blend_s_jolt(material):
    """Short blends of worse matches jolt; their controls do not: what a perfect eye can see is there."""
    pairs = make_pairs(*material, Plan(window=1, below=0.06))
    jolts = [[_largest_jolt(pair.seam), _largest_jolt(pair.control)] for pair in pairs]
    assert np.median([seam / control for seam, control in jolts]) > 1.5


def _largest_jolt(film):
    second = np.diff(joint_positions(film), 2, axis=0)
    return np.sqrt((second**2).sum(axis=-1).mean(axis=-1)).max()


def test_too_few_matches_are_said(material):
    clips, found = material
    with pytest.raises(MocapError, match=r"needs 20 matches of 0\.8 to 1\.0 cm, with 1\.6 s .*; got \d+\.$"):
        lab.blind_test(clips, found, below=0.01)
    assert len(choose(clips, found, Plan(pairs=3))) == 3


@pytest.mark.parametrize("window", [0, -3, 61])
def test_a_window_that_does_not_fit_is_said(material, window):
    refused(f"A window has 1 to 60 frames here, got {window}", lab.blind_test, *material, window=window)


def test_clips_of_several_rates_are_said(material):
    clips, found = material
    refused("clips of one rate", lab.blind_test, [clips[0], datasets.sample("jog")], found)


def test_the_page_has_films_and_sentences_and_says_without_a_script_what_it_is(material):
    test = lab.blind_test(*material)
    assert isinstance(test, BlindTest)
    data = test.scene
    assert len(data["onLeft"]) == 20
    assert len(data["films"]) == 40
    assert len(data["sentences"]) == 21
    assert data["plan"] == {"below_cm": 4.0, "window": 10, "seed": 0}
    bundle, metadata = test._repr_mimebundle_()
    assert metadata["image/png"]["alt"] in bundle["text/html"]
    assert base64.b64decode(bundle["image/png"])[1:4] == b"PNG"
    assert bundle["text/plain"].startswith("Blind test: 20 pairs")
    assert len(test.html()) < 300_000


def test_the_films_are_exact_to_half_a_step(material):
    film = make_pairs(*material, Plan())[3].seam
    body, (first, second), data = packed([film, film[5:]])
    assert second["offset"] == 2 * 3 * first["frames"] * body["joints"]
    numbers = np.frombuffer(zlib.decompress(data), "<u2")[: second["offset"] // 2]
    places = np.cumsum(np.cumsum(numbers.reshape(-1, 3, first["frames"]), -1, dtype="<u2"), -1, dtype="<u2")
    points = np.moveaxis(places * STEP, -1, 0) + first["low"]
    starts, ends, _ = bones(film.skeleton)
    assert np.abs(points - joint_positions(film)[:, np.unique([0, *starts, *ends])]).max() < 0.6 * STEP
