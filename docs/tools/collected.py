"""Pages of the repository that lie outside docs/, copied into docs/collected/ so that the site has them.

README, changelog, and the pages and pictures of the benchmarks.  Links between them and the pages of docs/ are turned
so that they stay links within the site; links to code become names, since the site does not hold the code.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from sphinx.application import Sphinx

LINK = re.compile(r"(!?)\[([^\]\n]*)\]\(((?!https?:|#|mailto:)[^)#\s]+)(#[^)\s]*)?\)")
FENCE = re.compile(r"^(```.*?^```$)", re.M | re.S)


def sources(root: Path) -> dict[Path, str]:
    """File of the repository -> where it goes below docs/."""
    pages = [root / "README.md", root / "CHANGELOG.md", *sorted((root / "benchmarks").rglob("*.md"))]
    pictures = sorted((root / "benchmarks").rglob("*.png"))
    inside = [path for path in (*pages, *pictures) if "sets" not in path.parts and "answers" not in path.parts]
    return {path: f"collected/{path.relative_to(root).as_posix()}" for path in inside}


def placed(text: str, page: Path, name: str, root: Path) -> str:
    """Text of a page whose links point to what the site has.

    page : its file in the repository;  name : where the site has it, relative to docs/
    """
    homes = sources(root)

    def turned(match: re.Match[str]) -> str:
        mark, label, target, anchor = match[1], match[2], match[3], match[4] or ""
        file = (page.parent / target).resolve()
        if file.is_dir() and (file / "README.md").exists():
            file = file / "README.md"
        if file in homes:
            home = homes[file]
        elif file.is_relative_to(root / "docs") and file.exists():
            home = file.relative_to(root / "docs").as_posix()
        elif file.exists():
            return f"`{file.relative_to(root).as_posix()}`" if file.is_relative_to(root) else label
        else:
            return match[0]
        return f"{mark}[{label}]({os.path.relpath(home, Path(name).parent)}{anchor})"

    parts = FENCE.split(text)
    return "".join(part if part.startswith("```") else LINK.sub(turned, part) for part in parts)


def _tree(page: Path, homes: dict[Path, str]) -> str:
    """Contents for a README: the pages beside and below it, as far as no README between has them."""
    if page.name != "README.md" or "benchmarks" not in page.parts:
        return ""
    readmes = {file.parent for file in homes if file.name == "README.md"}

    def owner(file: Path) -> Path:
        folder = file.parent.parent if file.name == "README.md" else file.parent
        return next(place for place in (folder, *folder.parents) if place in readmes)

    below = [file for file in homes if file.suffix == ".md" and file != page and "benchmarks" in file.parts and owner(file) == page.parent]
    names = [file.relative_to(page.parent).with_suffix("").as_posix() for file in below]
    return "\n".join(["", "```{toctree}", ":hidden:", "", *names, "```", ""]) if names else ""


def _collect(app: Sphinx) -> None:
    docs = Path(app.srcdir)
    homes = sources(docs.parent)
    for path, name in homes.items():
        if path.suffix == ".md":
            content = (placed(path.read_text("utf-8"), path, name, docs.parent) + _tree(path, homes)).encode()
        else:
            content = path.read_bytes()
        target = docs / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_bytes() != content:  # an unchanged file keeps its time: no new build of it
            target.write_bytes(content)
    kept = {docs / name for name in homes.values()}
    for old in [file for file in (docs / "collected").rglob("*") if file.is_file() and file not in kept]:
        old.unlink()


def _turn_links(app: Sphinx, name: str, content: list[str]) -> None:
    """Of a page of docs/ as it is read."""
    file = Path(app.env.doc2path(name))
    docs = Path(app.srcdir)
    if file.suffix == ".md" and not file.is_relative_to(docs / "collected"):
        content[0] = placed(content[0], file, file.relative_to(docs).as_posix(), docs.parent)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("builder-inited", _collect)
    app.connect("source-read", _turn_links)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
