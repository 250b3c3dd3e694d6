"""Packages that come with an extra of this one, and not with it alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["needed_by"]


@contextmanager
def needed_by(what: str, extra: str) -> Iterator[None]:
    """Around an import: where the package is missing, the error says which extra installs it."""
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        said = f"{what} needs {package}: pip install 'bounce-audio[{extra}]'"
        raise ModuleNotFoundError(said, name=error.name) from error
