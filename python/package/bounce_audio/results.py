"""What was found, as data. Fields have the names and units of the JSON document of the command line.

Numbers that do not exist are `None`, and NaN in arrays. Sequences are tuples.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import numpy.typing as npt

from . import _notebook
from ._documents import Document, structured
from ._extras import needed_by

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

__all__ = [
    "IMPACT",
    "Ball",
    "Budget",
    "Candidate",
    "Drop",
    "Estimate",
    "Estimates",
    "Irregular",
    "Judged",
    "Model",
    "ModelCandidate",
    "Parameters",
    "Prediction",
    "Reach",
    "Rebound",
    "Rebounds",
    "Recording",
    "Rejected",
    "Release",
    "Report",
    "Restitution",
    "RuleReport",
    "Scatter",
    "SettingsUsed",
    "Spread",
    "Told",
    "Unfitted",
    "Warning",
]

#: The type of an array of impacts, one row each. Times are in seconds from the first sample, NaN where there is no number.
IMPACT = np.dtype(
    [
        ("time_s", "f8"),
        ("time_std_s", "f8"),
        ("level_db", "f8"),
        ("interval_s", "f8"),
        ("ratio", "f8"),
        ("rebound_height_m", "f8"),
        ("rebound_height_std_m", "f8"),
        ("impact_speed_m_per_s", "f8"),
        ("impact_speed_std_m_per_s", "f8"),
        ("rebound_speed_m_per_s", "f8"),
        ("rebound_speed_std_m_per_s", "f8"),
        ("restitution", "f8"),
        ("restitution_std", "f8"),
        ("energy_kept", "f8"),
        ("energy_kept_std", "f8"),
        ("status", "U8"),
    ]
)

_TABLE = partial(structured, dtype=IMPACT)


@dataclass(frozen=True, eq=False)
class Warning(Document):
    """A warning: a word for programs and a sentence for people, with its remedy."""

    code: str
    message: str


@dataclass(frozen=True, eq=False)
class Recording(Document):
    """The recording: rate, channels, the one (from 1) that most drops were heard on, length, form of its samples."""

    sample_rate_hz: float
    channels: int
    channel: int
    duration_s: float
    encoding: str


@dataclass(frozen=True, eq=False)
class SettingsUsed(Document):
    """The settings that were used; see `Settings`."""

    height_m: float | None
    height_std_m: float
    gravity_m_per_s2: float
    mass_kg: float | None
    diameter_m: float | None
    contact_time_s: float | None
    model: str
    start_s: float | None
    end_s: float | None
    timing: str
    time_scale: float
    clock_std: float


@dataclass(frozen=True, eq=False)
class Estimate(Document):
    """A value, its standard error and its 95 % interval; both None where the data do not tell."""

    value: float
    std_error: float | None
    interval95: tuple[float, ...] | None


@dataclass(frozen=True, eq=False)
class Restitution(Document):
    """The coefficient of restitution: e with its error, the mean impact speed it belongs to, and how it was found."""

    value: float
    std_error: float | None
    interval95: tuple[float, ...] | None
    at_speed_m_per_s: float | None
    method: str


@dataclass(frozen=True, eq=False)
class Estimates(Document):
    """Ways to e, side by side: ratios of flights, equations (25) and (30), height of the first rebound."""

    flight_ratio: Estimate | None
    eq25: Estimate | None
    eq30: Estimate | None
    first_rebound: Estimate | None


@dataclass(frozen=True, eq=False)
class Scatter(Document):
    """Median standard error of the times, and standard deviation of ln e from bounce to bounce."""

    timing_std_s: float | None
    bounce_std: float | None


@dataclass(frozen=True, eq=False)
class Parameters(Document):
    """The parameters of a model; None where it has not got one."""

    _left_out_if_empty = frozenset(
        ("contact_time_s", "drag_per_s2", "restitution", "speed_exponent")
    )

    contact_time_s: Estimate | None = None
    drag_per_s2: Estimate | None = None
    restitution: float | None = None
    speed_exponent: Estimate | None = None


@dataclass(frozen=True, eq=False)
class ModelCandidate(Document):
    """A model and how well it explains the drop: ln of its evidence less that of the first, and its e."""

    model: str
    gain_nats: float
    restitution: float


@dataclass(frozen=True, eq=False)
class Unfitted(Document):
    """A model that could not be fitted, and why."""

    model: str
    reason: str


@dataclass(frozen=True, eq=False)
class Model(Document):
    """The model of the flights: the one selected, what was given, its parameters, and what it was compared with."""

    _left_out_if_empty = frozenset(("unfitted",))

    selected: str
    given: tuple[str, ...]
    parameters: Parameters
    candidates: tuple[ModelCandidate, ...]
    alike: str | None
    unfitted: tuple[Unfitted, ...] = ()


@dataclass(frozen=True, eq=False)
class Ball(Document):
    """The ball as spring and damper. Stiffness and damping are None without a mass."""

    contact_time_s: float
    contact_time_std_s: float
    stiffness_n_per_m: float | None
    stiffness_std_n_per_m: float | None
    damping_n_s_per_m: float | None
    damping_std_n_s_per_m: float | None
    natural_frequency_rad_per_s: float
    natural_frequency_std_rad_per_s: float
    damping_ratio: float
    damping_ratio_std: float
    release_rule: str
    source: str


@dataclass(frozen=True, eq=False)
class Budget(Document):
    """Where the error of e comes from, as shares of its variance that make 1."""

    timing: float
    bounce: float
    inputs: float
    noise_sizes: float
    model: float


@dataclass(frozen=True, eq=False)
class Irregular(Document):
    """A bounce that does not go by the e of the others; `impact` counts from 1."""

    impact: int
    time_s: float
    kind: str
    ratio: float
    expected_ratio: float
    other_restitution: Estimate | None


@dataclass(frozen=True, eq=False)
class Rejected(Document):
    """A strong sound that is no impact, and why."""

    time_s: float
    reason: str
    detail: str


@dataclass(frozen=True, eq=False)
class Rebound(Document):
    """The rebound after the first impact: heights in metres, e, and resilience, the share of the height that is kept."""

    drop_height_m: float
    impact_speed_m_per_s: float
    height_m: Estimate
    restitution: Estimate
    resilience: Estimate


@dataclass(frozen=True, eq=False)
class Release(Document):
    """The release by the first flights: its height under the gravity of the settings, and gravity by their height."""

    height_m: Estimate
    gravity_m_per_s2: Estimate | None


@dataclass(frozen=True, eq=False)
class Rebounds(Document):
    """How high the ball comes back from a height, in metres: after each bounce, ten unless it comes to rest before."""

    drop_height_m: float
    heights_m: tuple[Estimate, ...]


@dataclass(frozen=True, eq=False)
class Reach(Document):
    """From how high the ball must fall for a bounce (from 1) to rise to `height_m`; None if 10,000 times that is too low."""

    bounce: int
    height_m: float
    drop_height_m: Estimate | None


@dataclass(frozen=True, eq=False)
class Prediction(Document):
    """What another drop of the ball would do, with the errors of one drop: what was not asked is None."""

    rebounds: Rebounds | None
    reach: Reach | None


@dataclass(frozen=True, eq=False)
class Drop(Document):
    """One drop. `restitution.value` is the answer, `impacts` an array with a row for each impact (see `IMPACT`)."""

    _left_out_if_empty = frozenset(("prediction",))

    channel: int
    impacts: Annotated[npt.NDArray[np.void], _TABLE]
    bounces: int
    observed_time_s: float
    total_time_s: float | None
    restitution: Restitution | None
    estimates: Estimates
    #: None without a height, or where the first flight does not fit it.
    first_rebound: Rebound | None
    #: None where the first flights do not tell.
    release: Release | None
    scatter: Scatter
    model: Model
    ball: Ball | None
    budget: Budget | None
    #: None where the impacts were given and nothing was left to chance.
    evidence_nats: float | None
    irregular: tuple[Irregular, ...]
    rejected: tuple[Rejected, ...]
    warnings: tuple[Warning, ...]
    #: None unless `predict_from_m` or `reach_m` asked for it, and where e has no error.
    prediction: Prediction | None = None
    _picture: _notebook.Picture | None = field(default=None, repr=False)

    def to_dataframe(self) -> pd.DataFrame:
        """The impacts as a pandas table with a row for each, counted from 1.

        Raises `ModuleNotFoundError` where pandas is not installed.
        """
        with needed_by("to_dataframe", "pandas"):
            import pandas as pd

        rows = pd.RangeIndex(1, len(self.impacts) + 1, name="impact")
        columns = {name: self.impacts[name] for name in IMPACT.names or ()}
        return pd.DataFrame(columns, index=rows)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws e of each impact against its speed in m/s, with e of the drop, and gives the axes.

        `ax` are matplotlib axes to draw into; new ones by default. Raises `ModuleNotFoundError` where matplotlib is not installed.
        """
        from ._plot import restitution_by_speed

        return restitution_by_speed(self, ax)

    def to_svg(self) -> str | None:
        """The sheet of the drop as SVG: level, onsets, flights, e and heights; None where its sound is not at hand.

        It is at hand for what `analyze` and `analyze_file` gave, and not after pickling. A file is read again: if it is not
        there any more, `OSError` is raised.
        """
        return None if self._picture is None else self._picture.svg(level_only=False)

    def _repr_html_(self) -> str:
        return _notebook.of_drop(self, self._picture)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_picture": None}


@dataclass(frozen=True, eq=False)
class Told(Document):
    """A drop as it was heard so far, and its number from 1. A drop of which more was heard is told again by its number."""

    number: int
    drop: Drop


@dataclass(frozen=True, eq=False)
class Candidate(Document):
    """What comes nearest to a drop where there is none: its impacts, and the evidence it has and needs, in nats."""

    impacts: Annotated[npt.NDArray[np.void], _TABLE]
    evidence_nats: float
    needed_nats: float
    lack: str


@dataclass(frozen=True, eq=False)
class Judged(Document):
    """The verdict of a rule on one drop: "pass", "fail" or "undecided", and the rebound that it rests on (`evidence`)."""

    outcome: str
    evidence: str
    rebound_m: Estimate | None
    fitted_rebound_m: Estimate | None
    single_rebound_std_m: float | None
    impact_speed_m_per_s: float
    restitution: float | None
    measured_speeds_m_per_s: tuple[float, ...] | None
    extrapolated: bool
    would_decide: str | None


@dataclass(frozen=True, eq=False)
class Spread(Document):
    """How far apart the rebounds of so many drops may be, in metres."""

    greatest_m: float
    drops: int


@dataclass(frozen=True, eq=False)
class RuleReport(Document):
    """A rule and what each drop says of it."""

    name: str
    source: str
    drop_height_m: float
    allowed_m: tuple[float, ...]
    mass_kg: float
    diameter_m: float
    drops: tuple[Judged, ...]
    spread_m: float | None
    allowed_spread: Spread | None


@dataclass(frozen=True, eq=False)
class Report(Document):
    """Everything about one recording. Without a drop `drops` is empty, and `warnings[0]` says why."""

    schema_version: int
    file: str
    recording: Recording
    settings: SettingsUsed
    drops: tuple[Drop, ...]
    candidate: Candidate | None
    rejected: tuple[Rejected, ...]
    rejected_weak: int
    rule: RuleReport | None
    warnings: tuple[Warning, ...]
    _picture: _notebook.Picture | None = field(default=None, repr=False)

    def to_dataframe(self) -> pd.DataFrame:
        """A pandas table with a row for each impact of each drop, indexed by `drop` and `impact` from 1.

        Raises `ModuleNotFoundError` where pandas is not installed.
        """
        with needed_by("to_dataframe", "pandas"):
            import pandas as pd

        if not self.drops:
            return pd.DataFrame(columns=list(IMPACT.names or ()))
        tables = {i: drop.to_dataframe() for i, drop in enumerate(self.drops, 1)}
        return pd.concat(tables, names=["drop"])

    def _repr_html_(self) -> str:
        return _notebook.of_report(self, self._picture)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_picture": None}

