"""What was heard in a folder, by the shards that `bounce_audio.dask` wrote."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from . import _core
from ._extras import needed_by
from .errors import ArgumentError

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["lines", "summary", "to_dataframe"]

#: Where a run says which shards are its own, in order.
RUN = "run.json"


def summary(out: str | os.PathLike[str]) -> str:
    """What `bounce-audio batch` says at its end, of a folder that `bounce_audio.dask.analyze_folder` wrote.

    A line for each drop, then the mean e, whether drops differ by more than their errors claim, and the outliers.

    Raises `ArgumentError` if the run is not finished: run it again, and it goes on where it was.
    """
    digests = _core.Digests()
    for shard in _shards(Path(out)):
        digests.add(_lines(shard))
    return digests.summary()


def lines(out: str | os.PathLike[str]) -> Iterator[str]:
    """The documents of all recordings as JSON, each a line, in the order of the inputs.

    One that could not be analyzed has the keys `file` and `error`.

    Raises `ArgumentError` if the run is not finished.
    """
    for shard in _shards(Path(out)):
        yield from _lines(shard)


def to_dataframe(out: str | os.PathLike[str]) -> pd.DataFrame:
    """A pandas table with a row per drop in the order of the inputs: the columns of `bounce-audio batch`.

    A recording without a drop, or that could not be analyzed, has one row with the reason; see the column `status`.

    Raises `ArgumentError` if the run is not finished, `FileNotFoundError` if it wrote no Parquet, `ModuleNotFoundError`
    where pandas or pyarrow is not installed.
    """
    with needed_by("to_dataframe", "pandas,parquet"):
        import pandas as pd
        import pyarrow  # noqa: F401

    shards = [shard.with_suffix(".parquet") for shard in _shards(Path(out))]
    return pd.concat(map(pd.read_parquet, shards), ignore_index=True)


def _lines(shard: Path) -> list[str]:
    return shard.read_text("utf-8").splitlines()


def _shards(out: Path) -> list[Path]:
    try:
        run = json.loads((out / RUN).read_text("utf-8"))
    except FileNotFoundError:
        raise ArgumentError(
            f"{out} is no folder that analyze_folder wrote: it has no {RUN}"
        ) from None
    shards = [out / f"{name}.ndjson" for name in run["shards"]]
    missing = sum(not shard.exists() for shard in shards)
    if missing:
        raise ArgumentError(
            f"{out} is not finished: {missing} of {len(shards)} shards are missing"
        )
    return shards
