"""Directive ``exported``: what the package exports of a group of modules, documented from the docstrings.

    .. exported:: effects
GROUPS says which modules make a group; together they hold every name of ``hdrive_mbs.__all__`` once.
"""

from __future__ import annotations

import dataclasses
import inspect
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import hdrive_mbs as hm
from hdrive_mbs.quantities import Described

GROUPS: dict[str, tuple[str, ...]] = {
    "scenes": ("scene", "scene_file", "rotor_line_builder", "ross_file", "quantities", "conversions", "quantity", "errors"),
    "components": ("components",),
    "motors": ("motors",),
    "loads": ("loads",),
    "flexsplines": ("flexsplines",),
    "bearings": ("bearings",),
    "teeth": ("teeth",),
    "effects": ("effects",),
    "analyses": ("analysis", "signals"),
    "solvers": ("engine",),
    "plots": ("plots",),
    "records": ("records",),
    "diagnosis": ("diagnosis",),
    "campaigns": ("campaign",),
}
"""Page -> beginnings of module names, whole words."""


def modules() -> dict[str, str]:
    """Exported name -> module that has it."""
    return {name: module for module, names in hm._WHERE.items() for name in names}


def group_of(module: str) -> str:
    """Page of a module."""
    first = module.partition(".")[0]
    found = [group for group, beginnings in GROUPS.items() if first in beginnings]
    if len(found) != 1:
        raise ValueError(
            f"hdrive_mbs.{module} is in {found or 'no group'} of the API reference: name it in GROUPS of docs/tools/exported.py."
        )
    return found[0]


def members(group: str) -> list[str]:
    """Exported names of a group, in the order in which the package lists them."""
    return [name for name, module in modules().items() if group_of(module) == group]


def _described(name: str) -> list[str]:
    thing: Any = getattr(hm, name)
    if not inspect.isclass(thing):
        return [f".. autofunction:: hdrive_mbs.{name}", ""]
    fields = set(getattr(thing, "__dataclass_fields__", ()))
    own = [key for key, value in vars(thing).items() if not key.startswith("_") and key not in fields and _is_method(value)]
    lines = [f".. autoclass:: hdrive_mbs.{name}"]
    if any(_is_exported(base) for base in thing.__bases__):
        lines.append("   :show-inheritance:")
    if own:
        lines.append(f"   :members: {', '.join(own)}")
    return [*lines, ""]


def _is_exported(thing: Any) -> bool:
    return modules().get(thing.__name__) == thing.__module__.removeprefix("hdrive_mbs.")


def _own_bases(app: Sphinx, name: str, thing: Any, options: Any, bases: list[Any]) -> None:
    """Bases that a reader can look up."""
    bases[:] = [base for base in bases if _is_exported(base)]


def _fields(app: Sphinx, what: str, name: str, thing: Any, options: Any, arguments: str | None, result: str | None) -> Any:
    """Names of the fields for what is described by its fields: the docstring says what they are."""
    if what != "class" or not issubclass(thing, Described):
        return None
    needed = [field.name for field in dataclasses.fields(thing) if field.init] if dataclasses.is_dataclass(thing) else []
    return (f"(*, {', '.join(needed)})" if needed else "()"), None


def _is_method(value: Any) -> bool:
    """Something with a docstring of its own that a user may call or read."""
    inner = getattr(value, "__func__", None) or getattr(value, "fget", None) or getattr(value, "func", None) or value
    return bool(inspect.isroutine(inner) and (inner.__doc__ or "").strip())


class Exported(SphinxDirective):
    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        lines = [line for name in members(self.arguments[0]) for line in _described(name)]
        holder = nodes.container()
        self.state.nested_parse(StringList(lines, source=self.env.docname), self.content_offset, holder)
        return holder.children


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("exported", Exported)
    app.connect("autodoc-process-bases", _own_bases)
    app.connect("autodoc-process-signature", _fields)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
