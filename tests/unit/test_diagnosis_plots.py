"""Pictures of a diagnosis: every kind of answer is drawn, with its numbers where they belong, and nothing is cut off."""

from __future__ import annotations

import base64
import dataclasses
import functools
import io
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.image import imread
from matplotlib.patches import Rectangle

from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.errors import AnalysisError, PlaceError
from hdrive_mbs.plots import plot
from hdrive_mbs.plots.diagnosis_domain import plot_domain, plot_orders
from hdrive_mbs.plots.diagnosis_force import plot_force
from hdrive_mbs.plots.diagnosis_gap import plot_gap
from hdrive_mbs.plots.diagnosis_look import binned, varies
from hdrive_mbs.plots.diagnosis_loop import plot_loop
from hdrive_mbs.plots.diagnosis_ranking import plot_places, plot_ranking
from hdrive_mbs.plots.diagnosis_traces import plot_residual, plot_traces
from hdrive_mbs.plots.report_html import report_html, write_report_html
from tests.unit.diagnosis_samples import NAN, SAMPLES, gaps
from tests.unit.picture_checks import assert_nothing_is_cut_off, figure_of, written

NEEDS: dict[str, tuple[Callable[..., Axes], str]] = {
    "gap": (plot_gap, "gaps"),
    "ranking": (plot_ranking, "ranking"),
    "places": (plot_places, "where"),
    "traces": (plot_traces, "traces"),
    "residual": (plot_residual, "traces"),
    "force": (plot_force, "forces"),
    "loop": (plot_loop, "loops"),
    "domain": (plot_domain, "domain"),
    "orders": (plot_orders, "order_maps"),
}


@pytest.mark.parametrize("sample", SAMPLES)
def test_every_answer_has_a_summary_that_says_the_verdict(sample: str) -> None:
    axes = plot(SAMPLES[sample]())
    assert_nothing_is_cut_off(axes)
    said = " ".join(written(axes)).replace("\n", " ")
    verdicts = ("No gap beyond", "An effect is missing", "A parameter is off", "A sensor is off", "A gap that nothing", "Two causes")
    assert any(text in said for text in verdicts)


@pytest.mark.parametrize("name", NEEDS)
def test_every_picture_is_drawn_whole(name: str) -> None:
    function, _ = NEEDS[name]
    assert_nothing_is_cut_off(function(SAMPLES["effect"]()))


@pytest.mark.parametrize(("name", "sample"), [("ranking", "tied"), ("ranking", "without_numbers"), ("gap", "without_numbers")])
def test_pictures_stay_whole_with_ties_and_without_numbers(name: str, sample: str) -> None:
    function, _ = NEEDS[name]
    assert_nothing_is_cut_off(function(SAMPLES[sample]()))


@pytest.mark.parametrize("name", NEEDS)
def test_a_picture_of_what_is_not_there_is_refused_with_a_reason(name: str) -> None:
    function, field = NEEDS[name]
    with pytest.raises(AnalysisError, match=r"This diagnosis has no .* to draw\."):
        function(dataclasses.replace(SAMPLES["effect"](), **{field: ()}))


def bars(axes: Axes) -> list[Rectangle]:
    return [patch for patch in axes.patches if isinstance(patch, Rectangle)]


def test_gap_bars_are_as_long_as_the_misfits() -> None:
    axes = plot_gap(SAMPLES["effect"](), together=True)
    assert sorted(bar.get_width() for bar in bars(axes)) == [1.02, 5.1, 34.2]
    assert axes.get_xscale() == "log"


def test_gap_without_a_claim_shows_two_models_only() -> None:
    assert sorted(bar.get_width() for bar in bars(plot_gap(SAMPLES["none"](), together=True))) == [1.01, 3.1]


def test_gap_of_many_columns_shows_all_together_and_the_worst() -> None:
    few = gaps(34.2, 5.1, 1.02)
    many = (
        few[0],
        *(dataclasses.replace(few[1], record=f"r{k}", nominal=few[1].nominal.__class__(value=k, low=k, high=k)) for k in range(40)),
    )
    axes = plot_gap(dataclasses.replace(SAMPLES["effect"](), gaps=many))
    labels = [tick.get_text() for tick in axes.get_yticklabels()]
    assert labels[0] == "all together"
    assert labels[1:] == [f"r{k}, motor angle" for k in range(25, 40)]
    assert_nothing_is_cut_off(axes)


def test_ranking_bars_are_the_probabilities_and_no_number_is_no_bar() -> None:
    answer = SAMPLES["effect"]()
    assert [bar.get_width() for bar in bars(plot_ranking(answer))] == [item.probability for item in answer.ranking]
    lost = SAMPLES["without_numbers"]()
    assert bars(plot_ranking(lost))[0].get_width() == 0.0


def test_residual_panel_shows_measured_minus_simulated_in_noise() -> None:
    answer = SAMPLES["effect"]()
    axes = plot_traces(answer, record="staircase", column="load_angle", residuals=True, ax=figure_of(plot_gap(answer)).add_subplot())
    trace = next(item for item in answer.traces if (item.record, item.column) == ("staircase", "load_angle"))
    drawn = {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in axes.get_lines()}
    assert np.allclose(drawn["with the cause"], (trace.measured - trace.effect) / trace.noise, rtol=1e-12, atol=1e-12)
    assert np.std(drawn["with the cause"]) < np.std(drawn["parameters refitted"])


def test_a_model_that_follows_the_measured_line_does_not_hide_it() -> None:
    lines = {str(line.get_label()): line for line in plot_traces(SAMPLES["effect"]()).get_lines()}
    models = [line for label, line in lines.items() if label in ("nominal", "parameters refitted", "with the cause")]
    assert len(models) == 3
    for line in models:
        assert lines["measured"].get_linewidth() > 2.0 * line.get_linewidth()
        assert list(lines.values()).index(lines["measured"]) < list(lines.values()).index(line)  # drawn before, so below


def test_residuals_are_labelled_in_plain_words() -> None:
    answer = SAMPLES["effect"]()
    lower = figure_of(plot_traces(answer)).axes[1]
    assert lower.get_ylabel().replace("\n", " ") == "measured minus simulated [standard deviations of the noise]"
    summary = figure_of(plot(answer)).axes[-1]
    assert summary.get_xlabel() == "time [s] (load angle, record 'load_cycle')"


def test_held_out_stretches_are_shaded_where_they_are() -> None:
    answer = SAMPLES["effect"]()
    axes = plot_traces(answer)
    trace = answer.traces[0]
    shaded = np.zeros(len(trace.times), dtype=bool)
    for patch in bars(axes):
        low, high = patch.get_x(), patch.get_x() + patch.get_width()
        shaded |= (trace.times >= low - 1e-9) & (trace.times <= high + 1e-9)
    assert np.array_equal(shaded, trace.held_out)


def test_residuals_far_apart_get_a_scale_on_which_both_are_seen() -> None:
    answer = SAMPLES["effect"]()
    far = dataclasses.replace(answer.traces[0], nominal=answer.traces[0].nominal + 1e4 * answer.traces[0].noise)
    axes = plot_traces(dataclasses.replace(answer, traces=(far,)))
    assert figure_of(axes).axes[1].get_yscale() == "symlog"
    assert_nothing_is_cut_off(axes)


def test_a_record_that_is_not_there_is_named() -> None:
    with pytest.raises(PlaceError, match=r"No record 'stairs'.*staircase, load_cycle"):
        plot_traces(SAMPLES["effect"](), record="stairs")
    with pytest.raises(PlaceError, match=r"No place 'gear'.*load"):
        plot_force(SAMPLES["effect"](), at="gear")


def test_models_that_could_not_be_simulated_leave_no_line() -> None:
    answer = SAMPLES["effect"]()
    trace = answer.traces[0]
    lost = dataclasses.replace(trace, nominal=np.full_like(trace.nominal, NAN), refit=np.full_like(trace.refit, NAN))
    axes = plot_traces(dataclasses.replace(answer, traces=(lost,)))
    assert_nothing_is_cut_off(axes)
    drawn = {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in axes.get_lines()}
    assert not np.isfinite(drawn["nominal"]).any()
    assert np.isfinite(drawn["with the cause"]).all()


def test_bins_hold_mean_and_spread() -> None:
    x = np.repeat([0.0, 1.0], 10)
    y = np.where(x > 0.5, 3.0, 1.0) + np.tile([-0.5, 0.5], 10)
    middle, mean, low, high = binned(x, y, bins=2)
    assert middle.tolist() == [0.25, 0.75]
    assert mean.tolist() == [1.0, 3.0]
    assert (high - low).tolist() == pytest.approx([1.0, 1.0])  # plus and minus a standard deviation of 0.5
    assert not varies(np.full(5, NAN), 5)
    assert not varies(np.ones(5), 5)


def test_loop_is_shown_without_its_straight_line() -> None:
    axes = plot_loop(SAMPLES["effect"]())
    curves = {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in axes.get_lines()}
    # torque 4 cos beside the spring: half width 4 N m; the refitted model has 0.3 N m
    assert np.max(np.abs(curves["with the cause"])) == pytest.approx(4.0, rel=0.05)
    assert np.max(np.abs(curves["parameters refitted"])) == pytest.approx(0.3, abs=0.05)
    assert "times twist" in axes.get_ylabel()


class Page(HTMLParser):
    """Open elements, pictures and whatever would be fetched."""

    VOID = ("meta", "img", "br")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.pictures: list[dict[str, str | None]] = []
        self.fetched: list[str] = []
        self.headings: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        for name in ("src", "href", "data", "action"):
            if name in given and not str(given[name]).startswith("data:"):
                self.fetched.append(str(given[name]))
        if tag in ("script", "link", "iframe", "object"):
            self.fetched.append(tag)
        if tag == "img":
            self.pictures.append(given)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("h1", "h2", "h3"):
            self.headings.append(data)


def page_of(answer: Diagnosis) -> Page:
    page = Page()
    page.feed(report_html(answer))
    page.close()
    assert page.open == []
    return page


@functools.cache
def pages(sample: str) -> Page:
    """The page of an answer with two of its traces: each takes a while to draw."""
    answer = SAMPLES[sample]()
    return page_of(dataclasses.replace(answer, traces=answer.traces[:2]))


@pytest.mark.slow
@pytest.mark.parametrize("sample", ["effect", "none", "without_numbers", "without_pictures"])
def test_page_needs_nothing_from_outside_and_names_every_picture(sample: str) -> None:
    page = pages(sample)
    assert page.fetched == []
    assert page.pictures
    for picture in page.pictures:
        assert len(picture["alt"] or "") > 20
        assert int(picture["width"] or 0) <= 600  # fits a phone at two thirds of its size
    assert page.headings[0].startswith("Diagnosis of 'drive bench'")


@pytest.mark.slow
def test_words_of_a_picture_name_the_models_that_are_drawn_and_no_others() -> None:
    """Of a claim all three; where none is claimed, nothing is drawn with a cause, nor after."""
    told = {sample: [str(picture["alt"]) for picture in pages(sample).pictures] for sample in ("effect", "none")}
    claimed = [text for text in told["effect"] if text.startswith(("Bars on a log", "Column", "Measured minus", "Loop", "Map"))]
    assert len(claimed) == 1 + 2 + 1 + 1 + 1
    assert all("with the cause" in text for text in claimed)
    assert not any("with the cause" in text or "after" in text for text in told["none"])
    [loop] = [text for text in told["effect"] if text.startswith("Loop")]
    assert loop.endswith("over twist of gear. Shown: estimated, parameters refitted, with the cause.")
    [orders] = [text for text in told["effect"] if text.startswith("Map")]
    assert "before (parameters refitted): speed of motor over order" in orders
    assert "after (with the cause): speed of motor over order" in orders


def test_page_of_an_effect_has_every_picture() -> None:
    # gap, two traces, one residual, places, force, loop, domain, order map, ranking
    assert len(pages("effect").pictures) == 1 + 2 + 7


def test_pictures_of_the_page_can_be_decoded() -> None:
    for picture in pages("effect").pictures:
        head, data = str(picture["src"]).split(",", 1)
        content = base64.b64decode(data)
        if head == "data:image/png;base64":
            assert imread(io.BytesIO(content)).shape[2] == 4
        else:
            assert head == "data:image/svg+xml;base64"
            assert b"<svg" in content[:1000]
            assert not re.search(rb'(href|src)="https?:', content)


def test_names_from_files_cannot_become_markup() -> None:
    answer = SAMPLES["effect"]()
    bad = "<script>alert(1)</script>"
    answer = dataclasses.replace(
        answer, records=(bad,), notes=(bad,), traces=(), forces=(), loops=(), order_maps=(), domain=(), verdict='x"><script>'
    )
    text = report_html(answer)
    assert "<script" not in text
    assert "&lt;script&gt;" in text


def test_page_is_written_whole(tmp_path: Path) -> None:
    path = write_report_html(SAMPLES["without_pictures"](), tmp_path / "r" / "d.html")
    assert path.read_text("utf-8").rstrip().endswith("</html>")
    assert [item.name for item in path.parent.iterdir()] == ["d.html"]
