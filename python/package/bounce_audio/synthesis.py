"""Recordings made from the model, with their truth."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._documents import Document, build
from .errors import ArgumentError
from .settings import whole

__all__ = ["DropTruth", "Synthetic", "Truth", "presets", "synth"]


_numbers = partial(np.asarray, dtype=np.float64)
_indices = partial(np.asarray, dtype=np.intp)
_flags = partial(np.asarray, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class DropTruth(Document):
    """What is true about a drop. Arrays have a number for each impact within the recording, times in seconds."""

    #: When the ball touched, from the first sample.
    impacts_s: Annotated[npt.NDArray[np.float64], _numbers]
    #: When its sound reached the first channel's microphone.
    onsets_s: Annotated[npt.NDArray[np.float64], _numbers]
    #: The same for each other channel, in their order.
    more_onsets_s: tuple[
        Annotated[npt.NDArray[np.float64], _numbers], ...
    ]
    #: Whether each impact can be heard.
    audible: Annotated[npt.NDArray[np.bool_], _flags]
    energy_to_noise_db: Annotated[npt.NDArray[np.float64], _numbers]
    #: Least standard error of its time that any method can reach, and that a match with the mean sound can.
    timing_limit_s: Annotated[npt.NDArray[np.float64], _numbers]
    timing_floor_s: Annotated[npt.NDArray[np.float64], _numbers]
    #: e before scatter, at the geometric mean of the audible impacts' speeds.
    restitution: float
    restitution_nominal_each: Annotated[npt.NDArray[np.float64], _numbers]
    restitution_each: Annotated[npt.NDArray[np.float64], _numbers]
    speeds_m_per_s: Annotated[npt.NDArray[np.float64], _numbers]
    #: Indices from 0.
    irregular: Annotated[npt.NDArray[np.intp], _indices]
    changes: Annotated[npt.NDArray[np.intp], _indices]
    #: Impacts that a splice cut out, that came before the recorder started, and after it stopped.
    impacts_cut: int
    impacts_before: int
    impacts_after: int
    height_m: float
    #: From touch to leaving of the first impact.
    contact_time_s: float
    #: Period of the sound of the first impact.
    period_s: float


@dataclass(frozen=True, eq=False)
class Truth(Document):
    """What is true about a recording that was made; `parameters` is the whole scene."""

    scene: str
    seed: int
    sample_rate_hz: int
    duration_s: float
    drops: tuple[DropTruth, ...]
    parameters: dict[str, Any]


@dataclass(frozen=True, eq=False)
class Synthetic:
    """A recording that was made: float32 samples of shape (n,), or (channels, n) where there are several, and its truth."""

    samples: npt.NDArray[np.float32]
    sample_rate_hz: int
    truth: Truth


def synth(scene: str | os.PathLike[str] = "pingpong", *, seed: int = 1) -> Synthetic:
    """Makes a recording from the model. The same scene and seed make the same samples on every machine.

    `scene` is the name of a preset (see `presets`), or the path of a scene as TOML, whose name ends in `.toml`.

    Raises `ArgumentError` for a name that is not known, a seed that is no whole number of 64 bits, or a scene out of range,
    `OSError` if a file cannot be read.

    >>> import bounce_audio
    >>> made = bounce_audio.synth("steel", seed=7)
    >>> made.samples.dtype, made.samples.ndim, made.sample_rate_hz
    (dtype('float32'), 1, 44100)
    """
    name = os.fspath(scene)
    is_file = isinstance(scene, os.PathLike) or name.endswith(".toml")
    if not is_file and name not in presets():
        raise ArgumentError(f"scene is '{name}', expected a name of presets() or a path that ends in .toml")
    text = Path(name).read_text("utf-8") if is_file else name
    rows, document = _core.synth(text, is_file, whole("seed", seed, 0, 2**64 - 1))
    truth = build(Truth, json.loads(document))
    samples = rows[0] if len(rows) == 1 else rows
    return Synthetic(samples, truth.sample_rate_hz, truth)


def presets() -> dict[str, str]:
    """The names of the scenes that come with the package, and what each is there to show.

    >>> import bounce_audio
    >>> "pingpong" in bounce_audio.presets()
    True
    """
    return dict(_core.presets())
