"""Many drops together, and the rules of sports."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass

from . import _core
from ._documents import Document, build
from .errors import ArgumentError
from .results import Drop, Report, Spread

__all__ = ["Comparison", "Outlier", "Rule", "compare", "rules"]


@dataclass(frozen=True, eq=False)
class Outlier(Document):
    """A measurement far from the others: its index from 0, and its distance from the median in standard deviations."""

    index: int
    distance: float


@dataclass(frozen=True, eq=False)
class Comparison(Document):
    """The random-effects mean of measurements, and whether they differ by more than their errors claim."""

    count: int
    mean: float
    mean_std: float
    #: Standard deviation of the values, and that which their errors claim.
    spread: float
    claimed: float
    #: Standard deviation between the measurements beside their errors.
    between: float
    chi_square: float
    #: Probability of a greater χ² by chance, if the errors are right.
    chance: float
    #: √(χ²/(N − 1)): about 1 where they differ as much as they claim.
    birge: float
    outliers: tuple[Outlier, ...]


def compare(
    measurements: Iterable[Report | Drop | tuple[float, float]],
) -> Comparison:
    """The mean e of drops, and whether they differ by more than their errors claim.

    Each item is a drop, a report, of which all drops count, or a value with its standard error. Drops whose e has no error
    are left out. `outliers` counts in the order of what is left.

    Raises `ArgumentError` for fewer than two measurements, an error that is not above 0, or what is none of these.

    >>> import bounce_audio
    >>> together = bounce_audio.compare([(0.90, 0.01), (0.91, 0.01), (0.92, 0.01)])
    >>> round(together.mean, 3), round(together.birge, 3)
    (0.91, 1.0)
    """
    if isinstance(measurements, (Report, Drop)):
        raise ArgumentError("compare takes several in a list: of one report they are report.drops")
    pairs = [pair for item in measurements for pair in _pairs(item)]
    if len(pairs) < 2:
        raise ArgumentError(f"there are {len(pairs)} measurements, expected two or more")
    for value, std in pairs:
        if not 0.0 < std < float("inf") or value != value:
            raise ArgumentError(f"({value}, {std}) is no value with an error above 0")
    return build(Comparison, json.loads(_core.compare(pairs)))


def _pairs(item: Report | Drop | tuple[float, float]) -> list[tuple[float, float]]:
    if isinstance(item, Report):
        return [pair for drop in item.drops for pair in _pairs(drop)]
    if isinstance(item, Drop):
        e = item.restitution
        return [(e.value, e.std_error)] if e is not None and e.std_error else []
    try:
        value, std = item
        return [(float(value), float(std))]
    except (TypeError, ValueError):
        raise ArgumentError(
            f"{item!r} is no value with its error, such as (0.9, 0.01), and neither a drop nor a report: "
            "those of a report are report.drops"
        ) from None


@dataclass(frozen=True, eq=False)
class Rule(Document):
    """How a rule book tests a ball: heights in metres to the ball's lowest point, mass in kg, diameter in metres."""

    name: str
    about: str
    source: str
    drop_height_m: float
    allowed_m: tuple[float, ...]
    mass_kg: float
    diameter_m: float
    allowed_spread: Spread | None


def rules() -> tuple[Rule, ...]:
    """The rules that `analyze(..., rule=NAME)` can judge by.

    >>> import bounce_audio
    >>> bounce_audio.rules()[0].name
    'ittf-ball'
    """
    return tuple(build(Rule, rule) for rule in json.loads(_core.rules()))
