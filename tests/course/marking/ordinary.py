"""Commands run as an ordinary user, without rights of root's: from an account of root."""

import os
import shutil
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
USER = "12345"  # who owns nothing
PROGRAMS = ("unshare", "mount", "setpriv")

# In a view of the file system of its own, Python may lie in a home that others cannot read: so a folder of
# the same name takes the place of the topmost folder that is closed, and holds Python only.
SHOWN = """
set -e
closed=$1 python=$2
shift 2
if [ -n "$closed" ]; then
    mount --bind "$python" /mnt
    mount -t tmpfs -o mode=755 none "$closed"
    mkdir -p "$python"
    mount --bind /mnt "$python"
fi
exec setpriv --reuid USER --regid USER --clear-groups --inh-caps=-all --bounding-set=-all "$@"
""".replace("USER", USER)


def as_ordinary_user(command):
    """Return a command that runs another one as an ordinary user; the same one if it is not root who asks."""
    if os.geteuid() != 0:
        return command
    if sys.platform != "linux" or not all(map(shutil.which, PROGRAMS)):
        pytest.skip("no setpriv or unshare")
    if any(folder.stat().st_mode & 0o5 != 0o5 for folder in (ROOT, *ROOT.parents)):
        pytest.skip("the tests lie in a folder that is closed to others")
    python = Path(sys.base_prefix).resolve()
    folders = [folder for folder in reversed(python.parents) if folder.stat().st_mode & 0o5 != 0o5]
    closed = str(folders[0]) if folders else ""
    own_view = ["unshare", "--mount", "--propagation", "private"]
    return [*own_view, "sh", "-c", SHOWN, "sh", closed, str(python), *command]


def give(folder):
    """Give a folder and what is in it to the ordinary user."""
    for place in (folder, *folder.rglob("*")):
        if os.geteuid() == 0:
            os.chown(place, int(USER), int(USER), follow_symlinks=False)
