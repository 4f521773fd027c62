"""Makes the pictures of README and docs:  python docs/make_pictures.py [FOLDER]"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import hdrive_mbs as hm  # noqa: E402
from models.harmonic_drive_train import build  # noqa: E402


def make(folder: Path) -> list[Path]:
    """Start-up of the train under load, with a kinematic error of two periods per turn of the wave generator."""
    train = build().with_effect(hm.KinematicError(amplitude=1e-4, order=2), at="gear.mesh")
    response = hm.simulate(train, 1.5, sample_step=5e-4)
    return [path for path in hm.save_figure(hm.plot(response), folder / "start_up") if path.suffix == ".png"]


if __name__ == "__main__":
    for picture in make(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs"):
        print(picture)
