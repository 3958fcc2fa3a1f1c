"""What each right and each known wrong answer is told, of all exercises, as it was frozen.

python -m tests.course.told   # freeze it again, after a change that is meant; look at the difference
"""

import json
from pathlib import Path

from mocap.course.check import Check
from mocap.course.checks import all_checks

FILE = Path(__file__).with_suffix(".json")


def told(check: Check) -> list[str]:
    """List the sentence for the right answer, then those for the mistakes in their order."""
    functions = [check.truth, *(mistake for mistake, _ in check.mistakes)]
    return [str(check.verdict(function)) for function in functions]


def frozen() -> dict[str, list[str]]:
    return json.loads(FILE.read_text("utf-8"))


if __name__ == "__main__":
    said = {name: told(check) for name, check in all_checks().items()}
    FILE.write_text(json.dumps(said, ensure_ascii=False, indent=1) + "\n", "utf-8")
