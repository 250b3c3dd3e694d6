"""JSON documents as dataclasses, and back."""

from __future__ import annotations

import dataclasses
import functools
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, ClassVar, TypeVar, cast

import numpy as np
import numpy.typing as npt

__all__ = ["Document", "build", "structured"]

T = TypeVar("T")


class Document:
    """A result: a dataclass with the names of the JSON document of the command line."""

    __hash__ = None  # type: ignore[assignment]

    #: Fields that the JSON document leaves out where they are None or empty.
    _left_out_if_empty: ClassVar[frozenset[str]] = frozenset()

    def to_dict(self) -> dict[str, Any]:
        """The JSON document of this, made of dicts, lists, numbers, texts and None."""
        return {
            name: _plain(value)
            for name in _names(cast(Any, type(self)))
            if not _is_empty(value := getattr(self, name))
            or name not in self._left_out_if_empty
        }

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return self.to_dict() == other.to_dict()


def build(cls: type[T], document: Mapping[str, Any]) -> T:
    """A dataclass from its document; what is not there has its default."""
    decoders = _decoders(cast(Any, cls))
    return cls(
        **{
            name: decode(document[name])
            for name, decode in decoders.items()
            if name in document
        }
    )


def structured(
    rows: Sequence[Mapping[str, Any]], dtype: np.dtype[Any]
) -> npt.NDArray[np.void]:
    """An array with a field for each column; a number that does not exist is NaN."""
    table = np.empty(len(rows), dtype)
    for name in dtype.names or ():
        # None becomes NaN where the column has numbers.
        table[name] = [row[name] for row in rows]
    table.flags.writeable = False
    return table


def _is_empty(value: object) -> bool:
    return value is None or (isinstance(value, tuple) and not value)


def _names(cls: type) -> tuple[str, ...]:
    fields = dataclasses.fields(cls)
    return tuple(f.name for f in fields if not f.name.startswith("_"))


def _plain(value: Any) -> Any:
    if isinstance(value, Document):
        return value.to_dict()
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return _rows(value) if value.dtype.names else value.tolist()
    return value


def _rows(table: np.ndarray[Any, Any]) -> list[dict[str, Any]]:
    names = table.dtype.names or ()
    columns = [table[name].tolist() for name in names]
    # A number that is not equal to itself is NaN, which stands for none.
    return [
        {name: value if value == value else None for name, value in zip(names, row)}
        for row in zip(*columns)
    ]


#: How the fields of each class are read: hints are made out once.
_DECODERS: dict[type, dict[str, Callable[[Any], Any]]] = {}


def _decoders(cls: type) -> dict[str, Callable[[Any], Any]]:
    if cls not in _DECODERS:
        _DECODERS[cls] = _made_out(cls)
    return _DECODERS[cls]


def _made_out(cls: type) -> dict[str, Callable[[Any], Any]]:
    hints = typing.get_type_hints(cls, include_extras=True)
    return {
        f.name: _decoder(hints[f.name])
        for f in dataclasses.fields(cast(Any, cls))
        if not f.name.startswith("_")
    }


def _decoder(hint: Any) -> Callable[[Any], Any]:
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if dataclasses.is_dataclass(hint):
        return functools.partial(build, cast(Any, hint))
    if origin is Annotated:
        # The type says how it is read.
        return cast(Callable[[Any], Any], arguments[1])
    if origin in (types.UnionType, typing.Union):
        known = _decoder(next(a for a in arguments if a is not type(None)))
        return lambda value: None if value is None else known(value)
    if origin is tuple:
        item = _decoder(arguments[0])
        return lambda values: tuple(item(value) for value in values)
    return lambda value: value
