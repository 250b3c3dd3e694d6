"""What Python says is what the command line says, to the digit."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

import bounce_audio
from bounce_audio import Settings
from bounce_audio.errors import RecordingError
from conftest import PROJECT, Command

FOLDERS = [PROJECT / "fixtures/wav-variants", PROJECT / "fixtures/compressed"]
OTHERS = os.environ.get("BOUNCE_AUDIO_RECORDINGS")
NO_RECORDING = {".md", ".sh", ".toml", ".json"}
FILES = [
    path
    for folder in [*FOLDERS, *([Path(OTHERS)] if OTHERS else [])]
    for path in sorted(folder.iterdir())
    if path.suffix not in NO_RECORDING
]


# Opus, WebM and Matroska are left to the command: they are larger than what is left of the wheel's two megabytes.
OPUS = [path for path in FILES if path.suffix in {".opus", ".webm", ".mka"} or "opus" in path.name]


def test_there_are_fixtures() -> None:
    assert len(FILES) > 60 and len(OPUS) > 3


@pytest.mark.parametrize("path", OPUS, ids=lambda path: path.name)
def test_opus_is_refused_with_the_command_that_converts_it(path: Path) -> None:
    with pytest.raises(RecordingError, match=r"it is (Opus|WebM or Matroska), which is not read; ffmpeg -i IN\.\w+ OUT\.wav"):
        bounce_audio.analyze_file(path)


@pytest.mark.parametrize("path", sorted(set(FILES) - set(OPUS)), ids=lambda path: path.name)
def test_a_file_gives_the_document_of_the_command(path: Path, command: Command) -> None:
    done = command("analyze", path, "--format", "json")
    if done.returncode == 2:
        with pytest.raises(RecordingError) as raised:
            bounce_audio.analyze_file(path)
        assert done.stderr == f"bounce-audio: {raised.value}\n"
        return
    report = bounce_audio.analyze_file(path)
    assert report.to_dict() == json.loads(done.stdout)
    content = bounce_audio.analyze_bytes(path.read_bytes(), name=str(path))
    assert content == report


def test_settings_and_a_rule_give_it_too(recording: Path, command: Command) -> None:
    words = "--height 30.5cm --height-error 2mm --gravity 9.8 --model drag --end 6s --channel 1 --rule ittf-ball"
    done = command("analyze", recording, *words.split(), "--format", "json")
    report = bounce_audio.analyze_file(
        recording,
        height_m=0.305,
        height_std_m=0.002,
        gravity_m_per_s2=9.8,
        model="drag",
        end_s=6,
        channel=1,
        rule="ittf-ball",
    )
    assert report.to_dict() == json.loads(done.stdout)
    assert report.rule is not None and report.rule.drops[0].rebound_m is not None


def test_predictions_are_those_of_the_command(
    recording: Path, pingpong: bounce_audio.Synthetic, command: Command
) -> None:
    words = "--predict 30.5cm --reach 1m --reach-bounce 3"
    done = command("analyze", recording, *words.split(), "--format", "json")
    asked: Settings = {"predict_from_m": 0.305, "reach_m": 1.0, "reach_bounce": 3}
    report = bounce_audio.analyze_file(recording, **asked)
    assert report.to_dict() == json.loads(done.stdout)
    [drop] = report.drops
    prediction = drop.prediction
    assert prediction is not None and prediction.rebounds is not None
    heights = [height.value for height in prediction.rebounds.heights_m]
    assert len(heights) == 10 and heights == sorted(heights, reverse=True)
    assert prediction.reach is not None and prediction.reach.bounce == 3
    # The other ways to a drop give it too.
    samples, rate = pingpong.samples, pingpong.sample_rate_hz
    by_samples = bounce_audio.analyze(samples, rate, **asked).drops[0]
    assert by_samples.prediction is not None
    listener = bounce_audio.Listener(rate, **asked)
    told = list(listener.drops([samples]))
    assert told[0].drop.prediction is not None and listener.report is not None
    assert listener.report.drops[0].prediction == by_samples.prediction
    times = drop.impacts["time_s"], drop.impacts["time_std_s"]
    assert bounce_audio.fit(*times, **asked).prediction is not None
    assert "prediction" not in bounce_audio.fit(*times).to_dict()


def test_samples_give_what_their_file_does(
    recording: Path, pingpong: bounce_audio.Synthetic
) -> None:
    of_file = bounce_audio.analyze_file(recording, height_m=0.305)
    integers = np.rint(pingpong.samples * 32768.0).astype(np.int16)
    of_samples = bounce_audio.analyze(
        integers, pingpong.sample_rate_hz, name=str(recording), height_m=0.305
    )
    assert of_samples == of_file


@pytest.mark.parametrize(
    ("words", "numbers"),
    [
        (
            "--bounces 70 --total-time 7.5 --height 0.305 --mass 0.0025 --total-time-error 0.05",
            {
                "bounces": 70,
                "total_time_s": 7.5,
                "height_m": 0.305,
                "mass_kg": 0.0025,
                "std_error": {"total_time_s": 0.05},
            },
        ),
        (
            "--restitution 0.93 --contact-time 0.001 --height 0.3 --gravity 9.8",
            {
                "restitution": 0.93,
                "contact_time_s": 0.001,
                "height_m": 0.3,
                "gravity_m_per_s2": 9.8,
            },
        ),
    ],
)
def test_a_ball_is_solved_alike(
    words: str, numbers: dict[str, object], command: Command
) -> None:
    done = command("solve", *words.split(), "--format", "json")
    solved = bounce_audio.solve(**numbers)  # type: ignore[call-overload]
    assert solved.to_dict() == json.loads(done.stdout)


def test_a_scene_is_made_alike(
    tmp_path: Path, pingpong: bounce_audio.Synthetic, recording: Path
) -> None:
    truth = json.loads(recording.with_suffix(".truth.json").read_text())
    assert pingpong.truth.to_dict() == truth
    scene = PROJECT / "assets/scenes/stereo.toml"
    by_file, by_name = bounce_audio.synth(scene), bounce_audio.synth("stereo")
    assert by_file.samples.shape[0] == 2
    assert np.array_equal(by_file.samples, by_name.samples)
