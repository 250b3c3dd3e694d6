#!/usr/bin/env python3
"""Measures what a second thread is worth to `analyze`: time of two threads beside one, and of two processes as control.

    ./measure_threads.py [RECORDINGS] [ROUNDS]     16 recordings of a table-tennis ball, 5 rounds

A ratio of 0.5 is all that two cores can give. What threads fall behind processes is what they wait for each other: the
interpreter's lock, which is held while documents become dataclasses, and memory. Ways take turns, and the median counts.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import bounce_audio

MADE = bounce_audio.synth("pingpong")


def listen(_: int) -> int:
    """Listens once; gives little, so that a process has little to send back."""
    return len(bounce_audio.analyze(MADE.samples, MADE.sample_rate_hz).drops)


def seconds(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def by(pool: Executor, recordings: int) -> float:
    return seconds(lambda: list(pool.map(listen, range(recordings))))


def main() -> None:
    recordings, rounds = map(int, [*sys.argv[1:], *("16", "5")[len(sys.argv) - 1 :]])
    with (
        ThreadPoolExecutor(1) as one,
        ThreadPoolExecutor(2) as two,
        ProcessPoolExecutor(2, get_context("spawn")) as processes,
    ):
        pools: dict[str, Executor] = {"one thread": one, "two threads": two, "two processes": processes}
        # Processes start with their first work.
        for pool in pools.values():
            by(pool, recordings)
        took: dict[str, list[float]] = {name: [] for name in pools}
        for _ in range(rounds):
            for name, pool in pools.items():
                took[name].append(by(pool, recordings))
    for name, times_s in took.items():
        ratios = sorted(t / alone for t, alone in zip(times_s, took["one thread"]))
        print(
            f"{name}: {statistics.median(times_s):.2f} s, {statistics.median(ratios):.2f} of one thread"
            f" ({ratios[0]:.2f} to {ratios[-1]:.2f})"
        )


if __name__ == "__main__":
    main()
