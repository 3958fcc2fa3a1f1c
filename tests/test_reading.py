"""The rules of reading.py find what they mean and nothing else, and all files follow them or are recorded."""

import ast
import subprocess
import sys
from textwrap import dedent, indent

import pytest

from tests import reading

FILES = reading.files()


def rules_broken(code):
    return {finding.rule for finding in reading.open_findings(dedent(code))}


# The files --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("file", [*FILES, "tests/reading.py"])
def test_a_file_can_be_read(file):
    text = (reading.ROOT / file).read_text("utf-8")
    if reading.is_recorded(file, text):
        return
    places = [f"{file}:{line}: {rule}: {message}" for line, rule, message in reading.open_findings(text)]
    way_out = "An exempt file that changes complies; `# reads: <rule>: <reason>` excuses a statement."
    assert not places, "\n".join([*places, way_out])


def test_the_record_holds_no_file_that_complies_or_is_gone():
    """`python tests/reading.py --exempt` removes them."""
    assert reading.needless() == []


def test_each_recorded_file_has_a_reason():
    entries = [entry for room in reading.record().values() for entry in room.values()]
    assert all(len(entry["reason"].split()) > 1 for entry in entries)


@pytest.mark.parametrize("file", FILES)
def test_each_excuse_is_of_a_rule_has_a_reason_and_is_needed(file):
    text = FILES[file].read_text("utf-8")
    for excuse in reading.excuses(text):
        found = {(finding.line, finding.rule) for finding in reading.findings(text)}
        where = f"{file}:{excuse.line}"
        assert excuse.rule in reading.RULES, where
        assert len(excuse.reason.split()) > 1, f"{where}: no reason"
        assert any((line, excuse.rule) in found for line in excuse.lines), f"{where}: not needed"


# The rules --------------------------------------------------------------------------------------------------


def score(code):
    (function,) = reading.functions(ast.parse(dedent(code)))
    return reading.cognitive_complexity(function)


COMPLEXITIES = {
    "def f():\n return 1": 0,
    "def f():\n if a:\n  b()": 1,
    "def f():\n if a:\n  b()\n else:\n  c()": 2,
    "def f():\n if a:\n  b()\n elif c:\n  d()\n else:\n  e()": 3,
    "def f():\n for a in b:\n  if a:\n   c()": 3,
    "def f():\n for a in b:\n  if a:\n   c()\n  elif d:\n   e()": 4,
    "def f():\n while a:\n  for b in c:\n   if b:\n    d()": 6,
    "def f():\n for a in b:\n  c()\n else:\n  d()": 2,
    "def f():\n if a and b and c or d:\n  e()": 3,
    "def f():\n return a if b else c": 1,
    "def f():\n return a if b else c if d else e": 3,
    "def f():\n try:\n  a()\n except A:\n  if b:\n   c()\n finally:\n  d()": 3,
    "def f():\n with a:\n  if b:\n   c()": 1,
    "def f():\n match a:\n  case 1:\n   if b:\n    c()\n  case 2:\n   d()": 3,
    "def f():\n return [a for a in b if a]": 0,
    "def f():\n return sorted(a, key=lambda b: c if b else d)": 2,
    "def f():\n def g():\n  if a:\n   b()\n return g": 2,
    "def f():\n return f()": 1,
    "class A:\n def f(self):\n  return self.f()": 1,
}
"""As in G. A. Campbell, Cognitive Complexity, 2018: appendices A and B."""


@pytest.mark.parametrize(("code", "complexity"), COMPLEXITIES.items())
def test_cognitive_complexity(code, complexity):
    assert score(code) == complexity


def test_two_examples_of_the_paper():
    """`sumOfPrimes` counts 7 (but for its label, 1 of them), `getWords` 1 in the paper."""
    primes = """
        def sum_of_primes(limit):
            total = 0
            for number in range(limit):
                for divisor in range(number):
                    if number % divisor == 0:
                        break
                total += number
            return total
    """
    words = """
        def words(number):
            match number:
                case 1: return "one"
                case 2: return "a couple"
                case _: return "lots"
    """
    assert (score(primes), score(words)) == (6, 1)


def nested(conditions):
    """Make a function of that many nested ifs, and one level more: 1 + 2 + 3 + ..."""
    lines = [" " * depth + "if a:" for depth in range(1, conditions + 1)]
    return "\n".join(["def f():", *lines, " " * (conditions + 1) + "b()"])


BROKEN = {
    "complexity": [nested(5), "class A:\n" + indent(nested(5), " ")],
    "statement": [
        f"a = f({', '.join(['b'] * 20)})",
        f"if f({', '.join(['b'] * 20)}):\n pass",
        f"for a in f({', '.join(['b'] * 20)}):\n pass",
        f"a = [{', '.join(['b'] * 20)}]",
        f"a = {{{', '.join(['1: b'] * 20)}}}",
    ],
    "pair": [
        "low, high = 0, f()",
        "def f():\n low, high = a, b",
        "self.low, self.high = low, high",
        "a, *b = c, d",
        "a, b = b, a + b",
        "a, b = c[0], d[1]",
        "class A:\n a, b = 1, 2",
    ],
    "constant": ["A, B = 1, 2", "A = B = 3", "A, B = range(2)", "class C:\n A, B = 1, 2", "_A, _B = f()"],
    "factor": [
        "price * (end > 0)",
        "speeds * ~standing",
        "', aligned' * bool(turn)",
        "price * (not end)",
        "price *= end > 0",
        "-1 / fps * frames * ~np.isfinite(clock).any()",
        "[path] * path.is_dir()",
        "(a & (b < c)) * d",
        "(a or b) * c",
        "1 * np.isnan(a)",
    ],
    "walrus": [
        "pins = join(plants := plant(motion), pins)",
        "if (a := f()) is None:\n pass",
        "if (a := f()) and b:\n pass",
        "b = [c := d, c]",
        "b = [a for a in c if (d := a) > 1]",
        "b = (a := c) if d else e",
    ],
    "integer": [
        "if edge.kind == 3:\n pass",
        "if kind in (3, 4):\n pass",
        "if 1 == edge['kind']:\n pass",
        "mode = 2",
        "Edge(kind=1)",
        "a[:, 7]",
        "a[..., 3]",
        "a[:, 3:]",
        "a[:, 2:6]",
        "a[4]",
        "a[7::7]",
        "a.reshape(-1, 7)",
    ],
    "name": [
        "found = f()",
        "def f(own):\n pass",
        "def before():\n pass",
        "self.most = 1",
        "class A:\n left: int",
        "for one in a:\n pass",
        "[other for other in a]",
        "with a as here:\n pass",
        "import a as some",
        "_more = 1",
        "try:\n pass\nexcept E as what:\n pass",
        "lambda way: 1",
        "match a:\n case (given, *others):\n  pass",
    ],
}
KEPT = {
    "complexity": [nested(4), "\n".join(["def f():", *[" if a:\n  b()"] * 12])],
    "statement": [
        f"a = f({', '.join(['b'] * 17)})",
        f"a = [{', '.join(['1'] * 99)}]",
        f"a = {{{', '.join(['1: -2.5'] * 99)}}}",
        f"a = f([{', '.join(['(1, None)'] * 99)}])",
        f"def f({', '.join(f'a{n}: int = 1' for n in range(20))}):\n pass",
        "if a:\n" + " b = c + d\n" * 40,
        "try:\n a()\nexcept E:\n" + " b = c + d\n" * 40,
        "match a:\n case 1:\n" + "  b = c + d\n" * 40,
        '"""' + "A long text. " * 99 + '"""',
    ],
    "pair": [
        "a, b = b, a",
        "a[i], a[j] = a[j], a[i]",
        "low, high = box",
        "(low,) = [f(a)][:1]",
        "x, z = point[0], point[2]",
        "low, high = box.low, box.high",
        "low, high = (f(side) for side in box)",
        "for a, b in c:\n pass",
    ],
    "constant": ["A = 1\nB = 2", "A = (1, 2)", "def f():\n A, B = g()\n return A @ B", "a, b = f()"],
    "factor": [
        "price * weight",
        "price if end > 0 else 0",
        "np.where(standing, 0, speeds)",
        "a * -b",
        "a * (b if c > d else e)",
        "(a > b) + (c > d)",
        "~a & b",
        "a * f(b > c)",
    ],
    "walrus": [
        "if a := f():\n pass",
        "while chunk := file.read(3):\n pass",
        "b = [a for c in d if (a := f(c))]",
        "if a:\n pass\nelif b := f():\n pass",
    ],
    "integer": [
        "if edge.kind is Kind.CUT:\n pass",
        "if len(kinds) == 3:\n pass",
        "if edge.frames == 30:\n pass",
        "a[:, 2]",
        "a[-1]",
        "a[..., :3]",
        "a[:200]",
        "a[::10]",
        "a[:, FIRST]",
        "a[frames[3:]]",
        "a.reshape(-1, 3)",
        "a['kind']",
        "mode = 'fast'",
        "f(type=True)",
    ],
    "name": [
        "found_legs = f()",
        "def before_the_seam():\n pass",
        "left, right = f()",
        "def f(left, right):\n pass",
        "a(more=1)",
        "print(found)",
        "a = b.most",
        "first, last = f()",
    ],
}


@pytest.mark.parametrize(("rule", "code"), [(rule, code) for rule, codes in BROKEN.items() for code in codes])
def test_a_rule_finds_what_it_means(rule, code):
    assert rule in rules_broken(code)


@pytest.mark.parametrize(("rule", "code"), [(rule, code) for rule, codes in KEPT.items() for code in codes])
def test_a_rule_finds_nothing_else(rule, code):
    assert rule not in rules_broken(code)


def test_each_rule_has_examples_of_both_kinds_and_says_what_to_write_instead():
    assert list(BROKEN) == list(KEPT) == list(reading.RULES)
    for rule in reading.RULES.values():
        assert "Instead" in rule.__doc__ or "      # " in rule.__doc__, rule.__name__


def test_an_example_in_a_rules_docstring_breaks_the_rule_and_what_stands_beside_it_does_not():
    for name in ("pair", "factor", "walrus", "name"):
        lines = [line for line in reading.RULES[name].__doc__.splitlines() if " # " in line]
        assert lines
        for line in lines:
            bad, _, good = (part.strip() for part in line.partition(" # "))
            if bad:
                assert name in rules_broken(bad), bad
            assert name not in rules_broken(good), good


# Exceptions -------------------------------------------------------------------------------------------------

EXCUSED = [
    "found = f()  # reads: name: the paper's own word",
    "# reads: name: the paper's own word\nfound = f()",
    "found = f(  # reads: name: the paper's own word\n    1,\n)",
    "def f(\n    own,  # reads: name: the paper's own word\n):\n    pass",
    "def f(own):  # reads: name: the paper's own word\n    pass",
    "@g\n@h\ndef f(own):  # reads: name: the paper's own word\n    pass",
    "class A:\n    # reads: name: the paper's own word\n    more: int",
    "if a:\n    # reads: name: the paper's own word\n    more = 1",
]
NOT_EXCUSED = [
    "a = f()  # reads: name: the paper's own word\nfound = f()",
    "found = f()  # reads: pair: the paper's own word",
    "def f(a):  # reads: name: the paper's own word\n    found = a",
    "found = f()\n# reads: name: the paper's own word",
    "found = '# reads: name: the paper is quoted'",
    "found = f()  # it reads well",
]


@pytest.mark.parametrize("code", EXCUSED)
def test_a_comment_excuses_the_statement_it_is_in_or_above(code):
    assert not rules_broken(code)
    (excuse,) = reading.excuses(code)
    assert (excuse.rule, excuse.reason) == ("name", "the paper's own word")


@pytest.mark.parametrize("code", NOT_EXCUSED)
def test_a_comment_excuses_nothing_else(code):
    assert rules_broken(code) == {"name"}


def test_a_comment_at_a_def_excuses_the_complexity_of_the_function():
    assert not rules_broken(nested(5).replace(":", ":  # reads: complexity: the paper's own loop", 1))


# The record -------------------------------------------------------------------------------------------------


def test_comments_docstrings_imports_and_formatting_do_not_change_a_fingerprint():
    plain = "import a\n\n\ndef f(a, b):\n    return a + b\n"
    same = '"""About."""\n\n\ndef f(\n    a,\n    b,\n):\n    """Add."""\n    # really\n    return (a + b)\n'
    assert reading.fingerprint(plain) == reading.fingerprint(same)
    for changed in ("a - b", "a + b + 0", "a + c", "'a + b'"):
        assert reading.fingerprint(plain.replace("a + b", changed)) != reading.fingerprint(plain)


def test_a_fingerprint_is_the_same_in_each_version_of_python():
    assert (
        reading.fingerprint("def f(a, *, b=1.5):\n    return {f'{a!r:>{b}}': -b, **a}[..., 1:]\n")
        == "439787f64e7f"
    )


@pytest.fixture
def house(tmp_path, monkeypatch):
    """Build a house of two files, with a record of its own."""
    monkeypatch.setattr(reading, "ROOT", tmp_path)
    monkeypatch.setattr(reading, "RECORD", tmp_path / "record.toml")
    (tmp_path / "mocap/room").mkdir(parents=True)
    (tmp_path / "mocap/room/old.py").write_text("found = 1\n")
    (tmp_path / "mocap/room/more.py").write_text("more = 1\n")
    (tmp_path / "record.toml").write_text("")
    return tmp_path


def test_a_recorded_file_is_exempt_until_it_changes(house):
    file = house / "mocap/room/old.py"
    reading.add(["mocap/room/old.py"], 'not "read" yet')
    assert reading.record()["mocap/room"]["old.py"]["reason"] == 'not "read" yet'
    assert reading.is_recorded("mocap/room/old.py", file.read_text())
    assert reading.is_recorded("mocap/room/old.py", f"# A comment\n{file.read_text()}")
    assert not reading.is_recorded("mocap/room/old.py", "found = 2\n")
    assert not reading.is_recorded("mocap/room/more.py", file.read_text())
    assert reading.needless() == []


@pytest.mark.parametrize("text", ["legs = 1\n", "found = 2\n", None])
def test_the_record_only_shrinks(house, text):
    """A file leaves it that complies, that changed, or that is gone, and none enters by itself."""
    names = ["mocap/room/old.py", "mocap/room/more.py"]
    reading.add(names, "not read yet")
    if text is None:
        (house / names[0]).unlink()
    else:
        (house / names[0]).write_text(text)
    assert reading.needless() == names[:1]
    reading.shorten()
    assert list(reading.record()["mocap/room"]) == ["more.py"]
    (house / names[1]).unlink()
    (house / "mocap/room/new.py").write_text("found = 1\n")
    reading.shorten()
    assert reading.record() == {}


def test_the_command_lists_findings_of_files_that_are_not_exempt(house, monkeypatch, capsys):
    reading.add(["mocap/room/old.py"], "not read yet")
    monkeypatch.setattr(sys, "argv", ["reading.py"])
    assert reading.main() == 1
    assert "mocap/room/more.py:1: name: `more`" in (shown := capsys.readouterr().out)
    assert "old.py" not in shown
    monkeypatch.setattr(sys, "argv", ["reading.py", "--all"])
    assert reading.main() == 1
    assert "mocap/room/old.py:1: name: `found`" in capsys.readouterr().out


def test_it_runs_by_itself():
    command = [sys.executable, "tests/reading.py", "tests/reading.py"]
    done = subprocess.run(command, cwd=reading.ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")
