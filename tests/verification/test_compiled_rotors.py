"""Rotor lines as machine code over longer runs: through criticals like the engine, energy, Sommerfeld's capture.

The equations leave out tilts squared beside 1 (see compiled/rotor_equations.py); the tilts of each case say how much that is.
"""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.initial_values import initial_values
from hdrive_mbs.analysis.time_response import channel_of
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.step_limit import longest_step
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from models import rotor_bench, two_rotor_line
from tests.verification.reference_sommerfeld import spin_up
from tests.verification.test_rotor_conservation import ROTOR_1, ROTOR_2, section
from tests.verification.test_sommerfeld import DISC, END, STRONG, WEAK
from tests.verification.test_sommerfeld import scene as sommerfeld

SAMPLE = rotor_bench.SAMPLE_TIME


def largest(values: object) -> float:
    return float(np.max(np.abs(np.asarray(values))))


def test_the_bench_runs_up_through_its_first_critical_speed_like_the_engine() -> None:
    scene, start = rotor_bench.build("run_up"), rotor_bench.start("run_up")
    network = scene.network()
    samples = 7600
    lateral = ("rotor_1.x", "rotor_1.y", "rotor_2.x", "rotor_2.y")
    tilts = ("rotor_1.psi", "rotor_1.theta", "rotor_2.psi", "rotor_2.theta")
    felt = tuple(f"bearing_{k}.housing.{d}_acceleration" for k in (1, 2) for d in "xy")
    line = CompiledLine(without_idle(network, start["initial"]), (*lateral, *tilts, *felt, "bearing_1.angle", "drive.torque"))
    given = initial_values(network, start["initial_speed"], start["initial"])
    run, finer = (line.run(samples, SAMPLE, step=SAMPLE / n, **given) for n in (6, 12))
    top = int(np.argmax(np.abs(run.values["rotor_1.x"])))
    assert 1000 < top < samples - 400
    # the last of the samples is held for one
    engine = hm.simulate(scene, samples * SAMPLE, solver=rotor_bench.SOLVER, **start)
    noise = rotor_bench.noise()
    for kind in (lateral, tilts, felt, ("bearing_1.angle",)):
        size = max(largest(run.values[name]) for name in kind)
        for name in kind:
            assert largest(run.values[name] - engine.at(name, run.times)) < 1e-6 * size, name
            assert largest(run.values[name] - finer.values[name]) < 1e-6 * size, name
    # a reference with a corner in every sample: the torque follows it, and steps that meet the corners make the same of them
    held = engine.at("drive.torque", run.times)
    assert largest(run.values["drive.torque"] - held) < 0.05 * noise["motor_torque"]


def test_the_published_line_passes_its_critical_speed_like_the_engine() -> None:
    scene, step, every = two_rotor_line.build(), 1.0 / 64000.0, 1.0 / 4000.0
    network = scene.network()
    lateral = ("rotor_1.x", "rotor_1.y", "rotor_2.x", "rotor_2.y", "bearing_a.x", "bearing_b.y")
    tilts = ("rotor_1.psi", "rotor_2.theta", "drive_disc.psi")
    line = CompiledLine(network, (*lateral, *tilts, "rotor_1.speed", "section_2.twist"))
    run, finer = (line.run(801, every, step=s, **initial_values(network, 370.0, {})) for s in (step, 0.5 * step))
    engine = hm.simulate(scene, 0.2, solver=hm.RungeKutta4(step=step), sample_step=every, initial_speed=370.0)
    assert len(engine.times) == 801
    top = int(np.argmax(run.values["rotor_1.x"]))
    assert 200 < top < 700
    for kind in (lateral, tilts, ("rotor_1.speed",), ("section_2.twist",)):
        size = max(largest(run.values[name]) for name in kind)
        for name in kind:
            assert largest(run.values[name] - engine[name].values) < 1e-6 * size, name
    for name in (*lateral, "rotor_1.speed"):
        # order 4: what is left of the error of the coarser run is 16/15 of the difference
        assert largest(run.values[name] - finer.values[name]) < 1e-7 * largest(run.values[name]), name


def energy(network: Network, moment: Moment) -> np.ndarray:
    """Exact kinetic energy, and that of the twisted and bent shaft and of the bearing [J]."""
    total = np.asarray(network.kinetic_energy(moment), float)
    for element in network.matrices:
        total = total + element.stored(moment)
    beam = section(0.3).beam()
    torsion = beam.shear_modulus * beam.polar_moment / beam.length
    return np.asarray(total + 0.5 * torsion * network.connection("shaft").stretch(moment) ** 2)


def stirred(unbalance: float, tilt: float) -> tuple[float, float]:
    """Change of the energy of an undamped line over that of its whirl, and the largest tilt.

    unbalance : factor on that of the rotors;  tilt : rate of tilt at the start over 300 rad/s
    """
    first = ROTOR_1.replacing(eccentricity=unbalance * ROTOR_1.eccentricity, tilt=unbalance * ROTOR_1.tilt)
    last = ROTOR_2.replacing(eccentricity=unbalance * ROTOR_2.eccentricity)
    law = hm.LinearBearing.isotropic(radial=2e6, damping=0.0, axial=1e6, tilt=5e3)
    parts = {"rotor_1": first, "shaft": section(0.3), "rotor_2": last, "bearing": hm.Bearing(law=law)}
    network = hm.Scene(name="undamped", parts=parts, connections=[("rotor_1", "shaft", "rotor_2", "bearing")]).network()
    names = [body.name for body in network.bodies]
    places = [channel_of(body, "angle") for body in network.bodies]
    rates = [channel_of(body, "speed") for body in network.bodies]
    every = 0.2 * longest_step(network)
    start = {"rotor_1": 300.0, "rotor_2": 299.0, "rotor_1.psi": 300.0 * tilt, "rotor_2.x": 100.0 * tilt}
    run = CompiledLine(network, [*places, *rates]).run(2000, every, step=0.25 * every, speeds=start)
    angles, speeds = ({name: run.values[c] for name, c in zip(names, channels, strict=True)} for channels in (places, rates))
    moment = network.moment(run.times, angles, speeds, {})
    spinning = sum(0.5 * rotor.body.polar * moment.speed(rotor.coordinates[5]) ** 2 for rotor in network.rotors)
    total = energy(network, moment)
    lean = max(largest(angles[name]) for name in names if name.endswith(("psi", "theta")))
    return largest(total - total[0]) / largest(total - spinning), lean


def test_an_undamped_balanced_line_keeps_its_exact_energy_but_for_tilts_squared() -> None:
    (lost, lean), (less, smaller) = stirred(0.0, 2e-3), stirred(0.0, 1e-3)
    assert lost < lean**2
    assert lean / smaller == pytest.approx(2.0, rel=1e-2)
    assert lost / less == pytest.approx(4.0, rel=0.25)


def test_an_undamped_unbalanced_line_keeps_its_exact_energy_but_for_tilts_times_unbalance() -> None:
    for unbalance in (1.0, 0.1):
        lost, lean = stirred(unbalance, 1e-3)
        assert lost < lean * (lean + unbalance * ROTOR_1.tilt)


@pytest.mark.parametrize("torque", [WEAK, STRONG])
def test_a_weak_motor_is_captured_at_the_critical_speed_and_a_strong_one_is_not(torque: float) -> None:
    network = sommerfeld(torque).network()
    every = 0.01
    samples = round(END[torque] / every) + 1
    line = CompiledLine(without_idle(network), ["disc.speed", "disc.radial"])
    run = line.run(samples, every, step=1.25e-3)
    finer = line.run(samples, every, step=0.625e-3)
    other = spin_up(DISC, torque, end=END[torque], step=every, tolerance=1e-10, stop=False)
    assert other.passed == (torque == STRONG)
    assert (run.values["disc.speed"][-1] > 1.5 * DISC.critical_speed) == (torque == STRONG)
    np.testing.assert_allclose(run.times, other.times, rtol=0.0, atol=1e-9)
    for name, wanted in (("disc.speed", other.speed), ("disc.radial", other.distance)):
        own = largest(run.values[name] - finer.values[name])
        assert own < 1e-5 * largest(wanted)
        assert largest(finer.values[name] - wanted) < 1e-5 * largest(wanted), name
