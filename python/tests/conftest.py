"""What the tests share: the command line, and recordings."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import bounce_audio

PROJECT = Path(__file__).resolve().parents[2]

Command = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session")
def command() -> Command:
    """Runs `bounce-audio` with arguments; BOUNCE_AUDIO_COMMAND says where it is."""
    program = os.environ.get("BOUNCE_AUDIO_COMMAND")
    if program is None:
        pytest.fail("BOUNCE_AUDIO_COMMAND has to name the command to compare with")

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        words = [program, *map(str, arguments)]
        return subprocess.run(words, capture_output=True, text=True, check=False)

    return run


@pytest.fixture(scope="session")
def pingpong() -> bounce_audio.Synthetic:
    """A ping-pong ball, of which much is heard."""
    return bounce_audio.synth("pingpong")


@pytest.fixture(scope="session")
def recording(command: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same ball in a file."""
    path = tmp_path_factory.mktemp("recording") / "pingpong.wav"
    assert command("synth", "--preset", "pingpong", "-o", path).returncode == 0
    return path
