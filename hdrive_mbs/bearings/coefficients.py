"""Bearing coefficients as named fields, and as the 6x6 matrix that they stand for.

A law that has coefficients has, for a prefix such as ``stiffness``, the fields ``stiffness_xx``,
``_yy``, ``_zz``, ``_xy``, ``_yx``, ``_psi``, ``_theta`` and ``stiffness_couplings`` (36 values, row by
row, for the entries without a field of their own).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.bearings.law import DIRECTIONS, FloatArray
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described
from hdrive_mbs.tracked_arrays import array_of

PLACES = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yx": (1, 0), "psi": (3, 3), "theta": (4, 4)}
"""Entry of the matrix -> its row and column."""

_PAIRS = (
    ("xx", "yy", "equal values for a bearing that is alike in x and y"),
    ("psi", "theta", "equal values for a bearing that is alike in both planes"),
)


def check_pair(law: Described, first: str, second: str, advice: str) -> None:
    """Raise ParameterError where one field of a pair is given without the other."""
    for given, missing in ((first, second), (second, first)):
        if getattr(law, given) is not None and getattr(law, missing) is None:
            owner = type(law).__name__
            raise ParameterError(f"{owner}.{given} is given without {missing}, which must not be left at zero unsaid. Give both: {advice}.")


def check_cross(law: Described, prefix: str) -> None:
    """Raise ParameterError where one cross-coupling coefficient is given without the other."""
    usual = "equal values for a fluid film" if prefix.startswith("damping") else f"{prefix}_yx = -{prefix}_xy for the usual whirl term"
    check_pair(law, f"{prefix}_xy", f"{prefix}_yx", f"{usual}, 0 where the other direction does not couple")


def check_coefficients(law: Described, prefix: str) -> None:
    """Raise ParameterError for half-given pairs and for couplings that are not a 6x6 matrix of their own."""
    for first, second, advice in _PAIRS:
        check_pair(law, f"{prefix}_{first}", f"{prefix}_{second}", advice)
    check_cross(law, prefix)
    couplings = getattr(law, f"{prefix}_couplings")
    if couplings is None:
        return
    where = f"{type(law).__name__}.{prefix}_couplings"
    if len(couplings) != 36:
        raise ParameterError(f"{where} has {len(couplings)} values; it must have 36, row by row over {', '.join(DIRECTIONS)}.")
    table = np.reshape(couplings, (6, 6))
    _check_spin(where, table)
    for entry, place in PLACES.items():
        if table[place] != 0.0:
            raise ParameterError(
                f"{where} has {table[place]:g} at row {place[0]}, column {place[1]}: this entry belongs in {prefix}_{entry}."
            )


def _check_spin(where: str, matrix: FloatArray) -> None:
    if np.any(matrix[5, :]) or np.any(matrix[:, 5]):
        raise ParameterError(
            f"{where}: row and column of phi (the sixth) must be zero, a bearing does not hold the spin. "
            "Put drag about the axis into WithFriction or an effect on the shaft."
        )


def matrix_of(law: Described, prefix: str) -> FloatArray:
    """The 6x6 matrix of the fields with this prefix."""
    couplings = getattr(law, f"{prefix}_couplings")
    matrix: FloatArray = np.full((6, 6), 0.0, object) if couplings is None else np.reshape(np.array(couplings, object), (6, 6))
    for entry, place in PLACES.items():
        matrix[place] = getattr(law, f"{prefix}_{entry}") or 0.0
    return array_of(matrix)


def fields_of(owner: str, prefix: str, matrix: npt.ArrayLike) -> dict[str, Any]:
    """The fields that stand for a 6x6 matrix; pairs that are zero are left out.

    Raises ParameterError for another shape, numbers that are not finite and a spin that is held.
    """
    where = f"{owner}.from_matrices: {prefix}"
    try:
        array = np.array(matrix, float)
    except (TypeError, ValueError):
        raise ParameterError(f"{where} = {matrix!r}: must be a 6x6 matrix of numbers over {', '.join(DIRECTIONS)}.") from None
    if array.shape != (6, 6):
        raise ParameterError(f"{where} has the shape {array.shape}; it must be (6, 6) over {', '.join(DIRECTIONS)}.")
    if not np.isfinite(array).all():
        raise ParameterError(f"{where} has entries that are not finite numbers.")
    _check_spin(where, array)
    fields: dict[str, Any] = {f"{prefix}_{entry}": float(array[PLACES[entry]]) for entry in ("xx", "yy", "zz")}
    for pair in (("xy", "yx"), ("psi", "theta")):
        values = [float(array[PLACES[entry]]) for entry in pair]
        if any(values):
            fields |= {f"{prefix}_{entry}": value for entry, value in zip(pair, values, strict=True)}
    rest = array.copy()
    for place in PLACES.values():
        rest[place] = 0.0
    if rest.any():
        fields[f"{prefix}_couplings"] = tuple(rest.ravel().tolist())
    return fields
