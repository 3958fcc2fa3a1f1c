"""Groups of options by which commands read clips, paths and graphs, and the reading itself."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from mocap import body, graphs
from mocap._shared.deprecation import DEPRECATED, Deprecation
from mocap._shared.progress import Progress
from mocap.cli.clip_sets import named_apart, read_set, surveyed_spaces, warn_of_bodies, warn_of_space
from mocap.cli.option_types import CM, LENGTH, RATE, Joints, RootOffset, Skeleton, Up, number
from mocap.cli.stages import bar, timed_reading, timed_stage
from mocap.datasets.clip_origins import Origin
from mocap.errors import MocapError, SkeletonMismatch, warn

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from mocap.body.ground_path import GroundPath
    from mocap.body.motion import Motion
    from mocap.cli.clip_sets import Spaces
    from mocap.files.recordings import Recording
    from mocap.files.spaces import Space
    from mocap.graphs.motion_graph import MotionGraph

SHORTEST_LINE = 0.5  # metres: a shorter path is doubted

# The options for the parameters of `files.load_path`.
PATH_READING = {"id": "--id", "length": "--length"}

# The options for the parameters of `files.load`, which are named in its errors.
READING = {
    "skeleton": "--skeleton",
    "fps": "--read-fps (once --fps)",  # both work until 0.3
    "scale": "--scale",
    "up": "--up",
    "root_offset": "--root-offset",
    "body": "--body",
    "roles": "--joints",
}
# Commands that read several clips lack two options.
SOURCES = READING | {"fps": "--read-fps to mocap convert", "body": "--body of mocap convert"}
DEPRECATED.append(Deprecation("--fps", since="0.2", removed_in="0.3", instead="--read-fps"))


@contextmanager
def named_options(names: Mapping[str, str]) -> Iterator[None]:
    """Replace the names of parameters in an error by those of options.

    Examples
    --------
    >>> from mocap.errors import Remedy
    >>> with named_options({"fps": "--fps"}):
    ...     raise MocapError("no rate", remedy=Remedy("give {}", "fps"))
    Traceback (most recent call last):
    mocap.errors.MocapError: no rate: give --fps
    """
    try:
        yield
    except MocapError as error:
        if error.remedy is None:
            raise
        raise MocapError(error.worded(names)) from error


@contextmanager
def retargeting_advised() -> Iterator[None]:
    """Add the command that helps to an error about clips of two bodies.

    Examples
    --------
    >>> with retargeting_advised():
    ...     raise SkeletonMismatch("The skeletons differ in these joints: tail. Retarget one first.")
    Traceback (most recent call last):
    mocap.errors.SkeletonMismatch: The skeletons ... joints: tail. mocap retarget lets one body wear both.
    """
    try:
        yield
    except SkeletonMismatch as error:
        problem = error.problem().removesuffix(" Retarget one first.")
        raise SkeletonMismatch(f"{problem} mocap retarget lets one body wear both.") from error


def require_file(path: Path, advice: str) -> None:
    """Raise for a folder if a command takes one file.

    Parameters
    ----------
    path : the argument.
    advice : the remedy in the error, such as "give one of its files".

    Examples
    --------
    >>> require_file(Path(__file__).parent, "give one of its files")
    Traceback (most recent call last):
    mocap.errors.MocapError: ...cli is a folder: give one of its files.
    """
    if path.is_dir():
        raise MocapError(f"{path} is a folder: {advice}.")


def with_chosen_roles(motion: "Motion", joints: Sequence[Path]) -> "Motion":
    """Return a motion whose joints have the roles of a file, or those that are found by a search."""
    from mocap.files.role_maps import choose_roles, read_roles  # the help needs no NumPy

    maps = {path: read_roles(path) for path in joints}
    return body.with_roles(motion, choose_roles(tuple(motion.skeleton.names), maps))


@dataclass(frozen=True)
class PathReading:
    """Options of a command that reads a path."""

    unit: Annotated[
        float | None, LENGTH, "metres per unit of length in the path (default: 1; for .svg 0.01)"
    ] = None
    length: Annotated[float | None, LENGTH, "length of the path in metres, in place of --unit"] = None
    id: Annotated[
        str | None, "id of the line or group in an .svg (default: the longest line that is not filled)"
    ] = None

    def is_given(self) -> bool:
        """Return whether one of the options is given."""
        return self != PathReading()

    def load(self, path: Path) -> "GroundPath":
        """Read a path, with the names of options in errors; warn of one that is shorter than a step."""
        from mocap.files.path_files import read_path  # the help needs no NumPy

        if self.unit is not None and self.length is not None:
            raise MocapError("Give one of --unit and --length: each sets the size of the path.")
        with named_options(PATH_READING):
            line = read_path(path, self.unit, self.length, self.id, PATH_READING)
        if line.length < SHORTEST_LINE and self.length is None:
            size = f"{line.length:.2g} m long, shorter than a step"
            warn(f"{path} is {size}: is its unit right? --unit or --length sets its size.")
        return line


@dataclass(frozen=True)
class FileReading:
    """Options of a command that reads single clips."""

    joints: ClassVar[Sequence[Path]] = ()  # files of roles, an option of `Reading`
    named: ClassVar[Mapping[str, str]] = READING  # the options by which messages name the parameters

    skeleton: Skeleton = None
    read_fps: Annotated[
        float | None,
        RATE,
        "frames per second of the clip as it is read, without resampling (default: as in the file; 120 for "
        ".amc)",
    ] = None
    fps: Annotated[float | None, RATE, "the former name of --read-fps, which warns"] = None
    scale: Annotated[
        float | None,
        LENGTH,
        "metres per unit of length in the clip (default: as the frames show)",
    ] = None
    up: Up = None
    root_offset: RootOffset = None
    body: Annotated[
        int | None,
        number(1, 1000, int),
        "number of the body in a .bvh of several bodies, from 1 (default: the first)",
    ] = None

    def __post_init__(self) -> None:
        """Warn about the former name of an option."""
        if self.fps is None:
            return
        if self.read_fps is not None:
            raise MocapError("--fps is the former name of --read-fps: give --read-fps alone.")
        warn("--fps is read as --read-fps, which does not resample; mocap cut --rate resamples.")

    def read(self, path: Path, space: "Space | None" = None, *, stretch: float | None = None) -> "Recording":
        """Read a clip without the roles of its joints, with the names of options in errors.

        Parameters
        ----------
        path : the clip.
        space : its unit and its vertical axis, by default those of the options, or as its frames show.
        stretch : the largest change of a bone's length, metres, by default as for `files.load`.
        """
        with timed_stage("loading packages"):
            from mocap.files.load_save import read  # the help needs no NumPy
            from mocap.files.tuned import TUNED

        require_file(path, "give one of its files")
        if path.suffix.lower() == ".asf":
            raise MocapError(f"{path} is a skeleton without a motion: give an .amc file, or a .bvh.")
        limit = TUNED.stretch if stretch is None else stretch
        rate = self.read_fps or self.fps
        scale, up, root_offset = space.choices() if space else (self.scale, self.up, self.root_offset)
        with named_options(READING), timed_reading(path):
            return read(path, self.skeleton, rate, scale, limit, up, root_offset, self.body)

    def read_with_roles(
        self, path: Path, space: "Space | None" = None, *, stretch: float | None = None
    ) -> "Recording":
        """Read a clip and find the roles of its joints. State its space, unless it is given.

        Parameters
        ----------
        path, space, stretch : as for `read`.
        """
        recording = self.read(path, space, stretch=stretch)
        if space is None:
            warn_of_space(path, recording, self.named)
        warn_of_bodies(path, recording, READING)
        return self._with_roles(recording)

    def _with_roles(self, recording: "Recording") -> "Recording":
        with named_options(READING):
            return recording._replace(motion=with_chosen_roles(recording.motion, self.joints))

    def require_skeleton_of_use(self, path: Path) -> None:
        """Raise if a skeleton is given for a clip that needs none."""
        if self.skeleton and path.suffix.lower() in (".bvh", ".npz"):
            raise MocapError(f"--skeleton is for .amc clips; {path} needs none.")

    def load(self, path: Path) -> "Motion":
        """Read a clip, and warn about a body of an impossible size."""
        return self.load_body(path, {})

    def load_set(self, paths: Iterable[Path], named: Sequence[Path]) -> "list[Motion]":
        """Read clips as one set; those of folders that cannot be read are left out, see `read_found`."""
        recordings, paths_read = read_set(self.read, paths, named, READING)
        return named_apart([self._with_roles(recording) for recording in recordings], paths_read)

    def survey(self, paths: Sequence[Path]) -> "Spaces":
        """Decide and state the spaces of clips that are read again later: see `surveyed_spaces`."""
        if self.scale is not None and self.up is not None:
            return {}
        return surveyed_spaces(self.read, paths, READING, progress=bar("surveying"))

    def load_any(self, path: Path, spaces: "Spaces") -> "Motion":
        """Read one of several clips, of which some may not need the skeleton.

        Parameters
        ----------
        path : the clip.
        spaces : from `survey`.
        """
        return self.read_with_roles(path, spaces.get(path)).motion

    def load_body(self, path: Path, spaces: "Spaces") -> "Motion":
        """Read one of several clips, and warn about a body of an impossible size.

        Parameters
        ----------
        path, spaces : as for `load_any`.
        """
        from mocap.quality.clip_flaws import warn_of_size

        self.require_skeleton_of_use(path)
        motion = self.load_any(path, spaces)
        warn_of_size([motion])
        return motion


@dataclass(frozen=True)
class Reading(FileReading):
    """Options for reading one clip, and for the roles of its joints."""

    joints: Joints = ()  # type: ignore[misc] # an option in place of the constant


@dataclass(frozen=True)
class ReadingAtRate(Reading):
    """The same options for a command that never had the former name of `--read-fps`."""

    fps: ClassVar[None] = None  # type: ignore[misc] # a constant in place of the option


@dataclass(frozen=True)
class Sources:
    """Options of a command that reads several clips."""

    skeleton: Skeleton = None
    scale: Annotated[float | None, LENGTH, "metres per unit of a .bvh (default: as the frames show)"] = None
    up: Up = None
    root_offset: RootOffset = None
    joints: Joints = ()

    def load(self, paths: Sequence[Path], named: Sequence[Path]) -> "tuple[list[Motion], list[Origin]]":
        """Read clips as one set; warn of an unusual space, and of bodies of other sizes than people's.

        Parameters
        ----------
        paths : the files.
        named : the files and folders that the user named: see `read_found`.

        Returns
        -------
        The clips that could be read, and their files with the options by which they can be read again.
        """
        with timed_stage("loading packages"):
            from mocap.quality.clip_flaws import warn_of_size  # the help needs no NumPy

        with named_options(SOURCES):
            recordings, read = read_set(self._read, bar("reading")(paths), named, SOURCES)
            recordings = [self._with_roles(recording) for recording in recordings]
        clips = named_apart(recordings, read)
        warn_of_size(clips)
        return clips, [
            self._origin(path, recording) for path, recording in zip(read, recordings, strict=True)
        ]

    def _with_roles(self, recording: "Recording") -> "Recording":
        return recording._replace(motion=with_chosen_roles(recording.motion, self.joints))

    def _origin(self, path: Path, recording: "Recording") -> Origin:
        """Return a file with the options by which its clip can be read again."""
        if recording.space is None:
            return Origin(path, self.skeleton, self.scale)
        scale, up, root_offset = recording.space.choices()
        return Origin(path, self.skeleton, scale, up=up, root_offset=root_offset)

    def _read(self, path: Path, space: "Space | None" = None) -> "Recording":
        from mocap.files.load_save import read  # the help needs no NumPy
        from mocap.files.tuned import TUNED

        scale, up, root_offset = space.choices() if space else (self.scale, self.up, self.root_offset)
        with timed_reading(path):
            return read(path, self.skeleton, None, scale, TUNED.stretch, up, root_offset)


@dataclass(frozen=True)
class Building(Sources):
    """Options of a command that reads clips and builds their graph."""

    fps: Annotated[float, RATE, "frames per second of the graph"] = 30.0
    window: Annotated[float, number(0, 60), "duration of a transition, seconds"] = 1 / 3
    threshold: Annotated[float, CM, "largest RMS distance of a transition, cm"] = 4.0

    def build(
        self,
        clips: "Sequence[Motion]",
        progress: Progress = iter,
        *,
        jobs: int | None = None,
        executor: "Executor | None" = None,
    ) -> "MotionGraph":
        """Build the unpruned graph of some clips, in threads of this process or with an executor."""
        frames = round(self.window * self.fps)
        if frames < 2:
            raise MocapError(f"A window needs two frames or more, got {self.window:g} s at {self.fps:g} Hz.")
        clips = [body.resample(clip, self.fps) for clip in clips]
        threshold = self.threshold / 100
        return graphs.build(
            clips, window=frames, threshold=threshold, progress=progress, executor=executor, jobs=jobs
        )
