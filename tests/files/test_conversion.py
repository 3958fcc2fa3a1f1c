"""Motion files are found by their suffix, archives by what is in them."""

from pathlib import Path

import numpy as np

from mocap.files import conversion, load_save
from tests.refusals import refused
from tests.strategies import wave


def test_graphs_and_other_archives_in_a_folder_are_no_clips(tmp_path):
    load_save.save(wave(3), tmp_path / "b.bvh")
    np.savez(tmp_path / "c.npz", poses=np.zeros((2, 66)), trans=np.zeros((2, 3)), mocap_framerate=60.0)
    np.savez(tmp_path / "graph.npz", nodes=np.zeros(3))
    (tmp_path / "broken.npz").write_bytes(b"PK")
    (tmp_path / "notes.txt").write_text("")
    assert [path.name for path in conversion.find_files([tmp_path])] == ["b.bvh", "c.npz"]
    assert [path.name for path, _ in conversion.plan(tmp_path, tmp_path / "out")] == ["b.bvh", "c.npz"]


def test_an_empty_folder_is_refused(tmp_path):
    refused(r"holds no \.amc, \.bvh or AMASS \.npz file\.", conversion.find_files, [tmp_path])


def test_a_name_without_end_is_refused_in_a_sentence():
    refused(r"Cannot read a+: File name too long", conversion.find_files, [Path("a" * 5000)], most=6000)
