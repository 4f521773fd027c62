"""A scene and an analysis as a function of a point."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from hdrive_mbs.campaign.scene_figures import analysis_of
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.scene import Scene


@dataclass(frozen=True, kw_only=True)
class SceneAnalysis:
    """``scene`` with the values of a point, analysed: what ``sweep`` calls.

    scene : the scene; the names of a point are paths in it, like "gear.stiffness.stiffness_1"
    analysis : "modes", "campbell", "run_up", "start_up", or a function of a scene that returns figures
    options : of the analysis, like {"duration": 2.0}
    """

    scene: Scene
    analysis: str | Callable[..., Any]
    options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not isinstance(self.analysis, str):
            return
        known = [name for name in inspect.signature(analysis_of(self.analysis)).parameters if name != "scene"]
        for name in self.options:
            if name not in known:
                raise unknown_place("option", name, known, f"The analysis {self.analysis!r}")

    def __call__(self, point: Mapping[str, Any]) -> Any:
        function = analysis_of(self.analysis) if isinstance(self.analysis, str) else self.analysis
        return function(self.scene.replacing(point), **self.options)

    def units(self) -> dict[str, str]:
        """Unit of every number of the scene that has one."""
        return {path: item.unit for path, item in self.scene.parameters().items() if item.unit != "1"}

    def made_of(self) -> tuple[Scene, dict[str, Any]]:
        """The scene before any value of a point is put in, and the analysis with its options."""
        name = self.analysis if isinstance(self.analysis, str) else getattr(self.analysis, "__qualname__", type(self.analysis).__name__)
        return self.scene, {"analysis": name, "options": dict(self.options)}

    def check(self, point: Mapping[str, Any]) -> None:
        """Raise PlaceError or ParameterError at once for a path that the scene does not have."""
        try:
            self.scene.replacing(point)
        except ParameterError:
            return  # a value out of range is this job's own failure
