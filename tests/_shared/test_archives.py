import zipfile

import numpy as np
import pytest

from mocap._shared.archives import ROOM, Kind, open_archive, pack, read_arrays, write_arrays
from mocap.errors import FormatError
from tests.refusals import refused

LAYOUT = {"rows": ("i", ("N", 2)), "names": ("U", ("N",)), "rate": ("f", ()), "of_*N": ("f", ("d*",))}
PAIRS = Kind("some pairs", 2, LAYOUT)
GOOD = {"rows": np.arange(6).reshape(3, 2), "names": np.array(["a", "b", "c"]), "rate": 30.0}
GOOD |= {f"of_{number}": np.ones(number) for number in range(3)}


@pytest.mark.parametrize("kind", ["<i8", ">i8", "<i4", ">i4"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_come_back(tmp_path, kind, order):
    write_arrays(tmp_path / "pairs.npz", PAIRS, GOOD | {"rows": GOOD["rows"].astype(kind, order)})
    back = read_arrays(tmp_path / "pairs.npz", PAIRS)
    assert all(np.array_equal(back[key], GOOD[key]) for key in GOOD)
    assert back["rows"].dtype.isnative and back["rows"].flags.c_contiguous


@pytest.mark.parametrize(
    ("changes", "kind", "message"),
    [
        ({}, PAIRS._replace(version=1), "some pairs saved by mocap, version 1, got version 2"),
        ({}, PAIRS._replace(name="a web"), r"an \.npz of another kind"),
        ({"names": np.array(["a"])}, PAIRS, "'names' to fit the other arrays, got <U1"),
        ({"of_1": np.ones((1, 1))}, PAIRS, "'of_1' to fit the other arrays"),
        (
            {},
            PAIRS._replace(rules=lambda arrays: [("ones", arrays["of_2"] == 2)]),
            "that ones, got a damaged",
        ),
        ({}, PAIRS._replace(rules=lambda arrays: [("ones", arrays["of_3"])]), "a damaged one"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path, changes, kind, message):
    write_arrays(tmp_path / "pairs.npz", PAIRS, GOOD | changes)
    refused(message, read_arrays, tmp_path / "pairs.npz", kind, kind=FormatError)


def test_a_missing_file_and_a_folder_are_one_sentence(tmp_path):
    for path in (tmp_path, tmp_path / "nothing.npz"):
        refused(r"Cannot read .*: ", read_arrays, path, PAIRS)


def test_what_unpacks_to_too_much_is_written_as_it_is_and_refused_where_it_is_packed(tmp_path):
    zeros = {"zeros": np.zeros(ROOM)}
    pack(tmp_path / "ours.npz", zeros)
    with open_archive(tmp_path / "ours.npz", "ours") as members:
        assert not members["zeros"].read().any()
    np.savez_compressed(tmp_path / "theirs.npz", **zeros)
    with pytest.raises(FormatError, match="damaged"), open_archive(tmp_path / "theirs.npz", "zeros"):
        pass
    with zipfile.ZipFile(tmp_path / "many.npz", "w") as archive:
        for number in range(2**14 + 1):
            archive.writestr(str(number), "")
    with pytest.raises(FormatError, match="damaged"), open_archive(tmp_path / "many.npz", "a few"):
        pass
