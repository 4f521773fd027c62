"""Described values: every field of a part, law or effect knows its unit, meaning and range."""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar, Self
from weakref import WeakKeyDictionary

import numpy as np

from hdrive_mbs.call_arguments import cannot_be_called
from hdrive_mbs.errors import KeywordError, ParameterError, unknown_place
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.tracked import Tracked


def parameter(
    unit: str,
    doc: str,
    *,
    default: Any = dataclasses.MISSING,
    low: float | None = None,
    high: float | None = None,
    above: float | None = None,
    typical: tuple[float, float] | None = None,
    usual: tuple[float, float] | None = None,
    hint: str = "",
) -> Any:
    """A number with a unit.  ``low``/``high`` are allowed values, ``above`` is not; a search varies fields with a ``typical`` range.

    Values outside of the ``usual`` range are warned of, with the ``hint``.
    """
    quantity = Quantity(unit=unit, doc=doc, low=low, high=high, above=above, typical=typical, usual=usual, hint=hint)
    return dataclasses.field(default=default, metadata={"quantity": quantity})


def table(
    unit: str,
    doc: str,
    *,
    default: Any = dataclasses.MISSING,
    low: float | None = None,
    high: float | None = None,
    above: float | None = None,
    typical: tuple[float, float] | None = None,
) -> Any:
    """A sequence of numbers with a unit, kept as a tuple so that parts compare by value."""
    quantity = Quantity(unit=unit, doc=doc, low=low, high=high, above=above, sequence=True, typical=typical)
    return dataclasses.field(default=default, metadata={"quantity": quantity})


def option(doc: str, *, default: Any = dataclasses.MISSING, called_with: tuple[tuple[str, ...], ...] = ()) -> Any:
    """A field that is not a number: a law, a switch, the name of a place.

    called_with : of a field that takes a function the arguments that it gets, in each of the ways there are
    """
    return dataclasses.field(default=default, metadata={"doc": doc, "called_with": called_with})


_FLOATS = (float, Tracked)


@dataclass(frozen=True, kw_only=True)
class FreeParameter:
    """A number in a scene that can be set by its path: value, unit, range and meaning."""

    path: str
    value: float
    quantity: Quantity

    @property
    def unit(self) -> str:
        return self.quantity.unit

    @property
    def low(self) -> float:
        bounds = [b for b in (self.quantity.low, self.quantity.above) if b is not None]
        return max(bounds, default=-math.inf)

    @property
    def high(self) -> float:
        return math.inf if self.quantity.high is None else self.quantity.high

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        left = "(" if self.low in (-math.inf, self.quantity.above) else "["
        right = ")" if self.high == math.inf else "]"
        return f"{self.path} = {self.value:.6g}{unit}  {left}{self.low:g}, {self.high:g}{right}  {self.quantity.doc}"


def snake_case(name: str) -> str:
    """``CoulombStribeckFriction`` -> ``coulomb_stribeck_friction``."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


FIELDS = "Fields, given by name:"
"""Heads the list of fields in a docstring."""


@dataclass(frozen=True, kw_only=True)
class Described:
    """Base of all immutable data: checks its quantities, compares by value, copies with changes."""

    _kind: ClassVar[str] = "object"
    _use: ClassVar[str] = ""
    """Where an object of this kind goes, for one who put it somewhere else."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Add the fields with unit, range and meaning to the docstring, where ``help`` shows them."""
        super().__init_subclass__(**options)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, dataclasses.Field)}
        lines = [_field_line(name, field) for name, field in (getattr(cls, "__dataclass_fields__", {}) | own).items() if field.metadata]
        if cls.__doc__ and lines:
            cls.__doc__ = "\n".join([inspect.cleandoc(cls.__doc__), "", FIELDS, *lines])

    def __new__(cls, *values: Any, **fields: Any) -> Self:
        known, needed = _names(cls)
        if values:
            raise KeywordError(f"{cls.__name__}({values[0]!r}): values are given by name. It has: {', '.join(known)}.")
        for name in fields:
            if name not in known and name not in inspect.signature(cls).parameters:
                raise KeywordError(str(unknown_place("field", name, known, cls.__name__)))
        if not needed <= fields.keys():
            missing = [field for field in dataclasses.fields(cls) if field.name in needed and field.name not in fields]
            wanted = inspect.signature(cls).parameters  # of an initialiser of the class's own, not all fields
            said = [_field_line(field.name, field).strip() for field in missing if field.name in wanted]
            if said:
                raise ParameterError(f"{cls.__name__} lacks what has no default: {'; '.join(said)}.")
        return super().__new__(cls)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies and files make an object without any field first, which a call must not."""
        return _without_fields, (type(self),), self.__dict__

    def __post_init__(self) -> None:
        for field, quantity in _checked(type(self)):
            value = getattr(self, field.name)
            if (
                type(value) in _FLOATS
                and quantity is not None
                and not quantity.sequence
                and quantity.allows(value)
                and quantity.is_usual(value)
            ):
                continue
            if value is None and field.default is None:
                continue
            if quantity is not None:
                self._check_field(field.name, value, quantity)
            else:
                _check_option(f"{type(self).__name__}.{field.name}", value, str(field.type), field.metadata.get("doc", ""))
                wrong = "" if isinstance(value, Described) else cannot_be_called(value, field.metadata.get("called_with", ()))
                if wrong:
                    raise ParameterError(f"{type(self).__name__}.{field.name} = {readable(value, None)}: {wrong}")
        self.check()

    def _check_field(self, name: str, value: Any, quantity: Quantity) -> None:
        where = f"{type(self).__name__}.{name}"
        if quantity.sequence:
            plain = _plain(value, quantity)
            if plain is not None:
                object.__setattr__(self, name, plain)
                return
            try:
                numbers = tuple(_as_float(f"{where}[{i}]", item, quantity.unit) for i, item in enumerate(value))
            except TypeError:
                raise ParameterError(f"{where} = {value!r}: must be a sequence of numbers in {quantity.unit}.") from None
            for index, number in enumerate(numbers):
                quantity.check(f"{where}[{index}]", number)
            object.__setattr__(self, name, numbers)
        else:
            number = _as_float(where, value, quantity.unit)
            quantity.check(where, number)
            object.__setattr__(self, name, number)

    def check(self) -> None:
        """Checks between fields; override in a part or law and raise ParameterError."""

    def replacing(self, **changes: Any) -> Self:
        """A copy with fields changed.  Unknown fields are refused."""
        known = [field.name for field in dataclasses.fields(self)]
        for name in changes:
            if name not in known:
                raise unknown_place("field", name, known, type(self).__name__)
        return dataclasses.replace(self, **changes)

    def fields(self) -> Iterator[tuple[str, Any, Mapping[str, Any]]]:
        """Name, value and metadata of each field."""
        for field in dataclasses.fields(self):
            yield field.name, getattr(self, field.name), field.metadata

    def free_parameters(self, prefix: str = "") -> Iterator[FreeParameter]:
        """All numbers of this object and of the objects in it, by path."""
        for name, value, metadata in self.fields():
            path = f"{prefix}.{name}" if prefix else name
            quantity: Quantity | None = metadata.get("quantity")
            if isinstance(value, Described):
                yield from value.free_parameters(path)
            elif quantity is not None and not quantity.sequence and value is not None:
                yield FreeParameter(path=path, value=value, quantity=quantity)

    def setting(self, path: str, value: Any) -> Self:
        """A copy with the field at a dotted path changed."""
        return self.setting_all({path: value})

    def setting_all(self, changes: Mapping[str, Any]) -> Self:
        """A copy with the fields at dotted paths changed together: values that only go with each other can be set."""
        known = [field.name for field in dataclasses.fields(self)]
        own: dict[str, Any] = {}
        inner: dict[str, dict[str, Any]] = {}
        for path, value in changes.items():
            head, _, rest = path.partition(".")
            if head not in known:
                raise unknown_place("parameter", head, known, type(self).__name__)
            if not rest:
                own[head] = value
            elif isinstance(own.get(head, getattr(self, head)), Described):
                inner.setdefault(head, {})[rest] = value
            else:
                raise unknown_place("parameter", path, known, type(self).__name__)
        for head, parts in inner.items():
            own[head] = own.get(head, getattr(self, head)).setting_all(parts)
        return dataclasses.replace(self, **own)

    def describe(self) -> str:
        """One readable line: the type and its fields with units."""
        words = []
        for name, value, metadata in self.fields():
            quantity: Quantity | None = metadata.get("quantity")
            words.append(f"{name}={readable(value, quantity)}")
        return f"{type(self).__name__}({', '.join(words)})"

    def __str__(self) -> str:
        return self.describe()


def _without_fields(cls: type[Described]) -> Described:
    return object.__new__(cls)


_NAMES: WeakKeyDictionary[type, tuple[tuple[str, ...], frozenset[str]]] = WeakKeyDictionary()
_CHECKED: WeakKeyDictionary[type, tuple[tuple[dataclasses.Field[Any], Quantity | None], ...]] = WeakKeyDictionary()
"""Worked out once for each class, and forgotten with it."""


def _names(cls: type[Described]) -> tuple[tuple[str, ...], frozenset[str]]:
    """Fields that a class takes, and those of them without a default."""
    found = _NAMES.get(cls)
    if found is None:
        bare = [name for name, value in vars(cls).items() if isinstance(value, dataclasses.Field)]
        if bare:
            raise ParameterError(
                f"{cls.__name__} has the fields {', '.join(bare)} but is no dataclass: "
                "put @dataclass(frozen=True, kw_only=True) above its class line."
            )
        fields = dataclasses.fields(cls)
        found = tuple(field.name for field in fields if field.init), frozenset(field.name for field in fields if is_needed(field))
        _NAMES[cls] = found
    return found


def _checked(cls: type[Described]) -> tuple[tuple[dataclasses.Field[Any], Quantity | None], ...]:
    """Fields of a class with their quantities."""
    found = _CHECKED.get(cls)
    if found is None:
        found = tuple((field, field.metadata.get("quantity")) for field in dataclasses.fields(cls))
        _CHECKED[cls] = found
    return found


def is_needed(field: dataclasses.Field[Any]) -> bool:
    """Whether a field has to be given: it has no default."""
    return field.init and field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING


def _field_line(name: str, field: dataclasses.Field[Any]) -> str:
    quantity: Quantity | None = field.metadata.get("quantity")
    words = [quantity.doc if quantity is not None else field.metadata.get("doc", "")]
    if quantity is not None:
        bounds = (("above", quantity.above), ("at least", quantity.low), ("at most", quantity.high))
        words += [f"{word} {value:g}" for word, value in bounds if value is not None]
        if quantity.typical is not None:
            words.append("typically {:g} to {:g}".format(*quantity.typical))
    if field.default is not dataclasses.MISSING and field.default is not None:
        words.append(f"default {readable(field.default, None)}")
    unit = "" if quantity is None else f" [{quantity.unit}]"
    return f"    {name}{unit} : {', '.join(words)}"


def _plain(values: Any, quantity: Quantity) -> tuple[float, ...] | None:
    """A tuple, list or array of nothing but floats that are all allowed, checked together; None for what needs a closer look.

    A table of a record has ten thousands of them.
    """
    if isinstance(values, np.ndarray):
        if values.ndim != 1 or values.dtype != float:
            return None
        array, numbers = values, tuple(values.tolist())
    elif type(values) in (tuple, list) and set(map(type, values)) <= {float}:
        array, numbers = np.array(values, float), tuple(values)
    else:
        return None
    return numbers if not numbers or quantity.allows_all(array) else None


def _as_float(where: str, value: Any, unit: str) -> float:
    if type(value) is Tracked:
        return value
    wanted = "must be a number" if unit == "1" else f"must be a number, in {unit}"
    if isinstance(value, (str, bytes, bool)):
        raise ParameterError(f"{where} = {value!r}: {wanted}.")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ParameterError(f"{where} = {value!r}: {wanted}.") from None
    except OverflowError:
        raise ParameterError(f"{where}: must be a finite number, this one has over 300 digits.") from None


def _check_option(where: str, value: Any, annotation: str, doc: str) -> None:
    """Refuse a switch that is no bool, a name that is no text, and a law that cannot be called."""
    kinds = _kinds(annotation)
    if kinds == {"bool"} and not isinstance(value, bool):
        raise ParameterError(f"{where} = {value!r}: must be True or False ({doc}).")
    if kinds <= {"str", "None"} and not isinstance(value, str):
        raise ParameterError(f"{where} = {value!r}: must be a text ({doc}).")
    if "Callable[" in annotation and isinstance(value, type) and issubclass(value, Described):
        raise ParameterError(f"{where} = {value.__name__} is a class; give an object of it: {value.__name__}(...).")
    if "Callable[" in annotation and not callable(value):
        laws = {kind for kind in kinds if kind.isidentifier()}
        only_function = annotation.startswith("Callable[")
        if not (laws & {cls.__name__ for cls in type(value).__mro__} or (not laws and not only_function and isinstance(value, Described))):
            wanted = "a law of the library or a Python function" if laws else "a Python function"
            raise ParameterError(f"{where} = {readable(value, None)}: must be {wanted} ({doc}).{_instead(value)}")


def _instead(value: Any) -> str:
    """What an object of another kind is, and where it goes."""
    if not isinstance(value, Described):
        return ""
    use = value._use.format(name=type(value).__name__)
    return f" {type(value).__name__} is of the kind {value._kind!r}{': ' if use else ''}{use}."


@cache
def _kinds(annotation: str) -> frozenset[str]:
    return frozenset(kind.strip() for kind in annotation.split("|"))


def readable(value: Any, quantity: Quantity | None) -> str:
    """A value with its unit, for people."""
    unit = "" if quantity is None or quantity.unit == "1" else f" {quantity.unit}"
    if isinstance(value, float):
        return f"{value:.6g}{unit}"
    if isinstance(value, tuple) and quantity is not None:
        shown = ", ".join(f"{item:.6g}" for item in value[:4])
        return f"({shown}, ... {len(value)} values){unit}" if len(value) > 4 else f"({shown}){unit}"
    if isinstance(value, Described):
        return value.describe()
    if isinstance(value, Callable):  # type: ignore[arg-type]
        return f"function {getattr(value, '__name__', type(value).__name__)}"
    return repr(value)
