"""Results as a notebook shows them: the answer, what to know about it, and the level of the sound."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .errors import BounceAudioError

if TYPE_CHECKING:
    from . import _core
    from .results import Drop, Report, Restitution, Warning

__all__ = ["Picture", "of_drop", "of_report"]


@dataclass(frozen=True)
class Picture:
    """The picture of one drop of a report."""

    pictures: _core.Pictures
    number: int

    def svg(self, *, level_only: bool) -> str | None:
        return self.pictures.svg(self.number, level_only)

    @classmethod
    def attach(cls, report: Report, pictures: _core.Pictures) -> None:
        """Lets a report and its drops know their pictures."""
        object.__setattr__(report, "_picture", cls(pictures, 0))
        for number, drop in enumerate(report.drops):
            object.__setattr__(drop, "_picture", cls(pictures, number))


def of_drop(drop: Drop, picture: Picture | None, title: str = "Drop") -> str:
    """The answer of a drop, its warnings and its picture."""
    heard = f"{drop.bounces} bounces in {drop.observed_time_s:.3f} s, model: {drop.model.selected}"
    return (
        f"<div><b>{html.escape(title)}: {answer(drop.restitution)}</b><br>{html.escape(heard)}"
        f"{_list(drop.warnings)}{_svg(picture)}</div>"
    )


def of_report(report: Report, picture: Picture | None) -> str:
    """The drops of a report, or why there is none."""
    name = html.escape(report.file)
    warnings = _list(report.warnings)
    if not report.drops:
        return f"<div><b>{name}: no drop found</b>{warnings}{_svg(picture)}</div>"
    several = len(report.drops) > 1
    drops = (
        of_drop(drop, drop._picture, f"Drop {number}" if several else "Drop")
        for number, drop in enumerate(report.drops, 1)
    )
    return f"<div><b>{name}</b>{warnings}{''.join(drops)}</div>"


def answer(restitution: Restitution | None) -> str:
    """e with its error, to the two digits that this one leaves."""
    if restitution is None:
        return "e not determined"
    if not restitution.std_error or restitution.interval95 is None:
        return f"e = {restitution.value:.3f} (no error: a single ratio)"
    digits = _digits(restitution.std_error)
    low, high = (f"{end:.{digits}f}" for end in restitution.interval95)
    return (
        f"e = {restitution.value:.{digits}f} ± {restitution.std_error:.{digits}f} "
        f"(95 %: {low} to {high})"
    )


def _digits(std: float) -> int:
    return min(max(1 - math.floor(math.log10(std)), 1), 8)


def _list(warnings: Iterable[Warning]) -> str:
    items = "".join(f"<li>{html.escape(w.message)}</li>" for w in warnings)
    return f"<ul>{items}</ul>" if items else ""


def _svg(picture: Picture | None) -> str:
    if picture is None:
        return ""
    try:
        svg = picture.svg(level_only=True)
    except (OSError, BounceAudioError):
        # A file that was there when it was analyzed may be gone; the answer stands without its picture.
        return ""
    # The picture has a size of its own: where there is less room it shrinks.
    fitting = (svg or "").replace("<svg ", '<svg style="max-width: 100%; height: auto" ', 1)
    return f'<div style="max-width: 900px">{fitting}</div>'
