"""Which recordings are meant: files, folders with all that is in them, and places that fsspec knows."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from . import _core
from ._extras import needed_by
from .errors import ArgumentError

__all__ = ["Input", "Paths", "gather", "is_remote", "read", "sha256"]

Paths = str | os.PathLike[str] | Iterable[str | os.PathLike[str]]


@dataclass(frozen=True)
class Input:
    """A recording, and what tells that it has changed."""

    name: str
    mark: str


def gather(paths: Paths) -> list[Input]:
    """The inputs in the order in which they were named, those of a folder by name; what is named twice is taken once.

    Of a folder all files count, at any depth, whose names end as those of recordings do.
    """
    if isinstance(paths, (str, os.PathLike)):
        _check_there(os.fspath(paths))
        paths = [paths]
    named = list(paths)
    found = [i for p in named for i in _of(os.fspath(p))]
    if not found:
        raise ArgumentError(f"there are no recordings in {named!r}")
    return list(dict.fromkeys(found))


def _check_there(name: str) -> None:
    """Of several one that is not there gets a row that says so; the only one is a slip."""
    if not is_remote(name):
        os.stat(name)


def is_remote(name: str) -> bool:
    """Whether fsspec reads it."""
    return "://" in name


def read(name: str) -> bytes:
    """The bytes of a recording that fsspec reads."""
    with needed_by(name, "dask"):
        import fsspec

    with fsspec.open(name, "rb") as file:
        return bytes(file.read())


def sha256(name: str) -> str:
    """The SHA-256 of a recording's bytes, in hexadecimal digits."""
    if is_remote(name):
        return hashlib.sha256(read(name)).hexdigest()
    digest = hashlib.sha256()
    with open(name, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _of(name: str) -> Iterator[Input]:
    if is_remote(name):
        yield from _remote(name)
    elif os.path.isdir(name):
        files = (p for p in Path(name).rglob("*") if _is_meant(str(p)) and p.is_file())
        yield from (_local(str(p)) for p in sorted(files))
    else:
        # What is not there gets a row that says so.
        yield _local(name)


def _local(name: str) -> Input:
    try:
        of = os.stat(name)
    except OSError as error:
        return Input(name, f"errno {error.errno}")
    return Input(name, f"{of.st_size} {of.st_mtime_ns}")


def _remote(name: str) -> Iterator[Input]:
    with needed_by(name, "dask"):
        import fsspec

    store, path = fsspec.core.url_to_fs(name)
    if store.isdir(path):
        found = store.find(path, detail=True)
        found = {p: info for p, info in found.items() if _is_meant(p)}
    elif "*" in path:
        found = store.glob(path, detail=True)
    else:
        found = {path: store.info(path)}
    for file, info in sorted(found.items()):
        marks = (info.get(k) for k in ("size", "etag", "ETag", "mtime", "created"))
        yield Input(store.unstrip_protocol(file), " ".join(map(str, marks)))


def _is_meant(name: str) -> bool:
    hidden = os.path.basename(name).startswith(".")
    return not hidden and _core.is_named_as_recording(name)
