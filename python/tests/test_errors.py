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
        ({"hight_m": 0.3}, "hight_m is no setting.* height_m"),
        ({"height_m": -1}, "height is -1"),
        ({"height_m": float("nan")}, "height_m is nan"),
        ({"height_m": "30cm"}, "height_m is '30cm', expected a number"),
        ({"mass_kg": [1, 2]}, "mass_kg is"),
        ({"model": "cubic"}, "cubic"),
        ({"model": 3}, "model is 3, expected a name"),
        ({"channel": 0}, "channel is 0"),
        ({"channel": "left"}, "channel is 'left'"),
        ({"rule": "cricket"}, "rule is 'cricket'"),
        ({"start_s": 5}, "start is 5"),
        ({"predict_from_m": -1}, "predict_from_m is -1"),
        ({"reach_m": "high"}, "reach_m is"),
        ({"reach_m": 1, "reach_bounce": 1.5}, "reach_bounce is 1.5"),
    ],
)
def test_settings_that_are_wrong_are_named(
    settings: dict[str, object], said: str
) -> None:
    with pytest.raises(ArgumentError, match=said):
        bounce_audio.analyze(SILENCE, 48_000, **settings)  # type: ignore[arg-type]


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
    by_bytes = bounce_audio.analyze_file(bytes(recording))  # type: ignore[arg-type]
    assert by_bytes == bounce_audio.analyze_file(recording)


def test_numbers_of_numpy_are_numbers(pingpong: bounce_audio.Synthetic) -> None:
    rate = np.int64(pingpong.sample_rate_hz)
    report = bounce_audio.analyze(
        pingpong.samples, float(rate), height_m=float(np.float32(0.305))
    )
    same = bounce_audio.analyze(pingpong.samples, rate, height_m=np.float32(0.305))  # type: ignore[arg-type]
    assert same == report and report.settings.height_m == float(np.float32(0.305))


def test_what_has_no_solution_says_what_has() -> None:
    with pytest.raises(NoSolutionError, match="attainable"):
        bounce_audio.solve(bounces=70, total_time_s=700.0, height_m=0.305)
    with pytest.raises(ArgumentError, match="expected bounces"):
        bounce_audio.solve(bounces=70)  # type: ignore[call-overload]
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
