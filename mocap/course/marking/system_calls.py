"""The system calls that a student's process may make: their numbers, and conditions on their arguments.

A call that is not listed here fails with ENOSYS, as in a kernel that does not have it, so that libraries fall
back to another one. What is missing is missing on purpose: all that reaches another process (signals,
priorities, affinities, System V and POSIX queues, semaphores and shared memory, locks and leases of files,
`ptrace`, keys), the network, mounts and namespaces, and changes to files that Landlock does not forbid.
"""

from __future__ import annotations

import socket

from mocap._shared.records import NamedTuple

MACHINES = ("x86_64", "aarch64")

# Calls that are allowed whatever their arguments are: their numbers on x86_64 and aarch64; None for a call
# that a machine does not have.
ALLOWED: dict[str, tuple[int, int | None]] = {
    # Memory, threads and the own process.
    "brk": (12, 214),
    "mmap": (9, 222),
    "munmap": (11, 215),
    "mprotect": (10, 226),
    "mremap": (25, 216),
    "madvise": (28, 233),
    "msync": (26, 227),
    "futex": (202, 98),
    "set_robust_list": (273, 99),
    "set_tid_address": (218, 96),
    "rseq": (334, 293),
    "arch_prctl": (158, None),
    "sched_yield": (24, 124),
    "sched_getaffinity": (204, 123),
    "sched_get_priority_max": (146, 125),
    "sched_get_priority_min": (147, 126),
    "getcpu": (309, 168),
    "fork": (57, None),
    "vfork": (58, None),
    "execve": (59, 221),
    "exit": (60, 93),
    "exit_group": (231, 94),
    "wait4": (61, 260),
    "waitid": (247, 95),
    "restart_syscall": (219, 128),
    "getpid": (39, 172),
    "getppid": (110, 173),
    "gettid": (186, 178),
    "getpgid": (121, 155),
    "getpgrp": (111, None),
    "getsid": (124, 156),
    "setpgid": (109, 154),
    "setsid": (112, 157),
    "getuid": (102, 174),
    "geteuid": (107, 175),
    "getgid": (104, 176),
    "getegid": (108, 177),
    "getgroups": (115, 158),
    "getresuid": (118, 148),
    "getresgid": (120, 150),
    "getrlimit": (97, 163),
    "setrlimit": (160, 164),
    "getrusage": (98, 165),
    "times": (100, 153),
    "sysinfo": (99, 179),
    "uname": (63, 160),
    "umask": (95, 166),
    "getrandom": (318, 278),
    # Signals that the process handles, and time.
    "rt_sigaction": (13, 134),
    "rt_sigprocmask": (14, 135),
    "rt_sigreturn": (15, 139),
    "rt_sigsuspend": (130, 133),
    "rt_sigpending": (127, 136),
    "rt_sigtimedwait": (128, 137),
    "sigaltstack": (131, 132),
    "pause": (34, None),
    "alarm": (37, None),
    "getitimer": (36, 102),
    "setitimer": (38, 103),
    "nanosleep": (35, 101),
    "clock_nanosleep": (230, 115),
    "clock_gettime": (228, 113),
    "clock_getres": (229, 114),
    "gettimeofday": (96, 169),
    "time": (201, None),
    "timerfd_create": (283, 85),
    "timerfd_settime": (286, 86),
    "timerfd_gettime": (287, 87),
    # Descriptors: read, write and wait.
    "read": (0, 63),
    "write": (1, 64),
    "pread64": (17, 67),
    "pwrite64": (18, 68),
    "readv": (19, 65),
    "writev": (20, 66),
    "preadv": (295, 69),
    "pwritev": (296, 70),
    "preadv2": (327, 286),
    "pwritev2": (328, 287),
    "lseek": (8, 62),
    "close": (3, 57),
    "close_range": (436, 436),
    "dup": (32, 23),
    "dup2": (33, None),
    "dup3": (292, 24),
    "pipe": (22, None),
    "pipe2": (293, 59),
    "sendfile": (40, 71),
    "copy_file_range": (326, 285),
    "fsync": (74, 82),
    "fdatasync": (75, 83),
    "ftruncate": (77, 46),
    "fallocate": (285, 47),
    "fadvise64": (221, 223),
    "poll": (7, None),
    "ppoll": (271, 73),
    "select": (23, None),
    "pselect6": (270, 72),
    "epoll_create": (213, None),
    "epoll_create1": (291, 20),
    "epoll_ctl": (233, 21),
    "epoll_wait": (232, None),
    "epoll_pwait": (281, 22),
    "eventfd": (284, None),
    "eventfd2": (290, 19),
    "signalfd": (282, None),
    "signalfd4": (289, 74),
    "sendto": (44, 206),
    "recvfrom": (45, 207),
    "sendmsg": (46, 211),
    "recvmsg": (47, 212),
    "shutdown": (48, 210),
    "getsockopt": (55, 209),
    "getsockname": (51, 204),
    "getpeername": (52, 205),
    # Files and folders, which Landlock guards.
    "stat": (4, None),
    "fstat": (5, 80),
    "lstat": (6, None),
    "newfstatat": (262, 79),
    "statx": (332, 291),
    "statfs": (137, 43),
    "fstatfs": (138, 44),
    "access": (21, None),
    "faccessat": (269, 48),
    "faccessat2": (439, 439),
    "readlink": (89, None),
    "readlinkat": (267, 78),
    "getcwd": (79, 17),
    "chdir": (80, 49),
    "fchdir": (81, 50),
    "getdents": (78, None),
    "getdents64": (217, 61),
    "mkdir": (83, None),
    "mkdirat": (258, 34),
    "rmdir": (84, None),
    "creat": (85, None),
    "mknod": (133, None),
    "mknodat": (259, 33),
    "link": (86, None),
    "linkat": (265, 37),
    "symlink": (88, None),
    "symlinkat": (266, 36),
    "unlink": (87, None),
    "unlinkat": (263, 35),
    "rename": (82, None),
    "renameat": (264, 38),
    "renameat2": (316, 276),
    "getxattr": (191, 8),
    "lgetxattr": (192, 9),
    "fgetxattr": (193, 10),
    "listxattr": (194, 11),
    "llistxattr": (195, 12),
    "flistxattr": (196, 13),
}

PRETENDING = {
    "x86_64": {
        "chmod": 90,
        "fchmod": 91,
        "chown": 92,
        "fchown": 93,
        "lchown": 94,
        "fchownat": 260,
        "fchmodat": 268,
        "fchmodat2": 452,
        "utime": 132,
        "utimes": 235,
        "futimesat": 261,
        "utimensat": 280,
        "setxattr": 188,
        "lsetxattr": 189,
        "fsetxattr": 190,
    },
    "aarch64": {
        "fchmod": 52,
        "fchmodat": 53,
        "fchownat": 54,
        "fchown": 55,
        "utimensat": 88,
        "setxattr": 5,
        "lsetxattr": 6,
        "fsetxattr": 7,
        "fchmodat2": 452,
    },
}


class Condition(NamedTuple):
    """A call that is allowed if one of its arguments is right.

    Attributes
    ----------
    numbers : of the call, on x86_64 and aarch64.
    argument : which argument counts, from 0 on; only its low 32 bits do.
    mask : bits of the argument that are compared.
    values : what they may be.
    """

    numbers: tuple[int, int | None]
    argument: int
    mask: int
    values: tuple[int, ...]


ALL_BITS = 0xFFFFFFFF

# <fcntl.h>: commands that concern descriptors of the process. Others lock files, take leases of them, or have
# signals sent (F_SETOWN).
F_DUPFD = 0
F_GETFD = 1
F_SETFD = 2
F_GETFL = 3
F_SETFL = 4
F_DUPFD_CLOEXEC = 1030

# <asm-generic/ioctls.h>: requests about terminals and descriptors. Others change attributes of files, or have
# signals sent (FIOSETOWN).
TCGETS = 0x5401
TIOCGPGRP = 0x540F
TIOCGWINSZ = 0x5413
FIONREAD = 0x541B
FIONBIO = 0x5421
FIONCLEX = 0x5450
FIOCLEX = 0x5451

# <linux/prctl.h>
PR_GET_DUMPABLE = 3
PR_SET_NAME = 15
PR_GET_NAME = 16
PR_CAPBSET_READ = 23
PR_GET_NO_NEW_PRIVS = 39
PR_SET_VMA = 0x53564D41  # names of memory, by the C library

# <sched.h>: flags of `clone` for a new namespace of each kind, and for a child of the parent or its tracer.
CLONE_PTRACE = 0x2000
CLONE_PARENT = 0x8000
CLONE_NEWNS = 0x20000
CLONE_NEWCGROUP = 0x2000000
CLONE_NEWUTS = 0x4000000
CLONE_NEWIPC = 0x8000000
CLONE_NEWUSER = 0x10000000
CLONE_NEWPID = 0x20000000
CLONE_NEWNET = 0x40000000
NAMESPACES = CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC
NAMESPACES |= CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET

SOCKET_TYPE = 0xF  # bits of the type of a socket; the others are flags

# <fcntl.h>: how a file is opened.
O_ACCMODE = 0o3  # mask of O_RDONLY, which is 0, O_WRONLY and O_RDWR
O_WRONLY = 0o1
O_RDWR = 0o2
O_TRUNC = 0o1000
OPENINGS = (0, O_WRONLY, O_RDWR, O_ACCMODE, O_TRUNC | O_WRONLY, O_TRUNC | O_RDWR)
"""How files may be opened: none is cut that is not opened for writing, which Landlock allows at first."""

DESCRIPTOR_COMMANDS = (F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC)
DEVICE_REQUESTS = (TCGETS, TIOCGPGRP, TIOCGWINSZ, FIONREAD, FIONBIO, FIONCLEX, FIOCLEX)
PROCESS_OPTIONS = (
    PR_GET_DUMPABLE,
    PR_SET_NAME,
    PR_GET_NAME,
    PR_CAPBSET_READ,
    PR_GET_NO_NEW_PRIVS,
    PR_SET_VMA,
)

CONDITIONS = {}
CONDITIONS["openat"] = Condition((257, 56), 2, O_ACCMODE | O_TRUNC, OPENINGS)
CONDITIONS["open"] = Condition((2, None), 1, O_ACCMODE | O_TRUNC, OPENINGS)
CONDITIONS["fcntl"] = Condition((72, 25), 1, ALL_BITS, DESCRIPTOR_COMMANDS)
CONDITIONS["ioctl"] = Condition((16, 29), 1, ALL_BITS, DEVICE_REQUESTS)
CONDITIONS["prctl"] = Condition((157, 167), 0, ALL_BITS, PROCESS_OPTIONS)
CONDITIONS["clone"] = Condition((56, 220), 0, CLONE_PTRACE | CLONE_PARENT | NAMESPACES, (0,))
CONDITIONS["prlimit64"] = Condition((302, 261), 0, ALL_BITS, (0,))  # of the process itself
# A pair of datagram sockets could send to every server that has a socket in the file system.
CONDITIONS["socketpair"] = Condition((53, 199), 1, SOCKET_TYPE, (socket.SOCK_STREAM,))
