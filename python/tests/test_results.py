"""Results as data, tables and pictures."""

from __future__ import annotations

import dataclasses
import pickle
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bounce_audio
from bounce_audio import IMPACT, Report, Synthetic


@pytest.fixture(scope="module")
def report(pingpong: Synthetic) -> Report:
    return bounce_audio.analyze(
        pingpong.samples, pingpong.sample_rate_hz, height_m=0.305
    )


def test_the_truth_is_in_the_interval(report: Report, pingpong: Synthetic) -> None:
    [drop], [truth] = report.drops, pingpong.truth.drops
    assert drop.restitution is not None and drop.restitution.interval95 is not None
    low, high = drop.restitution.interval95
    assert low < truth.restitution < high
    heard = drop.impacts["time_s"]
    offsets = np.abs(heard[:, None] - truth.onsets_s[None, :]).min(axis=1)
    assert offsets.max() < 1e-3


def test_impacts_are_an_array_that_stays(report: Report) -> None:
    impacts = report.drops[0].impacts
    assert impacts.dtype == IMPACT and impacts.shape == (len(impacts),)
    assert np.isnan(impacts["ratio"][0]) and set(impacts["status"]) >= {"heard"}
    with pytest.raises(ValueError, match="read-only"):
        impacts["time_s"][0] = 0.0


def test_results_travel_and_compare(report: Report) -> None:
    back = pickle.loads(pickle.dumps(report))
    assert back == report and back is not report
    assert back.drops[0].to_svg() is None
    assert report.drops[0] != report and report.drops[0].scatter != "scatter"


def test_tables_have_a_row_for_each_impact(report: Report) -> None:
    pytest.importorskip("pandas")
    table = report.to_dataframe()
    assert len(table) == len(report.drops[0].impacts)
    assert table.loc[(1, 1), "time_s"] == report.drops[0].impacts["time_s"][0]
    silent = bounce_audio.analyze(np.zeros(48_000), 48_000)
    assert len(silent.to_dataframe()) == 0


def test_a_notebook_shows_answer_warnings_and_level(report: Report) -> None:
    drop = report.drops[0]
    assert drop.restitution is not None
    page = drop._repr_html_()
    assert f"{drop.restitution.value:.3f}"[:5] in page and "<svg" in page
    for warning in drop.warnings:
        assert "<li>" in page and warning.code
    sheet, level = drop.to_svg(), page[page.index("<svg") : page.rindex("</svg>") + 6]
    assert sheet is not None and len(level) < len(sheet)
    picture = ElementTree.fromstring(level)
    assert picture.tag.endswith("svg") and picture.get("viewBox")
    # It shrinks with the page; the sheet as a file has its size alone.
    assert picture.get("style") == "max-width: 100%; height: auto"
    assert ElementTree.fromstring(sheet).get("style") is None
    assert ElementTree.fromstring(sheet).tag.endswith("svg")


def test_names_cannot_break_the_page() -> None:
    report = bounce_audio.analyze(np.zeros(48_000), 48_000, name="<script>")
    page = report._repr_html_()
    assert "<script>" not in page and "&lt;script&gt;: no drop found" in page


def test_a_file_that_is_gone_leaves_the_answer(recording: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.wav"
    copy.write_bytes(recording.read_bytes())
    drop = bounce_audio.analyze_file(copy).drops[0]
    sheet = drop.to_svg()
    assert sheet is not None and "<svg" in drop._repr_html_()
    copy.unlink()
    page = drop._repr_html_()
    assert "e = 0.9" in page and "<svg" not in page


def test_e_is_drawn_against_the_speed(report: Report) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ax = report.drops[0].plot()
    assert "speed" in ax.get_xlabel() and ax.get_xscale() == "log"
    points = ax.containers[0].lines[0].get_ydata()
    assert len(points) == np.isfinite(report.drops[0].impacts["restitution"]).sum()
    assert report.drops[0].plot(ax) is ax
    impacts = report.drops[0].impacts.copy()
    impacts["impact_speed_m_per_s"][1] = 0.0
    standing = dataclasses.replace(report.drops[0], impacts=impacts)
    assert standing.plot().get_xscale() == "linear"


def test_times_alone_give_e(report: Report) -> None:
    impacts = report.drops[0].impacts
    drop = bounce_audio.fit(impacts["time_s"], impacts["time_std_s"], height_m=0.305)
    heard = report.drops[0].restitution
    assert drop.restitution is not None and heard is not None
    assert drop.restitution.value == pytest.approx(heard.value, abs=1e-4)
    assert drop.evidence_nats is None and np.isnan(drop.impacts["level_db"]).all()
    for times, errors, said in [
        ([1.0], 1e-3, "times_s has 1, expected two or more"),
        ([2.0, 1.0], 1e-3, "expected times that grow"),
        ([1.0, 2.0], 0.0, "time_std_s is 0"),
        ([1.0, 2.0], [1e-3] * 3, "time_std_s has shape"),
        ([[1.0], [2.0]], 1e-3, "times_s has shape"),
        ([[1.0], [2.0, 3.0]], 1e-3, "times_s: rows of different lengths"),
        (["a", "b"], 1e-3, "times_s has type .*, expected numbers"),
    ]:
        with pytest.raises(bounce_audio.ArgumentError, match=said):
            bounce_audio.fit(times, errors)


def test_drops_are_compared(report: Report) -> None:
    [drop] = report.drops
    assert drop.restitution is not None and drop.restitution.std_error is not None
    pair = (drop.restitution.value, drop.restitution.std_error)
    together = bounce_audio.compare([report, drop, pair])
    assert together.count == 3 and together.mean == pytest.approx(pair[0])
    far = bounce_audio.compare([(0.9, 1e-3)] * 9 + [(0.8, 1e-3)])
    assert [o.index for o in far.outliers] == [9] and far.outliers[0].distance < 0
    for few in ([], [pair], [pair, (0.9, 0.0)]):
        with pytest.raises(bounce_audio.ArgumentError):
            bounce_audio.compare(few)
    alone: Any
    for alone in (report, drop, [0.9], [(1, 2, 3)], ["ab"]):
        with pytest.raises(bounce_audio.ArgumentError, match="report.drops"):
            bounce_audio.compare(alone)


def test_rules_can_be_asked_for(pingpong: Synthetic) -> None:
    for rule in bounce_audio.rules():
        report = bounce_audio.analyze(
            pingpong.samples, pingpong.sample_rate_hz, rule=rule.name
        )
        assert report.rule is not None and report.rule.allowed_m == rule.allowed_m
        assert report.settings.mass_kg == rule.mass_kg
