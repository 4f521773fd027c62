"""Writes ross_rotor.toml, ross_rotor.json and ross_rotor_values.json beside this file, with ROSS:

    ross-env/bin/python tests/data/make_ross_rotor.py

The environment is that of benchmarks/rotor_speed/README.md (ROSS 2.3.0).  The rotor is our own: two discs on a stepped,
bored shaft; at one end a bearing with cross coupling in a housing on an elastic foundation, at the other one whose
coefficients depend on speed, and a seal between.  The values are damped frequencies [rad/s], damping ratios and whirl
from ROSS's ``run_modal`` at the speeds of the bearing's table, where its interpolation plays no part.
"""

from __future__ import annotations

import json
from pathlib import Path

import ross

HERE = Path(__file__).resolve().parent
SPEEDS = (0.0, 200.0, 400.0)
MODES = 8


def rotor() -> ross.Rotor:
    steel = ross.Material("plain_steel", rho=7810.0, E=206e9, G_s=80e9)
    shaft = [ross.ShaftElement(0.1, 0.0, 0.04, material=steel, n=k, beta=2e-6) for k in range(6)]
    shaft += [ross.ShaftElement(0.15, 0.015, 0.05, material=steel, n=k, shear_effects=False, rotary_inertia=False) for k in range(6, 10)]
    discs = [ross.DiskElement(n=2, m=8.0, Id=0.0206, Ip=0.04), ross.DiskElement(n=8, m=12.0, Id=0.06, Ip=0.11, tag="large disc")]
    bearings = [
        ross.BearingElement(n=0, n_link=11, kxx=2e7, kyy=1.6e7, kxy=1e6, kyx=-1e6, cxx=800.0, cyy=900.0, tag="Drive end"),
        ross.BearingElement(n=11, kxx=3e7, kyy=2e7, cxx=300.0, cyy=200.0, tag="Foundation"),
        ross.SealElement(n=5, kxx=1e5, kyy=1e5, cxx=40.0, cyy=40.0),
        ross.BearingElement(
            n=10,
            kxx=[5e6, 8e6, 9e6],
            kyy=[4e6, 6e6, 7e6],
            kxy=[0.0, 3e5, 5e5],
            kyx=[0.0, -3e5, -5e5],
            kzz=[1e6, 1e6, 1e6],
            cxx=[900.0, 600.0, 400.0],
            cyy=[900.0, 700.0, 500.0],
            frequency=list(SPEEDS),
            tag="Free end",
        ),
    ]
    return ross.Rotor(shaft, discs, bearings, [ross.PointMass(n=11, m=2.0)])


def values(one: ross.Rotor) -> list[dict[str, object]]:
    found = []
    for speed in SPEEDS:
        modal = one.run_modal(speed, num_modes=2 * 12)
        kept = [k for k in range(len(modal.wd)) if modal.wd[k] > 1.0]
        rows = [
            {"frequency": float(modal.wd[k]), "damping_ratio": float(modal.damping_ratio[k]), "whirl": str(modal.whirl_direction()[k])}
            for k in kept
        ]
        found.append({"speed": speed, "modes": rows[:MODES]})
    return found


if __name__ == "__main__":
    made = rotor()
    for suffix in ("toml", "json"):
        path = HERE / f"ross_rotor.{suffix}"
        path.unlink(missing_ok=True)
        made.save(path)
    document = {"ross": ross.__version__, "made by": "tests/data/make_ross_rotor.py", "points": values(made)}
    (HERE / "ross_rotor_values.json").write_text(json.dumps(document, indent=1) + "\n")
