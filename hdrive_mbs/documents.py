"""TOML and JSON files as plain data, within bounds, so that no file can keep the reader busy for ever."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

from hdrive_mbs.errors import FileFormatError

LARGEST = 2**24
"""Bytes; a scene of a hundred tables has less than a hundredth of it."""
DEEPEST = 200
"""Parts of a dotted key: the time that Python's reader takes grows with their square."""

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?<![\w-])(?:{_PART}[ \t]*+\.[ \t]*+){{{DEEPEST}}}")


def document_text(path: Path, largest: int = LARGEST) -> str:
    """The text of a file.

    largest : bytes that it may have

    Raises FileFormatError for a file that cannot be read, is no regular file, is no UTF-8 or is too large.
    """
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            raise FileFormatError(f"{path} is no regular file (a device or pipe); copy it to a file first.")
        size = path.stat().st_size
        if size > largest:
            raise FileFormatError(f"{path} has {size / 2**20:.0f} MiB; a file of this kind has at most {largest / 2**20:.0f} MiB.")
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise FileFormatError(f"{path}: cannot be read ({error.strerror or error}).") from error
    except UnicodeDecodeError as error:
        raise FileFormatError(f"{path} is not a text file in UTF-8 ({error}).") from error


def read_document(path: Path) -> Any:
    """What a .json file holds, or any other as TOML.

    Raises FileFormatError for a file that cannot be read, is no UTF-8, cannot be parsed or is too large or too deep.
    """
    text = document_text(path)
    is_json = path.suffix.lower() == ".json"
    if not is_json and (deep := _DEEP_KEY.search(text)):
        line = text.count("\n", 0, deep.start()) + 1
        raise FileFormatError(f"{path} cannot be parsed: line {line} has a key of more than {DEEPEST} parts.")
    try:
        return json.loads(text) if is_json else tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"{path} cannot be parsed: {error}") from error
