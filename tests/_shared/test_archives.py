import numpy as np
import pytest

from mocap._shared.archives import Kind, read_arrays, write_arrays
from mocap.errors import FormatError, MocapError

PAIRS = Kind("some pairs", 2, {"rows": ("i", ("N", 2)), "names": ("U", ("N",)), "rate": ("f", ())})
GOOD = {"rows": np.zeros((3, 2), np.int32), "names": np.array(["a", "b", "c"]), "rate": 30.0}


def test_arrays_come_back(tmp_path):
    write_arrays(tmp_path / "pairs.npz", PAIRS, GOOD)
    back = read_arrays(tmp_path / "pairs.npz", PAIRS)
    assert all(np.array_equal(back[key], GOOD[key]) for key in GOOD)
    older = PAIRS._replace(version=1)
    with pytest.raises(FormatError, match="some pairs saved by mocap, version 1, got version 2"):
        read_arrays(tmp_path / "pairs.npz", older)
    with pytest.raises(FormatError, match=r"an \.npz of another kind"):
        read_arrays(tmp_path / "pairs.npz", PAIRS._replace(name="a web"))


def test_sizes_of_one_letter_are_the_same(tmp_path):
    write_arrays(tmp_path / "pairs.npz", PAIRS, GOOD | {"names": np.array(["a"])})
    with pytest.raises(FormatError, match="'names' to fit the other arrays"):
        read_arrays(tmp_path / "pairs.npz", PAIRS)


def test_a_missing_file_and_a_folder_are_one_sentence(tmp_path):
    for path in (tmp_path, tmp_path / "nothing.npz"):
        with pytest.raises(MocapError, match=r"Cannot read .*: "):
            read_arrays(path, PAIRS)
