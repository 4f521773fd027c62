"""Pictures of teeth: drawn without a display, with what they must show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.plots import animate, plot, save_figure
from models.double_harmonic_transmission import gear


@pytest.mark.parametrize("index", [0, 1])
def test_the_positions_show_P_and_R_of_every_step(index: int, tmp_path: Path) -> None:
    motion = hm.tooth_motion(gear("A").stages()[index], np.radians(np.arange(0.0, 181.0, 10.0)))
    axes = plot(motion)
    drawn = {line.get_label(): line.get_xydata() for line in axes.get_lines()}
    np.testing.assert_allclose(drawn["P, tip"], 1e3 * motion.P)
    np.testing.assert_allclose(drawn["R, root"], 1e3 * motion.R)
    assert all(path.stat().st_size > 10_000 for path in save_figure(axes, tmp_path / "positions"))


def test_the_section_shows_all_wheels() -> None:
    labels = plot(gear("A")).get_legend_handles_labels()[1]
    assert labels == ["circular spline", "flexspline", "output wheel", "wave generator, beside the teeth", "neutral fibre"]
    ordinary = hm.HarmonicGear.standard(
        flexspline_teeth=200, circular_spline_teeth=202, module=hm.mm(0.3), profile_angle=0.52, addendum=hm.mm(0.24), clearance=hm.mm(0.06),
        backlash=hm.mm(0.01), fibre_radius=hm.mm(29.3), deformation=hm.CosineDeformation(amplitude=hm.mm(0.3)),
    )  # fmt: skip
    assert plot(ordinary).get_legend_handles_labels()[1] == ["circular spline", "flexspline", "wave generator", "neutral fibre"]


def test_the_clearance_curve_and_map_show_the_zero(tmp_path: Path) -> None:
    stage = gear("A").stages()[1]
    curve = plot(hm.clearances(stage))
    marked = next(line for line in curve.get_lines() if str(line.get_label()).startswith("smallest"))
    assert marked.get_ydata()[0] == pytest.approx(1e6 * hm.clearances(stage).minimum)  # type: ignore[index]
    result = hm.clearance_map(stage, amplitudes=np.linspace(0.25e-3, 0.38e-3, 14))
    assert np.isnan(result.gap[-1]).all()  # 0.38 mm: the tip would be in the root
    assert np.nanmin(result.gap) < 0.0 < np.nanmax(result.gap)
    row = np.argmin(np.abs(result.amplitudes - 0.30e-3))
    assert np.nanmin(result.gap[row]) > 0.0
    save_figure(plot(result), tmp_path / "map")


def test_the_animation_is_a_gif_of_so_many_frames(tmp_path: Path) -> None:
    from PIL import Image

    with Image.open(animate(gear("A"), tmp_path / "meshing.gif", frames=6, dpi=50)) as picture:
        assert picture.n_frames == 6  # type: ignore[attr-defined]
        assert picture.info["loop"] == 0
