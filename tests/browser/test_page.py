"""The page of a report, opened in a browser from a file, without a network."""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.browser

PHONE = 360
_MESHES = """Array.from(document.querySelectorAll(".motion .body")[0].data)
    .filter((trace) => trace.type === "mesh3d").map((trace) => Array.from(trace.z))"""


def meshes(page: Page) -> list[list[float]]:
    """Return the heights (mm) of all corners of the body as currently drawn."""
    heights: list[list[float]] = page.evaluate(_MESHES)
    return heights


def wait_for_body(page: Page) -> None:
    page.locator(".motion canvas").first.wait_for(state="attached")
    expect(page.locator(".motion .trace .main-svg").first).to_be_attached()


def set_slider(page: Page, name: str, value: float) -> None:
    page.locator(f".motion .{name}").evaluate(
        "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }", value
    )


def displacements(page: Page) -> list[float]:
    set_slider(page, "time", 0)
    rest = meshes(page)
    set_slider(page, "time", 1e9)  # to the end
    return [
        now - then
        for part, at_rest in zip(meshes(page), rest, strict=True)
        for now, then in zip(part, at_rest, strict=True)
    ]


@pytest.mark.parametrize("name", ["run_page", "study_page"])
def test_draws_everything_without_errors_and_requests_no_other_file(
    name: str, opened: Callable[..., Any], request: pytest.FixtureRequest
) -> None:
    path: Path = request.getfixturevalue(name)
    shown = opened(path)
    shown.scroll_through()
    wait_for_body(shown.page)
    assert shown.page.locator(".chart").count() == (1 if name == "run_page" else 12)
    assert shown.errors == []
    assert [url for url in shown.requests if not url.startswith(("data:", "blob:"))] == [path.as_uri()]


def test_play_moves_the_body_and_pause_stops_it(run_page: Path, opened: Callable[..., Any]) -> None:
    page = opened(run_page).page
    wait_for_body(page)
    at_rest = meshes(page)
    play = page.get_by_role("button", name="play")
    play.click()
    page.wait_for_function(f"(rest) => JSON.stringify({_MESHES}) !== JSON.stringify(rest)", arg=at_rest)
    pause = page.get_by_role("button", name="pause")
    pause.click()
    stopped = meshes(page)
    assert stopped != at_rest
    page.wait_for_timeout(300)
    assert meshes(page) == stopped


def test_play_starts_at_the_current_time(run_page: Path, opened: Callable[..., Any]) -> None:
    """The time of the first animation frame may precede the click."""
    page = opened(run_page).page
    wait_for_body(page)
    page.evaluate(
        """() => {
            const seconds = document.querySelector(".motion .seconds");
            window.times = [];
            const note = () => window.times.push(seconds.textContent);
            new MutationObserver(note).observe(seconds, { childList: true });
        }"""
    )
    for number in range(1, 4):
        set_slider(page, "time", 0)
        page.get_by_role("button", name="play").click()
        page.wait_for_function("(count) => window.times.length >= count", arg=4 * number)  # frames, not time
        page.get_by_role("button", name="pause").click()
    times = page.evaluate("window.times")
    assert len(times) > 6
    assert all(re.fullmatch(r"0\.\d{4} s", text) for text in times)


def test_sliders_announce_time_and_exaggeration_and_nothing_else_is_announced(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    page = opened(run_page).page
    wait_for_body(page)
    set_slider(page, "time", 1e9)
    set_slider(page, "exaggeration", 10)
    expect(page.get_by_role("slider", name="time", exact=True)).to_have_attribute(
        "aria-valuetext", "0.0705 s"
    )
    exaggeration = page.get_by_role("slider", name="exaggeration", exact=True)
    expect(exaggeration).to_have_attribute("aria-valuetext", "\u00d7 10")
    assert page.locator("output, [aria-live], [role=status]").count() == 0


def test_foreign_scripts_do_not_run(run_page: Path, opened: Callable[..., Any]) -> None:
    shown = opened(run_page)
    shown.page.evaluate(
        """() => {
            const script = document.createElement("script");
            script.textContent = "window.foreign = true";
            document.body.append(script);
        }"""
    )
    assert shown.page.evaluate("window.foreign") is None
    assert any("Content Security Policy" in error for error in shown.errors)


def test_the_time_slider_moves_the_body_to_the_end_and_back(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    page = opened(run_page).page
    wait_for_body(page)
    at_rest = meshes(page)
    set_slider(page, "time", 1e9)
    expect(page.locator(".motion .seconds")).to_have_text("0.0705 s")  # 22 steps
    assert meshes(page) != at_rest
    set_slider(page, "time", 0)
    expect(page.locator(".motion .seconds")).to_have_text("0.0000 s")
    assert meshes(page) == at_rest


def test_displacements_are_exaggerated_by_the_displayed_factor(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    page = opened(run_page).page
    wait_for_body(page)
    set_slider(page, "exaggeration", 1)
    expect(page.locator(".motion .factor")).to_have_text("\u00d7 1")
    once = displacements(page)
    set_slider(page, "exaggeration", 10)
    expect(page.locator(".motion .factor")).to_have_text("\u00d7 10")
    tenfold = displacements(page)
    assert max(map(abs, once)) > 0.1  # mm
    assert tenfold == pytest.approx([10 * each for each in once], abs=1e-3)


def test_the_tip_leaves_a_trace(run_page: Path, opened: Callable[..., Any]) -> None:
    page = opened(run_page).page
    wait_for_body(page)
    set_slider(page, "time", 1e9)
    last = "Array.from(document.querySelector('.motion .body').data).at(-1)"
    assert page.evaluate(f"{last}.name") == "trace of the tip"
    assert page.evaluate(f"{last}.z.length") >= 23


@pytest.mark.parametrize("name", ["run_page", "study_page"])
@pytest.mark.parametrize("colors", ["light", "dark"])
def test_fits_a_phone(
    name: str, colors: str, opened: Callable[..., Any], request: pytest.FixtureRequest
) -> None:
    shown = opened(request.getfixturevalue(name), width=PHONE, colors=colors)
    shown.scroll_through()
    assert shown.page.evaluate("document.documentElement.scrollWidth") <= PHONE
    assert shown.errors == []


def test_colors_follow_the_system_until_the_reader_chooses(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    shown = opened(run_page, colors="dark")
    shown.scroll_through()
    dark = colors_of(shown.page)
    shown.page.get_by_role("button", name="light or dark colors").click()
    light = colors_of(shown.page)
    assert (brightness(dark[0]), brightness(dark[1])) == pytest.approx((0.1, 0.9), abs=0.1)
    assert (brightness(light[0]), brightness(light[1])) == pytest.approx((0.97, 0.1), abs=0.1)
    assert dark[2] != light[2]


def colors_of(page: Page) -> tuple[str, str, str]:
    """Return the colors of the background, of the text of a chart, and of its first line."""
    colors: list[str] = page.evaluate(
        """[getComputedStyle(document.body).backgroundColor,
            getComputedStyle(document.querySelector(".chart .xtitle")).fill,
            getComputedStyle(document.querySelector(".chart .js-line")).stroke]"""
    )
    return colors[0], colors[1], colors[2]


def brightness(color: str) -> float:
    parts = [int(part) for part in color.strip("rgb()").split(",")]
    return sum(parts) / 3 / 255


def test_a_phone_has_no_toolbar_and_a_swipe_over_a_chart_scrolls(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    shown = opened(run_page, width=PHONE)
    shown.scroll_through()
    assert shown.page.locator(".modebar-group").count() == 0
    for name in ("div.chart", "div.trace"):
        assert shown.page.locator(name).evaluate("(chart) => chart.layout.dragmode") is False


def test_the_toolbar_does_not_cover_data(run_page: Path, opened: Callable[..., Any]) -> None:
    shown = opened(run_page)
    shown.scroll_through()
    for name in ("div.chart", "div.trace"):
        expect(shown.page.locator(f"{name} .modebar-group").first).to_be_attached()
    boxes = shown.page.evaluate(
        """Array.from(document.querySelectorAll("div.chart, div.trace")).map((chart) => [
            chart.querySelector(".modebar-group").getBoundingClientRect().bottom,
            chart.querySelector(".nsewdrag").getBoundingClientRect().top,
        ])"""
    )
    assert len(boxes) == 2
    assert all(toolbar <= data for toolbar, data in boxes)


def test_legends_are_lists_that_hide_and_show_lines(run_page: Path, opened: Callable[..., Any]) -> None:
    shown = opened(run_page, width=PHONE)
    shown.scroll_through()
    page = shown.page
    assert page.locator("svg .legend").count() == 0  # those of plotly, which scroll
    buttons = page.locator(".chart ~ .legend button")
    labels = buttons.all_inner_texts()
    assert labels[0] == "morphology: best fitness"
    lines = page.locator(".chart .js-line")
    assert lines.count() == len(labels) == 5
    buttons.first.click()
    expect(lines).to_have_count(4)
    expect(buttons.first).to_have_attribute("aria-pressed", "false")
    expect(buttons.first).to_be_focused()
    buttons.first.press("Enter")
    expect(lines).to_have_count(5)
    motion = page.locator(".motion .of-body li")
    assert motion.last.inner_text() == "trace of the tip"
    for legend in page.locator("ul.legend").all():
        assert legend.evaluate("(list) => list.scrollHeight <= list.clientHeight")


def test_a_table_wider_than_the_screen_has_a_cue(run_page: Path, opened: Callable[..., Any]) -> None:
    cut = """Array.from(document.querySelectorAll(".scroll"))
        .map((table) => [table.scrollWidth > table.clientWidth, !table.nextElementSibling.hidden])"""
    for width in (PHONE, 1100):
        page = opened(run_page, width=width).page
        page.wait_for_function(f"{cut}.every(([isCut, hasCue]) => isCut === hasCue)")
        assert any(is_cut for is_cut, _ in page.evaluate(cut)) == (width == PHONE)


def test_settings_stand_at_the_top(run_page: Path, study_page: Path, opened: Callable[..., Any]) -> None:
    facts = """Object.fromEntries(Array.from(document.querySelectorAll(".facts div"))
        .map(({ children: [label, value] }) => [label.textContent, value.textContent]))"""
    run = {"objective": "tip-dz (mm)", "aggregator": "wm", "collaboration": "fittest", "n": "2", "seed": "1"}
    assert opened(run_page).page.evaluate(facts) == run
    assert opened(study_page).page.evaluate(facts) == {**run, "aggregator": "am, hm", "n": "2, 3"}


def test_the_sampled_instants_are_marked_and_give_the_score(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    page = opened(run_page).page
    wait_for_body(page)
    labels = page.locator(".trace .annotation-text").all_text_contents()
    assert [*map(str.split, labels)] == [
        ["sample", "00.0032", "s"],
        ["sample", "50.0673", "s"],
    ]  # two lines each
    marks = page.evaluate(
        """Array.from(document.querySelector(".trace").data)
            .filter((trace) => trace.mode === "markers" && trace.name === "z")
            .map((trace) => [trace.x, trace.y])"""
    )
    [(times, heights)] = marks
    assert times == pytest.approx([0.0032, 0.0673], abs=1e-4)
    [score] = re.findall(r"([\d.]+) mm", page.locator(".lead").inner_text())
    assert heights[1] - heights[0] == pytest.approx(float(score), abs=1e-3)
    assert f"z +{float(score):.3f} mm" in page.locator(".compared").inner_text()


@pytest.mark.parametrize("name", ["run_page", "study_page"])
def test_prints_all_charts_and_the_body_in_light_colors(
    name: str, opened: Callable[..., Any], request: pytest.FixtureRequest
) -> None:
    shown = opened(request.getfixturevalue(name), colors="dark")
    page = shown.page
    page.evaluate(
        """addEventListener("beforeprint", () => {
            const still = document.querySelector(".still"), context = still.getContext("2d");
            window.printed = {
                blank: Array.from(document.querySelectorAll("div.chart, div.trace"))
                    .filter((one) => !one.querySelector(".js-line, .box, .point")).length,
                text: getComputedStyle(document.querySelector(".trace .xtitle")).fill,
                shades: new Set(context.getImageData(0, 0, still.width, still.height).data).size,
            };
        })"""
    )
    images = images_in(page.pdf(format="A4"))
    printed = page.evaluate("window.printed")
    assert printed["blank"] == 0
    assert printed["shades"] > 50
    assert brightness(printed["text"]) < 0.3
    assert max(map(len, map(set, images))) > 50
    assert brightness(page.evaluate("getComputedStyle(document.querySelector('.trace .xtitle')).fill")) > 0.7
    expect(page.locator(".still")).to_be_hidden()
    assert shown.errors == []


def images_in(pdf: bytes) -> list[bytes]:
    """Return the pixels of the images in a PDF."""
    streams = re.findall(rb"<<((?:(?!endobj).)*?)>>\s*stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL)
    return [
        zlib.decompress(data) if b"/FlateDecode" in head else data
        for head, data in streams
        if b"/Image" in head
    ]
