"""Imports point one way, and importing the package loads and changes next to nothing."""

from __future__ import annotations

import ast
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import hdrive_mbs

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "hdrive_mbs"


def modules() -> dict[str, Path]:
    """Dotted name of every module of the package."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = list(path.relative_to(ROOT).with_suffix("").parts)
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports(path: Path, *, at_top: bool = False) -> Iterator[str]:
    """Top-level packages that a module imports; with at_top only those that run when it is imported."""

    def walk(node: ast.AST) -> Iterator[ast.AST]:
        for child in ast.iter_child_nodes(node):
            if at_top and isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
                continue
            if at_top and isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
                continue
            yield child
            yield from walk(child)

    for node in walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            yield node.module.split(".")[0]


def importers(name: str) -> set[str]:
    """Subpackages of hdrive_mbs that import a package anywhere."""
    return {module.split(".")[1] if "." in module else "" for module, path in modules().items() if name in set(imports(path))}


def test_the_package_is_found() -> None:
    assert len(modules()) > 80
    assert "exudyn" in set(imports(PACKAGE / "engine" / "assembly.py"))


@pytest.mark.parametrize(("name", "where"), [("exudyn", {"engine"}), ("matplotlib", {"plots"}), ("typer", {"cli"})])
def test_each_heavy_package_has_one_home(name: str, where: set[str]) -> None:
    assert importers(name) == where


def test_relative_imports_are_not_used() -> None:
    for module, path in modules().items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            assert not (isinstance(node, ast.ImportFrom) and node.level), module


def test_every_layer_of_the_package_is_named_in_the_contract() -> None:
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    named = {name.strip().split(".")[1] for layer in layers for name in layer.split("|")}
    existing = {module.split(".")[1] for module in modules() if "." in module}
    assert existing - named <= {"data"}, "a new top-level module needs its layer in [tool.importlinter]"


def test_imports_point_one_way() -> None:
    linter = pytest.importorskip("importlinter.cli", reason="import-linter comes with the dev extra")
    assert linter
    code = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(no_cache=True))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "0 broken" in done.stdout


def in_a_fresh_interpreter(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    return done.stdout


def test_importing_the_package_loads_none_of_the_heavy_ones_and_prints_nothing() -> None:
    heavy = ("exudyn", "matplotlib", "scipy", "pint", "numpy", "rich", "typer")
    code = f"import sys, hdrive_mbs; print([name for name in {heavy!r} if name in sys.modules])"
    assert in_a_fresh_interpreter(code) == "[]\n"


def test_building_and_asking_a_scene_needs_no_engine_and_no_plots() -> None:
    code = (
        "import sys; from models.harmonic_drive_train import build\n"
        "scene = build(); scene.network(); str(scene); scene.parameters()\n"
        "print([name for name in ('exudyn', 'matplotlib', 'scipy', 'pint', 'rich') if name in sys.modules])"
    )
    assert in_a_fresh_interpreter(code) == "[]\n"


def test_importing_every_module_changes_nothing_that_others_see() -> None:
    code = """
import importlib, locale, os, pkgutil, random, signal, sys, warnings
import numpy, matplotlib
def state():
    import matplotlib
    return (
        dict(os.environ), os.getcwd(), random.getstate(), numpy.random.get_state()[1].tolist(), numpy.geterr(),
        numpy.get_printoptions(), signal.getsignal(signal.SIGINT), list(sys.path), dict(matplotlib.rcParams),
        matplotlib.get_backend(), locale.getlocale(), [str(item) for item in warnings.filters if 'hdrive' in str(item)],
    )
import exudyn, scipy.interpolate, pint, rich, typer, matplotlib.pyplot
before = state()
import hdrive_mbs
for module in pkgutil.walk_packages(hdrive_mbs.__path__, 'hdrive_mbs.'):
    importlib.import_module(module.name)
print(before == state())
"""
    assert in_a_fresh_interpreter(code) == "True\n"


def test_every_exported_name_exists_and_is_listed() -> None:
    import hdrive_mbs as hm

    for name in hm.__all__:
        assert getattr(hm, name) is not None
    assert sorted(hm.__all__) == sorted(dir(hm))
    with pytest.raises(AttributeError, match="module 'hdrive_mbs' has no attribute 'Gearbox'"):
        _ = hm.Gearbox


def test_heavy_packages_are_imported_where_they_are_used_and_not_at_the_top() -> None:
    # so that scenes, laws and effects load fast
    slow = {"scipy", "pint", "rich", "matplotlib"}
    for module, path in modules().items():
        top = module.split(".")[1] if "." in module else ""
        if top not in ("analysis", "diagnosis", "plots", "cli", "engine", "teeth"):
            assert not slow & set(imports(path, at_top=True)), module


def test_type_checkers_and_editors_know_every_name_that_the_package_offers() -> None:
    stub = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    imported = {(node.module, alias.asname) for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    offered = {(f"hdrive_mbs.{module}", name) for name, module in hdrive_mbs._MODULE_OF.items()}
    assert imported == offered
