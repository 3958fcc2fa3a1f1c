"""Show our code a Linux without what Windows lacks.

Python imports this file before all others if PYTHONPATH names its folder.

Every Python that a test starts with that variable inherits it, and so do kernels and worker processes. *Our*
modules, the tests, and the cells of notebooks get:

- Modules without a version for Windows cannot be imported, nor found by `importlib`.
- `os`, `signal`, `socket`, ... are views without the names whose documentation says "Availability: Unix" or
  "not Windows". `os.name` is "nt" and `sys.platform` is "win32".

Every module of the process gets, as on Windows:

- `multiprocessing` knows spawn only.
- A text file without `encoding=` is in the code page that PYTHONIOENCODING names, and without `newline=` its
  lines end in CR LF. With PYTHONWARNDEFAULTENCODING a missing `encoding=` in our code is an error.
- A file that this process holds open can be neither replaced nor removed, `os.rename` replaces nothing, and
  names such as `aux.txt`, `a:b` and `a.` cannot be made.

The names are hidden from our code only. The standard library and Jupyter decide by `os.name`, as they are
imported, which half of themselves they use, and their Linux half needs what is hidden. With `os.name = "nt"`
for all, `pathlib` would make paths of Windows, and with `sys.platform = "win32"` for all, `asyncio` would
look for functions of Windows.

This cannot tell how the Windows half of a library behaves. It knows nothing of backslashes and drives in
paths, files that another process holds open, names that differ in case only, paths of more than 260
characters, symbolic links, signals to processes, and the console.
"""

import builtins
import errno
import importlib
import importlib.util
import io
import locale
import mmap
import multiprocessing
import multiprocessing.context
import os
import re
import select
import signal
import socket
import sys
import time
import types
import warnings

OURS = ("mocap", "tests", "figures", "conftest", "__channelexec__")  # and __main__, if it is no library's
MISSING = {"crypt", "curses", "fcntl", "grp", "nis", "ossaudiodev", "posix", "pty", "pwd", "readline"}
MISSING |= {"resource", "spwd", "syslog", "termios", "tty", "_posixsubprocess", "_posixshmem"}

# By module, the names that Windows lacks, as a regular expression.
LACKING = {
    os: r"""
        ctermid|environb|getenvb|get(e|res)?[ug]id|getgrouplist|getgroups|getp(gid|grp|riority)|getsid|initgroups
        |set(e|re|res)?[ug]id|setgroups|setns|setp(gid|grp|riority)|setsid|uname(_result)?|unshare|PRIO_\w+
        |fchmod|fchown|fdatasync|fpathconf|fstatvfs|[gs]et_blocking|lockf|F_\w+|login_tty|openpty|pipe2|posix_\w+
        |p(read|write)v?|readv|writev|RWF_\w+|sendfile|SF_\w+|splice|SPLICE_\w+|tc[gs]etpgrp|ttyname|copy_file_range
        |grantpt|unlockpt|ptsname|chflags|chown|chroot|fchdir|lchflags|lchmod|lchown|mkfifo|mknod|major|minor|makedev
        |pathconf(_names)?|statvfs(_result)?|ST_\w+|sync|fwalk|memfd_create|MFD_\w+|eventfd\w*|EFD_\w+|timerfd\w*
        |\w+xattr|XATTR_\w+|SEEK_(DATA|HOLE)|O_(DIRECTORY|NOFOLLOW|CLOEXEC|NONBLOCK|NDELAY|SYNC|DSYNC|RSYNC|FSYNC)
        |O_(NOCTTY|PATH|TMPFILE|ASYNC|DIRECT|NOATIME|LARGEFILE|ACCMODE|EXEC|SEARCH|SHLOCK|EXLOCK|EVTONLY)
        |fork|forkpty|register_at_fork|killpg|nice|pidfd_open|PIDFD_\w+|plock|spawn[lv]pe?|wait|wait3|wait4|waitid
        |waitid_result|W[A-Z]+|P_(PID|PGID|PIDFD|ALL)|POSIX_\w+|CLD_\w+|CLONE_\w+|sched_\w+|SCHED_\w+|getloadavg
        |confstr(_names)?|sysconf(_names)?|getrandom|GRND_\w+|RTLD_\w+|EX_(?!OK)\w+|NGROUPS_MAX|GID_MAX""",
    signal: r"(?!SIG(ABRT|FPE|ILL|INT|SEGV|TERM|_DFL|_IGN)$)SIG[A-Z_0-9]+|ITIMER_\w+|ItimerError|alarm|pause"
    r"|[gs]etitimer|siginterrupt|pthread_\w+|sigpending|sigwait\w*|sigtimedwait|Sigmasks|pidfd_\w+",
    socket: r"send_fds|recv_fds|sethostname|CMSG_\w+|SCM_\w+|AF_(UNIX|PACKET|NETLINK|VSOCK|ALG|CAN|TIPC|RDS)",
    select: r"poll|epoll|kqueue|kevent|devpoll|POLL\w+|EPOLL\w+|PIPE_BUF",
    time: r"clock_\w+|CLOCK_\w+|pthread_getcpuclockid|tzset",
    mmap: r"MAP_\w+|PROT_\w+|MADV_\w+",
    locale: r"nl_langinfo|CODESET|LC_MESSAGES|(bind_)?textdomain\w*|d?c?gettext|bindtextdomain",
    sys: r"abiflags|[gs]etdlopenflags",
}
SHOWN = {(os, "name"): "nt", (sys, "platform"): "win32"}

OUR_MODULES = rf"({'|'.join(OURS)}|__main__|test_\w+)\b"
FORBIDDEN = re.compile(r"""[<>:"|?*\x00-\x1f\\]|[. ]$|^(con|prn|aux|nul|com\d|lpt\d)(\.|$)""", re.IGNORECASE)
CODE_PAGE = os.environ.get("PYTHONIOENCODING", "cp1252").partition(":")[0]


def is_ours(names: dict) -> bool:
    """Return whether a module with these globals is ours, or the cells of a notebook."""
    name, spec = names.get("__name__", ""), names.get("__spec__")
    if name == "__main__" and spec is not None:  # python -m LIBRARY
        name = spec.name
    return name == "__main__" or name.partition(".")[0] in OURS or name.startswith("test_")


class View(types.ModuleType):
    """A module without some of its names; what is set here is set there."""

    def __init__(self, whole: types.ModuleType) -> None:
        lacking = re.compile(LACKING[whole], re.VERBOSE)
        super().__init__(whole.__name__, whole.__doc__)
        self.__dict__.update(_whole=whole, _lacks=lacking.fullmatch, __spec__=whole.__spec__)
        self.__dict__.update({name: value for (module, name), value in SHOWN.items() if module is whole})

    def __getattr__(self, name: str) -> object:
        if self._lacks(name):
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r} on Windows")
        return getattr(self._whole, name)

    def __setattr__(self, name: str, value: object) -> None:
        setattr(self._whole, name, value)

    def __delattr__(self, name: str) -> None:
        delattr(self._whole, name)

    def __dir__(self) -> list[str]:
        return [name for name in dir(self._whole) if not self._lacks(name)]


def hide_modules_and_names() -> None:
    """Let imports by our code find views, and no module that Windows lacks."""
    views = {module.__name__: View(module) for module in LACKING}
    true_import, true_import_module = builtins.__import__, importlib.import_module
    true_find = importlib.util.find_spec

    def refuse(name: str) -> None:
        if name.partition(".")[0] in MISSING:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    def seen_import(name, globals=None, locals=None, fromlist=(), level=0):
        asks = sys._getframe(1).f_globals if globals is None else globals
        if level or not (is_ours(asks) or asks.get("__name__") == "_pytest.outcomes"):  # importorskip
            return true_import(name, globals, locals, fromlist, level)
        refuse(name)
        found = true_import(name, globals, locals, fromlist, level)
        return views.get(found.__name__, found)

    def seen_import_module(name: str, package: str | None = None) -> types.ModuleType:
        if not is_ours(sys._getframe(1).f_globals):
            return true_import_module(name, package)
        refuse(name)
        return views.get(name) or true_import_module(name, package)

    def seen_spec(name: str, package: str | None = None) -> object:
        ours = is_ours(sys._getframe(1).f_globals)
        return None if ours and name.partition(".")[0] in MISSING else true_find(name, package)

    builtins.__import__, importlib.util.find_spec = seen_import, seen_spec
    importlib.import_module = seen_import_module


def spawn_only() -> None:
    """Start processes as Windows does."""
    known, default = multiprocessing.context._concrete_contexts, multiprocessing.context._default_context
    default._default_context = known["spawn"]
    multiprocessing.get_all_start_methods = lambda: ["spawn"]
    for method in ("fork", "forkserver"):
        known.pop(method, None)


def write_in_the_code_page() -> None:
    """Open text files as Windows does, where nothing is said of encoding and ends of lines."""
    true_open = io.open

    def code_page(do_setlocale: bool = True) -> str:
        return CODE_PAGE

    def seen_open(
        file, mode="r", buffering=-1, encoding=None, errors=None, newline=None, closefd=True, opener=None
    ):
        if "b" not in mode:
            if encoding is None:
                io.text_encoding(None, 2)  # warns the caller
            encoding = CODE_PAGE if encoding in (None, "locale") else encoding
            if newline is None and not {"r", "+"} & set(mode):
                newline = "\r\n"
        if "r" not in mode and not isinstance(file, int):
            check_name(file)
        return true_open(file, mode, buffering, encoding, errors, newline, closefd, opener)

    locale.getencoding = locale.getpreferredencoding = code_page
    io.open = builtins.open = seen_open
    warnings.filterwarnings("ignore", category=EncodingWarning)
    warnings.filterwarnings(
        "error", category=EncodingWarning, module=rf"({'|'.join(OURS)}|__main__|test_\w+)\b"
    )


def check_name(path: object) -> None:
    """Refuse a file whose name Windows does not allow."""
    if any(FORBIDDEN.search(part) for part in os.fsdecode(path).split("/") if part not in ("", ".", "..")):
        raise OSError(errno.EINVAL, "Invalid argument", path)


def check_free(path: object) -> None:
    """Refuse to touch a file that this process holds open or has mapped into its memory."""
    place = os.path.realpath(os.fsdecode(path))
    held = {os.path.realpath(f"/proc/self/fd/{number}") for number in os.listdir("/proc/self/fd")}  # noqa: PTH208
    with io.FileIO("/proc/self/maps") as maps:
        mapped = f" {place}\n".encode() in maps.readall()
    if place in held or mapped:
        raise PermissionError(errno.EACCES, "The process cannot access the file: it is in use", path)


def guard_files() -> None:
    """Replace, remove and make files as Windows does."""
    true = {name: getattr(os, name) for name in ("replace", "rename", "unlink", "mkdir")}

    def replace(source, target, **more):
        check_name(target)
        check_free(source)
        check_free(target)
        if os.path.isdir(target):  # noqa: PTH112
            raise PermissionError(errno.EACCES, "Access is denied", target)
        return true["replace"](source, target, **more)

    def rename(source, target, **more):
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, "Cannot create a file when that file already exists", target)
        return replace(source, target, **more)

    def unlink(path, **more):
        if not more:
            check_free(path)
        return true["unlink"](path, **more)

    def mkdir(path, *mode, **more):
        check_name(path)
        return true["mkdir"](path, *mode, **more)

    os.replace, os.rename, os.unlink, os.remove, os.mkdir = replace, rename, unlink, unlink, mkdir


spawn_only()
write_in_the_code_page()
guard_files()
hide_modules_and_names()
