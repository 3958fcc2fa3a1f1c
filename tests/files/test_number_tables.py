"""Tables as people write them; a wrong line is named."""

import numpy as np
import pytest

from mocap.errors import FormatError
from mocap.files.number_tables import load_rows


@pytest.mark.parametrize("text", ["1,2,3\n4,5,6\n", "x;z;r\n1; 2 ;3\n\n4 5 6 # a stone", "1\t2\t3\r\n4,5,6"])
def test_rows_are_read(tmp_path, text):
    file = tmp_path / "t.csv"
    file.write_text(text, newline="")
    np.testing.assert_array_equal(load_rows(file, ("x", "z", "radius")), [[1, 2, 3], [4, 5, 6]])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1,2\n3\n", "line 2: expected x and z in each line, such as '1.5, 2', got"),
        ("1,2,3\n", "line 1: expected x and z"),
        ("1,2\nfive,6\n", "line 2"),
        ("0,0\n1,nan", "line 2: expected x and z"),
        ("x,z\n", "got no numbers"),
    ],
)
def test_a_wrong_line_is_named(tmp_path, text, sentence):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(FormatError, match=sentence):
        load_rows(tmp_path / "t.csv")
