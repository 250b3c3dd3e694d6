from typing import final

import numpy as np
import numpy.typing as npt
from typing_extensions import Self

__all__ = [
    "Digests",
    "Listener",
    "Pictures",
    "VERSION",
    "analyze",
    "analyze_bytes",
    "analyze_file",
    "break_off",
    "compare",
    "drop_columns",
    "drop_rows",
    "fit",
    "is_named_as_recording",
    "presets",
    "rules",
    "solve_contact",
    "solve_total_time",
    "synth",
    "system_words",
]

VERSION: str

@final
class Pictures:
    def svg(self, number: int, level_only: bool) -> str | None: ...

@final
class Digests:
    def __new__(cls) -> Self: ...
    def add(self, lines: list[str]) -> None: ...
    def summary(self) -> str: ...

@final
class Listener:
    def __new__(
        cls, sample_rate_hz: float, channels: int, settings: str, rule: str | None
    ) -> Self: ...
    def push(self, samples: npt.NDArray[np.float32]) -> str: ...
    def rest(self) -> str: ...
    def finish(self, name: str, encoding: str) -> str: ...

def analyze(
    samples: npt.NDArray[np.float32],
    sample_rate_hz: float,
    settings: str,
    *,
    channel: int | None,
    rule: str | None,
    name: str,
    encoding: str,
) -> tuple[str, Pictures]: ...
def analyze_bytes(
    content: bytes, name: str, settings: str, *, channel: int | None, rule: str | None
) -> str: ...
def analyze_file(
    path: str, settings: str, *, channel: int | None, rule: str | None
) -> tuple[str, Pictures]: ...
def break_off() -> None: ...
def compare(measurements: list[tuple[float, float]]) -> str: ...
def drop_columns() -> list[str]: ...
def drop_rows(lines: list[str]) -> str: ...
def fit(times_s: list[float], errors_s: list[float], document: str) -> str: ...
def is_named_as_recording(path: str) -> bool: ...
def presets() -> list[tuple[str, str]]: ...
def rules() -> str: ...
def solve_contact(
    restitution: float,
    contact_time_s: float,
    height_m: float | None,
    gravity_m_per_s2: float,
    mass_kg: float | None,
    errors: list[float | None],
) -> str: ...
def solve_total_time(
    bounces: int,
    total_time_s: float,
    height_m: float,
    contact_time_s: float | None,
    gravity_m_per_s2: float,
    mass_kg: float | None,
    errors: list[float | None],
) -> str: ...
def synth(
    scene: str, is_text: bool, seed: int
) -> tuple[npt.NDArray[np.float32], str]: ...
def system_words(number: int) -> str: ...
