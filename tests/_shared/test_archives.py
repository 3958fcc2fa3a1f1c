import zipfile

import numpy as np
import pytest

from mocap._shared.archives import ROOM, open_archive, pack
from mocap.errors import FormatError, MocapError


def test_a_missing_file_and_a_folder_are_one_sentence(tmp_path):
    for path in (tmp_path, tmp_path / "nothing.npz"):
        with pytest.raises(MocapError, match=r"Cannot read .*: "), open_archive(path, "some pairs"):
            pass


@pytest.mark.parametrize("kind", ["<i8", ">i8", "<i4"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_come_back_in_the_order_of_this_machine(tmp_path, kind, order):
    rows = np.arange(6).reshape(3, 2)
    pack(tmp_path / "pairs.npz", {"rows": rows.astype(kind, order)})
    with open_archive(tmp_path / "pairs.npz", "some pairs") as members:
        back = members["rows"].read()
    assert np.array_equal(back, rows) and back.dtype.isnative and back.flags.c_contiguous


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
