"""The page of a report, in a browser, from a file, without a network."""

from __future__ import annotations

import re
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
    """Heights of all corners of the body, as they are drawn now."""
    found: list[list[float]] = page.evaluate(_MESHES)
    return found


def moved(page: Page) -> None:
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
def test_draws_everything_without_a_complaint_and_asks_for_no_other_file(
    name: str, opened: Callable[..., Any], request: pytest.FixtureRequest
) -> None:
    path: Path = request.getfixturevalue(name)
    shown = opened(path)
    shown.scroll_through()
    moved(shown.page)
    assert shown.page.locator(".chart").count() == (1 if name == "run_page" else 12)
    assert shown.complaints == []
    assert [url for url in shown.requests if not url.startswith(("data:", "blob:"))] == [path.as_uri()]


def test_play_moves_the_body_and_pause_stops_it(run_page: Path, opened: Callable[..., Any]) -> None:
    page = opened(run_page).page
    moved(page)
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


def test_play_begins_where_time_stands(run_page: Path, opened: Callable[..., Any]) -> None:
    """The moment of the first picture may be before the click."""
    page = opened(run_page).page
    moved(page)
    page.evaluate(
        """() => {
            const told = document.querySelector(".motion .told");
            window.said = [];
            const note = () => window.said.push(told.textContent);
            new MutationObserver(note).observe(told, { childList: true });
        }"""
    )
    for _ in range(3):
        set_slider(page, "time", 0)
        page.get_by_role("button", name="play").click()
        page.wait_for_timeout(200)
        page.get_by_role("button", name="pause").click()
    said = page.evaluate("window.said")
    assert len(said) > 6
    assert all(re.fullmatch(r"0\.\d{4} s", text) for text in said)


def test_sliders_say_time_and_exaggeration_and_nothing_speaks_by_itself(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    page = opened(run_page).page
    moved(page)
    set_slider(page, "time", 1e9)
    set_slider(page, "exaggeration", 10)
    expect(page.get_by_role("slider", name="time", exact=True)).to_have_attribute(
        "aria-valuetext", "0.0705 s"
    )
    exaggeration = page.get_by_role("slider", name="exaggeration", exact=True)
    expect(exaggeration).to_have_attribute("aria-valuetext", "\u00d7 10")
    assert page.locator("output, [aria-live], [role=status]").count() == 0


def test_scripts_of_others_do_not_run(run_page: Path, opened: Callable[..., Any]) -> None:
    shown = opened(run_page)
    shown.page.evaluate(
        """() => {
            const script = document.createElement("script");
            script.textContent = "window.foreign = true";
            document.body.append(script);
        }"""
    )
    assert shown.page.evaluate("window.foreign") is None
    assert any("Content Security Policy" in complaint for complaint in shown.complaints)


def test_time_is_scrubbed_to_the_end_and_back(run_page: Path, opened: Callable[..., Any]) -> None:
    page = opened(run_page).page
    moved(page)
    at_rest = meshes(page)
    set_slider(page, "time", 1e9)
    expect(page.locator(".motion .told")).to_have_text("0.0705 s")  # 22 steps
    assert meshes(page) != at_rest
    set_slider(page, "time", 0)
    expect(page.locator(".motion .told")).to_have_text("0.0000 s")
    assert meshes(page) == at_rest


def test_displacements_are_exaggerated_as_much_as_is_said(run_page: Path, opened: Callable[..., Any]) -> None:
    page = opened(run_page).page
    moved(page)
    set_slider(page, "exaggeration", 1)
    expect(page.locator(".motion .times")).to_have_text("\u00d7 1")
    once = displacements(page)
    set_slider(page, "exaggeration", 10)
    expect(page.locator(".motion .times")).to_have_text("\u00d7 10")
    tenfold = displacements(page)
    assert max(map(abs, once)) > 1e-4
    assert tenfold == pytest.approx([10 * each for each in once], abs=1e-6)


def test_the_tip_leaves_a_trace(run_page: Path, opened: Callable[..., Any]) -> None:
    page = opened(run_page).page
    moved(page)
    set_slider(page, "time", 1e9)
    last = "Array.from(document.querySelector('.motion .body').data).at(-1)"
    assert page.evaluate(f"{last}.name") == "trace of the tip"
    assert page.evaluate(f"{last}.z.length") >= 23


@pytest.mark.parametrize("name", ["run_page", "study_page"])
@pytest.mark.parametrize("colours", ["light", "dark"])
def test_fits_a_phone(
    name: str, colours: str, opened: Callable[..., Any], request: pytest.FixtureRequest
) -> None:
    shown = opened(request.getfixturevalue(name), width=PHONE, colours=colours)
    shown.scroll_through()
    assert shown.page.evaluate("document.documentElement.scrollWidth") <= PHONE
    assert shown.complaints == []


def test_colours_are_those_of_the_system_until_somebody_chooses(
    run_page: Path, opened: Callable[..., Any]
) -> None:
    shown = opened(run_page, colours="dark")
    shown.scroll_through()
    dark = colours_of(shown.page)
    shown.page.get_by_role("button", name="light or dark colours").click()
    light = colours_of(shown.page)
    assert (brightness(dark[0]), brightness(dark[1])) == pytest.approx((0.1, 0.9), abs=0.1)
    assert (brightness(light[0]), brightness(light[1])) == pytest.approx((0.97, 0.1), abs=0.1)
    assert dark[2] != light[2]


def colours_of(page: Page) -> tuple[str, str, str]:
    """The ground, the words of a chart, and its first line."""
    found: list[str] = page.evaluate(
        """[getComputedStyle(document.body).backgroundColor,
            getComputedStyle(document.querySelector(".chart .xtitle")).fill,
            getComputedStyle(document.querySelector(".chart .js-line")).stroke]"""
    )
    return found[0], found[1], found[2]


def brightness(colour: str) -> float:
    parts = [int(part) for part in colour.strip("rgb()").split(",")]
    return sum(parts) / 3 / 255
