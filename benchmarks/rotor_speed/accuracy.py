"""Reference whirl frequencies, and how far a tool's Campbell diagram is from them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.linalg import expm, solve_triangular
from scipy.optimize import brentq

from benchmarks.rotor_speed import rotor
from benchmarks.rotor_speed.beam import AREA, BENDING, SECOND_MOMENT, SHEAR, FloatArray, matrices

CLOSE = 96
"""Elements whose frequencies start the search for the exact ones; 7e-7 off at most for the first six."""


def exact_frequencies(speeds: FloatArray, count: int = 6) -> FloatArray:
    """The ``count`` lowest lateral frequencies at each speed [rad/s], by size; forward positive, backward negative.

    Those of the beam equations themselves, without elements: roots of ``_mismatch``, each searched for within 1e-5 of
    the frequency that elements give.
    """
    near = element_frequencies(CLOSE, speeds, count)
    found = np.empty_like(near)
    for row, speed in enumerate(speeds.tolist()):
        for column, guess in enumerate(near[row].tolist()):
            found[row, column] = brentq(_mismatch, guess * (1.0 - 1e-5), guess * (1.0 + 1e-5), args=(speed,), xtol=1e-10, rtol=1e-13)
    return found


def _mismatch(frequency: float, speed: float) -> float:
    """Determinant that vanishes at the whirl q exp(i w t) of the exact beam, by transfer matrices.

    Along the shaft (v, s, B, Q) = displacement, slope, bending moment, shear force obey

        v' = s + Q / kG A,   s' = B / E I,   B' = -Q + rho I (2 w W - w^2) s,   Q' = -rho A w^2 v

    a disc adds (w W Ip - w^2 Id) s to B and -m w^2 v to Q; at the ends B = 0 and Q = +k v (first), -k v (last bearing).
    """
    along = np.zeros((4, 4))
    along[0, 1], along[0, 3], along[1, 2], along[2, 3] = 1.0, 1.0 / SHEAR, 1.0 / BENDING, -1.0
    along[2, 1] = rotor.DENSITY * SECOND_MOMENT * (2.0 * frequency * speed - frequency**2)
    along[3, 0] = -rotor.DENSITY * AREA * frequency**2
    state = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [rotor.BEARING_STIFFNESS, 0.0]])
    ends = (0.0, *(disc.position for disc in rotor.DISCS), rotor.LENGTH)
    for number, (start, end) in enumerate(pairwise(ends)):
        state = expm((end - start) * along) @ state
        if number < len(rotor.DISCS):
            disc = rotor.DISCS[number]
            state[2] += (frequency * speed * disc.polar_inertia - frequency**2 * disc.transverse_inertia) * state[1]
            state[3] -= disc.mass * frequency**2 * state[0]
    last = state[3] + rotor.BEARING_STIFFNESS * state[0]
    return float(state[2, 0] * last[1] - state[2, 1] * last[0])


def element_frequencies(elements: int, speeds: FloatArray, count: int = 6) -> FloatArray:
    """The same of equal Timoshenko elements: what a tool with such elements should give, solved in another way.

    Undamped free whirl q exp(i w t) obeys (K + w W P - w^2 M) q = 0 with real symmetric matrices, or

        [[K, 0], [0, M]] z = w [[-W P, M], [M, 0]] z,        z = [q, w q]

    With K = L L' and M = N N' this is a symmetric eigenvalue problem for 1/w: every w comes out real, the low ones
    most accurately.  Against ``exact_frequencies`` the error falls with the square of the number of elements in the
    end, since the shear angle is constant along an element; with few elements it falls faster.
    """
    plane = matrices(elements)
    lower_stiffness, lower_mass = np.linalg.cholesky(plane.stiffness), np.linalg.cholesky(plane.mass)
    size = len(lower_mass)
    polar = solve_triangular(lower_stiffness, solve_triangular(lower_stiffness, plane.polar, lower=True).T, lower=True)
    pencil = np.zeros((2 * size, 2 * size))
    pencil[:size, size:] = solve_triangular(lower_stiffness, lower_mass, lower=True)
    pencil[size:, :size] = pencil[:size, size:].T
    found = np.empty((len(speeds), count))
    for row, speed in enumerate(speeds.tolist()):
        pencil[:size, :size] = -0.5 * speed * (polar + polar.T)
        frequencies = 1.0 / np.linalg.eigvalsh(pencil)
        found[row] = frequencies[np.argsort(np.abs(frequencies), kind="stable")[:count]]
    return found


def frequency_errors(found: FloatArray, reference: FloatArray) -> FloatArray:
    """|w / w_reference - 1| at each speed, frequencies matched by rank: (speeds, count) arrays, signs do not matter.

    Matching by rank judges the numbers alone, not how a tool follows its branches through crossings.  A frequency that a
    tool missed shifts all above it and shows as a large error.
    """
    if found.shape != reference.shape:
        raise ValueError(f"Frequencies of shape {found.shape} cannot be matched with {reference.shape}: same speeds, same number of modes.")
    return np.asarray(np.abs(np.sort(np.abs(found), axis=1) / np.sort(np.abs(reference), axis=1) - 1.0))
