"""Says what a source archive and a wheel lack of the tree: ``python .ci/archives.py FOLDER_WITH_BOTH``."""

from __future__ import annotations

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
IN_SOURCE = ("hdrive_mbs/", "models/", "benchmarks/", "docs/", "tests/")
ALSO_IN_SOURCE = {"README.md", "CHANGELOG.md", "LICENSE", "pyproject.toml"}
OFTEN_FORGOTTEN = {
    "hdrive_mbs/py.typed",
    "hdrive_mbs/__init__.pyi",
    "hdrive_mbs/data/robot_joint_line.py",
    "hdrive_mbs/data/robot_joint_line/to_and_fro.csv",
}


def main(folder: Path) -> int:
    """Compare; returns the number of faults."""
    files = {name for name in tracked() if (ROOT / name).is_file()}
    there = (path for path in (ROOT / "hdrive_mbs").rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    package = {str(path.relative_to(ROOT)) for path in there}  # also what git ignores: a build leaves that out in silence
    wheel = members_of_wheel(only(folder, "*.whl"))
    source = members_of_source(only(folder, "*.tar.gz"))
    wanted = {name for name in files if name.startswith(IN_SOURCE)} | ALSO_IN_SOURCE
    faults = [f"not in the wheel: {name}" for name in sorted((package | OFTEN_FORGOTTEN) - wheel)]
    faults += [f"not in the source archive: {name}" for name in sorted(wanted - source)]
    faults += [f"should not be in the wheel: {name}" for name in sorted(wheel) if not name.startswith(("hdrive_mbs/", "hdrive_mbs-"))]
    faults += [f"should not be in an archive: {name}" for name in sorted(wheel | source) if "__pycache__" in name or name.endswith(".pyc")]
    print("\n".join(faults) or f"{len(package)} files of the package are in both archives")
    return min(len(faults), 1)


def tracked() -> list[str]:
    """Files of the repository, and new ones that it does not ignore."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return listed.stdout.splitlines()


def only(folder: Path, pattern: str) -> Path:
    (found,) = folder.glob(pattern)
    return found


def members_of_wheel(path: Path) -> set[str]:
    with zipfile.ZipFile(path) as archive:
        return {name for name in archive.namelist() if not name.endswith("/")}


def members_of_source(path: Path) -> set[str]:
    """Without the folder that all of them are in."""
    with tarfile.open(path) as archive:
        return {item.name.partition("/")[2] for item in archive.getmembers() if item.isfile()}


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
