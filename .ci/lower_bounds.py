"""Constraints for pip that hold every direct dependency at its lowest allowed version, extras included."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

_REQUIREMENT = re.compile(r"([\w.-]+)(?:\[[^\]]*\])?\s*>=\s*([\w.]+)")


def main() -> None:
    """Print ``name==version`` of each, the highest where several places ask for one."""
    with (Path(__file__).resolve().parents[1] / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    asked = [*project["dependencies"], *(item for extra in project["optional-dependencies"].values() for item in extra)]
    found: dict[str, str] = {}
    for item in asked:
        if item.startswith(project["name"]):
            continue
        match = _REQUIREMENT.match(item)
        if match is None:
            raise SystemExit(f"{item!r} has no lowest version; write it as 'name>=version,<version'.")
        name, version = match.groups()
        if name not in found or _parts(found[name]) < _parts(version):
            found[name] = version
    print("\n".join(f"{name}=={version}" for name, version in sorted(found.items())))


def _parts(version: str) -> list[int]:
    return [int(part) for part in re.findall(r"\d+", version)]


if __name__ == "__main__":
    main()
