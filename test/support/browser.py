"""Debian's Chromium without a display, with WebGL computed on the processor."""
import json

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

from patience import wait_for


class Browser:
    """A window of so many pixels; `webgl` False: as a browser that has none."""

    def __init__(self, width=1400, height=900, webgl=True):
        options = Options()
        options.binary_location = "/usr/bin/chromium"
        gl = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else ["--disable-3d-apis"]
        for argument in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                         "--disable-background-networking", "--window-size=%d,%d" % (width, height)] + gl:
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        self.set_size(width, height)

    def close(self):
        self.driver.quit()

    def set_size(self, width, height, phone=False):
        """Of the page itself, in its own pixels."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 2 if phone else 1, "mobile": phone})
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": phone})

    def open(self, path, link=""):
        """Opens a file and waits for its first picture and its plots."""
        self.driver.get("about:blank")
        self.messages()
        self.driver.get("file://" + str(path) + link)
        self.wait("window.hybridSphere && hybridSphere.firstFrame > 0 && hybridSphere.settled")

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, condition):
        """Until an expression of the page is true."""
        try:
            wait_for(lambda: self.run("return Boolean(%s)" % condition), condition)
        except AssertionError as error:
            raise AssertionError("%s\n%s" % (error, self.messages())) from error

    def messages(self):
        """What the console has said since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self):
        """Addresses that were asked for since the last call."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
