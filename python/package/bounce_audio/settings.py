"""Settings: what is known of the ball, how to listen, and what to predict."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Literal, TypedDict

from .errors import ArgumentError

__all__ = ["Channel", "Settings"]

#: The channel to listen to: the one in which impacts stand out most, or its number from 1.
Channel = int | Literal["best"]


class Settings(TypedDict, total=False):
    """Keyword arguments of all that listens. What is not given has its default; None stands for "not known"."""

    #: From the ball's lowest point to the surface at release, in metres.
    height_m: float | None
    #: Standard error of the height in metres. Default 0.001.
    height_std_m: float
    #: Default 9.81.
    gravity_m_per_s2: float
    #: With the diameter it gives the drag of the air, with a contact time stiffness and damping.
    mass_kg: float | None
    diameter_m: float | None
    #: Time in contact at each impact, taken to be right within 5 %.
    contact_time_s: float | None
    #: Model of the flights. Default "auto", the one that the recording supports.
    model: Literal[
        "auto",
        "constant",
        "contact",
        "linear",
        "drag",
        "speed",
        "viscoelastic",
        "flexible",
    ]
    #: Listen from here. Default: the start.
    start_s: float | None
    #: Listen up to here. Default: the end.
    end_s: float | None
    #: Seconds of the recording in one of the ball's: 8 for slow motion of eight times. Default 1.
    time_scale: float
    #: Standard error of the clock's rate, as a share. Default 0.
    clock_std: float
    #: How impacts are timed, from fastest to most exact. Default "correlation".
    timing: Literal["envelope", "fraction", "correlation"]
    #: Predict how high the ball comes back after each of ten bounces when it falls from this height, in metres.
    predict_from_m: float | None
    #: Predict from how high it must fall for one of its bounces to rise to this height, in metres.
    reach_m: float | None
    #: Which bounce that is, from 1 to 10. Default 2.
    reach_bounce: int


def as_json(settings: Mapping[str, object]) -> str:
    """The document of settings, for the library to check."""
    known = Settings.__annotations__
    for name in settings:
        if name not in known:
            raise ArgumentError(f"{name} is no setting; there are {', '.join(known)}")
    return json.dumps({name: _plain(name, value) for name, value in settings.items()})


def _plain(name: str, value: object) -> object:
    if value is None or name not in ("model", "timing"):
        return number(name, value)
    if isinstance(value, str):
        return value
    raise ArgumentError(f"{name} is {value!r}, expected a name")


def number(name: str, value: object) -> float | None:
    """A finite number, whatever type it came in; None stays. A text is none: it may have a unit."""
    if value is None:
        return None
    try:
        if isinstance(value, str):
            raise TypeError(value)
        as_float = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} is {value!r}, expected a number") from None
    if not math.isfinite(as_float):
        raise ArgumentError(f"{name} is {as_float}, expected a finite number")
    return as_float


def channel_number(channel: Channel) -> int | None:
    """The number of the channel; None for the best."""
    if channel == "best":
        return None
    if isinstance(channel, int) and not isinstance(channel, bool) and channel > 0:
        return channel
    raise ArgumentError(
        f'channel is {channel!r}, expected "best" or the number of a channel, from 1'
    )
