"""A folder of recordings, by threads and by workers that are killed."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import bounce_audio
from bounce_audio import ArgumentError, Settings
from conftest import PROJECT, Command

pytest.importorskip("dask")
distributed = pytest.importorskip("distributed")

from bounce_audio.dask import analyze_folder  # noqa: E402

#: Two seconds of each recording are enough here.
SETTINGS: Settings = {"height_m": 0.305, "end_s": 2.0}
LISTENING = "--height 30.5cm --end 2s".split()

VARIANTS = PROJECT / "fixtures/wav-variants"


@pytest.fixture(scope="module")
def recordings(recording: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Forty recordings, one of them none, in two folders."""
    folder = tmp_path_factory.mktemp("recordings")
    (folder / "more").mkdir()
    for number in range(40):
        place = folder / "more" if number % 3 else folder
        shutil.copy(recording, place / f"{number:02}.wav")
    # A broken WAV: of a file of no known kind the command, which reads more kinds, names more.
    (folder / "07.wav").write_bytes(b"RIFF" + bytes(4) + b"WAVE")
    (folder / "notes.txt").write_text("none either")
    return folder


def output(out: Path) -> dict[str, bytes]:
    """All that a run wrote."""
    return {path.name: path.read_bytes() for path in out.iterdir()}


@pytest.fixture(scope="module")
def undisturbed(recordings: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("undisturbed")
    run = analyze_folder(recordings, out, files_per_shard=6, **SETTINGS)
    assert (run.files, run.shards, run.shards_before) == (41, 7, 0)
    return out


@pytest.fixture
def client() -> Iterator[Any]:
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_lines_and_summary_are_those_of_batch(
    undisturbed: Path, recordings: Path, command: Command
) -> None:
    done = command("batch", recordings, *LISTENING, "--format", "ndjson")
    ours = [json.loads(line) for line in bounce_audio.folders.lines(undisturbed)]
    theirs = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(ours) == 41 and ours == theirs
    # Before the summary there is the bar of the progress, on a terminal alone.
    assert bounce_audio.summary(undisturbed) == done.stderr


def test_rows_are_in_parquet_too(
    undisturbed: Path, recordings: Path, command: Command
) -> None:
    pytest.importorskip("pyarrow")
    read_csv = pytest.importorskip("pandas").read_csv
    rows = bounce_audio.folders.to_dataframe(undisturbed)
    table = undisturbed.parent / "rows.csv"
    command("batch", recordings, *LISTENING, "-o", table, "--force")
    theirs = read_csv(table)
    assert list(rows.columns) == list(theirs.columns) and len(rows) == len(theirs)
    drops = rows["status"] == "drop"
    assert drops.sum() >= 39
    for column in ("restitution", "restitution_std", "first_impact_s", "bounces"):
        assert list(rows[column][drops]) == list(theirs[column][drops])
    [bad] = rows[rows["status"] == "error"].to_dict("records")
    assert bad["file"].endswith("07.wav") and bad["restitution"] != bad["restitution"]


def test_a_second_run_does_nothing_again(undisturbed: Path, recordings: Path) -> None:
    before = {p.name: p.stat().st_mtime_ns for p in undisturbed.glob("*.ndjson")}
    run = analyze_folder(recordings, undisturbed, files_per_shard=6, **SETTINGS)
    assert run.shards_before == run.shards == len(before)
    after = {p.name: p.stat().st_mtime_ns for p in undisturbed.glob("*.ndjson")}
    assert after == before


def test_what_changes_is_done_again(recordings: Path, tmp_path: Path) -> None:
    files, out = tmp_path / "files", tmp_path / "out"
    files.mkdir()
    for name in ("a.wav", "b.wav", "c.wav", "d.wav"):
        shutil.copy(recordings / "00.wav", files / name)

    def shards_before(**settings: float) -> int:
        return analyze_folder(
            files, out, files_per_shard=2, parquet=False, **settings
        ).shards_before

    assert shards_before() == 0
    (files / "c.wav").write_bytes(b"")
    assert shards_before() == 1
    assert shards_before(height_m=0.3) == 0
    assert shards_before() == 2
    assert "failed: 1" in bounce_audio.summary(out)
    [first, _] = json.loads((out / "run.json").read_text())["shards"]
    (out / f"{first}.ndjson").unlink()
    with pytest.raises(ArgumentError, match="1 of 2 shards are missing"):
        bounce_audio.summary(out)


def test_content_that_changed_behind_its_time_is_found_when_asked(
    recordings: Path, tmp_path: Path
) -> None:
    files, out = tmp_path / "files", tmp_path / "out"
    files.mkdir()
    names = ["a.wav", "b\nb.wav", "c\\c.wav", "d.wav"]
    for name in names:
        shutil.copy(recordings / "00.wav", files / name)

    def shards_before(verify: bool) -> int:
        return analyze_folder(
            files, out, files_per_shard=2, parquet=False, verify=verify, **SETTINGS
        ).shards_before

    assert [shards_before(v) for v in (False, True)] == [0, 2]
    sums = sorted(out.glob("*.sha256"))
    assert len(sums) == 2
    subprocess.run(["sha256sum", "--check", "--quiet", *sums], check=True)
    before = output(out)
    changed = files / "d.wav"
    times, content = changed.stat(), changed.read_bytes()
    # As long, and silent from the first second on.
    kept = 2 * 44_100
    changed.write_bytes(content[:kept] + bytes(len(content) - kept))
    os.utime(changed, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert [shards_before(v) for v in (False, True, True)] == [2, 1, 2]
    after = output(out)
    assert sum(after[name] != before[name] for name in before) == 2
    last = list(bounce_audio.folders.lines(out))[-1]
    alone = bounce_audio.analyze_file(changed, **SETTINGS)
    assert json.loads(last) == alone.to_dict()


def test_what_is_wrong_is_said_at_once(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(ArgumentError, match="no recordings"):
        analyze_folder(tmp_path, out)
    with pytest.raises(ArgumentError, match="height"):
        analyze_folder(VARIANTS, out, height_m=-1.0)
    with pytest.raises(ArgumentError, match="files_per_shard"):
        analyze_folder(VARIANTS, out, files_per_shard=0)
    with pytest.raises(FileNotFoundError, match="recordigns"):
        analyze_folder(tmp_path / "recordigns", out)
    with pytest.raises(ArgumentError, match="run.json"):
        bounce_audio.summary(tmp_path)
    assert not out.exists()
    run = analyze_folder([tmp_path / "gone.wav"], out, parquet=False)
    [line] = bounce_audio.folders.lines(out)
    assert run.files == 1 and "no such file" in json.loads(line)["error"]


def test_places_of_fsspec_are_read_by_their_bytes(
    recordings: Path, tmp_path: Path
) -> None:
    fsspec = pytest.importorskip("fsspec")
    store = fsspec.filesystem("memory")
    for name in ("b.wav", "a.wav"):
        store.pipe(f"/bucket/{name}", (recordings / "00.wav").read_bytes())
    store.pipe("/bucket/notes.txt", b"none")
    analyze_folder("memory://bucket", tmp_path / "out", parquet=False)
    documents = [json.loads(n) for n in bounce_audio.folders.lines(tmp_path / "out")]
    assert [d["file"][-6:] for d in documents] == ["/a.wav", "/b.wav"]
    here = bounce_audio.analyze_file(recordings / "00.wav").to_dict()
    assert documents[0]["drops"] == here["drops"] and here["drops"]


def test_workers_give_what_threads_do(
    client: Any, undisturbed: Path, recordings: Path, tmp_path: Path
) -> None:
    analyze_folder(recordings, tmp_path, files_per_shard=6, **SETTINGS)
    assert output(tmp_path) == output(undisturbed)


def test_a_killed_worker_costs_its_shard_once(
    client: Any, undisturbed: Path, recordings: Path, tmp_path: Path
) -> None:
    killed = []

    def kill_one() -> None:
        while not list(tmp_path.glob("*.ndjson")):
            time.sleep(0.01)
        killed.append(next(iter(client.run(os.getpid).values())))
        os.kill(killed[0], signal.SIGKILL)

    killer = threading.Thread(target=kill_one)
    killer.start()
    analyze_folder(
        recordings, tmp_path, files_per_shard=6, client=client, **SETTINGS
    )
    killer.join()
    assert len(killed) == 1
    assert output(tmp_path) == output(undisturbed)


class Deadly(distributed.WorkerPlugin):  # type: ignore[misc]
    """Has a worker die of one recording."""

    def setup(self, worker: Any) -> None:
        from bounce_audio import _shards

        whole = _shards._document

        def document(file: str, job: _shards.Job) -> str:
            if file.endswith("05.wav"):
                os.kill(os.getpid(), signal.SIGKILL)
            return whole(file, job)

        _shards._document = document


def test_a_recording_that_kills_every_worker_has_a_line_that_says_so(
    client: Any, recordings: Path, tmp_path: Path
) -> None:
    client.register_plugin(Deadly())
    files = sorted((recordings / "more").iterdir())[:6]
    run = analyze_folder(files, tmp_path, files_per_shard=3, parquet=False)
    documents = [json.loads(line) for line in bounce_audio.folders.lines(tmp_path)]
    assert run.shards == 2 and len(documents) == 6
    failed = [d for d in documents if "error" in d]
    assert [d["file"][-6:] for d in failed] == ["05.wav"]
    assert "killed" in failed[0]["error"]


def test_a_killed_scheduler_costs_no_shard_that_was_written(
    undisturbed: Path, recordings: Path, tmp_path: Path
) -> None:
    out, address = tmp_path / "out", tmp_path / "scheduler.json"
    command = "from distributed.cli import dask_{0} as d; d.main()"
    at = ["--scheduler-file", str(address), "--host", "127.0.0.1"]

    def start(what: str, *more: str) -> subprocess.Popen[bytes]:
        words = [sys.executable, "-c", command.format(what), *at, "--no-dashboard", *more]
        return subprocess.Popen(words, stderr=subprocess.DEVNULL)

    scheduler = start("scheduler", "--port", "0")
    workers = [
        start("worker", "--nthreads", "1", "--no-nanny", "--death-timeout", "10")
        for _ in range(2)
    ]

    def kill() -> None:
        while not list(out.glob("*.ndjson")):
            time.sleep(0.01)
        scheduler.kill()

    killer = threading.Thread(target=kill)
    try:
        while not address.exists():
            time.sleep(0.01)
        with distributed.Client(scheduler_file=str(address), timeout=30) as client:
            killer.start()
            with pytest.raises(ConnectionError, match="scheduler is gone"):
                analyze_folder(
                    recordings, out, files_per_shard=6, client=client, **SETTINGS
                )
            killer.join()
    finally:
        for process in (scheduler, *workers):
            process.kill()
            process.wait()
    assert 0 < len(list(out.glob("*.ndjson"))) < 7
    run = analyze_folder(recordings, out, files_per_shard=6, **SETTINGS)
    assert 0 < run.shards_before < run.shards
    assert output(out) == output(undisturbed)


@pytest.mark.parametrize("after_s", [0.7, 0.9, 1.2, 1.6, 2.1])
def test_all_of_it_may_be_killed_at_any_moment(
    after_s: float, undisturbed: Path, recordings: Path, tmp_path: Path
) -> None:
    call = (
        "import sys, bounce_audio.dask as d;"
        "d.analyze_folder(sys.argv[1], sys.argv[2], files_per_shard=6, height_m=0.305, end_s=2.0)"
    )
    words = [sys.executable, "-c", call, str(recordings), str(tmp_path)]
    with subprocess.Popen(words) as process:
        time.sleep(after_s)
        process.kill()
    analyze_folder(recordings, tmp_path, files_per_shard=6, **SETTINGS)
    assert output(tmp_path) == output(undisturbed)
