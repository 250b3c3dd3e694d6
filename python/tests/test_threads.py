"""Threads."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import bounce_audio
from bounce_audio import Synthetic


def test_threads_give_what_one_does(pingpong: Synthetic) -> None:
    def run(_: int) -> bounce_audio.Report:
        return bounce_audio.analyze(pingpong.samples, pingpong.sample_rate_hz)

    alone = run(0)
    with ThreadPoolExecutor(2) as pool:
        assert all(report == alone for report in pool.map(run, range(8)))


def test_other_threads_go_on_meanwhile(pingpong: Synthetic) -> None:
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    ticker = threading.Thread(target=tick)
    ticker.start()
    begin = time.perf_counter()
    for _ in range(5):
        bounce_audio.analyze(pingpong.samples, pingpong.sample_rate_hz)
    end = time.perf_counter()
    done.set()
    ticker.join()
    inside = [t for t in ticks if begin < t < end]
    # With the lock held there would be one tick between two analyses.
    assert len(inside) > 20
