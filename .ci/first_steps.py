"""A small simulation by the installed package, and a scene file for the command line."""

from __future__ import annotations

from pathlib import Path

import hdrive_mbs as hm

assert "site-packages" in hm.__file__, hm.__file__
scene = hm.Scene(
    name="two inertias",
    parts={
        "motor": hm.Motor(inertia=2e-3, characteristic=hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=100.0, duration=0.05))),
        "shaft": hm.Shaft(stiffness=500.0, damping=0.05),
        "load": hm.Load(inertia=0.01, torque=hm.ConstantTorque(value=1.0)),
    },
    connections=[("motor", "shaft", "load")],
)
again = hm.load_scene(hm.save_scene(scene, "train.toml"))
assert again == scene
run = hm.simulate(scene, 0.1)
# a ramp of 100 rad/s in 0.05 s: the load follows the motor, to within its own vibration
speeds = {place: run[f"{place}.speed"].values for place in ("motor", "load")}
assert abs(speeds["motor"][-1] - 100.0) < 1e-6, speeds["motor"][-1]
assert abs(speeds["load"].mean() - speeds["motor"].mean()) < 5.0
assert hm.load(run.save("run.npz")).settings == run.settings
print(f"hdrive_mbs {hm.__version__} from {Path(hm.__file__).parent}: {run.steps} steps, {run.status}")
