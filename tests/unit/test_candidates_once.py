"""What may be missing is tried at each place once for each set of values that a search may begin at."""

from __future__ import annotations

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.scene import Scene
from tests.unit.diagnosis_cases import bench


def test_no_start_is_put_into_the_scene_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[tuple[str, str]] = []
    put = Scene.with_effect

    def noted(scene: Scene, effect: hm.Effect, *, at: str, name: str | None = None) -> Scene:
        tried.append((repr(effect), at))
        return put(scene, effect, at=at, name=name)

    monkeypatch.setattr(Scene, "with_effect", noted)
    found = candidates(bench().scene)
    assert len(tried) == len(set(tried)) > 100
    assert sum(len(item.first) for item in found) > 50
    for item in found:
        assert {(repr(start.effect), start.at) for start in (*item.first, *item.starts)} <= set(tried)
