"""What every effect on a rotor line must keep, whatever it is.

The shared tests of test_effects.py that need no scene are run again over these effects; the others act on a line of
their own.
"""

from __future__ import annotations

import dataclasses
import functools
import re
import warnings

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.places import PLACES
from hdrive_mbs.engine.assembly import LoweringWarning, assemble
from hdrive_mbs.engine.simulation import RawRun, run
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene_file import scene_from_dict, scene_to_dict
from tests.contracts import test_effects as trains
from tests.contracts.test_effects import TRAIN_KINDS, Example, all_effects, distance

EXAMPLES = {
    type(example.effect): example
    for example in (
        Example(hm.RotorUnbalance(unbalance=1e-3, phase=0.4, lever=0.02), "disc", ("unbalance",)),
        Example(hm.DynamicUnbalance(couple=1e-3, phase=0.4), "disc", ("couple",)),
        Example(hm.ShaftBow(amplitude=1e-3, phase=0.3), "disc", ("amplitude",)),
        Example(hm.ShaftKink(angle=1e-2, phase=0.3, share=0.7), "first", ("angle",)),
        Example(
            hm.Misalignment(once=20.0, twice=30.0, twice_phase=1.0, thrice=10.0, roundness=0.4, direction=0.3, lever=0.05),
            "left",
            ("once", "twice", "thrice"),
        ),
        Example(hm.LoadedMisalignment(once=20.0, twice=30.0, thrice=10.0, growth=0.1, lever=0.05), "left", ("once", "twice", "thrice")),
        Example(hm.OilWhirl(amplitude=50.0, phase=0.2, growth=1.5, reference_speed=20.0, onset=5.0), "left", ("amplitude",)),
        Example(hm.OilWhirlOnset(amplitude=50.0, phase=0.2, onset=5.0), "left", ("amplitude",)),
        Example(
            hm.VaryingOilWhirl(amplitude=50.0, phase=0.2, growth=1.5, slope=0.3, reference_speed=20.0, onset=5.0), "left", ("amplitude",)
        ),
        Example(hm.OilWhirlCycle(amplitude=500.0, phase=0.2, slope=0.3, reference_speed=20.0, onset=5.0, seed=0.1), "left", ("amplitude",)),
        Example(hm.BallPass(amplitude=50.0, order=3.57, phase=0.2, growth=0.5, reference_speed=20.0), "left", ("amplitude",)),
        Example(hm.InnerRacePass(amplitude=50.0, order=5.43, phase=0.2), "left", ("amplitude",)),
        Example(hm.InnerRacePulses(amplitude=50.0, mean=40.0, order=5.43, phase=0.2), "left", ("amplitude", "mean")),
        Example(
            hm.BallPassHarmonics(amplitude=50.0, order=3.57, phase=0.2, second_amplitude=20.0, third_amplitude=10.0, direction=0.7),
            "left",
            ("amplitude", "second_amplitude", "third_amplitude"),
        ),
        Example(hm.ExternalShock(amplitude=500.0, start=0.013, length=5e-3, direction=1.0), "left", ("amplitude",)),
        Example(hm.GroundVibration(amplitude=50.0, frequency=300.0, phase=0.4, direction=1.0), "left", ("amplitude",)),
        Example(hm.MagneticPull(stiffness=2e4, centre_x=1e-4, throb=1e4, frequency=300.0, phase=0.3), "disc", ("stiffness", "throb")),
        Example(
            hm.PulsatingPull(stiffness=2e4, centre_x=1e-4, pulsation=1e4, frequency=300.0, phase=0.3), "disc", ("stiffness", "pulsation")
        ),
        Example(hm.ProbeRunout(once=1e-4, once_phase=0.3, twice=5e-5, thrice=1e-5), "disc", ("once", "twice", "thrice")),
        Example(hm.ProbeGain(error=0.1, curvature=100.0), "probe", ("error", "curvature")),
        Example(hm.ProbeCrossTalk(share=0.1), "probe", ("share",)),
        Example(hm.BearingClearance(gap=1e-4), "left", ("gap",)),
        Example(hm.DampedClearance(gap=1e-4, film_damping=1.0), "left", ("gap",)),
        Example(hm.HertzianClearance(gap=1e-4, exponent=1.0, reference_force=20.0), "left", ("gap",)),
        Example(hm.BearingCubicStiffness(stiffness=1e13), "right", ("stiffness",)),
        Example(hm.BearingHardening(rate=1e4), "left", ("rate",)),
        Example(hm.BearingCrossCoupling(stiffness=5e4, exponent=1.5, reference_speed=50.0, fading=1e6), "left", ("stiffness",)),
        Example(hm.FadingCrossCoupling(stiffness=5e4, asymmetry=0.2, fading=1e6), "left", ("stiffness",)),
        Example(hm.BearingAnisotropy(asymmetry=0.3, angle=0.4), "right", ("asymmetry",)),
        Example(hm.BearingStiffnessChange(change=0.3), "left", ("change",)),
        Example(hm.BearingDampingChange(change=0.8), "left", ("change",)),
        Example(hm.Looseness(share=0.6, lift_off=-2e-5, play=3e-5), "left", ("share",)),
        Example(hm.LooseBolt(share=0.6, lift_off=-2e-5, play=3e-5), "left", ("share",)),
        Example(hm.LooseFit(share=0.6, half_play=5e-6, direction="both"), "left", ("share",)),
        Example(hm.SupportStiffnessChange(change=0.3), "left", ("change",)),
        Example(hm.SupportDampingChange(change=0.8), "left", ("change",)),
        Example(hm.SupportMassChange(change=0.4), "left", ("change",)),
        Example(hm.SupportStiffnessDrift(change=0.5, time_constant=0.02), "left", ("change",)),
        Example(hm.SupportStiffnessStep(change=0.5, middle_time=0.01, length=0.01), "left", ("change",)),
        Example(hm.SupportFriction(coulomb=20.0, smoothing_speed=1e-3), "left", ("coulomb",)),
        Example(hm.SupportPresliding(coulomb=20.0, presliding=2e-5), "left", ("coulomb",)),
        Example(hm.SupportSquareDamping(coefficient=1e4), "left", ("coefficient",)),
        Example(hm.HiddenModeSupport(mass=0.5, natural_frequency=300.0, ratio=1.3, angle=0.4), "left", ("mass",)),
        Example(hm.BreathingCrack(compliance=1e-4, cross_share=0.3, position=0.8, angle=-1.0, steepness=2.0), "first", ("compliance",)),
        Example(hm.MomentCrack(compliance=1e-4, cross_share=0.3, position=0.8, angle=-1.0, closing_moment=3.0), "first", ("compliance",)),
        Example(hm.SteepCrack(compliance=1e-4, cross_share=0.3, position=0.8, angle=-1.0, steepness=2.0), "first", ("compliance",)),
        Example(
            hm.ArcCrack(compliance=1e-4, cross_share=0.3, position=0.8, angle=-1.0, steepness=2.0, opens_at=0.5), "first", ("compliance",)
        ),
        Example(hm.Keyway(compliance=1e-4, cross_share=0.3, position=0.8, angle=-1.0), "first", ("compliance",)),
        Example(hm.PhasedCrack(compliance=1e-4, cross_share=0.3, position=0.8, angle=-1.0, phase=0.7), "first", ("compliance",)),
        Example(hm.InternalDamping(time=1e-3), "first", ("time",)),
        Example(hm.RelaxingDamping(time=1e-3, relaxation_time=2e-3), "first", ("time",)),
        Example(hm.ShaftStiffnessAsymmetry(asymmetry=0.2, angle=0.4), "first", ("asymmetry",)),
        Example(
            hm.Rub(gap=1e-5, stiffness=1e5, friction=0.2, radius=0.05, centre_x=1e-5, centre_y=-5e-6, exponent=1.5), "disc", ("stiffness",)
        ),
        Example(hm.DampedRub(gap=1e-5, stiffness=1e5, damping=30.0, friction=0.2, radius=0.05), "disc", ("stiffness", "damping")),
        Example(hm.HertzianRub(gap=1e-5, stiffness=1e5, loss=2.0, friction=0.2, radius=0.05), "disc", ("stiffness",)),
        Example(
            hm.CoatedRub(gap=1e-5, stiffness=1e5, damping=30.0, coat_depth=1e-5, friction=0.2, radius=0.05),
            "disc",
            ("stiffness", "damping"),
        ),
    )
}


def effects_of_lines() -> list[type[Effect]]:
    """Every concrete effect of the package that acts at a place that only rotor lines have."""
    return [kind for kind in all_effects() if kind.acts_on not in TRAIN_KINDS]


@pytest.fixture(params=effects_of_lines(), ids=lambda kind: kind.__name__)
def example(request: pytest.FixtureRequest) -> Example:
    if request.param not in EXAMPLES:
        pytest.fail(f"{request.param.__name__} has no example: add a line to EXAMPLES in {__file__}.")
    return EXAMPLES[request.param]


# -- the line they act on -----------------------------------------------------------------------------

SOLVER = hm.RungeKutta4(step=1e-4)
DURATION = 0.03
START_SPEED = 40.0
"""rad/s, and a torque that brakes it: about a quarter turn, from which every law moves."""


def line() -> hm.Scene:
    """An unbalanced disc between two soft bearings, one of them in a housing; all modes below 8e3 rad/s."""
    soft = hm.LinearBearing.isotropic(radial=2e5, damping=50.0, axial=1e5, axial_damping=50.0, tilt=100.0, tilt_damping=0.1)
    ring = hm.Bearing(law=soft, mass=1.0, polar_inertia=4e-3, transverse_inertia=2e-3)
    section = hm.ShaftSection(length=0.4, diameter=0.015, youngs_modulus=2e11, shear_modulus=8e10, damping=1e-5)
    parts: dict[str, hm.Component] = {
        "drive": hm.DriveTorque(characteristic=hm.TorqueSpeedTable(speeds=(0.0, 1.0), torques=(-2.0, -2.0))),
        "left": ring.replacing(housing=hm.Housing.isotropic(mass=2.0, stiffness=3e5, damping=30.0)),
        "first": section,
        "disc": hm.Rotor(mass=5.0, polar_inertia=0.05, transverse_inertia=0.03, eccentricity=1e-4),
        "second": section,
        "right": ring,
        "gravity": hm.Gravity(),
        "probe": hm.Sensor(quantity="disc.x"),
        "probe_across": hm.Sensor(quantity="disc.y"),
    }
    return hm.Scene(name="line", parts=parts, connections=[("drive", "left", "first", "disc", "second", "right")])


def placed(example: Example, effect: Effect | None = None) -> hm.Scene:
    return line().with_effect(effect or example.effect, at=example.at, name="it")


def without_size(example: Example) -> Effect:
    return example.effect.replacing(**dict.fromkeys(example.size, 0.0))


def start_speeds(network: Network) -> dict[str, float]:
    return {body.name: body.sense * body.ratio * START_SPEED for body in network.bodies}


@functools.cache
def engine_run(scene: hm.Scene) -> RawRun:
    network = scene.network()
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        assembly = assemble(network)
    return run(assembly, duration=DURATION, solver=SOLVER, angles={}, speeds=start_speeds(network), states={})


def observed(scene: hm.Scene) -> dict[str, np.ndarray]:
    """Angles, speeds, states and readings of a run on the engine."""
    raw, network = engine_run(scene), scene.network()
    moment = network.moment(raw.times, raw.angles, raw.speeds, raw.states)
    return trains.channels(raw) | {f"reading of {c.name}": np.asarray(c.read(moment)) for c in network.channels if c.reads}


def reference_run(network: Network, count: int) -> dict[str, np.ndarray]:
    """The same method and steps with plain floats: nothing recorded, nothing of the engine."""
    bodies, states = [body.name for body in network.bodies], [state.name for state in network.states]
    n, speeds = len(bodies), start_speeds(network)

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        values = y.tolist()
        angles, velocities = dict(zip(bodies, values[:n], strict=True)), dict(zip(bodies, values[n : 2 * n], strict=True))
        slopes = network.accelerations(network.moment(t, angles, velocities, dict(zip(states, values[2 * n :], strict=True))))
        return np.array([*values[n : 2 * n], *(float(slopes[name]) for name in [*bodies, *states])])

    y, h = np.array([0.0] * n + [speeds[name] for name in bodies] + [state.initial for state in network.states]), SOLVER.step
    path = [y]
    for k in range(count):
        t = k * h
        a = rates(t, y)
        b = rates(t + h / 2, y + h / 2 * a)
        c = rates(t + h / 2, y + h / 2 * b)
        d = rates(t + h, y + h * c)
        y = y + h / 6 * (a + 2 * b + 2 * c + d)
        path.append(y)
    found = np.array(path)
    named = {f"angle of {name}": found[:, k] for k, name in enumerate(bodies)}
    named |= {f"speed of {name}": found[:, n + k] for k, name in enumerate(bodies)}
    return named | {name: found[:, 2 * n + k] for k, name in enumerate(states)}


# -- what every effect must keep ------------------------------------------------------------------------

test_its_text_states_equation_source_and_what_it_leaves_out = trains.test_its_text_states_equation_source_and_what_it_leaves_out
test_it_refuses_numbers_that_are_not_finite = trains.test_it_refuses_numbers_that_are_not_finite
test_it_refuses_unknown_fields = trains.test_it_refuses_unknown_fields
test_its_size_can_be_zero_but_only_negative_where_that_means_something = (
    trains.test_its_size_can_be_zero_but_only_negative_where_that_means_something
)
test_it_says_its_kind_its_family_and_where_a_search_begins = trains.test_it_says_its_kind_its_family_and_where_a_search_begins


def test_every_effect_of_rotor_lines_has_an_example() -> None:
    missing = [kind.__name__ for kind in effects_of_lines() if kind not in EXAMPLES]
    assert not missing, f"no line in EXAMPLES for {', '.join(missing)}"


def test_it_runs_without_a_python_callback(example: Example) -> None:
    network = placed(example).network()
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        lowered = assemble(network).lowered
    assert {item.how for item in lowered} <= {"native", "symbolic"}


def test_steady_rotation_has_a_place_for_it(example: Example) -> None:
    """The line hangs at rest somewhere with it, and nothing is left of the forces there but on the spin."""
    scene = placed(example)
    network, at = scene.network(), rotor_point(scene, START_SPEED)
    assert set(at.states) == {state.name for state in network.states}
    assert all(np.isfinite([*at.angles.values(), *at.states.values()]))


def test_of_size_zero_it_changes_nothing(example: Example) -> None:
    # equal equations and steps: rounding alone, 1e-16 a step over 300 steps, enlarged where what moves is small
    difference = distance(_moved(observed(placed(example, without_size(example)))), _moved(observed(line())))
    assert max(difference.values()) < 1e-9, difference


def test_of_example_size_it_can_be_seen(example: Example) -> None:
    difference = distance(_moved(observed(placed(example))), _moved(observed(line())))
    assert max(difference.values()) > 1e-3, difference


def _moved(values: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Without what stands still but for rounding: axial motion, which nothing excites."""
    return {name: item for name, item in values.items() if not name.endswith(".z")}


def test_the_engine_agrees_with_the_equations_in_plain_numbers(example: Example) -> None:
    scene = placed(example)
    raw = engine_run(scene)
    wanted = reference_run(scene.network(), len(raw.times) - 1)
    np.testing.assert_allclose(raw.times, SOLVER.step * np.arange(len(raw.times)), atol=1e-12)
    difference = distance(_moved(trains.channels(raw)), _moved(wanted))
    assert max(difference.values()) < 1e-7, difference


def test_a_compiled_run_equals_that_of_the_engine(example: Example) -> None:
    # the same method with the same steps: what differs is rounding, and what the compiled equations leave out
    scene = placed(example)
    network = scene.network()
    names = [body.name for body in network.bodies]
    states = [state.name for state in network.states]
    readings = [channel.name for channel in network.channels if channel.reads]
    lateral = {body.name for body in network.bodies if body.lateral}
    channels = {name: (name, f"{name}_rate") if name in lateral else (f"{name}.angle", f"{name}.speed") for name in names}
    senses = {body.name: 1.0 if body.lateral else body.sense for body in network.bodies}
    known = {channel.name for channel in network.channels}
    shown = {name: pair for name, pair in channels.items() if set(pair) <= known}
    assert len(shown) > len(names) / 2
    line_ = CompiledLine(network, [*(name for pair in shown.values() for name in pair), *states, *readings])
    samples = round(DURATION / SOLVER.step) + 1
    compiled = line_.run(samples, SOLVER.step, step=SOLVER.step, speeds=start_speeds(network)).values
    engine = observed(scene)
    wanted = {
        channel: senses[name] * engine[f"{what} of {name}"]
        for name, pair in shown.items()
        for what, channel in zip(("angle", "speed"), pair, strict=True)
    }
    wanted |= {name: engine[name] for name in states} | {name: engine[f"reading of {name}"] for name in readings}
    kinds = {name: KINDS.get(name.rpartition(".")[2], name) for name in wanted}
    sizes = {kind: max(float(np.max(np.abs(wanted[name]))) for name in wanted if kinds[name] == kind) for kind in kinds.values()}
    # the compiled equations are of second order in tilts (compiled/rotor_equations.py), sin t = t - t^3/6; a contact that begins at another
    # moment within a step enlarges that
    allowed = (1e-6 + sizes["tilt"] ** 2 / 6.0) * (4.0 if isinstance(example.effect, (hm.Rub, hm.HertzianRub)) else 1.0)
    assert allowed < 4e-5
    for name, values in wanted.items():
        if not name.endswith((".z", ".z_rate")):  # nothing excites axial motion but rounding
            np.testing.assert_allclose(compiled[name], values, rtol=0.0, atol=allowed * sizes[kinds[name]], err_msg=name)


KINDS = {
    f"{d}{ending}": f"{kind}{ending}"
    for kind, ds in {"across": "xy", "tilt": ("psi", "theta")}.items()
    for d in ds
    for ending in ("", "_rate")
}
"""What is held against the largest of its kind: weight moves the line in y, and x hardly at first."""


def test_its_claim_of_dissipation_holds(example: Example) -> None:
    # assembling checks the claims of every law at random moments
    network = placed(example).network()
    claims = [claim for element in network.elements if hasattr(element, "claims") for claim in element.claims()]
    assert any(claim.name.startswith("it") for claim in claims) == example.effect.dissipative


def test_its_places_are_those_where_it_can_be_put(example: Example) -> None:
    kind, scene = type(example.effect), line()
    places = kind.places(scene.network())
    assert len(set(places)) == len(places)
    assert example.at in places
    for place in places:
        assert scene.with_effect(example.effect, at=place, name="it").network() is not None
    with pytest.raises(PlaceError, match=kind.__name__):
        scene.with_effect(example.effect, at="second" if example.at != "second" and kind.acts_on != "shaft" else "disc").network()


def test_at_an_unknown_place_it_says_so(example: Example) -> None:
    with pytest.raises(PlaceError, match="dics"):
        line().with_effect(example.effect, at="dics").network()


def test_every_kind_of_place_but_those_of_drive_trains_is_on_the_line() -> None:
    network = line().network()
    assert {kind for kind, find in PLACES.items() if not find(network)} == {"connection", "gear", "coupling", "load"}


def test_a_pair_of_amplitude_and_phase_turns_like_a_vector(example: Example) -> None:
    # half a turn makes it its negative; a couple unbalance of 1e-5 kg m^2 bends that by its share of the moment of inertia, 3e-4
    bare = _response(line())
    small = without_size(example)
    if isinstance(small, hm.BallPass):
        small = small.replacing(sharpness=0.0)  # its harmonics turn by multiples of the phase
    assert {name for pair in type(example.effect).vectors for name in pair} <= {name for name, _, _ in example.effect.fields()}
    for size, phase in type(example.effect).vectors:
        assert next(metadata["quantity"].unit for name, _, metadata in example.effect.fields() if name == phase) == "rad"
        one = small.replacing(**{size: 0.01 * getattr(example.effect, size), phase: 0.4})
        there, back = (_response(placed(example, one.replacing(**{phase: angle}))) - bare for angle in (0.4, 0.4 + np.pi))
        assert np.max(np.abs(there)) > 0.0
        assert np.max(np.abs(there + back)) < 1e-3 * np.max(np.abs(there))


def _response(scene: hm.Scene) -> np.ndarray:
    """Accelerations and readings at one moment."""
    network, rng = scene.network(), np.random.default_rng(5)
    places = {body.name: float(rng.normal(0.0, 1e-4 if body.lateral else 1.0)) for body in network.bodies}
    speeds = {body.name: float(rng.normal(0.0, 1e-3 if body.lateral else 30.0)) for body in network.bodies}
    moment = network.moment(0.0152, places, speeds, {state.name: 0.3 for state in network.states})
    found = network.accelerations(moment)
    return np.array([*(float(found[body.name]) for body in network.bodies), *(float(c.read(moment)) for c in network.channels if c.reads)])


def test_its_starts_are_values_of_its_fields(example: Example) -> None:
    for name, values in type(example.effect).starts.items():
        for value in values:
            assert getattr(example.effect.replacing(**{name: value}), name) == value


def test_it_is_compared_by_value_and_set_by_path(example: Example) -> None:
    assert dataclasses.replace(example.effect) == example.effect
    scene = placed(example)
    assert scene == placed(example)
    for name in example.size:
        half = 0.5 * getattr(example.effect, name)
        changed = scene.replacing({f"it.{name}": half})
        assert getattr(changed.effect("it").effect, name) == half
        assert changed != scene


def test_it_survives_a_scene_file(example: Example) -> None:
    scene = placed(example)
    assert scene_from_dict(scene_to_dict(scene), types=[type(example.effect)]) == scene


def test_the_package_lists_it(example: Example) -> None:
    name = type(example.effect).__name__
    assert getattr(hm, name) is type(example.effect)
    assert re.fullmatch(r"[a-z_]+", type(example.effect).family)
