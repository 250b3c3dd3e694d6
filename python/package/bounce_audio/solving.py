"""The ball from numbers instead of a recording."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import overload

from . import _core
from ._documents import Document, build
from .errors import ArgumentError
from .results import Warning
from .settings import whole

__all__ = [
    "BallParameters",
    "Conditioning",
    "ContactInputs",
    "ContactSolution",
    "GivenErrors",
    "Rest",
    "SolvedBall",
    "TotalTimeInputs",
    "TotalTimeSolution",
    "solve",
]


@dataclass(frozen=True, eq=False)
class GivenErrors(Document):
    """Standard errors of the inputs."""

    total_time_s: float | None
    height_m: float | None
    gravity_m_per_s2: float | None
    mass_kg: float | None
    contact_time_s: float | None
    restitution: float | None


@dataclass(frozen=True, eq=False)
class TotalTimeInputs(Document):
    """What a whole drop was solved from."""

    bounces: int
    total_time_s: float
    height_m: float
    contact_time_s: float | None
    gravity_m_per_s2: float
    mass_kg: float | None
    std_error: GivenErrors


@dataclass(frozen=True, eq=False)
class ContactInputs(Document):
    """What one bounce was solved from."""

    restitution: float
    contact_time_s: float
    height_m: float | None
    gravity_m_per_s2: float
    mass_kg: float | None
    std_error: GivenErrors


@dataclass(frozen=True, eq=False)
class BallParameters(Document):
    """The numbers of a ball; or, in the same fields, their standard errors."""

    restitution: float
    contact_time_s: float | None
    stiffness_n_per_m: float | None
    damping_n_s_per_m: float | None
    stiffness_per_mass_per_s2: float | None
    damping_per_mass_per_s: float | None
    natural_frequency_rad_per_s: float | None
    natural_frequency_hz: float | None
    damping_ratio: float | None


@dataclass(frozen=True, eq=False)
class Rest(Document):
    """How many impacts the ball makes until it rests, by equation (19) and exactly."""

    impacts_by_eq19: int
    impacts_exact: int | None
    last_impact_exact_s: float | None


@dataclass(frozen=True, eq=False)
class SolvedBall(BallParameters):
    """A ball, when it would come to rest, and its standard errors; these are None where no input has one."""

    release_rule: str
    rest: Rest | None
    std_error: BallParameters | None


@dataclass(frozen=True, eq=False)
class Conditioning(Document):
    """How much the contact time of equation (20) leans on what it was made from."""

    contact_time_per_restitution: float
    contact_time_per_total_time: float
    restitution_rounded: float | None
    contact_time_rounded_s: float | None
    rest_at_given_contact_time: Rest | None
    contact_time_one_more_bounce_s: float | None


@dataclass(frozen=True, eq=False)
class TotalTimeSolution(Document):
    """The ball of a whole drop, by each equation."""

    inputs: TotalTimeInputs
    eq25: SolvedBall
    eq30: SolvedBall
    with_contact_time: SolvedBall | None
    conditioning: Conditioning
    warnings: tuple[Warning, ...]


@dataclass(frozen=True, eq=False)
class ContactSolution(Document):
    """The ball of one bounce."""

    inputs: ContactInputs
    ball: SolvedBall
    warnings: tuple[Warning, ...]


@overload
def solve(
    *,
    bounces: int,
    total_time_s: float,
    height_m: float,
    restitution: None = None,
    contact_time_s: float | None = None,
    mass_kg: float | None = None,
    gravity_m_per_s2: float = 9.81,
    std_error: dict[str, float] | None = None,
) -> TotalTimeSolution: ...


@overload
def solve(
    *,
    bounces: None = None,
    total_time_s: None = None,
    restitution: float,
    contact_time_s: float,
    height_m: float | None = None,
    mass_kg: float | None = None,
    gravity_m_per_s2: float = 9.81,
    std_error: dict[str, float] | None = None,
) -> ContactSolution: ...


def solve(
    *,
    bounces: int | None = None,
    total_time_s: float | None = None,
    height_m: float | None = None,
    restitution: float | None = None,
    contact_time_s: float | None = None,
    mass_kg: float | None = None,
    gravity_m_per_s2: float = 9.81,
    std_error: dict[str, float] | None = None,
) -> TotalTimeSolution | ContactSolution:
    """Finds the ball: restitution, contact time, stiffness, damping.

    Two ways lead to it. From a whole drop: `bounces` from release to rest, `total_time_s` and `height_m`. From one bounce:
    `restitution` and `contact_time_s`. With `mass_kg` there are stiffness and damping, without it both divided by the mass.
    `std_error` has the standard errors of the inputs by their names; results then have theirs.

    Raises `ArgumentError` for a number out of range or an incomplete choice, `NoSolutionError` if no ball fits.

    >>> import bounce_audio
    >>> solved = bounce_audio.solve(bounces=70, total_time_s=7.5, height_m=0.305, mass_kg=0.0025)
    >>> round(solved.eq25.restitution, 5)
    0.93347
    """
    errors = _errors(std_error or {})
    ball = (gravity_m_per_s2, mass_kg, errors)
    match (bounces, total_time_s, height_m, restitution, contact_time_s):
        case (int(), _, _, None, _) if total_time_s is not None and height_m is not None:
            count = whole("bounces", bounces, 0, 2**32 - 1)
            numbers = (count, total_time_s, height_m, contact_time_s)
            document = _core.solve_total_time(*numbers, *ball)
            return build(TotalTimeSolution, json.loads(document))
        case (None, None, _, _, _) if restitution is not None and contact_time_s is not None:
            document = _core.solve_contact(restitution, contact_time_s, height_m, *ball)
            return build(ContactSolution, json.loads(document))
    raise ArgumentError(
        "expected bounces, total_time_s and height_m, or restitution and contact_time_s"
    )


_ERRORS = tuple(GivenErrors.__dataclass_fields__)


def _errors(given: dict[str, float]) -> list[float | None]:
    for name in given:
        if name not in _ERRORS:
            raise ArgumentError(
                f"std_error of {name!r} is not known, expected one of {', '.join(_ERRORS)}"
            )
    return [given.get(name) for name in _ERRORS]
