"""Settings: what is known of the ball, how to listen, and what to predict."""

from __future__ import annotations

import difflib
import json
import math
import numbers
import operator
from collections.abc import Mapping
from typing import Literal, TypedDict, get_args, get_type_hints

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


#: Settings that are a word, and which there are.
_WORDS = {name: get_args(get_type_hints(Settings)[name]) for name in ("model", "timing")}


def as_json(settings: Mapping[str, object], *more: str) -> str:
    """The document of settings, for the library to check; `more` are what else the caller takes by keyword."""
    for name in settings:
        if name not in Settings.__annotations__:
            raise _unknown(name, (*Settings.__annotations__, *more))
    return json.dumps({name: _plain(name, value) for name, value in settings.items()})


def _unknown(name: str, known: tuple[str, ...]) -> ArgumentError:
    near = difflib.get_close_matches(name, known, 1)
    meant = f"did you mean {near[0]}? There" if near else "there"
    return ArgumentError(f"{name} is no setting: {meant} are {', '.join(known)}")


def _plain(name: str, value: object) -> object:
    if name not in _WORDS:
        return number(name, value)
    if value in _WORDS[name]:
        return value
    raise ArgumentError(f"{name} is {value!r}, expected one of {', '.join(_WORDS[name])}")


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


def whole(name: str, value: object, least: int, most: int) -> int:
    """A whole number within limits, of any type that has only such."""
    try:
        found = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise ArgumentError(f"{name} is {value!r}, expected a whole number") from None
    if not least <= found <= most:
        raise ArgumentError(f"{name} is {found}, expected {least} to {most}")
    return found


def channel_number(channel: Channel) -> int | None:
    """The number of the channel; None for the best."""
    if channel == "best":
        return None
    is_whole = isinstance(channel, numbers.Integral) and not isinstance(channel, bool)
    if is_whole and 0 < channel < 2**32:
        return int(channel)
    raise ArgumentError(
        f'channel is {channel!r}, expected "best" or the number of a channel, from 1'
    )
