"""`mocap completion`: what bash, zsh and fish offer, asked in these shells."""

import os
import re
import select
import shutil
import subprocess
import time

import pytest

# Words that are typed, the last one in part, and what a shell offers for it.
OFFERS = [
    ("mocap con", {"convert"}),
    ("mocap bl", {"blend"}),
    ("mocap data f", {"fetch"}),
    ("mocap data fetch b", {"bandai_namco"}),
    ("mocap convert a.bvh b.glb --to g", {"glb"}),
    ("mocap convert a.bvh b.glb --sk", {"--skeleton"}),
    ("mocap warp --loo", {"--loose-feet"}),
    ("mocap graph inf", {"info"}),
    ("mocap graph --by", {"--by-labels"}),
    ("mocap course ma", {"mark"}),
    ("mocap walk g.npz --verb", {"--verbose"}),
    ("mocap completion z", {"zsh"}),
]
ASK_BASH = """
source mocap.bash
read -ra COMP_WORDS <<< "$1"
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
COMP_LINE=$1
COMP_POINT=${#1}
_mocap mocap "${COMP_WORDS[-1]}" "${COMP_WORDS[-2]}"
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.fixture
def script(tmp_path, monkeypatch, run):
    """Write the script of a shell into an empty folder."""
    monkeypatch.chdir(tmp_path)

    def write(shell):
        if not shutil.which(shell):
            pytest.skip(f"there is no {shell}")
        (tmp_path / f"mocap.{shell}").write_text(run(f"completion {shell}").out)

    return write


def ask(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return {line.partition("\t")[0].strip() for line in done.stdout.splitlines() if line}


def test_bash_completes_commands_options_and_choices(script):
    script("bash")
    assert {line: ask("bash", "-c", ASK_BASH, "bash", line) for line, _ in OFFERS} == dict(OFFERS)


def test_fish_completes_commands_options_and_choices(script):
    script("fish")
    asked = "source mocap.fish; complete --do-complete $argv[1]"
    assert {line: ask("fish", "--no-config", "-c", asked, line) for line, _ in OFFERS} == dict(OFFERS)


class Terminal:
    """A shell in a terminal of its own."""

    def __init__(self, *command):
        self.here, there = os.openpty()
        settings = {"stdin": there, "stdout": there, "stderr": there, "start_new_session": True}
        self.process = subprocess.Popen(command, env=os.environ | {"TERM": "dumb", "PS1": "> "}, **settings)
        os.close(there)

    def type(self, text, until):
        """Type a text, and return what is shown until a pattern is in it."""
        os.write(self.here, text.encode())
        shown = ""
        stop = time.monotonic() + 60
        while not re.search(until, shown):
            assert time.monotonic() < stop, shown
            if select.select([self.here], [], [], 0.2)[0]:
                shown += os.read(self.here, 4096).decode()
        return shown

    def end(self):
        self.process.kill()
        self.process.wait()
        os.close(self.here)


def test_bash_enters_a_folder(script, tmp_path):
    """After a Tab, bash has written the folder's slash, and no space."""
    script("bash")
    for name in ("clips", "my clips", "walk"):
        (tmp_path / name).mkdir()
    terminal = Terminal("bash", "--norc", "-i")
    try:
        terminal.type("source ./mocap.bash; echo re''ady\n", r"\nready[^>]*> ")
        shown = {
            "view cl": "clips/",
            "graph my": r"my\ clips/",
            "walk g.npz --path cl": "clips/",
            "wal": "walk ",
        }
        for line, whole in shown.items():
            assert f"{whole}|" in terminal.type(f"mocap {line}\t|", r"\|")
            terminal.type("\x15echo do''ne\n", r"\ndone[^>]*> ")  # Ctrl-U drops the line
    finally:
        terminal.end()


def test_zsh_completes_commands_options_and_choices(script):
    """After a Tab, zsh has written the rest of the word."""
    script("zsh")
    terminal = Terminal("zsh", "--no-rcs", "--interactive")
    try:
        terminal.type(
            "autoload -Uz compinit && compinit -D && source ./mocap.zsh; echo re''ady\n", "\nready|\rready"
        )
        for line, (word,) in OFFERS:
            rest = word.removeprefix(line.split()[-1])
            assert rest in terminal.type(f"{line}\t", re.escape(rest))
            terminal.type("\x15echo do''ne\n", r"\ndone[^>]*> ")  # Ctrl-U drops the line
    finally:
        terminal.end()
