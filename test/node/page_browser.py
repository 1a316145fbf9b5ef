"""A headless Chromium that opens the page of a tank, for tests; not there where chromium, chromium-driver or python3-selenium is not installed."""

import base64
import io
import os
import shutil
import subprocess
import sys
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

WEB = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts", "web")
MISSING = None
if not (webdriver and shutil.which("chromium") and shutil.which("chromedriver")):
    MISSING = "the page is not looked at in a browser: chromium, chromium-driver or python3-selenium is not installed (scripts/install --browser)"
try:
    import tornado  # noqa: F401
    from wavetank.web.libraries import missing_packages

    NO_SERVER = "the server of the page is not tested: %s is not installed (scripts/install --web)" % missing_packages()[0] if missing_packages() else None
except ImportError:
    NO_SERVER = "the server of the page is not tested: python3-tornado is not installed (scripts/install --web)"


def start_server(*arguments):
    """The process, and the address of its page."""
    process = subprocess.Popen([sys.executable, WEB, "--port", "0", *arguments], stdout=subprocess.PIPE, universal_newlines=True)
    line = process.stdout.readline()
    if not line:
        raise AssertionError("the server did not start")
    return process, line.split()[0]


def end(process):
    """By SIGTERM, as often as it is asked: its exit code."""
    if process.poll() is None:
        process.terminate()
    if not process.stdout.closed:
        process.communicate(timeout=10)
    return process.returncode


class Browser:
    def __init__(self, width=900, height=640):
        options = webdriver.ChromeOptions()
        wanted = [
            "--headless=new",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--disable-dev-shm-usage",
            "--window-size=%d,%d" % (width, height),
        ]
        for argument in wanted + (["--no-sandbox"] if os.geteuid() == 0 else []):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)

    def get(self, expression):
        """The value of an expression of JavaScript."""
        return self.driver.execute_script("return " + expression)

    def wait(self, expression, seconds=20):
        end = time.time() + seconds
        while time.time() < end:
            if self.get(expression):
                return
            time.sleep(0.05)
        shown = self.get("window.wavetank ? [wavetank.time, wavetank.received, wavetank.status, document.body.innerText] : 'nothing'")
        raise AssertionError("never true on the page: %s; it shows %s, and its errors are %s" % (expression, shown, self.errors()))

    def press(self, name):
        self.driver.find_element("id", name).click()

    def water_share(self):
        """The part of the canvas that has one of the water's colours: blue, and more so than anything else that is drawn."""
        import matplotlib.image

        data = self.driver.execute_script(
            "const view = wavetank.view; view.renderer.render(view.scene, view.camera); return view.canvas.toDataURL('image/png');"
        )
        picture = 255 * matplotlib.image.imread(io.BytesIO(base64.b64decode(data.partition(",")[2])))[:, :, :3]
        red, green, blue = picture[:, :, 0], picture[:, :, 1], picture[:, :, 2]
        return float(((blue > 90) & (blue > red + 45) & (blue > green + 8)).mean())

    def errors(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def quit(self):
        self.driver.quit()
