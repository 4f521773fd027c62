"""Whether what a document quotes is what was printed."""

from __future__ import annotations

import re

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def missing(quote: str, printed: str) -> str:
    """The first line of a quotation that was not printed at its place; empty if all were."""
    left = [line for line in printed.splitlines() if line.strip()]
    anywhere = False
    for line in quote.splitlines():
        if line.strip() == "...":
            anywhere = True
            continue
        places = range(len(left)) if anywhere else range(min(1, len(left)))
        place = next((k for k in places if alike(line, left[k])), None)
        if place is None:
            return line
        del left[: place + 1]
        anywhere = False
    return "" if anywhere or not left else f"end, before {left[0]}"


def alike(quoted: str, printed: str) -> bool:
    """The same words, and numbers to one in the last digit quoted or 0.2 %: another machine rounds and steps otherwise.

    Whether fields are wider or narrower does not matter; a quotation that ends with ... is compared up to there.
    """
    quoted, printed = (" ".join(line.split()) for line in (quoted, printed))
    cut = quoted.endswith(" ...")
    words, before = ([part.strip() for part in NUMBER.split(line)] for line in (quoted.removesuffix(" ..."), printed))
    numbers, found = NUMBER.findall(quoted), NUMBER.findall(printed)
    if cut and len(before) >= len(words):
        end = before[len(words) - 1][: len(words[-1])]
        before, found = [*before[: len(words) - 1], end], found[: len(numbers)]
    return words == before and all(close(*pair) for pair in zip(numbers, found, strict=True))


def close(quoted: str, printed: str) -> bool:
    mantissa, _, exponent = quoted.partition("e")
    digit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(float(printed) - float(quoted)) <= max(1.01 * digit * ("." in mantissa or bool(exponent)), 2e-3 * abs(float(quoted)))
