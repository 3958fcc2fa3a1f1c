"""Write the address of the repository wherever it is mentioned.

    python .ci/home.py          # after an edit of `Repository` in pyproject.toml
    python .ci/home.py --check  # list the files that mention another one

`Repository` under [project.urls] in pyproject.toml is the only line that is edited by hand. Until the project
has a home, it names the host `repository.invalid`, which no network has; a release needs another.
"""

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MENTIONS = {
    "pyproject.toml": ("/issues", "/blob/main/CHANGELOG.md"),
    "CITATION.cff": ("",),
    "SECURITY.md": ("/security/advisories/new",),
    "CODE_OF_CONDUCT.md": ("/security/advisories/new",),
    ".github/ISSUE_TEMPLATE/config.yml": ("/security/advisories/new",),
}
ADDRESS = r'https?://[^\s"<>]+?'


def home() -> str:
    """Return the address that pyproject.toml names."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return str(project["urls"]["Repository"]).rstrip("/")


def rewritten(name: str, text: str, address: str) -> str:
    """Return the text of a file with another address before each of its known endings."""
    for ending in MENTIONS[name]:
        pattern = rf'{ADDRESS}(?={re.escape(ending)}["<>\s])' if ending else rf'(?<=-code: "){ADDRESS}(?=")'
        text, count = re.subn(pattern, lambda _: address, text)
        if not count:
            raise SystemExit(f"{name} has no address that ends in {ending or 'the name of the project'}")
    return text


def main() -> int:
    """Write all mentions, or with --check list the files to write; the status is the number of these."""
    check = "--check" in sys.argv[1:]
    address = home()
    stale = []
    for name in MENTIONS:
        text = (ROOT / name).read_text("utf-8")
        new = rewritten(name, text, address)
        if new != text:
            stale.append(name)
            if not check:
                (ROOT / name).write_text(new, "utf-8", newline="\n")
    for name in stale:
        print(f"{name}: {'mentions another address than' if check else 'now mentions'} {address}")
    return len(stale) if check else 0


if __name__ == "__main__":
    sys.exit(main())
