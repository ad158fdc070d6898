"""Headless Chromium without a network, for looking at a page as a reader does."""

import base64
import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
DRIVER = shutil.which("chromedriver")
LACKING = (
    "no Chromium here: apt-get install chromium chromium-driver"
    if CHROMIUM is None or DRIVER is None
    else "no selenium here: pip install 'cardume[dev]'"
    if find_spec("selenium") is None
    else ""
)
SWITCHES = (
    *("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run"),
    *(
        "--disable-background-networking",
        "--disable-component-update",
        "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    ),
    *("--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
)


class Page:
    """A browser with one page open."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, path: Path, width: int = 1280, height: int = 800, is_dark: bool = False) -> None:
        """Show a file in a window of that inner size, once it says that it is ready."""
        self.say("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}
        self.say("Emulation.setEmulatedMedia", features=[scheme])
        self.resize(width, height)
        self.go(path.resolve().as_uri())

    def go(self, address: str) -> None:
        """Show a page and wait for it; a busy machine takes its time to draw."""
        self.run("window.is_old = true")
        self.driver.get(address)
        self.wait("!window.is_old && document.body && document.body.dataset.ready === 'yes'", 300.0)

    def resize(self, width: int, height: int) -> None:
        """Give the window another inner size."""
        is_phone = width < 600
        self.say(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=2 if is_phone else 1,
            mobile=is_phone,
        )

    def say(self, command: str, **given: Any) -> Any:
        """A command of Chromium's own protocol."""
        return self.driver.execute_cdp_cmd(command, given)

    def run(self, script: str, *given: Any) -> Any:
        """What a script in the page returns."""
        return self.driver.execute_script(script, *given)

    def wait(self, condition: str, seconds: float = 120.0) -> None:
        """Until a condition holds in the page."""
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self.driver, seconds).until(lambda driver: driver.execute_script(f"return {condition}"))

    def complaints(self) -> list[str]:
        """What the console says, since this was asked last."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] != "INFO"]

    def asked_for(self) -> list[str]:
        """Addresses outside the page that it asked for, since this was asked last."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        urls = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
        return [url for url in urls if not url.startswith(("file:", "data:", "blob:"))]

    def picture(self, path: Path) -> None:
        """What the window shows, as a PNG file."""
        path.write_bytes(base64.b64decode(self.say("Page.captureScreenshot")["data"]))

    def whole_picture(self, path: Path) -> None:
        """The whole page, however long, as a PNG file."""
        size = self.say("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
        found = self.say("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)
        path.write_bytes(base64.b64decode(found["data"]))

    def print(self, path: Path) -> None:
        """The page on paper, as a PDF file."""
        found = self.say("Page.printToPDF", preferCSSPageSize=True, printBackground=True)
        path.write_bytes(base64.b64decode(found["data"]))


@contextmanager
def browser() -> Iterator[Page]:
    """A browser, gone when the block ends."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM or ""
    options.page_load_strategy = "none"  # `go` waits by itself, and longer
    for switch in SWITCHES:
        options.add_argument(switch)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(DRIVER))
    driver.set_script_timeout(300)
    driver.command_executor.client_config.timeout = 330
    try:
        yield Page(driver)
    finally:
        driver.quit()
