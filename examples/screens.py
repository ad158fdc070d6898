"""Take the pictures of the report and the laboratory that docs show; needs Chromium, its driver and pdftoppm.

python examples/screens.py [FOLDER]        FOLDER: docs/pictures, as make screens does, unless another is given
"""

import subprocess
import sys
import tempfile
import time
from io import BytesIO
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "pictures"
PROGRAM = [sys.executable, "-c", "from cardume.cli.main import main; main()"]
PAGES, GAP = (0, 1, 3), 10  # of the printed report, and pixels between them
COLORS = 128  # of a picture
SCREENS = {"desk": (1280, 800, False), "dark": (1280, 800, True), "phone": (390, 844, False)}
LOSSY = """
    const row = [...document.querySelectorAll('.control')].find((one) => one.dataset.key.endsWith('acoustics.loss'));
    const slider = row.querySelector('.slider');
    slider.value = arguments[0] * slider.max;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    row.scrollIntoView({ block: 'center' });
    window.scrollTo(0, 0);
"""

sys.path.insert(0, str(ROOT / "tests"))
from report.browser import Page, browser  # noqa: E402


def keep(picture: Image.Image, path: Path) -> None:
    """Write a picture, small."""
    picture.convert("RGB").quantize(COLORS, dither=Image.Dither.NONE).save(path, optimize=True)
    print(path)


def seen(page: Page, width: int) -> Image.Image:
    """What the window shows, in its own pixels."""
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        page.picture(Path(file.name))
        picture = Image.open(BytesIO(Path(file.name).read_bytes()))
    return picture.resize((width, round(picture.height * width / picture.width)), Image.Resampling.LANCZOS)


def report(page: Page, folder: Path, scratch: Path) -> None:
    """The report of paper/figure-5 on a desk, in the dark, on a phone, and on paper."""
    subprocess.run([*PROGRAM, "run", "paper/figure-5", "-q", "-o", str(scratch / "run")], check=False)
    for name, (width, height, is_dark) in SCREENS.items():
        page.open(scratch / "run" / "report.html", width, height, is_dark)
        keep(seen(page, width), folder / f"report-{name}.png")
    page.open(scratch / "run" / "report.html")
    page.print(scratch / "report.pdf")
    subprocess.run(["pdftoppm", "-png", "-r", "72", scratch / "report.pdf", scratch / "page"], check=True)
    sheets = [Image.open(path).convert("RGB") for path in sorted(scratch.glob("page-*.png"))]
    chosen = [sheets[number] for number in PAGES]
    width = sum(sheet.width for sheet in chosen) + GAP * (len(chosen) - 1)
    whole = Image.new("RGB", (width, max(sheet.height for sheet in chosen)), "#999999")
    for place, sheet in enumerate(chosen):
        whole.paste(sheet, (place * (sheet.width + GAP), 0))
    keep(whole, folder / "report-printed.png")


def laboratory(page: Page, folder: Path, scratch: Path) -> None:
    """The laboratory with a pinned run and one of many lost messages."""
    (scratch / "missions").mkdir()
    command = [*PROGRAM, "lab", "--no-browser", "-q", "--folder", str(scratch / "missions")]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        line = {"offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
        page.say("Network.emulateNetworkConditions", **line)
        page.say("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])
        page.resize(1280, 800)
        page.go(address)
        page.run("document.getElementById('pin').click()")
        page.run(LOSSY, 0.8)
        page.wait("cardume.latencies.length > 0")
        time.sleep(3.0)  # the axes are fitted when the hand rests
        keep(seen(page, 1280), folder / "lab.png")
    finally:
        process.terminate()
        process.wait(60)


def main() -> None:
    """Take all of them."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    with tempfile.TemporaryDirectory() as scratch, browser() as page:
        report(page, folder, Path(scratch))
        laboratory(page, folder, Path(scratch))


if __name__ == "__main__":
    main()
