"""Runs a tutorial and keeps what its blocks print and the figures that scripts of the gallery draw of it, in a process of its own:

python -m tests.examples.tutorial_process PAGE FOLDER [NAME ...]
"""

from __future__ import annotations

import json
import pickle
import sys
from pathlib import Path

from docs.gallery.make import drawn, run

if __name__ == "__main__":
    page, folder, *names = sys.argv[1:]
    Path(folder, "printed.json").write_text(json.dumps(run(page)[1]), "utf-8")
    for name in names:
        Path(folder, f"{name}.pickle").write_bytes(pickle.dumps(drawn(name).figure))
