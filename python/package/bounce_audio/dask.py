"""A folder of recordings on all cores, or on many machines, by Dask.

>>> import bounce_audio, bounce_audio.dask
>>> bounce_audio.dask.analyze_folder("recordings", "results", height_m=0.305)  # doctest: +SKIP
>>> print(bounce_audio.summary("results"))  # doctest: +SKIP
"""

from __future__ import annotations

import importlib.util
import json
import os
import sys
from concurrent.futures import CancelledError
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core, _inputs, _shards
from ._extras import needed_by
from ._shards import Job, Shard
from .errors import ArgumentError
from .folders import RUN
from .settings import Channel, Settings, as_json, channel_number

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Run", "analyze_folder"]

_OPTIONS = ("files_per_shard", "parquet", "verify", "client", "workers", "progress")


@dataclass(frozen=True)
class Run:
    """What a run did: how many recordings and shards there are, and how many of these were there before."""

    out: str
    files: int
    shards: int
    shards_before: int


def analyze_folder(
    paths: _inputs.Paths,
    out: str | os.PathLike[str],
    *,
    channel: Channel = "best",
    rule: str | None = None,
    files_per_shard: int = 100,
    parquet: bool | None = None,
    verify: bool = False,
    client: Any = None,
    workers: int | None = None,
    progress: bool | None = None,
    **settings: Unpack[Settings],
) -> Run:
    """Listens to many recordings, and writes what was heard into the folder `out`.

    `paths` are files and folders, with all recordings in these, or places that fsspec reads ("s3://bucket/folder"). The
    recordings go into shards of `files_per_shard`. Each shard is a file of JSON lines, as `bounce-audio batch --format
    ndjson` writes them, and one with a row per drop as Parquet: if `parquet` is true, or by default where pyarrow is
    installed. A recording that cannot be analyzed has a line with the reason.

    `client` is a `distributed.Client`; by default the one that is active, else `workers` threads of this process, which is
    as fast as processes are. The workers have to see `paths` and `out` under the same names. `progress` shows how many
    shards are done, by default on a terminal.

    Shards are written aside and renamed, and named by the version, the settings, and the name, size and time of each
    recording: whatever was interrupted, the same call goes on where it was. Beside each is the SHA-256 of its recordings
    as `sha256sum --check` reads it; with `verify` the workers compare it with what is there now, and listen again to shards
    whose recordings changed behind an unchanged size and time. A shard whose worker was killed is done again by another
    one; a recording that kills every worker has a line that says so. Results do not depend on the workers.

    Raises `ArgumentError` for a setting out of range, or no recordings, `ModuleNotFoundError` where Dask is not installed,
    and `ConnectionError` when the scheduler of the client dies: what is done stays, and the same call with another client
    goes on.
    """
    _check_installed(parquet)
    job = Job(
        out=os.path.abspath(out),
        settings=as_json(settings, "channel", "rule", *_OPTIONS),
        channel=channel_number(channel),
        rule=rule,
        parquet=_has("pyarrow") if parquet is None else parquet,
        verify=verify,
    )
    job.check()
    if files_per_shard < 1:
        raise ArgumentError(f"files_per_shard is {files_per_shard}, expected 1 or more")
    inputs = _inputs.gather(paths)
    shards = _shards.plan(inputs, job, files_per_shard)
    _say_what_is_run(shards, job)
    before = {shard.name for shard in shards if _shards.is_done(shard, job)}
    todo = [shard for shard in shards if verify or shard.name not in before]
    shown = sys.stderr.isatty() if progress is None else progress
    client = _active() if client is None else client
    done = _by_threads(todo, job, workers) if client is None else _by_client(todo, job, client)
    for number, name in enumerate(done, 1):
        before.discard(name or "")
        if shown:
            print(f"\r{number} of {len(todo)} shards", end="", file=sys.stderr, flush=True)
    if shown and todo:
        print(file=sys.stderr)
    _shards.clear(shards, job)
    return Run(job.out, len(inputs), len(shards), len(before))


def _check_installed(parquet: bool | None) -> None:
    """Raises what the first shard would, while nothing is written yet."""
    with needed_by("analyze_folder", "dask"):
        import dask  # noqa: F401
    if parquet:
        with needed_by("parquet=True", "parquet"):
            import pyarrow  # noqa: F401


def _has(module: str) -> bool:
    return importlib.util.find_spec(module) is not None


def _say_what_is_run(shards: list[Shard], job: Job) -> None:
    """Which shards are those of this run, in the order of the inputs."""
    os.makedirs(job.out, exist_ok=True)
    run = {
        "version": _core.VERSION,
        "settings": json.loads(job.settings),
        "channel": job.channel,
        "rule": job.rule,
        "shards": [shard.name for shard in shards],
    }
    _shards.put(Path(job.out) / RUN, json.dumps(run, indent=2).encode())


def _active() -> Any:
    """The client that is active, if there is one."""
    if "distributed" not in sys.modules:
        return None
    import distributed

    try:
        return distributed.get_client()
    except ValueError:
        return None


def _by_threads(todo: list[Shard], job: Job, workers: int | None) -> Iterator[str | None]:
    """In threads of this process, by Dask's own scheduler for them."""
    import dask
    from dask.system import CPU_COUNT

    count = workers or CPU_COUNT
    # Some for each thread at a time, so that what is done can be told.
    for start in range(0, len(todo), 4 * count):
        tasks = [dask.delayed(_shards.run)(s, job) for s in todo[start : start + 4 * count]]
        yield from dask.compute(*tasks, scheduler="threads", num_workers=count)


def _by_client(todo: list[Shard], job: Job, client: Any) -> Iterator[str | None]:
    from distributed import KilledWorker, as_completed

    futures = {client.submit(_shards.run, s, job, pure=False): s for s in todo}
    deadly = []
    for future in as_completed(list(futures)):
        try:
            yield _result(future)
        except KilledWorker:
            deadly.append(futures[future])
    for shard in deadly:
        yield _one_by_one(shard, job, client)


def _result(future: Any) -> Any:
    """What a task gave; it raises what the task did. What was asked of a scheduler that died is cancelled."""
    try:
        return future.result()
    except (CancelledError, OSError) as error:
        if future.status == "error":
            raise
        raise ConnectionError(
            "the scheduler is gone: the same call goes on where it was"
        ) from error


def _one_by_one(shard: Shard, job: Job, client: Any) -> str:
    """A shard that killed its workers, to find the recording that did."""
    from distributed import KilledWorker

    content = _result(client.submit(_shards.sums, shard, pure=False))
    lines = []
    for file in shard.files:
        try:
            lines.append(_result(client.submit(_shards.listen, file, job, pure=False)))
        except KilledWorker:
            lines.append(_shards.failure(file, "every worker that listened to it was killed"))
    _shards.write(shard, job, lines, content)
    return shard.name
