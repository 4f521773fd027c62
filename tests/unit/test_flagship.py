"""The robot joint of models/robot_joint_line.py: gear and rotor line in one, against small models of its own."""

from __future__ import annotations

import math
import warnings

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from models import robot_joint_line as joint

FloatArray = npt.NDArray[np.float64]

LEVEL = -0.5 * math.pi
"""Arm angle at which its weight loads the gear forward: the output turns backwards."""

WEIGHT = joint.ARM_MASS * joint.ARM_RADIUS * 9.80665
HOUSINGS = {"x": 8e5, "y": 2e6}
PASSED = 2.4
"""By then the lateral critical speeds are passed [s]."""

STEP = 1.2e-4
SOLVER = hm.Trapezoidal(step=STEP, newton_tolerance=1e-5)


@pytest.fixture(scope="module")
def run() -> hm.RunUp:
    return hm.run_up(joint.build(), 3.0, places=("brake_disc",), solver=SOLVER)


@pytest.fixture(scope="module")
def diagram() -> hm.WhirlCampbell:
    scene = joint.build(arm_angle=LEVEL)
    return hm.campbell(scene, np.linspace(0.0, 500.0, 6), orders={"motor": (1.0, 2.0)})


def polar_stiffness(diameter: float, length: float) -> float:
    return joint.SHEAR_MODULUS * math.pi * diameter**4 / 32.0 / length


# -- the modes, about a level arm -------------------------------------------------------------------------


def torsional_eigenvalues() -> npt.NDArray[np.complex128]:
    """Of a chain of 12 inertias written by hand: motor, hub, a, disc, b, generator | flange, c, encoder, d, arm | gear housing."""
    inertia = np.array([3e-4, 3e-5, 8e-6, 3e-3, 8e-6, 1.1e-4, 6e-4, 8e-6, 2e-4, 8e-6, 0.04 + 4.0 * 0.09, 0.05])
    stiffness, damping = np.zeros((12, 12)), np.zeros((12, 12))

    def spring(k: float, c: float, factors: dict[int, float]) -> None:
        row = np.zeros(12)
        row[list(factors)] = list(factors.values())
        stiffness[...] += k * np.outer(row, row)
        damping[...] += c * np.outer(row, row)

    spring(120.0, 0.012, {0: 1.0, 1: -1.0})
    for diameter, first, lengths in ((0.012, 1, (0.03, 0.15, 0.17, 0.04)), (0.032, 6, (0.03, 0.04, 0.04, 0.04))):
        for k, length in enumerate(lengths, start=first):
            spring(polar_stiffness(diameter, length), 1e-5 * polar_stiffness(diameter, length), {k: 1.0, k + 1: -1.0})
    # forward twist phi_wg/u - phi_fs - (1 + 1/u) phi_cs, phi_cs in true sense; weight 11.8 N m < T1 = 14 N m, so K1 holds
    spring(3.1e4, 12.0, {5: 0.01, 6: -1.0, 11: -1.01})
    spring(2e6, 50.0, {11: 1.0})
    # Kloss: at no slip dM/dw = -2 M_b/(s_b w_s)
    slip = 1.0 - 5700.0 / 6000.0
    breakdown = 2.5 * 400.0 / (5700.0 * math.pi / 30.0)
    damping[0, 0] += 2.0 * breakdown / (slip * (2.5 + math.sqrt(2.5**2 - 1.0)) * 200.0 * math.pi) + 2e-4
    damping[10, 10] += 0.3
    zero, one = np.zeros((12, 12)), np.eye(12)
    state = np.block([[zero, one], [-stiffness / inertia[:, None], -damping / inertia[:, None]]])
    found = np.linalg.eigvals(state)
    found = found[found.imag > 1.0]
    return found[np.argsort(np.abs(found))]


def test_the_torsional_modes_are_those_of_a_chain_of_twelve_inertias() -> None:
    # without ovality: a kinematic error changes the lever of the generator by its slope, 2 A u = 2 %
    found = hm.campbell(joint.build(arm_angle=LEVEL, ovality=0.0), [0.0, 400.0], count=8)
    wanted = torsional_eigenvalues()[:2]
    own = [k for k, word in enumerate(found.whirl) if word == "torsional"]
    for row in range(2):
        np.testing.assert_allclose(found.frequencies[row, own], wanted.imag, rtol=1e-5)
        np.testing.assert_allclose(found.damping_ratios[row, own], -wanted.real / np.abs(wanted), rtol=1e-4)


def test_the_first_lateral_criticals_are_those_of_a_disc_on_an_elastic_shaft_in_two_supports(diagram: hm.WhirlCampbell) -> None:
    # 1/k = a^2 b^2/(3 E I L) + ((b/L)^2 + (a/L)^2)/k_s,  1/k_s = 1/k_bearing + 1/k_housing; overhangs and tilts left out
    a, b, length = 0.15, 0.17, 0.32
    bending = joint.YOUNGS_MODULUS * math.pi * joint.INPUT_DIAMETER**4 / 64.0
    along = [
        speed
        for speed, order, note in zip(diagram.critical_speeds, diagram.critical_orders, diagram.critical_notes, strict=True)
        if diagram.order_numbers[order] == 1.0 and not note and speed > 300.0
    ]
    for found, housing in zip(along, (HOUSINGS["x"], HOUSINGS["y"]), strict=True):
        support = 1.0 / (1.0 / 2e7 + 1.0 / housing)
        flexible = a**2 * b**2 / (3.0 * bending * length) + ((b / length) ** 2 + (a / length) ** 2) / support
        assert found == pytest.approx(math.sqrt(1.0 / flexible / 2.0), rel=0.01)


def test_torsion_and_bending_are_in_one_campbell_diagram(diagram: hm.WhirlCampbell) -> None:
    assert diagram.status == "complete"
    assert {"torsional", "forward", "backward"} <= set(diagram.whirl)
    twice = [
        speed
        for speed, order, word in zip(diagram.critical_speeds, diagram.critical_orders, diagram.critical_whirl, strict=True)
        if diagram.order_numbers[order] == 2.0 and word == "torsional"
    ]
    assert twice[0] == pytest.approx(0.5 * torsional_eigenvalues()[0].imag, rel=1e-3)  # met by the kinematic error
    labels = hm.plot(diagram).get_legend_handles_labels()[1] + [text.get_text() for text in hm.plot(diagram).figure.legends[0].get_texts()]
    assert {"torsional", "forward"} <= set(labels)


def test_the_unbalance_of_one_shaft_is_not_said_to_excite_the_bending_of_another(diagram: hm.WhirlCampbell) -> None:
    # the arm tilts at about 440 rad/s; only torque joins the output shaft to the motor
    near = (np.abs(diagram.critical_speeds - 441.0) < 10.0) & (np.array(diagram.critical_orders) == 0)
    notes = [note for note, is_near in zip(diagram.critical_notes, near, strict=True) if is_near]
    assert len(notes) == 2
    assert all("other shaft" in note for note in notes)
    own = hm.campbell(joint.build(arm_angle=LEVEL), [0.0, 500.0], orders={"arm": (100.0,)})
    bending = [note for note, word in zip(own.critical_notes, own.critical_whirl, strict=True) if word == "forward"]
    assert any("other shaft" in note for note in bending)  # the input shaft, for the arm's order
    assert any("other shaft" not in note for note in bending)


# -- the run-up -----------------------------------------------------------------------------------------


def test_the_line_takes_up_its_lost_motion_and_crosses_it_as_the_arm_passes_the_top_and_the_bottom(run: hm.RunUp) -> None:
    half = 0.5 * joint.gear().lost_motion
    twist, angle = run.values["gear.twist"], run.values["arm.angle"]
    start = np.argmax(np.abs(twist) > half)
    assert 0.02 < run.times[start] < 0.2
    assert np.all(np.abs(twist[:start]) <= half)
    # the weight changes its sign at -pi and -2 pi; acceleration and drag shift that by asin(J a/(m g r)), 4 J w'/u and c w below 0.15 rad
    loaded = twist > half
    late = run.times > 1.2
    leaves = late & (twist < -half)
    first_left = angle[leaves][0]
    back = angle[late & loaded & (run.times > run.times[leaves][-1])][0]
    shift = math.asin((0.4 * 1.92 + 0.3 * 4.8) / WEIGHT)
    assert -math.pi - shift - 0.1 < first_left < -math.pi
    assert -2.0 * math.pi - 0.1 < back < -2.0 * math.pi + shift + 0.1


def test_the_kinematic_error_is_in_resonance_where_twice_the_speed_meets_the_torsional_mode(run: hm.RunUp) -> None:
    smooth = joint.build(ovality=0.0)
    without = hm.run_up(smooth, 1.2, places=("brake_disc",), solver=SOLVER)
    inside = run.times <= 1.2
    error = run.values["gear.torque"][inside] - without["gear.torque"].at(run.times[inside])
    largest = np.argmax(np.abs(error))
    # the mesh opens in the vibration, which softens it; passed at 190 rad/s^2 the peak comes late: 0.9 to 1.2 of the crossing
    assert run.values["wave_generator.speed"][largest] == pytest.approx(111.5, rel=0.2)
    early = run.times[inside] < 0.3
    assert np.max(np.abs(error)) > 10.0 * np.max(np.abs(error[early]))


def test_the_run_passes_its_lateral_critical_speeds(run: hm.RunUp) -> None:
    assert list(run.critical_speeds) == pytest.approx([359.4, 381.9], rel=1e-3)
    assert run.final_speed > 470.0
    assert not run.captured
    assert 381.9 < run.peak_speed["brake_disc"] < 1.15 * 381.9
    # far below the critical speeds the disc whirls by e n^2/(1 - n^2)
    slow = (run.times > 1.0) & (run.times < 1.05)
    ratio = run.values["motor.speed"][slow].mean() / 381.9
    x = run.values["brake_disc.y"][slow]
    assert 0.5 * np.ptp(x) == pytest.approx(5e-6 * ratio**2 / (1.0 - ratio**2), rel=0.15)


def test_the_energy_of_the_whole_line_balances(run: hm.RunUp) -> None:
    balance = hm.energy_balance(run)
    # the trapezoidal rule shifts a mode of frequency w by (w h)^2/12; the fastest with energy in it is the lateral one
    assert np.max(np.abs(balance.energy_residual)) < (382.0 * STEP) ** 2 / 12.0 * balance.energy_scale


def test_the_circular_spline_puts_its_torque_into_its_housing(run: hm.RunUp) -> None:
    reaction, torque = run.values["gear.housing_torque"], run.values["gear.torque"]
    # virtual work: (1 + 1/u + de/da) T against the output, e = A sin 2a with the generator's angle a against the ring
    turned = 2.0 * (run.values["gear.wave_generator.angle"] - run.values["gear.circular_spline.angle"])
    lever = 1.01 + 2.0 * _error_amplitude() * np.cos(turned)
    np.testing.assert_allclose(reaction, lever * torque, rtol=1e-9, atol=1e-9)
    angle, speed, rate = (run.values[f"gear_housing.{key}"] for key in ("angle", "speed", "acceleration"))
    np.testing.assert_allclose(2e6 * angle + 50.0 * speed + 0.05 * rate, reaction, atol=1e-3 * np.max(np.abs(reaction)))


def test_a_chain_of_eight_inertias_in_scipy_runs_up_alike(run: hm.RunUp) -> None:
    half, end = 0.5 * joint.gear().lost_motion, 1.0
    size = _error_amplitude()
    # motor, hub with ring a, disc, generator with ring b; flange with ring c, encoder disc with ring d, arm; gear housing
    inertia = np.array([3e-4, 3.8e-5, 3e-3, 1.18e-4, 6.08e-4, 2.08e-4, 0.4, 0.05])
    input_1, input_2 = polar_stiffness(0.012, 0.18), polar_stiffness(0.012, 0.21)
    output_1, output_2 = polar_stiffness(0.032, 0.07), polar_stiffness(0.032, 0.08)
    slip = 0.05 * (2.5 + math.sqrt(2.5**2 - 1.0)) * 200.0 * math.pi
    breakdown = 2.5 * 400.0 / (5700.0 * math.pi / 30.0)

    def mesh(q: FloatArray, w: FloatArray) -> tuple[float, float]:
        """Torque, and lever of the generator: the error follows its angle against the circular spline."""
        turned = 2.0 * (q[3] - q[7])
        lever = 0.01 + 2.0 * size * math.cos(turned)
        twist = 0.01 * q[3] - q[4] - 1.01 * q[7] + size * math.sin(turned)
        rate = lever * w[3] - w[4] - (1.0 + lever) * w[7]
        stretch = math.copysign(max(abs(twist) - half, 0.0), twist)
        corner = 14.0 / 3.1e4
        elastic = 3.1e4 * stretch if abs(stretch) < corner else math.copysign(14.0 + 5e4 * (abs(stretch) - corner), stretch)
        return elastic + 12.0 * rate, lever

    def right(t: float, state: FloatArray) -> FloatArray:
        q, w = state[:8], state[8:]  # forward, the housing in true sense
        slipping = 480.0 * min(t / 2.5, 1.0) - w[0]
        motor = 2.0 * breakdown * slip * slipping / (slipping**2 + slip**2) - 2e-4 * w[0]
        torque, lever = mesh(q, w)
        loads = [120.0 * (q[0] - q[1]) + 0.012 * (w[0] - w[1])]
        for k, stiffness in ((1, input_1), (2, input_2), (4, output_1), (5, output_2)):
            loads.append(stiffness * (q[k] - q[k + 1] + 1e-5 * (w[k] - w[k + 1])))
        coupling, first, second, third, fourth = loads
        arm = -WEIGHT * math.sin(q[6]) - 0.3 * w[6]
        foot = -2e6 * q[7] - 50.0 * w[7]
        before = [motor - coupling, coupling - first, first - second, second - lever * torque]
        after = [torque - third, third - fourth, fourth + arm, (1.0 + lever) * torque + foot]
        return np.concatenate([w, np.array(before + after) / inertia])

    times = np.linspace(0.01, end, 400)
    done = solve_ivp(right, (0.0, end), np.zeros(16), method="LSODA", rtol=1e-7, atol=1e-10, t_eval=times)
    assert done.success
    wanted = np.array([mesh(state[:8], state[8:])[0] for state in done.y.T])
    # rings are lumped (1e-4 of the first mode), gravity turns the unbalance of the disc (1e-4 N m, 0.01 N m at the output)
    np.testing.assert_allclose(run["gear.torque"].at(times), wanted, atol=0.005 * float(np.max(np.abs(wanted))))
    np.testing.assert_allclose(run["motor.speed"].at(times), done.y[8], atol=1e-3 * done.y[8, -1])


def _error_amplitude() -> float:
    errors = [hm.WheelError(wheel="circular_spline", harmonic=2, amplitude=joint.OVALITY)]
    (effect,) = hm.tooth_errors(joint.gear(), errors)
    return effect.amplitude


def test_another_rule_of_integration_gives_the_same_run(run: hm.RunUp) -> None:
    other = hm.run_up(joint.build(), PASSED, places=("brake_disc",), solver=hm.GeneralizedAlpha(step=STEP, newton_tolerance=1e-6))
    # both are of second order, with errors of (w h)^2/12 to (w h)^2/2 = 1e-3 of the phase and so of the peak
    assert other.peak_amplitude["brake_disc"] == pytest.approx(run.peak_amplitude["brake_disc"], rel=1e-3)
    assert other.peak_speed["brake_disc"] == pytest.approx(run.peak_speed["brake_disc"], rel=1e-3)
    assert np.max(other.values["gear.torque"]) == pytest.approx(np.max(run.values["gear.torque"]), rel=5e-3)


@pytest.mark.parametrize(("bearing", "criticals", "peak"), [("improved", 1e-4, 0.003), ("simplified", 0.01, 0.03)])
def test_the_line_runs_up_with_every_model_of_its_bearings(run: hm.RunUp, bearing: str, criticals: float, peak: float) -> None:
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        scene = joint.build(bearing)
    assert bool(said) == (bearing == "simplified")  # it says where its modes part: the tilting of the arm, by 6 %
    assert len(scene.network().bodies) < len(joint.build().network().bodies)
    other = hm.run_up(scene, PASSED, places=("brake_disc",), solver=SOLVER)
    np.testing.assert_allclose(other.critical_speeds, run.critical_speeds, rtol=criticals)
    assert other.peak_amplitude["brake_disc"] == pytest.approx(run.peak_amplitude["brake_disc"], rel=peak)
    # torsion knows nothing of the bearings but the rings' inertia
    assert np.max(other.values["gear.torque"]) == pytest.approx(np.max(run.values["gear.torque"]), rel=1e-3)


def eccentric_arm() -> hm.Rotor:
    """The arm as a body: 5 kg at 0.24 m in place of 4 kg at 0.3 m and 1 kg on the axis, with the same m r and inertia about the axis."""
    radius = joint.ARM_MASS * joint.ARM_RADIUS / 5.0
    about_axis = 0.04 + joint.ARM_MASS * joint.ARM_RADIUS**2
    about_centre = about_axis - 5.0 * radius**2
    return hm.Rotor(
        mass=5.0, polar_inertia=about_centre, transverse_inertia=0.21 - 2.5 * radius**2, eccentricity=radius, angle=-0.5 * math.pi
    )


def test_in_stiff_supports_an_eccentric_body_loads_the_gear_as_the_weight_of_the_arm_does() -> None:
    # in elastic ones its mass couples torsion with bending, by (w/w_b)^2 = (223/441)^2 of m r^2: EccentricLoad leaves that out
    stiff: dict[str, object] = {f"section_{k}.youngs_modulus": 1e4 * joint.YOUNGS_MODULUS for k in (5, 6, 7, 8)}
    stiff |= {f"section_{k}.damping": 0.0 for k in (5, 6, 7, 8)}
    stiff |= {f"bearing_{k}.law": hm.LinearBearing.isotropic(radial=1e12, damping=1e5, axial=1e9, tilt=1e7) for k in "cd"}
    stiff |= {f"bearing_{k}.housing": None for k in "cd"}
    scene = joint.build().replacing(stiff)
    weight = hm.simulate(scene, 0.4, solver=SOLVER)
    body = hm.simulate(scene.without("weight_of_arm").replacing(arm=eccentric_arm()), 0.4, solver=SOLVER)
    wanted = weight.values["gear.torque"]
    np.testing.assert_allclose(body.values["gear.torque"], wanted, atol=2e-3 * np.max(np.abs(wanted)))


def test_a_campbell_diagram_keeps_the_inertia_of_an_eccentric_body_about_its_axis() -> None:
    scene = joint.build(arm_angle=LEVEL)
    found = [hm.campbell(item, [0.0, 300.0], count=3) for item in (scene, scene.replacing(arm=eccentric_arm()))]
    weight, body = ([f for f, word in zip(item.frequencies[1], item.whirl, strict=True) if word == "torsional"] for item in found)
    assert body == pytest.approx(weight, rel=1e-9)


def test_an_unknown_bearing_model_is_refused() -> None:
    with pytest.raises(hm.ParameterError, match="full, simplified, improved"):
        joint.build("stiff")


def test_the_joint_can_be_kept_in_a_file(tmp_path: object) -> None:
    scene = joint.build()
    assert hm.load_scene(hm.save_scene(scene, tmp_path / "joint.toml")) == scene  # type: ignore[operator]


def test_five_bodies_turn_as_the_whole_line_does(run: hm.RunUp) -> None:
    # springs in line are exact at rest; what is left is bending, and vibration of the bodies that were put together
    scene = joint.torsional_line()
    solver = hm.DormandPrince(relative_tolerance=1e-8, absolute_tolerance=1e-10)
    response = hm.simulate(scene, 3.0, solver=solver, sample_step=1e-3, progress=False)
    times = 1e-3 * np.arange(2900)
    noise = {item.channel: item.noise for item in joint.MEASURED.values()}
    # the motor's angle drifts apart with its speed: a share that is far below the tolerance of any parameter
    limits = {**noise, "motor_encoder": 4e-6 * np.ptp(run.values["motor.angle"])}
    for reading, channel in (("motor_encoder", "motor.angle"), ("output_encoder", "encoder_disc.angle"), ("motor.torque", "motor.torque")):
        difference = response.at(reading, times) - np.interp(times, run.times, run.values[channel])
        assert np.sqrt(np.mean(difference**2)) < limits[reading]
