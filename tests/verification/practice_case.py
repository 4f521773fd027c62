"""Practice cases of the withheld benches: records of another integrator, with what they were made of.

They come with the project's shared data and are no part of the package; tests that need one skip where it is missing.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

SHARED = Path(__file__).parents[3] / "shared" / "withheld"


@dataclass(frozen=True, kw_only=True)
class PracticeCase:
    """name : folder of the case;  symbols : symbol of the maker -> parameter of the model"""

    name: str
    symbols: Mapping[str, str]

    @property
    def folder(self) -> Path:
        return SHARED / "practice" / self.name

    @property
    def needed(self) -> pytest.MarkDecorator:
        return pytest.mark.skipif(not self.folder.is_dir(), reason="the shared bench records are not beside this checkout")

    def true_parameters(self) -> dict[str, float]:
        values = json.loads((self.folder / "truth.json").read_text())["true_parameters"]
        return {name: values[symbol] for symbol, name in self.symbols.items()}

    def columns(self, record: str) -> dict[str, np.ndarray]:
        parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow reads the records")
        table = parquet.read_table(self.folder / f"{record}.parquet")
        return {name: table[name].to_numpy().astype(float) for name in table.column_names}


def data_sheet(bench: str) -> dict[str, Any]:
    """What is known of a bench to everyone."""
    return tomllib.loads((SHARED / f"{bench}_bench.toml").read_text())
