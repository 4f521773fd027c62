"""What a campaign was made of: the scene, where there is one, and the settings that make it again."""

from __future__ import annotations

from typing import Any

from hdrive_mbs.scene import Scene


def made_of(function: Any, name: str, fingerprint: str) -> tuple[Scene | None, dict[str, Any]]:
    """Scene and settings of a function: what its own ``made_of()`` gives, if it has one, with its name and fingerprint."""
    scene, settings = function.made_of() if hasattr(function, "made_of") else (None, {})
    return scene, {"function": name, "fingerprint": fingerprint, **settings}
