"""A headless browser, and the pages that it opens."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import attrs
import pytest
from playwright.sync_api import Browser, Page, Request, sync_playwright
from processes import python

_FLAGS = (
    *("--no-sandbox", "--no-first-run", "--disable-quic", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync"),
    *("--use-angle=swiftshader", "--enable-unsafe-swiftshader"),  # meshes without a graphics card
)


@attrs.define
class Opened:
    """An open page with its errors and requests so far.

    Attributes:
        page: The page.
        errors: Errors on the console, and uncaught exceptions.
        requests: Requested addresses.
    """

    page: Page
    errors: list[str] = attrs.field(factory=list)
    requests: list[str] = attrs.field(factory=list)

    def scroll_through(self) -> None:
        """Scroll each chart into view, which draws it."""
        drawn = self.page.locator(".chart, .motion")
        for number in range(drawn.count()):
            drawn.nth(number).scroll_into_view_if_needed()
            drawn.nth(number).locator(".main-svg").first.wait_for(state="attached")


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=os.environ["CHROMIUM"], args=_FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def opened(browser: Browser) -> Iterator[Callable[..., Opened]]:
    pages = []

    def open_(path: Path, width: int = 1100, colors: str = "light") -> Opened:
        page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=colors)  # type: ignore[arg-type]
        found = Opened(page)
        page.on(
            "console", lambda message: found.errors.append(message.text) if message.type == "error" else None
        )
        page.on("pageerror", lambda error: found.errors.append(str(error)))

        def note(request: Request) -> None:
            found.requests.append(request.url)

        page.on("request", note)
        page.goto(path.as_uri())
        pages.append(page)
        return found

    yield open_
    for page in pages:
        page.close()


def evoframe(directory: Path, *arguments: str) -> None:
    result = python("-m", "evoframe", *arguments, directory=directory)
    assert result.returncode == 0, result.stderr


@pytest.fixture(scope="session")
def run_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a short run of the published experiment."""
    directory = tmp_path_factory.mktemp("run")
    evoframe(directory, "run", "quick", "--out", "r")
    evoframe(directory, "verify", "r")
    evoframe(directory, "report", "r")
    return directory / "r" / "report" / "report.html"


@pytest.fixture(scope="session")
def study_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a study of short runs."""
    directory = tmp_path_factory.mktemp("study")
    (directory / "s.toml").write_text(
        'extends = "quick"\nruns = 2\n[run]\ngenerations = 3\n'
        '[grid]\n"collaboration.n" = [2, 3]\naggregator = ["am", "hm"]\n'
    )
    evoframe(directory, "study", "s.toml", "--out", "s")
    evoframe(directory, "report", "s")
    return directory / "s" / "report" / "report.html"
