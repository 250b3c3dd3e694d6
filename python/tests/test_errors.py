"""Exceptions by kind."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bounce_audio
from bounce_audio import ArgumentError, InternalError, NoSolutionError, RecordingError
from bounce_audio import _core
from bounce_audio.settings import _WORDS

SILENCE = np.zeros(48_000, np.float32)


def test_no_drop_is_an_answer_with_its_reason() -> None:
    report = bounce_audio.analyze(SILENCE, 48_000)
    assert report.drops == ()
    assert report.warnings[0].code == "silence"
    assert "silent" in report.warnings[0].message


def test_paths_that_cannot_be_read_are_told_by_the_system(tmp_path: Path) -> None:
    missing = tmp_path / "missing.wav"
    with pytest.raises(FileNotFoundError) as raised:
        bounce_audio.analyze_file(missing)
    assert raised.value.filename == str(missing)
    with pytest.raises(RecordingError, match="directory"):
        bounce_audio.analyze_file(tmp_path)
    (tmp_path / "empty.wav").touch()
    with pytest.raises(RecordingError, match="empty"):
        bounce_audio.analyze_file(tmp_path / "empty.wav")


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"hight_m": 0.3}, "hight_m is no setting: did you mean height_m?.* rule"),
        ({"chanel": 2}, "did you mean channel?"),
        ({"xyz": 1}, "xyz is no setting: there are height_m,"),
        ({"height_m": -1}, "height_m is -1"),
        ({"height_std_m": -1}, "height_std_m is -1"),
        ({"gravity_m_per_s2": 0}, "gravity_m_per_s2 is 0"),
        ({"mass_kg": 0}, "mass_kg is 0"),
        ({"diameter_m": 0}, "diameter_m is 0"),
        ({"contact_time_s": 2}, "contact_time_s is 2"),
        ({"time_scale": 0}, "time_scale is 0"),
        ({"clock_std": 1}, "clock_std is 1"),
        ({"end_s": -1}, "end_s is -1"),
        ({"height_m": float("nan")}, "height_m is nan"),
        ({"height_m": "30cm"}, "height_m is '30cm', expected a number"),
        ({"mass_kg": [1, 2]}, "mass_kg is"),
        ({"model": "cubic"}, "model is 'cubic', expected one of auto, constant,"),
        ({"model": 3}, "model is 3, expected one of auto,"),
        ({"timing": "exact"}, "timing is 'exact', expected one of envelope, fraction,"),
        ({"channel": 0}, "channel is 0"),
        ({"channel": "left"}, "channel is 'left'"),
        ({"channel": 2**70}, "channel is 1"),
        ({"rule": "cricket"}, "rule is 'cricket'"),
        ({"start_s": 5}, "start_s is 5"),
        ({"predict_from_m": -1}, "predict_from_m is -1"),
        ({"reach_m": "high"}, "reach_m is"),
        ({"reach_m": 1, "reach_bounce": 1.5}, "reach_bounce is 1.5"),
        ({"reach_bounce": 2}, "reach_bounce is 2 without reach_m"),
    ],
)
def test_settings_that_are_wrong_are_named(
    settings: dict[str, object], said: str
) -> None:
    with pytest.raises(ArgumentError, match=said):
        bounce_audio.analyze(SILENCE, 48_000, **settings)  # type: ignore[arg-type]


def test_the_words_of_settings_are_those_of_the_library() -> None:
    for name, words in _WORDS.items():
        for word in words:
            settings: Any = {name: word}
            used = bounce_audio.analyze(SILENCE, 48_000, **settings).settings
            assert getattr(used, name) == word
        with pytest.raises(ArgumentError, match=f"`{'`, `'.join(words)}`$"):
            _core.Listener(48_000.0, 1, f'{{"{name}": "no"}}', None)


@pytest.mark.parametrize(
    "rate", [0, -48_000, 100, float("nan"), float("inf"), "48000", None]
)
def test_rates_that_are_none_are_refused(rate: Any) -> None:
    with pytest.raises(ArgumentError, match="rate"):
        bounce_audio.analyze(SILENCE, rate)


def test_what_was_meant_otherwise_says_what_to_do(recording: Path) -> None:
    with pytest.raises(ArgumentError, match="analyze_file listens to a file"):
        bounce_audio.analyze(str(recording), 48_000)
    with pytest.raises(ArgumentError, match=r"scene is 'pong', .*presets\(\)"):
        bounce_audio.synth("pong")
    for seed in (-1, 2**64, 1.5):
        with pytest.raises(ArgumentError, match=f"seed is {seed}, expected"):
            bounce_audio.synth(seed=seed)  # type: ignore[arg-type]
    for channels in (-1, 1.5):
        with pytest.raises(ArgumentError, match=f"channels is {channels}, expected"):
            bounce_audio.Listener(48_000, channels)  # type: ignore[arg-type]
    with pytest.raises(ArgumentError, match="content is of type str, expected bytes"):
        bounce_audio.analyze_bytes("drop.wav")  # type: ignore[arg-type]
    with pytest.raises(ArgumentError, match="160 Hz or more"):
        bounce_audio.analyze(SILENCE, 100)
    by_bytes = bounce_audio.analyze_file(bytes(recording))  # type: ignore[arg-type]
    assert by_bytes == bounce_audio.analyze_file(recording)


def test_a_recording_may_lie_in_any_buffer(recording: Path) -> None:
    content = recording.read_bytes()
    report = bounce_audio.analyze_bytes(content)
    for buffer in (bytearray(content), memoryview(content), np.frombuffer(content, "u1")):
        assert bounce_audio.analyze_bytes(buffer) == report


def test_numbers_of_numpy_are_numbers(pingpong: bounce_audio.Synthetic) -> None:
    rate = np.int64(pingpong.sample_rate_hz)
    report = bounce_audio.analyze(
        pingpong.samples, float(rate), height_m=float(np.float32(0.305))
    )
    same = bounce_audio.analyze(pingpong.samples, rate, height_m=np.float32(0.305))  # type: ignore[arg-type]
    chosen = bounce_audio.analyze(pingpong.samples, rate, height_m=0.305, channel=np.int64(1))  # type: ignore[arg-type]
    assert chosen.drops and chosen.recording.channel == 1
    assert same == report and report.settings.height_m == float(np.float32(0.305))


def test_what_has_no_solution_says_what_has() -> None:
    with pytest.raises(NoSolutionError, match="attainable"):
        bounce_audio.solve(bounces=70, total_time_s=700.0, height_m=0.305)
    with pytest.raises(ArgumentError, match="expected bounces"):
        bounce_audio.solve(bounces=70)  # type: ignore[call-overload]
    with pytest.raises(ArgumentError, match="bounces is -1"):
        bounce_audio.solve(bounces=-1, total_time_s=7.0, height_m=0.305)
    with pytest.raises(ArgumentError, match="'speed' is not known"):
        bounce_audio.solve(
            restitution=0.9, contact_time_s=0.001, std_error={"speed": 1.0}
        )


def test_a_bug_becomes_an_exception_that_can_be_caught() -> None:
    with pytest.raises(InternalError, match="own mistake: asked to"):
        _core.break_off()


def test_exceptions_travel_between_processes() -> None:
    for kind in (ArgumentError, InternalError, NoSolutionError, RecordingError):
        back = pickle.loads(pickle.dumps(kind("why")))
        assert type(back) is kind and str(back) == "why"
        assert isinstance(back, bounce_audio.BounceAudioError)
