"""Pictures by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._extras import needed_by

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .results import Drop

__all__ = ["restitution_by_speed"]


def restitution_by_speed(drop: Drop, ax: Axes | None) -> Axes:
    """e of each impact against its speed with error bars, and e of the drop with its interval."""
    if ax is None:
        with needed_by("plot", "plot"):
            import matplotlib.pyplot as plt

        ax = plt.subplots()[1]
    impacts = drop.impacts[~np.isnan(drop.impacts["restitution"])]
    speeds = impacts["impact_speed_m_per_s"]
    ax.errorbar(
        speeds,
        impacts["restitution"],
        xerr=impacts["impact_speed_std_m_per_s"],
        yerr=impacts["restitution_std"],
        fmt="o",
        markersize=3,
        label="each impact",
    )
    if drop.restitution is not None:
        ax.axhline(drop.restitution.value, color="C1", label="the drop")
        if drop.restitution.interval95 is not None:
            ax.axhspan(*drop.restitution.interval95, color="C1", alpha=0.2)
    if speeds.size and (speeds > 0.0).all():
        _scale_by_ratios(ax)
    ax.set_xlabel("impact speed (m/s)")
    ax.set_ylabel("coefficient of restitution")
    ax.legend()
    return ax


def _scale_by_ratios(ax: Axes) -> None:
    """As in the sheet of the drop: speeds fall by a ratio from bounce to bounce. Labels are plain numbers."""
    from matplotlib.ticker import LogLocator, NullFormatter

    ax.set_xscale("log")
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter(NullFormatter())
