import pytest

from mocap.course.lab.kept_functions import Plain, keep, run_sections, split
from mocap.errors import MocapError

ONE = Plain(frozenset(["import math"]), "def one(x):\n    return math.floor(x)\n")
TWO = Plain(frozenset(["import numpy as np"]), "def two(x):\n    return np.sum(x)\n")


def test_functions_stand_in_the_order_of_their_notebooks_with_their_imports_above(tmp_path):
    file = tmp_path / "mine.py"
    keep(file, "two", "08b", TWO)
    keep(file, "one", "02", ONE)
    text = keep(file, "two", "08b", TWO)
    assert text == file.read_text()
    assert [name for name, *_ in split(text)[1]] == ["one", "two"]
    assert "import math\nimport numpy as np\n" in text
    found, said = run_sections(file, text, {})
    assert said == []
    assert (found["one"](2.5), found["two"]([1, 2])) == (2, 3)


def test_a_section_that_fails_is_left_out_with_its_line(tmp_path):
    file = tmp_path / "mine.py"
    text = (
        keep(file, "one", "02", ONE)
        + "# ---- two ----\n\ndef two(x:\n    return\n\n# ---- three ----\n1 / 0\n"
    )
    found, said = run_sections(file, text, {})
    assert list(found) == ["one"]
    line = text[: text.index("def two")].count("\n") + 1
    assert said[0].startswith(f"{file}, line {line}: SyntaxError, "[:200])
    assert "ZeroDivisionError, division by zero; this section" in said[1] or len(said[1]) == 200


def test_helpers_of_one_function_do_not_replace_those_of_another(tmp_path):
    one = "# ---- one ----\ndef h(): return 1\ndef one(): return h()\n"
    text = one + one.replace("one", "two").replace("1", "2")
    found, _ = run_sections(tmp_path / "mine.py", text, {})
    assert (found["one"](), found["two"]()) == (1, 2)


def test_a_head_that_is_no_python_is_not_written_over(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text("import (\n")
    with pytest.raises(MocapError, match=r"line 1: .*; correct it, or delete it"):
        keep(file, "one", "02", ONE)
    assert file.read_text() == "import (\n"
