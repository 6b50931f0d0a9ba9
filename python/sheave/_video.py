"""Videos, encoded by the program ffmpeg."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Callable, Optional, Union

from . import _sheave
from ._errors import ArgumentError, Error

if TYPE_CHECKING:
    from ._simulation import Simulation


def write_video(
    simulation: "Simulation",
    path: Union[str, "os.PathLike[str]"],
    duration: Optional[float],
    fps: float,
    width: int,
    height: int,
    progress: Optional[Callable[[float], object]],
) -> None:
    """Steps the simulation and writes a video. The file appears complete or not at all."""
    if not _sheave.has_render:
        raise Error("videos need the renderer; build Sheave with -DSHEAVE_RENDER=ON")
    for name, value in (("fps", fps), ("duration", 1.0 if duration is None else duration)):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 < value < 1e9:
            raise ArgumentError(f"{name}: must be a number above 0, was {value!r}"[:300])
    if progress is not None and not callable(progress):
        raise ArgumentError(f"progress: must be a function of a number, or None, was {progress!r}"[:300])
    begin = simulation.time
    length = simulation.duration - begin if duration is None else duration
    frames = int(round(length * fps)) + 1
    if frames < 2:
        raise ArgumentError(f"duration: must be at least a frame of 1/{fps:g} s, was {length!r} s; the "
                            "default is the rest of the scene's duration, which may be 0")
    video = _sheave._Video(simulation, os.fspath(path), width, height, fps, frames)
    for frame in range(frames):
        simulation.run(begin + frame / fps)
        video.add()
        if progress is not None:
            progress((frame + 1) / frames)
    video.finish()
