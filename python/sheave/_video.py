"""Videos, by the program ffmpeg."""

from __future__ import annotations

import os
import shutil
import subprocess
from typing import TYPE_CHECKING, Callable, Optional, Union

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
    """Steps the simulation and writes what it looks like. The file appears whole or not at all."""
    if not fps > 0.0:
        raise ArgumentError(f"fps: must be above 0, was {fps!r}")
    program = shutil.which("ffmpeg")
    if program is None:
        raise Error("videos need the program ffmpeg, which is not installed")
    begin = simulation.time
    length = simulation.duration - begin if duration is None else duration
    frames = int(round(length * fps)) + 1
    if frames < 2:
        raise ArgumentError(f"duration: must be at least a frame, was {length!r}")
    target = os.fspath(path)
    root, extension = os.path.splitext(target)
    part = f"{root}.part{extension}"
    command = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
               "-s", f"{width}x{height}", "-r", f"{fps}", "-i", "-", "-an",
               "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", part]
    try:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as encoder:
            assert encoder.stdin is not None and encoder.stderr is not None
            try:
                for frame in range(frames):
                    simulation.run(begin + frame / fps)
                    encoder.stdin.write(simulation.render(width, height).tobytes())
                    if progress is not None:
                        progress((frame + 1) / frames)
                encoder.stdin.close()
            except BrokenPipeError:
                pass
            except BaseException:
                encoder.kill()
                raise
            complaint = encoder.stderr.read().decode(errors="replace").strip()
        if encoder.returncode != 0:
            raise Error(f"{target}: ffmpeg has failed: {complaint}")
        os.replace(part, target)
    finally:
        if os.path.exists(part):
            os.remove(part)
