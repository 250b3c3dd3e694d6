"""From samples, a file or a stream to what is heard in it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._documents import build
from ._notebook import Picture
from .errors import ArgumentError
from .results import Drop, Report, Told
from .settings import Channel, Settings, as_json, channel_number, number, whole

if TYPE_CHECKING:
    from typing_extensions import Buffer, Unpack

__all__ = ["Listener", "analyze", "analyze_bytes", "analyze_file", "fit"]

#: What the number of channels can have in a file.
_MOST_CHANNELS = 2**16 - 1


def analyze(
    samples: npt.ArrayLike,
    rate: float,
    *,
    channel: Channel = "best",
    rule: str | None = None,
    name: str = "samples",
    **settings: Unpack[Settings],
) -> Report:
    """Listens to samples in memory.

    `samples` has shape (n,) or (channels, n). Floats have a full scale of ±1. Signed integers are divided by 2**(bits-1);
    of unsigned ones 2**(bits-1) is taken off before. An array of float32 with its rows one after another is not copied; no
    other thread may write into it meanwhile. Nothing is mixed down or resampled. Samples that are no finite numbers are
    read as zero, with the warning "repaired". `rate` is the number of samples a second, in Hz. `rule` is a name of
    `rules()` to judge by, `name` what the report calls the recording; `settings` are those of `Settings`.

    Other threads of the program go on meanwhile.

    Raises `ArgumentError` for a wrong shape, type or setting, or a rate too low to listen at. Warns (`UserWarning`) of
    integers of 32 or 64 bits that are all but silent, as samples of 16 bits in a wider type are.

    >>> import bounce_audio
    >>> made = bounce_audio.synth("pingpong")
    >>> report = bounce_audio.analyze(made.samples, made.sample_rate_hz, height_m=0.305)
    >>> drop = report.drops[0]
    >>> low, high = drop.restitution.interval95
    >>> low < made.truth.drops[0].restitution < high
    True
    >>> drop.impacts["time_s"][:3].round(3)
    array([0.7  , 1.156, 1.57 ])
    """
    array = _arrays.array_of("samples", samples)
    rows, encoding = _arrays.rows(array)
    if rows.size == 0:
        raise ArgumentError(f"samples are empty: their shape is {array.shape}")
    _arrays.warn_of_width(array)
    document, pictures = _core.analyze(
        rows,
        _rate(rate),
        as_json(settings, "channel", "rule", "name"),
        channel=channel_number(channel),
        rule=rule,
        name=name,
        encoding=encoding,
    )
    return _report(document, pictures)


def analyze_file(
    path: str | os.PathLike[str],
    *,
    channel: Channel = "best",
    rule: str | None = None,
    **settings: Unpack[Settings],
) -> Report:
    """Listens to a recording in a file (WAV, FLAC, M4A, MP3, AAC, Ogg Vorbis, AIFF, CAF, or an MP4 or MOV video), which is read in blocks.

    The report is that of `bounce-audio analyze PATH --format json`, to the digit. `channel`, `rule` and `settings` are those
    of `analyze`.

    Raises `OSError`, such as `FileNotFoundError`, if it cannot be opened, `RecordingError` if it is no recording that can be
    read, `ArgumentError` for a setting out of range.

    >>> import bounce_audio
    >>> bounce_audio.analyze_file("no-such-file.wav")
    Traceback (most recent call last):
    FileNotFoundError: [Errno 2] No such file or directory: 'no-such-file.wav'
    """
    document, pictures = _core.analyze_file(
        os.fsdecode(path),
        as_json(settings, "channel", "rule"),
        channel=channel_number(channel),
        rule=rule,
    )
    return _report(document, pictures)


def analyze_bytes(
    content: Buffer,
    *,
    name: str = "bytes",
    channel: Channel = "best",
    rule: str | None = None,
    **settings: Unpack[Settings],
) -> Report:
    """Listens to a recording whose file is in memory, such as one that came over a network. All else is as in `analyze_file`.

    `content` is `bytes`, or whatever else has bytes, such as a `bytearray` or a `memoryview`, which is copied.

    >>> import bounce_audio
    >>> bounce_audio.analyze_bytes(b"no recording", name="a.wav")
    Traceback (most recent call last):
    bounce_audio.errors.RecordingError: a.wav: not a readable recording: ...
    """
    document = _core.analyze_bytes(
        _bytes(content),
        name,
        as_json(settings, "channel", "rule", "name"),
        channel=channel_number(channel),
        rule=rule,
    )
    return _report(document)


def fit(
    times_s: npt.ArrayLike,
    time_std_s: npt.ArrayLike,
    **settings: Unpack[Settings],
) -> Drop:
    """The drop whose impacts were timed by other means: a camera, a switch, a paper.

    `times_s` has shape (n,), ascending, in seconds; `time_std_s` is their standard error, one for all or one for each. The
    drop is taken to have been watched whole. `start_s`, `end_s` and `timing` have no meaning here.

    Raises `ArgumentError` for fewer than two times, times that do not ascend, or a setting out of range.

    >>> import bounce_audio
    >>> drop = bounce_audio.fit([1.0, 1.5, 1.9, 2.22, 2.476, 2.6808], 1e-4)
    >>> round(drop.restitution.value, 2)
    0.8
    """
    times, stds = _numbers("times_s", times_s), _numbers("time_std_s", time_std_s)
    if times.ndim != 1:
        raise ArgumentError(f"times_s has shape {times.shape}, expected (n,)")
    if times.size < 2:
        raise ArgumentError(f"times_s has {times.size}, expected two or more, which bound a flight")
    if stds.shape not in ((), times.shape):
        raise ArgumentError(f"time_std_s has shape {stds.shape}, expected one number or {times.shape}")
    errors = np.broadcast_to(stds, times.shape)
    document = _core.fit(times.tolist(), errors.tolist(), as_json(settings))
    return build(Drop, json.loads(document))


class Listener:
    """Listens to a stream block by block, in bounded memory, however long it lasts.

    `rate` is in Hz, `channels` how many there are; `rule` and `settings` are those of `analyze`.

    >>> import bounce_audio, numpy as np
    >>> made = bounce_audio.synth("pingpong")
    >>> sound = np.concatenate([made.samples, np.zeros(5 * made.sample_rate_hz, np.float32)])
    >>> listener = bounce_audio.Listener(made.sample_rate_hz)
    >>> for told in listener.drops(np.array_split(sound, 100)):
    ...     print(told.number, told.drop.bounces > 50)
    1 True
    """

    #: The report, once the stream has ended.
    report: Report | None

    def __init__(
        self,
        rate: float,
        channels: int = 1,
        *,
        rule: str | None = None,
        **settings: Unpack[Settings],
    ) -> None:
        self._channels = whole("channels", channels, 1, _MOST_CHANNELS)
        document = as_json(settings, "channels", "rule")
        self._core = _core.Listener(_rate(rate), self._channels, document, rule)
        self._encoding = "32-bit float"
        self.report = None

    def push(self, block: npt.ArrayLike) -> list[Told]:
        """Listens to the next samples, of shape (n,) or (channels, n); gives the drops that are over.

        A drop is told within a second of its last impact, and again by the same number if more of it is heard later: what
        was told before is replaced by it. What is told early may differ by a little from the report of `finish`, which has
        heard what came after it.

        Raises `ArgumentError` for a wrong shape or type, or after `finish`.
        """
        rows, self._encoding = _arrays.rows(block, self._channels)
        return _told(self._core.push(rows))

    def finish(self, name: str = "stream") -> Report:
        """Ends the stream; gives the report of all of it, with the drops told before.

        Raises `ArgumentError` if nothing was listened to, or it has ended before.
        """
        document = self._core.finish(name, self._encoding)
        self.report = _report(document)
        return self.report

    def drops(
        self, blocks: Iterable[npt.ArrayLike], name: str = "stream"
    ) -> Iterator[Told]:
        """Listens to all blocks and gives each drop as `push` does; then `report` has all that was found."""
        for block in blocks:
            yield from self.push(block)
        yield from _told(self._core.rest())
        self.finish(name)


def _numbers(name: str, values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    array = _arrays.array_of(name, values)
    try:
        return array.astype(np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} has type {array.dtype}, expected numbers") from None


def _bytes(content: Buffer) -> bytes:
    if isinstance(content, bytes):
        return content
    try:
        return bytes(memoryview(content))
    except TypeError:
        kind = type(content).__name__
        raise ArgumentError(f"content is of type {kind}, expected bytes; analyze_file listens to a file") from None


def _rate(rate: float) -> float:
    checked = number("rate", rate)
    if checked is None:
        raise ArgumentError("rate is None, expected the samples a second")
    return checked


def _told(document: str) -> list[Told]:
    return [build(Told, told) for told in json.loads(document)]


def _report(document: str, pictures: _core.Pictures | None = None) -> Report:
    report = build(Report, json.loads(document))
    if pictures is not None:
        Picture.attach(report, pictures)
    return report
