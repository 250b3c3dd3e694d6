"""Streams."""

from __future__ import annotations

import numpy as np
import pytest

import bounce_audio
from bounce_audio import ArgumentError, Listener, Synthetic


@pytest.fixture(scope="module")
def two_drops(pingpong: Synthetic) -> np.ndarray:
    quiet = np.zeros(4 * pingpong.sample_rate_hz, np.float32)
    return np.concatenate([pingpong.samples, quiet, pingpong.samples])


def test_drops_are_told_when_they_are_over(
    pingpong: Synthetic, two_drops: np.ndarray
) -> None:
    rate = pingpong.sample_rate_hz
    whole = bounce_audio.analyze(two_drops, rate)
    listener = Listener(rate)
    pushed = 0

    def blocks():
        nonlocal pushed
        for block in np.array_split(two_drops, 200):
            pushed += len(block)
            yield block

    drops, heard_until = [], []
    for told in listener.drops(blocks(), name="samples"):
        drops.append(told.drop)
        assert told.number == len(drops)
        heard_until.append(pushed)
    assert len(drops) == 2
    assert listener.report == whole
    for drop, at_once, until in zip(drops, whole.drops, heard_until):
        last_s = at_once.impacts["time_s"][-1]
        # Within a second, and a block.
        assert until / rate < last_s + 1 + len(two_drops) / 200 / rate
        assert abs(drop.impacts["time_s"][-1] - last_s) < 0.02
        assert drop.restitution is not None and at_once.restitution is not None
        off = drop.restitution.value - at_once.restitution.value
        assert abs(off) < at_once.restitution.std_error


def test_a_drop_of_which_more_is_heard_is_told_again_by_its_number() -> None:
    rate, samples = 8_000, np.zeros(10 * 8_000, np.float32)
    at_s, flight_s = 0.5, 1.0
    for number in range(29):
        # As two of them are not heard, it seems to be over before.
        if number not in (7, 8):
            samples[round(at_s * rate)] = 0.5
        at_s, flight_s = at_s + flight_s, 0.85 * flight_s
    first, again = Listener(rate).drops(np.array_split(samples, 100))
    assert first.number == again.number == 1
    assert first.drop.bounces == 7 and again.drop.bounces > 20


def test_blocks_of_any_length_give_the_same(pingpong: Synthetic) -> None:
    rate = pingpong.sample_rate_hz
    whole = bounce_audio.analyze(pingpong.samples, rate)
    for blocks in (3, 1000):
        listener = Listener(rate)
        for block in np.array_split(pingpong.samples, blocks):
            listener.push(block)
        listener.push(pingpong.samples[:0])
        assert listener.finish("samples") == whole


def test_two_channels_and_a_rule(pingpong: Synthetic) -> None:
    two = np.stack([0.1 * pingpong.samples, pingpong.samples])
    listener = Listener(pingpong.sample_rate_hz, 2, rule="ittf-ball")
    listener.push(two)
    report = listener.finish("samples")
    assert report == bounce_audio.analyze(
        two, pingpong.sample_rate_hz, rule="ittf-ball"
    )


def test_misuse_is_named() -> None:
    listener = Listener(48_000, 2, height_m=0.3)
    with pytest.raises(ArgumentError, match="1 channels, expected 2"):
        listener.push(np.zeros(100))
    listener.push(np.zeros((2, 100)))
    listener.finish()
    for call in (listener.finish, lambda: listener.push(np.zeros((2, 100)))):
        with pytest.raises(ArgumentError, match="finished"):
            call()
    with pytest.raises(ArgumentError, match="channels"):
        Listener(48_000, 0)
