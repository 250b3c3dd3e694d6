"""Arrays of samples as the library wants them: rows of 32-bit floats, full scale being ±1."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import ArgumentError

__all__ = ["array_of", "rows", "warn_of_width"]

#: Least bits of integers that may hold those of a narrower type.
_WIDE = 32


def array_of(name: str, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Values as an array, whose name is that of the argument."""
    if isinstance(values, np.ma.MaskedArray):
        raise ArgumentError(f"{name}: a masked array, expected one without a mask: fill it by its `filled`")
    try:
        return np.asarray(values)
    except ValueError:
        raise ArgumentError(f"{name}: rows of different lengths, expected an array") from None


def warn_of_width(samples: npt.NDArray[Any]) -> None:
    """Warns of wide integers whose peak would be silence at their width, as that of 16 bits in 64 is."""
    bits = 8 * samples.dtype.itemsize
    if samples.dtype.kind != "i" or bits < _WIDE:
        return
    peak = max(int(samples.max()), -int(samples.min()))
    # 16 bits in 32. Samples of 24 bits are louder but for the quietest recordings.
    if 0 < peak <= 2 ** (bits - 17):
        warnings.warn(
            f"samples of {samples.dtype} reach only {peak} of 2**{bits - 1}: were they of fewer bits? "
            "Pass those of 16 bits as np.int16, others divided by their full scale",
            stacklevel=3,
        )


def rows(
    samples: npt.ArrayLike, channels: int | None = None
) -> tuple[npt.NDArray[np.float32], str]:
    """Rows of samples, one for each channel, and how they were stored; `channels` is how many there have to be.

    Rows of 32-bit floats one after another are not copied.
    """
    array = array_of("samples", samples)
    encoding = _encoding(array.dtype)
    if array.ndim == 1:
        array = array[np.newaxis, :]
    if array.ndim != 2:
        raise ArgumentError(
            f"samples have {array.ndim} dimensions, expected shape (n,) or (channels, n)"
        )
    _check_rows(array.shape, channels)
    return np.ascontiguousarray(_scaled(array)), encoding


def _check_rows(shape: tuple[int, ...], channels: int | None) -> None:
    count, length = shape
    turned = count > length > 0 if channels is None else count != channels == length
    if turned:
        raise ArgumentError(
            f"samples have shape {shape}, which is {count} channels of {length} samples: "
            "transpose them to (channels, n)"
        )
    if channels is not None and count != channels:
        raise ArgumentError(f"samples have {count} channels, expected {channels}")


def _encoding(dtype: np.dtype[Any]) -> str:
    bits = 8 * dtype.itemsize
    match dtype.kind:
        case "i" | "u":
            return f"{bits}-bit integer"
        case "f":
            return f"{bits}-bit float"
    of_file = "; analyze_file listens to a file" if dtype.kind in "US" else ""
    raise ArgumentError(f"samples are of type {dtype}, expected floats or integers{of_file}")


def _scaled(array: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """Full scale becomes ±1: of integers the power of two that ends their range, of unsigned ones about its middle."""
    kind, full_scale = array.dtype.kind, 2.0 ** (8 * array.dtype.itemsize - 1)
    # What is too large for 32 bits becomes infinite, and is then read as zero, with a warning in the report.
    with np.errstate(over="ignore"):
        if kind == "f":
            return array.astype(np.float32, copy=False)
        if kind == "u":
            centred = array.astype(np.float64) - full_scale
            return (centred / full_scale).astype(np.float32)
        return array.astype(np.float32) * np.float32(1.0 / full_scale)
