"""Shapes, types and scales of samples."""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt
import pytest

import bounce_audio
from bounce_audio import ArgumentError, Report, Synthetic
from bounce_audio._arrays import rows


@pytest.fixture(scope="module")
def report(pingpong: Synthetic) -> Report:
    return bounce_audio.analyze(pingpong.samples, pingpong.sample_rate_hz)


def times(report: Report) -> npt.NDArray[np.float64]:
    assert len(report.drops) == 1
    return report.drops[0].impacts["time_s"]


@pytest.mark.parametrize(
    ("dtype", "offset"),
    [("i1", 0.0), ("u1", 1.0), ("i2", 0.0), ("u2", 1.0), ("i4", 0.0), ("u4", 1.0)]
    + [("i8", 0.0), (">i2", 0.0)],
)
def test_integers_have_the_scale_of_their_width(dtype: str, offset: float) -> None:
    ends = np.iinfo(dtype)
    middle = 0 if offset == 0.0 else int(ends.max) // 2 + 1
    scaled, encoding = rows(np.array([ends.min, middle, ends.max], dtype))
    assert encoding == f"{8 * np.dtype(dtype).itemsize}-bit integer"
    step = 2.0 ** (1 - 8 * np.dtype(dtype).itemsize)
    assert scaled[0, :2].tolist() == [-1.0, 0.0]
    assert scaled[0, 2] == np.float32(1.0 - step)


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f4"])
def test_floats_are_taken_as_they_are(dtype: str) -> None:
    scaled, _ = rows(np.array([-1.0, 0.25, 1.5], dtype))
    assert scaled.tolist() == [[-1.0, 0.25, 1.5]]


def test_rows_of_float32_are_not_copied() -> None:
    for samples in (np.zeros(100, np.float32), np.zeros((2, 100), np.float32)):
        assert np.shares_memory(rows(samples)[0], samples)


def test_integers_and_floats_give_the_same(pingpong: Synthetic, report: Report) -> None:
    wide = np.rint(pingpong.samples * 2.0**31).astype(np.int32)
    of_integers = bounce_audio.analyze(wide, pingpong.sample_rate_hz)
    assert of_integers.recording.encoding == "32-bit integer"
    assert np.array_equal(times(of_integers), times(report))
    of_doubles = bounce_audio.analyze(
        pingpong.samples.astype(float), pingpong.sample_rate_hz
    )
    assert np.array_equal(times(of_doubles), times(report))


def test_channels_are_rows_and_one_can_be_chosen(
    pingpong: Synthetic, report: Report
) -> None:
    rate = pingpong.sample_rate_hz
    two = np.stack([np.zeros_like(pingpong.samples), pingpong.samples])
    best = bounce_audio.analyze(two, rate)
    assert (best.recording.channels, best.recording.channel) == (2, 2)
    assert np.array_equal(times(best), times(report))
    chosen = bounce_audio.analyze(two, rate, channel=2)
    assert (chosen.drops[0].channel, chosen.recording.channel) == (2, 2)
    assert bounce_audio.analyze(two, rate, channel=1).drops == ()
    # Every other sample of a longer array: not in one piece, so it is copied.
    spread = np.repeat(two, 2, axis=1)[:, ::2]
    assert np.array_equal(times(bounce_audio.analyze(spread, rate)), times(report))
    with pytest.raises(ArgumentError, match="channel is 3 of 2"):
        bounce_audio.analyze(two, rate, channel=3)


def test_columns_of_channels_are_to_be_transposed(pingpong: Synthetic) -> None:
    columns = np.stack([pingpong.samples, pingpong.samples], axis=1)
    with pytest.raises(ArgumentError, match="transpose"):
        bounce_audio.analyze(columns, pingpong.sample_rate_hz)
    with pytest.raises(ArgumentError, match="transpose"):
        bounce_audio.Listener(48_000, 2).push(columns)


@pytest.mark.parametrize(
    ("samples", "said"),
    [
        (np.zeros(0, np.float32), "empty"),
        (np.zeros((2, 0), np.float32), "empty"),
        (np.zeros((0, 5), np.float32), "empty"),
        (np.float32(1.0), "0 dimensions"),
        (np.zeros((1, 2, 3)), "3 dimensions"),
        (np.zeros(5, complex), "complex128"),
        (np.zeros(5, bool), "bool"),
        (["a", "b"], "floats or integers"),
        ([None, 1.0], "object"),
        ([[0.0], [0.0, 1.0]], "rows of different lengths"),
        (np.ma.masked_array(np.zeros(5), mask=True), "masked.*filled"),
    ],
)
def test_what_are_no_samples_is_refused(samples: npt.ArrayLike, said: str) -> None:
    with pytest.raises(ArgumentError, match=said):
        bounce_audio.analyze(samples, 48_000)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_samples_that_are_no_numbers_are_zero_and_said(
    bad: float, pingpong: Synthetic
) -> None:
    with_bad, with_zero = pingpong.samples.copy(), pingpong.samples.copy()
    with_bad[1000:1003], with_zero[1000:1003] = bad, 0.0
    report = bounce_audio.analyze(with_bad, pingpong.sample_rate_hz)
    zeroed = bounce_audio.analyze(with_zero, pingpong.sample_rate_hz)
    assert np.isnan(with_bad[1000]) or np.isinf(with_bad[1000])
    assert report.drops == zeroed.drops
    [warning] = [w for w in report.warnings if w.code == "repaired"]
    assert warning.message.endswith("read as zero: 3")


def test_all_samples_may_be_no_numbers() -> None:
    report = bounce_audio.analyze(np.full(48_000, np.nan), 48_000)
    assert report.drops == () and report.warnings[0].code == "silence"


def test_doubles_too_large_are_said_too() -> None:
    report = bounce_audio.analyze(np.full(48_000, 1e300), 48_000)
    assert "repaired" in [w.code for w in report.warnings]


@pytest.mark.parametrize(("dtype", "bits"), [("i8", 16), ("i8", 24), ("i8", 32), ("i4", 16)])
def test_integers_of_fewer_bits_than_their_type_are_warned_of(dtype: str, bits: int) -> None:
    samples = np.zeros(48_000, dtype)
    samples[100] = 2 ** (bits - 1) - 1
    with pytest.warns(UserWarning, match=f"reach only {samples[100]} of .*np.int16") as warned:
        bounce_audio.analyze(samples, 48_000)
    # The line that called.
    assert warned[0].filename == __file__


def test_integers_as_wide_as_their_type_are_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for dtype, peak in (("i2", 1), ("i4", 2**23 - 1), ("i8", 2**62), ("i8", 0)):
            samples = np.zeros(48_000, dtype)
            samples[100] = peak
            bounce_audio.analyze(samples, 48_000)
        # A block may be quiet.
        bounce_audio.Listener(48_000).push(np.ones(480, np.int32))
