"""What is said where the package of an extra is not installed."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import bounce_audio
import bounce_audio.dask
from bounce_audio import Synthetic


def without(modules: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes imports of these fail as if they were not installed."""
    for module in modules.split():
        monkeypatch.setitem(sys.modules, module, None)


def said(extra: str, what: str, module: str) -> str:
    return rf"^{what} needs {module}: pip install 'bounce-audio\[{extra}\]'$"


def test_tables_and_plots_name_their_extra(
    pingpong: Synthetic, monkeypatch: pytest.MonkeyPatch
) -> None:
    report = bounce_audio.analyze(pingpong.samples, pingpong.sample_rate_hz)
    without("pandas matplotlib matplotlib.pyplot", monkeypatch)
    for table in (report.to_dataframe, report.drops[0].to_dataframe):
        with pytest.raises(ModuleNotFoundError, match=said("pandas", "to_dataframe", "pandas")):
            table()
    with pytest.raises(ModuleNotFoundError, match=said("plot", "plot", "matplotlib")):
        report.drops[0].plot()


@pytest.mark.parametrize(
    ("module", "parquet", "message"),
    [
        ("dask", False, said("dask", "analyze_folder", "dask")),
        ("pyarrow", True, said("parquet", "parquet=True", "pyarrow")),
    ],
)
def test_a_folder_is_not_begun_without_what_it_needs(
    module: str,
    parquet: bool,
    message: str,
    recording: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    without(module, monkeypatch)
    out = tmp_path / "out"
    with pytest.raises(ModuleNotFoundError, match=message):
        bounce_audio.dask.analyze_folder(recording, out, parquet=parquet)
    assert not out.exists()


def test_places_of_fsspec_and_tables_of_folders_name_their_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without("fsspec pyarrow", monkeypatch)
    with pytest.raises(ModuleNotFoundError, match=said("dask", "memory://a.wav", "fsspec")):
        bounce_audio.dask.analyze_folder("memory://a.wav", tmp_path / "out", parquet=False)
    with pytest.raises(ModuleNotFoundError, match=said("pandas,parquet", "to_dataframe", "pyarrow")):
        bounce_audio.folders.to_dataframe(tmp_path)
