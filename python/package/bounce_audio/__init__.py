"""Listens to a recording of a ball bouncing and says what the ball is like.

>>> import bounce_audio
>>> made = bounce_audio.synth("pingpong")
>>> report = bounce_audio.analyze(made.samples, made.sample_rate_hz)
>>> e = report.drops[0].restitution
>>> e.interval95[0] < made.truth.drops[0].restitution < e.interval95[1]
True

`analyze` takes samples in memory, `analyze_file` a recording, `Listener` a stream, `fit` times alone; `solve` finds the
ball from numbers, `synth` makes recordings with known truth, `compare` puts many drops together, `rules` names the rules of
sports. `bounce_audio.dask` listens to a folder on many machines, of which `summary` says the end.
"""

from ._core import VERSION as __version__
from .comparing import Comparison, Outlier, Rule, compare, rules
from .errors import (
    ArgumentError,
    BounceAudioError,
    InternalError,
    NoSolutionError,
    RecordingError,
)
from .folders import summary
from .listening import Listener, analyze, analyze_bytes, analyze_file, fit
from .results import IMPACT, Drop, Report, Told
from .settings import Settings
from .solving import solve
from .synthesis import Synthetic, Truth, presets, synth

__all__ = [
    "IMPACT",
    "ArgumentError",
    "BounceAudioError",
    "Comparison",
    "Drop",
    "InternalError",
    "Listener",
    "NoSolutionError",
    "Outlier",
    "RecordingError",
    "Report",
    "Rule",
    "Settings",
    "Synthetic",
    "Told",
    "Truth",
    "__version__",
    "analyze",
    "analyze_bytes",
    "analyze_file",
    "compare",
    "fit",
    "presets",
    "rules",
    "solve",
    "summary",
    "synth",
]
