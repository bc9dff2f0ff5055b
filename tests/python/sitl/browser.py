"""A Chromium that is installed on this machine, as the tests of the live page drive it."""

import math
import shutil
from contextlib import contextmanager

import numpy as np
import pytest

FLAGS = [
    "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]
FIELD_OF_VIEW_DEG = 50


def needs_browser():
    """Skips the test, and says what to install, where there is no browser."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        pytest.skip("there is no Chromium on PATH: apt-get install chromium (`cargo xtask test` does so as root on Debian)")
    pytest.importorskip("playwright", reason="Playwright is not installed: pip install -r xtask/python/browser.txt (`cargo xtask test` does so)")
    return chromium


@contextmanager
def browser():
    """A browser, ended at the end."""
    chromium = needs_browser()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=chromium, args=FLAGS, headless=True)
        try:
            yield running
        finally:
            running.close()


class Page:
    """The page at a size and in a colour scheme. Errors of its console fail the test at the end."""

    def __init__(self, browser, url: str, size=(1280, 800), scheme="light", expected=()):
        self.context = browser.new_context(viewport={"width": size[0], "height": size[1]}, color_scheme=scheme, reduced_motion="reduce")
        self.page = self.context.new_page()
        self.errors = []
        self.expected = expected
        self.requests = []
        self.page.on("console", self.hear)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(url)

    def hear(self, message):
        # What a screenshot makes the graphics driver say is not the page's fault.
        allowed = ["GPU stall due to ReadPixels", *self.expected]
        if message.type in ("error", "warning") and not any(text in message.text for text in allowed):
            self.errors.append(message.text)

    def wait(self, condition: str, timeout_s: float = 30):
        """Waits until an expression of `page` and `view` holds."""
        self.page.wait_for_function(f"() => {{ const {{ page, view }} = window.lmpcView ?? {{}}; return page && ({condition}); }}",
                                    timeout=1000 * timeout_s)

    def value(self, expression: str):
        return self.page.evaluate(f"() => {{ const {{ page, view }} = window.lmpcView; return {expression}; }}")

    def project(self, place):
        """Where a place, NED, is on the page, px: by the camera's place and aim alone."""
        eye, aim, box = self.value(
            "[view.camera.position.toArray(), view.controls.target.toArray(), (({ x, y, width, height }) => [x, y, width, height])(view.canvas.getBoundingClientRect())]")
        eye, aim = (np.array([-z, x, -y]) for x, y, z in (eye, aim))
        forward = (aim - eye) / np.linalg.norm(aim - eye)
        right = np.cross(np.array([0, 0, 1.0]), forward)
        right /= np.linalg.norm(right)
        down = np.cross(forward, right)
        way = np.array(place) - eye
        scale = box[3] / 2 / math.tan(math.radians(FIELD_OF_VIEW_DEG) / 2) / way.dot(forward)
        return box[0] + box[2] / 2 + way.dot(right) * scale, box[1] + box[3] / 2 + way.dot(down) * scale

    def fine(self):
        """Draws as fine as on a quick machine."""
        self.page.evaluate("""async () => {
            const { view } = window.lmpcView;
            Object.assign(view.fineness, { share: 1, take: () => false });
            view.resize();
            await new Promise(requestAnimationFrame); await new Promise(requestAnimationFrame);
        }""")

    def dark_pixels(self, point, reach: int = 14) -> int:
        """How many pixels around a point of the page are as dark as the vehicle's body is in light colours."""
        import io

        from PIL import Image

        self.fine()
        image = self.page.screenshot(clip={"x": point[0] - reach, "y": point[1] - reach, "width": 2 * reach, "height": 2 * reach})
        pixels = np.asarray(Image.open(io.BytesIO(image)).convert("L"), dtype=float)
        return int((pixels < 75).sum())

    def close(self):
        assert self.errors == []
        self.context.close()
