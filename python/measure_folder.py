#!/usr/bin/env python3
"""Measures a folder of five-second recordings by Dask: time beside `batch`, memory, and what is left of it when something is killed.

    ./measure_folder.py COMMAND [RECORDINGS] [TRIALS]     COMMAND is bounce-audio; 1000 recordings, 5 trials

It prints time and memory, and fails where a second run after a kill does not end in the output of an undisturbed one.
"""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import distributed

from bounce_audio.dask import analyze_folder

SCENE = Path(__file__).resolve().parents[1] / "assets/scenes/pingpong.toml"
UNLIKE = 50
SHARD = 10


def make(command: str, folder: Path, count: int) -> None:
    """Recordings of five seconds; beyond fifty they are copies."""
    scene = folder.with_suffix(".toml")
    scene.write_text(SCENE.read_text().replace("duration_s = 7.0", "duration_s = 5.0"))
    folder.mkdir()
    for number in range(count):
        path, like = folder / f"{number:04}.wav", folder / f"{number % UNLIKE:04}.wav"
        if path != like:
            shutil.copy(like, path)
            continue
        words = [command, "synth", str(scene), "--seed", str(number), "-o", str(path)]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        path.with_suffix(".truth.json").unlink()


@contextmanager
def cluster() -> Iterator[tuple[distributed.Client, subprocess.Popen[bytes]]]:
    """A scheduler and two workers in processes of their own, and a client of them."""
    with tempfile.TemporaryDirectory() as folder:
        address = Path(folder) / "scheduler.json"
        at = ["--scheduler-file", str(address), "--host", "127.0.0.1", "--no-dashboard"]

        def start(what: str, *more: str) -> subprocess.Popen[bytes]:
            code = f"from distributed.cli import dask_{what} as d; d.main()"
            words = [sys.executable, "-c", code, *at, *more]
            return subprocess.Popen(words, stderr=subprocess.DEVNULL)

        scheduler = start("scheduler", "--port", "0")
        workers = [start("worker", "--nthreads", "1") for _ in range(2)]
        try:
            while not address.exists():
                time.sleep(0.01)
            with distributed.Client(scheduler_file=str(address), timeout=60) as client:
                client.wait_for_workers(2)
                yield client, scheduler
        finally:
            for process in (scheduler, *workers):
                process.terminate()
                process.wait()


def output(out: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in out.iterdir()}


def resident_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def cpu_s(pid: int) -> float:
    """The processor's time of a process, user and system."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def by_batch(command: str, folder: Path, out: Path) -> None:
    begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    words = [command, "batch", str(folder), "--jobs", "2", "--format", "ndjson", "-o", str(out)]
    subprocess.run(words, check=True, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"batch: {time.perf_counter() - begin:.1f} s, {used:.1f} s of the processor", flush=True)


def by_dask(folder: Path, out: Path, shards: int) -> float:
    with cluster() as (client, _):
        pids = list(client.run(os.getpid).values())
        memory: list[str] = []

        def watch() -> None:
            for quarter in range(1, 5):
                while len(list(out.glob("*.ndjson"))) < shards * quarter // 4:
                    time.sleep(0.05)
                memory.append("+".join(f"{resident_mb(pid):.0f}" for pid in pids))

        watcher = threading.Thread(target=watch)
        watcher.start()
        begin, before = time.perf_counter(), sum(map(cpu_s, pids))
        analyze_folder(folder, out, files_per_shard=SHARD, client=client)
        took, used = time.perf_counter() - begin, sum(map(cpu_s, pids)) - before
        watcher.join()
    print(f"two workers: {took:.1f} s, {used:.1f} s of the processor")
    print(f"memory of the workers at each quarter: {', '.join(memory)} MB", flush=True)
    return took


def killed(folder: Path, out: Path, after_s: float, whom: str) -> None:
    """A run in which a worker or the scheduler is killed after so many seconds."""
    with cluster() as (client, scheduler):
        pids = {"worker": next(iter(client.run(os.getpid).values())), "scheduler": scheduler.pid}
        timer = threading.Timer(after_s, os.kill, (pids[whom], signal.SIGKILL))
        timer.start()
        try:
            analyze_folder(folder, out, files_per_shard=SHARD, client=client)
        except ConnectionError:
            pass
        timer.cancel()


def main() -> None:
    command, *numbers = sys.argv[1:]
    count, trials = map(int, [*numbers, *(1000, 5)[len(numbers) :]])
    shards, moments = -(-count // SHARD), random.Random(1)
    with tempfile.TemporaryDirectory() as place:
        folder, undisturbed = Path(place) / "recordings", Path(place) / "undisturbed"
        make(command, folder, count)
        by_batch(command, folder, Path(place) / "rows.ndjson")
        whole_s, whole = by_dask(folder, undisturbed, shards), output(undisturbed)
        for whom in ("worker", "scheduler"):
            for trial in range(trials):
                out, after_s = Path(place) / f"{whom}-{trial}", moments.uniform(0.1, 0.9) * whole_s
                killed(folder, out, after_s, whom)
                left = len(list(out.glob("*.ndjson")))
                run = analyze_folder(folder, out, files_per_shard=SHARD)
                if output(out) != whole:
                    sys.exit(f"another output after a killed {whom}")
                print(f"{whom} killed after {after_s:.1f} s: {left} of {run.shards} shards, then the same output", flush=True)


if __name__ == "__main__":
    main()
