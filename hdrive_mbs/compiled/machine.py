"""LLVM text -> functions that can be called, kept by structure."""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import llvmlite

from hdrive_mbs.compiled.kept_code import kept_code, key_of
from hdrive_mbs.compiled.llvm_code import functions
from hdrive_mbs.compiled.runge_kutta import loop
from hdrive_mbs.compiled.structure import Structure

_NUMBERS = itertools.count()


@dataclass(frozen=True)
class Processor:
    """What the machine code is written for.

    name, features : as LLVM calls them
    lanes : doubles that are computed side by side; 4 also where a register takes 8, for most groups are small
    wide : of larger groups; twice as many take 1.2 to 1.6 times as long where a register takes them (benchmarks/lanes)
    fused : whether it has fused multiply-add
    """

    name: str
    features: str
    lanes: int
    wide: int
    fused: bool


@dataclass(frozen=True)
class Machine:
    """A compiled run of one structure on a number of lanes."""

    run: Callable[..., None]
    kept: Any
    """The library and what holds it; its code lives as long as they do."""


@cache
def processor() -> Processor:
    """This computer's."""
    llvm = _llvm()
    features = llvm.get_host_cpu_features()
    arm = llvm.get_default_triple().startswith(("aarch64", "arm64"))
    lanes = 4 if features.get("avx2") else 2
    wide = 8 if features.get("avx512f") and features.get("avx512vl") else lanes
    return Processor(llvm.get_host_cpu_name(), features.flatten(), lanes, wide, bool(arm or features.get("fma")))


@lru_cache(maxsize=1024)
def machine(structure: Structure, width: int = 1, *, shared: bool = True) -> Machine:
    """Compile, or take what has been compiled for the same structure in this process.

    width : lanes that run side by side
    shared : all lanes have the same inputs
    """
    llvm, host = _llvm(), processor()
    linker = _linker()[1]
    sources = [*functions(structure, width, shared=shared, fused=host.fused), *loop(structure.states, len(structure.readings), width)]
    code = _code("\n".join(dict.fromkeys(sources)))
    made = llvm.JITLibraryBuilder().add_object_img(code).export_symbol("run").add_current_process()
    library = made.link(linker, f"library {next(_NUMBERS)}")
    pointer, real, whole = ctypes.c_void_p, ctypes.c_double, ctypes.c_int64
    kind = ctypes.CFUNCTYPE(None, pointer, real, whole, whole, whole, pointer, pointer, pointer, pointer, pointer, whole)
    return Machine(kind(library["run"]), (library, linker))


def _code(source: str) -> bytes:
    """Machine code of a text for this processor, as it was kept or made now."""
    llvm, host, store = _llvm(), processor(), kept_code()
    key = key_of([source, llvmlite.__version__, repr(llvm.llvm_version_info), llvm.get_default_triple(), host.name, host.features])
    found = None if store is None else store.read(key)
    if found is not None:
        return found
    target = _linker()[0]
    module = llvm.parse_assembly(source)
    module.verify()
    builder = llvm.create_pass_builder(
        target, llvm.create_pipeline_tuning_options(speed_level=0)
    )  # straight lines of code: more costs, gains nothing
    builder.getModulePassManager().run(module, builder)
    code: bytes = target.emit_object(module)
    module.close()
    if store is not None:
        store.write(key, code)
    return code


@cache
def _linker() -> tuple[Any, Any]:
    """What machine code is written for, and the one linker that puts it into memory: an engine for each piece of code takes much more."""
    llvm, host = _llvm(), processor()
    target = llvm.Target.from_default_triple().create_target_machine(cpu=host.name, features=host.features, opt=2, jit=True)
    return target, llvm.create_lljit_compiler(target)


def _llvm() -> Any:
    import llvmlite.binding as llvm  # 0.2 s that only runs need

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm
