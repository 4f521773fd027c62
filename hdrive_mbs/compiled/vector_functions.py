"""sin, cos, exp, tanh, log and pow of all lanes at once, as LLVM text; they need fused multiply-add.

Reductions after Cody and Waite (Software Manual for the Elementary Functions, 1980): x = k pi/2 + r and x = k ln 2 + r
with the period in two parts, so that fma leaves r exact to rounding.  Polynomials of sin and cos as in fdlibm
(k_sin.c, k_cos.c), of log as in fdlibm (e_log.c), of exp the Taylor series, whose remainder at |r| = ln(2)/2 is below 2^-57.
Errors are a few units in the last place; those of sin and cos have 1e-33 |x| on top, which
shows beside their zeros alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from hdrive_mbs.compiled.llvm_text import Text

VECTORS = ("sin", "cos", "exp", "tanh", "log", "pow")
"""What has a translation here."""
BOTH = "sin_cos"
"""Sine and cosine of the same angle, which take hardly more than one of them."""

_SIN = (
    -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
    2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10,
)  # fmt: skip
_COS = (
    4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
    -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11,
)  # fmt: skip
_EXP = tuple(1.0 / math.factorial(k + 2) for k in range(12))
_LOG = (
    6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01, 2.222219843214978396e-01,
    1.818357216161805012e-01, 1.531383769920937332e-01, 1.479819860511658591e-01,
)  # fmt: skip
_HALF_PI = (math.pi / 2.0, 6.123233995736766e-17)
"""pi/2 as the sum of two doubles: sin(pi in double) = pi - that double."""
_LN2 = (math.log(2.0), 2.3190468138462996e-17)
_LN2_ROUND = 6.93147180369123816490e-01
"""ln 2 with its last 32 bits zero, so that whole multiples of it are exact."""
_LN2_REST = 1.90821492927058770002e-10
_SHIFT = 6755399441055744.0
"""1.5 * 2^52: added to a number below 2^50, the last bits of the sum are its nearest whole number."""
_FAR = 1e13
"""Beyond this angle [rad], which only a run that diverges can reach, sin and cos are NaN."""


def vector_function(name: str, width: int, declared: dict[str, str]) -> str:
    """``define <lanes> @vector_<name>(<lanes>)``, for pow ``(<lanes>, <lanes>)``."""
    text = Text(width, declared)
    made = {"sin": _sin, "cos": _cos, "exp": _exp, "tanh": _tanh, "log": _log, "pow": _pow}[name](text)
    parameters = f"{text.real} %x, {text.real} %y" if name == "pow" else f"{text.real} %x"
    head = f"define internal {text.real} @vector_{name}({parameters}) alwaysinline {{\nentry:"
    return "\n".join([head, *text.lines, f"  ret {text.real} {made}", "}"])


def _sin(text: Text) -> str:
    return _angle(text, 0)


def _cos(text: Text) -> str:
    return _angle(text, 1)


def _angle(text: Text, quarters: int) -> str:
    """sin(x + quarters pi/2)."""
    return _turned(text, _around(text), quarters)


def sine_and_cosine(width: int, declared: dict[str, str]) -> str:
    """``define {<lanes>, <lanes>} @vector_sin_cos(<lanes>)``."""
    text = Text(width, declared)
    parts = _around(text)
    pair = f"{{{text.real}, {text.real}}}"
    first = text.new(f"insertvalue {pair} undef, {text.real} {_turned(text, parts, 0)}, 0")
    both = text.new(f"insertvalue {pair} {first}, {text.real} {_turned(text, parts, 1)}, 1")
    head = f"define internal {pair} @vector_{BOTH}({text.real} %x) alwaysinline {{\nentry:"
    return "\n".join([head, *text.lines, f"  ret {pair} {both}", "}"])


@dataclass(frozen=True)
class _Around:
    """Of an angle: sine and cosine of what is left beside whole quarters of a turn, their number, and whether it is beyond all measure."""

    sine: str
    cosine: str
    quarters: str
    far: str


def _around(text: Text) -> _Around:
    shifted = text.fma("%x", text.number(2.0 / math.pi), text.number(_SHIFT))
    turns = text.negative(text.sub(shifted, text.number(_SHIFT)))
    r = text.fma(turns, text.number(_HALF_PI[0]), "%x")
    r = text.fma(turns, text.number(_HALF_PI[1]), r)
    square = text.mul(r, r)
    sine = text.fma(text.mul(square, r), text.polynomial(square, _SIN), r)
    half = text.mul(square, text.number(0.5))
    near = text.sub(text.number(1.0), half)
    lost = text.sub(text.sub(text.number(1.0), near), half)
    cosine = text.add(near, text.fma(text.mul(square, square), text.polynomial(square, _COS), lost))
    return _Around(sine, cosine, text.bits(shifted), text.compare("ogt", text.intrinsic("fabs", "%x"), text.number(_FAR)))


def _turned(text: Text, parts: _Around, quarters: int) -> str:
    quarter = text.integers("add", parts.quarters, text.integer(quarters))
    odd = text.new(f"trunc {text.whole} {quarter} to {text.truth}")
    value = text.choose(odd, parts.cosine, parts.sine)
    sign = text.integers("shl", text.integers("and", quarter, text.integer(2)), text.integer(62))
    value = text.from_bits(text.integers("xor", text.bits(value), sign))
    return text.choose(parts.far, text.number(math.nan), value)


def _reduced(text: Text, x: str) -> tuple[str, str]:
    """Whole k, the nearest to x / ln 2, and r = x - k ln 2."""
    shifted = text.fma(x, text.number(1.0 / math.log(2.0)), text.number(_SHIFT))
    count = text.negative(text.sub(shifted, text.number(_SHIFT)))
    r = text.fma(count, text.number(_LN2[0]), x)
    whole = text.integers("sub", text.bits(shifted), text.bits(text.number(_SHIFT)))
    return whole, text.fma(count, text.number(_LN2[1]), r)


def _power_of_two(text: Text, whole: str) -> str:
    """2^k for whole k from -1022 to 1023."""
    return text.from_bits(text.integers("shl", text.integers("add", whole, text.integer(1023)), text.integer(52)))


def _less_one(text: Text, r: str) -> str:
    """exp(r) - 1 for small r."""
    return text.fma(text.mul(r, r), text.polynomial(r, _EXP), r)


def _below(text: Text, x: str, high: float) -> str:
    """x, or the limit above it; NaN stays."""
    return text.choose(text.compare("ogt", x, text.number(high)), text.number(high), x)


def _exp(text: Text) -> str:
    return _exponential(text, "%x")


def _exponential(text: Text, x: str) -> str:
    x = _below(text, x, 1000.0)
    x = text.choose(text.compare("olt", x, text.number(-1000.0)), text.number(-1000.0), x)
    whole, r = _reduced(text, x)
    first = text.integers("ashr", whole, text.integer(1))
    second = text.integers("sub", whole, first)
    value = text.add(text.number(1.0), _less_one(text, r))
    return text.mul(text.mul(value, _power_of_two(text, first)), _power_of_two(text, second))


def _tanh(text: Text) -> str:
    """e / (e + 2) with e = exp(2 |x|) - 1, which keeps small arguments."""
    size = text.intrinsic("fabs", "%x")
    whole, r = _reduced(text, _below(text, text.add(size, size), 44.0))
    power = _power_of_two(text, whole)
    e = text.fma(power, _less_one(text, r), text.sub(power, text.number(1.0)))
    return text.intrinsic("copysign", text.div(e, text.add(e, text.number(2.0))), "%x")


def _log(text: Text) -> str:
    value, _ = _logarithm(text, "%x")
    value = text.choose(text.compare("oeq", "%x", text.number(math.inf)), "%x", value)
    value = text.choose(text.compare("oeq", "%x", text.number(0.0)), text.number(-math.inf), value)
    return text.choose(text.compare("uge", "%x", text.number(0.0)), _or_nan(text, "%x", value), text.number(math.nan))


def _or_nan(text: Text, x: str, value: str) -> str:
    return text.choose(text.compare("uno", x, x), x, value)


def _logarithm(text: Text, x: str) -> tuple[str, str]:
    """log of a finite x > 0 as a number and what it lacks: x = 2^k (1 + f), s = f / (2 + f)."""
    tiny = text.compare("olt", x, text.number(2.0**-1000))
    x = text.choose(tiny, text.mul(x, text.number(2.0**100)), x)
    # the exponent of x / sqrt(1/2), so that 1 + f lies between sqrt(1/2) and sqrt(2)
    raised = text.integers("sub", text.bits(x), text.bits(text.number(math.sqrt(0.5))))
    k = text.integers("ashr", raised, text.integer(52))
    f = text.sub(text.from_bits(text.integers("sub", text.bits(x), text.integers("shl", k, text.integer(52)))), text.number(1.0))
    count = text.new(f"sitofp {text.whole} {k} to {text.real}")
    count = text.choose(tiny, text.sub(count, text.number(100.0)), count)
    s = text.div(f, text.add(f, text.number(2.0)))
    square = text.mul(s, s)
    half = text.mul(text.mul(f, f), text.number(0.5))
    rest = text.mul(square, text.polynomial(square, _LOG))
    part = text.mul(count, text.number(_LN2_ROUND))
    high = text.add(part, f)
    lost = text.sub(f, text.sub(high, part))
    small = text.fma(count, text.number(_LN2_REST), text.sub(text.mul(s, text.add(half, rest)), half))
    low = text.add(lost, small)
    total = text.add(high, low)
    return total, text.sub(low, text.sub(total, high))


def _pow(text: Text) -> str:
    """exp(y log |x|) with both parts of the logarithm and of the product; the sign of x for odd y."""
    zero, one = text.number(0.0), text.number(1.0)
    size = text.intrinsic("fabs", "%x")
    high, low = _logarithm(text, size)
    product = text.mul("%y", high)
    lost = text.fma("%y", low, text.fma("%y", high, text.negative(product)))
    value = _exponential(text, product)
    value = text.choose(text.compare("olt", text.intrinsic("fabs", product), text.number(700.0)), text.fma(value, lost, value), value)
    at_zero = text.compare("oeq", size, zero)
    edge = text.new(f"or {text.truth} {at_zero}, {text.compare('oeq', size, text.number(math.inf))}")
    vanishes = text.new(f"xor {text.truth} {at_zero}, {text.compare('olt', '%y', zero)}")
    value = text.choose(edge, text.choose(vanishes, zero, text.number(math.inf)), value)
    whole = text.compare("oeq", text.intrinsic("floor", "%y"), "%y")
    half = text.mul("%y", text.number(0.5))
    odd = text.new(f"and {text.truth} {whole}, {text.compare('une', text.intrinsic('floor', half), half)}")
    value = text.choose(odd, text.intrinsic("copysign", value, "%x"), value)
    below = text.compare("olt", "%x", zero)
    broken = text.new(f"and {text.truth} {below}, {text.new(f'xor {text.truth} {whole}, {text.true}')}")
    value = text.choose(broken, text.number(math.nan), value)
    value = text.choose(text.compare("uno", "%x", "%y"), text.number(math.nan), value)
    return text.choose(text.compare("oeq", "%y", zero), one, value)
