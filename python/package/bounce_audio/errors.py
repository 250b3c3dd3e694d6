"""Exceptions by kind. That there is no drop in a recording is none: it is an answer, with its reason."""

from __future__ import annotations

__all__ = [
    "ArgumentError",
    "BounceAudioError",
    "InternalError",
    "NoSolutionError",
    "RecordingError",
]


class BounceAudioError(Exception):
    """Any error of this package, but for the system's own, such as `FileNotFoundError`."""


class ArgumentError(BounceAudioError, ValueError):
    """An argument is out of its range, of a wrong shape or type, or has a name that is not known."""


class RecordingError(BounceAudioError, ValueError):
    """What was given is no recording that can be read, or holds no audio."""


class NoSolutionError(BounceAudioError, ArithmeticError):
    """No ball fits the numbers; the text says which could be reached."""


class InternalError(BounceAudioError, RuntimeError):
    """The library broke off, which is its own mistake: please report it with the text of this error."""
