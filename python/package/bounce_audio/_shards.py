"""Shards: some recordings that one task listens to, and the files that it writes."""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import os
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _core, _inputs
from ._inputs import Input
from .errors import BounceAudioError

__all__ = ["Job", "Shard", "clear", "failure", "is_done", "listen", "plan", "put", "run", "sums", "write"]

#: The ending of the file with the SHA-256 of a shard's recordings.
SUMS = ".sha256"

_TEXTS = {"file", "status", "reason", "model", "warnings"}
_COUNTS = {"drop", "drops", "bounces", "channel"}


@dataclass(frozen=True)
class Job:
    """What is done with each recording, and where the results go."""

    out: str
    settings: str
    channel: int | None
    rule: str | None
    parquet: bool
    verify: bool = False

    def check(self) -> None:
        """Raises what each recording would: settings out of range, a rule that is not known."""
        _core.Listener(48_000.0, 1, self.settings, self.rule)


@dataclass(frozen=True)
class Shard:
    """Recordings, and a name by their content, the job and the version."""

    name: str
    files: tuple[str, ...]


def plan(inputs: Sequence[Input], job: Job, files_per_shard: int) -> list[Shard]:
    """Shards of so many recordings in their order."""
    starts = range(0, len(inputs), files_per_shard)
    return [_shard(inputs[i : i + files_per_shard], job) for i in starts]


def _shard(inputs: Sequence[Input], job: Job) -> Shard:
    asked = [_core.VERSION, json.loads(job.settings), job.channel, job.rule]
    marked = [[i.name, i.mark] for i in inputs]
    text = json.dumps([asked, marked], sort_keys=True)
    digest = hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
    return Shard(digest, tuple(i.name for i in inputs))


def is_done(shard: Shard, job: Job) -> bool:
    """Whether all of its files are written."""
    endings = [".ndjson", SUMS, ".parquet"] if job.parquet else [".ndjson", SUMS]
    return all(os.path.exists(_path(shard, job, ending)) for ending in endings)


def run(shard: Shard, job: Job) -> str | None:
    """Listens to a shard and writes it; gives its name, or None where it stands and, if that is asked, is verified."""
    if is_done(shard, job) and not (job.verify and _has_changed(shard, job)):
        return None
    # Before listening: what changes meanwhile is found by the next verification.
    content = sums(shard)
    write(shard, job, [listen(file, job) for file in shard.files], content)
    return shard.name


def _has_changed(shard: Shard, job: Job) -> bool:
    """Whether the content of its recordings is not what was listened to."""
    return _path(shard, job, SUMS).read_bytes() != sums(shard)


def sums(shard: Shard) -> bytes:
    """The SHA-256 of its recordings, as `sha256sum` writes and checks it; what cannot be read has no line."""
    lines = []
    for name in shard.files:
        with contextlib.suppress(OSError):
            lines.append(_sum_line(name, _inputs.sha256(name)))
    return "".join(lines).encode("utf-8", "surrogateescape")


def _sum_line(name: str, digest: str) -> str:
    escaped = name.replace("\\", "\\\\").replace("\n", "\\n").replace("\r", "\\r")
    return f"{'' if escaped == name else chr(92)}{digest}  {escaped}\n"


def listen(file: str, job: Job) -> str:
    """The document of a recording as a line, or the reason why there is none: the lines of `bounce-audio batch`."""
    try:
        return _document(file, job)
    except OSError as error:
        why = _core.system_words(error.errno) if error.errno else str(error)
        return failure(file, why)
    except BounceAudioError as error:
        return failure(file, str(error).removeprefix(f"{file}: "))


def _document(file: str, job: Job) -> str:
    asked = {"channel": job.channel, "rule": job.rule}
    if _inputs.is_remote(file):
        content = _inputs.read(file)
        return _core.analyze_bytes(content, file, job.settings, **asked)  # type: ignore[arg-type]
    return _core.analyze_file(file, job.settings, **asked)[0]  # type: ignore[arg-type]


def failure(file: str, reason: str) -> str:
    """The line of a recording that could not be analyzed."""
    row = {"error": reason, "file": file}
    return json.dumps(row, ensure_ascii=False, separators=(",", ":")) + "\n"


def write(shard: Shard, job: Job, lines: list[str], content: bytes) -> None:
    """Writes the lines of a shard; a shard has its NDJSON last, once all else is there."""
    put(_path(shard, job, SUMS), content)
    if job.parquet:
        put(_path(shard, job, ".parquet"), _parquet(lines))
    put(_path(shard, job, ".ndjson"), "".join(lines).encode())


def put(path: Path, content: bytes) -> None:
    """Writes a file aside and puts it in its place: it is whole or not there, whenever the process dies."""
    aside = path.with_name(f".{path.name}.{uuid.uuid4().hex}.partial")
    try:
        with open(aside, "xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def clear(shards: Sequence[Shard], job: Job) -> None:
    """Removes what killed workers left of shards that are written by now."""
    names = {shard.name for shard in shards}
    for aside in Path(job.out).glob(".*.partial"):
        if aside.name[1:].split(".")[0] in names:
            aside.unlink(missing_ok=True)


def _path(shard: Shard, job: Job, ending: str) -> Path:
    return Path(job.out) / f"{shard.name}{ending}"


def _parquet(lines: list[str]) -> bytes:
    """The rows of a batch's CSV, a row per drop, with the types that its columns have."""
    from pyarrow import csv, parquet

    names = _core.drop_columns()
    rows = io.BytesIO(_core.drop_rows(lines).encode())
    table = csv.read_csv(
        rows,
        read_options=csv.ReadOptions(column_names=names),
        parse_options=csv.ParseOptions(newlines_in_values=True),
        convert_options=csv.ConvertOptions(column_types={n: _type(n) for n in names}),
    )
    out = io.BytesIO()
    parquet.write_table(table, out)
    return out.getvalue()


def _type(column: str) -> Any:
    import pyarrow

    if column in _TEXTS:
        return pyarrow.string()
    return pyarrow.int64() if column in _COUNTS else pyarrow.float64()
