import math

import numpy as np


def first_frame(track, heading, frame, back, off):
    for now in range(max(frame, back), len(track)):
        x, z = track[now] - track[now - back]
        if off(x, z) < math.pi / 9:
            return now - frame
    return -1


def wrapped(angle):
    return abs((angle + math.pi) % (2 * math.pi) - math.pi)


def from_x(track, heading, frame, back):
    return first_frame(track, heading, frame, back, lambda x, z: wrapped(math.atan2(z, x) - heading))


def not_wrapped(track, heading, frame, back):
    return first_frame(track, heading, frame, back, lambda x, z: abs(math.atan2(x, z) - heading))


def signed(track, heading, frame, back):
    return first_frame(track, heading, frame, back, lambda x, z: math.atan2(x, z) - heading)


def from_the_start(track, heading, frame, back):
    return first_frame(track, heading, back, back, lambda x, z: wrapped(math.atan2(x, z) - heading))


def numbered(track, heading, frame, back):
    after = first_frame(track, heading, frame, back, lambda x, z: wrapped(math.atan2(x, z) - heading))
    return after + frame if after >= 0 else after


def too_near(track, other, apart, cost):
    total = 0.0
    for frame, here in enumerate(track):
        there = other[min(frame, len(other) - 1)]
        total += cost(apart - math.dist(here, there))
    return total


def other_leaves(track, other, apart):
    return sum(max(apart - math.dist(a, b), 0) ** 2 for a, b in zip(track, other, strict=False))


def at_any_time(track, other, apart):
    return sum(max(apart - min(math.dist(a, b) for b in other), 0) ** 2 for a in track)


def far_costs_too(track, other, apart):
    return too_near(track, other, apart, lambda missing: missing**2)


def metres(track, other, apart):
    return too_near(track, other, apart, lambda missing: max(missing, 0))


def rooted(track, other, apart):
    return too_near(track, other, apart, lambda missing: max(missing, 0) ** 2) ** 0.5


def chosen(turn, tracks, wanted, fps, frames=-1):
    def miss(track):
        return abs(turn * (track[-1] - track[0]) * fps / (len(track) + frames) - wanted)

    return min(range(len(tracks)), key=lambda n: miss(tracks[n]))


def command(heading, speed):
    return complex(speed * math.cos(heading), speed * math.sin(heading))


def as_captured(turn, tracks, heading, speed, fps):
    return chosen(1, tracks, command(heading, speed), fps)


def turned_back(turn, tracks, heading, speed, fps):
    return chosen(turn.conjugate(), tracks, command(heading, speed), fps)


def from_x_axis(turn, tracks, heading, speed, fps):
    return chosen(turn, tracks, complex(speed * math.sin(heading), speed * math.cos(heading)), fps)


def in_metres(turn, tracks, heading, speed, fps):
    away = [abs(turn * (t[-1] - t[0]) - command(heading, speed)) for t in tracks]
    return away.index(min(away))


def per_frame(turn, tracks, heading, speed, fps):
    return chosen(turn, tracks, command(heading, speed), 1)


def fence_posts(turn, tracks, heading, speed, fps):
    return chosen(turn, tracks, command(heading, speed), fps, 0)


def at_any_speed(turn, tracks, heading, speed, fps):
    ways = [turn * (t[-1] - t[0]) for t in tracks]
    return int(np.argmin([abs(w / abs(w) - command(heading, 1)) for w in ways]))


WRONG = {
    "obeys_after": [
        (from_x, "headings start at +z"),
        (not_wrapped, "one direction"),
        (signed, "its absolute value"),
        (from_the_start, "count from the command, not from the start"),
        (numbered, "the number of the frame"),
    ],
    "crowding_cost": [
        (other_leaves, "stays where its track ends"),
        (at_any_time, "in the same frame"),
        (far_costs_too, "never below 0"),
        (metres, "sum their squares"),
        (rooted, "no square root"),
    ],
    "next_edge": [
        (as_captured, "multiply by `turn`"),
        (turned_back, "you turn the track back"),
        (from_x_axis, "a heading of 0 is +z"),
        (in_metres, "compare metres with metres per second"),
        (per_frame, "multiply by fps"),
        (fence_posts, "n frames apart"),
        (at_any_speed, "the directions alone"),
    ],
}
