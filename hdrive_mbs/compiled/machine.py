"""LLVM text -> functions that can be called, kept by structure."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.llvm_code import HEAD, PIECES, function
from hdrive_mbs.compiled.program import Structure
from hdrive_mbs.compiled.runge_kutta import OBSERVE, RUN
from hdrive_mbs.errors import DependencyError

FloatArray = npt.NDArray[np.float64]

_POINTER = ctypes.POINTER(ctypes.c_double)
_made: dict[tuple[Structure, Structure], Machine] = {}


@dataclass(frozen=True)
class Machine:
    """Compiled functions of one pair of structures (rates and channels)."""

    run: Callable[..., int]
    observe: Callable[..., None]
    kept: Any
    """The execution engine; its code lives as long as it does."""


def machine(rates: Structure, channels: Structure) -> Machine:
    """Compile, or take what has been compiled for the same structures in this process.

    Raises DependencyError without llvmlite.
    """
    key = (rates, channels)
    if key not in _made:
        _made[key] = _compiled(rates, channels)
    return _made[key]


def _compiled(rates: Structure, channels: Structure) -> Machine:
    try:
        import llvmlite.binding as llvm
    except ImportError:
        raise DependencyError('Compiled runs need llvmlite: python -m pip install "hdrive-mbs[diagnosis]"') from None
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    n, m = len(rates.results), max(1, len(channels.results))
    sources = [HEAD, PIECES, function("rates", rates), function("read", channels), RUN.format(n=n), OBSERVE.format(n=n, m=m)]
    module = llvm.parse_assembly("\n".join(sources))
    module.verify()
    target = llvm.Target.from_default_triple().create_target_machine(opt=2)
    options = llvm.create_pipeline_tuning_options(speed_level=2)
    builder = llvm.create_pass_builder(target, options)
    builder.getModulePassManager().run(module, builder)
    engine = llvm.create_mcjit_compiler(module, target)
    engine.finalize_object()
    real, whole = ctypes.c_double, ctypes.c_int64
    run = ctypes.CFUNCTYPE(whole, _POINTER, real, real, whole, whole, _POINTER, _POINTER, _POINTER)(engine.get_function_address("run"))
    observe = ctypes.CFUNCTYPE(None, real, real, whole, _POINTER, _POINTER, _POINTER, _POINTER)(engine.get_function_address("observe"))
    return Machine(run, observe, (engine, target, module))


def pointer(array: FloatArray) -> Any:
    """The memory of a contiguous array of doubles."""
    return array.ctypes.data_as(_POINTER)
