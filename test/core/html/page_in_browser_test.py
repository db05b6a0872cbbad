#!/usr/bin/python3
"""The page of `simulate --html` in Chromium: the sphere is where the table of the same run has it, and everything that
can be clicked does what it should.

The environment says where things are: SIMULATE, SCENES (config/).
"""
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))

from browser import Browser  # noqa: E402
from selenium.webdriver import ActionChains, Keys  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402

SCENES = pathlib.Path(os.environ["SCENES"])
FLOAT = 2.0**-23
HALF_STEP = 0.5 / 32767  # of a part of the orientation

SPHERE = "sphere: {mass: 1, radius: 0.1, body: solid}\n"
BOUNCE = SPHERE + """
initial_state: {position: [-1, 0], velocity: [1, 0], angular_velocity: [0, -40, 0]}
surface: {base: {law: smooth}, regions: [{name: floor, half_plane: {point: [0, 0], normal: [1, 0]}, law: rough}]}
"""

HALTS = SPHERE + """
initial_state: {position: [-1, 0], velocity: [1, 0]}
surface:
  livelock: stop
  base: {law: rough, belt: [1, 0]}
  regions: [{name: against, half_plane: {point: [0, 0], normal: [1, 0]}, law: rough, belt: [-4, 0]}]
"""


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.set_size(1400, 900)

    def scene(self, text):
        path = self.directory / "scene.yaml"
        path.write_text(text)
        return path

    def simulate(self, scene, *options, code=0):
        """The page, and the rows of the states and of the switches of the same run."""
        page, states, switches = (self.directory / name for name in ("page.html", "states.csv", "switches.csv"))
        result = subprocess.run([os.environ["SIMULATE"], str(scene), "--html", str(page), "--states", str(states),
                                 "--switches", str(switches), "--quiet", *options], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        return page, *([self.row(row) for row in csv.DictReader(path.open())] for path in (states, switches))

    @staticmethod
    def row(cells):
        words = ("kind", "from_region", "to_region", "mode", "region")
        return {key: value if key in words else float(value) for key, value in cells.items()}

    def opened(self, scene, *options, link="", code=0):
        page, states, switches = self.simulate(scene, *options, code=code)
        self.browser.open(page, link)
        return states, switches

    def state(self, time=None):
        if time is not None:
            self.browser.run("hybridSphere.seek(arguments[0])", time)
        return self.browser.run("return hybridSphere.state()")

    def time(self):
        return self.browser.run("return hybridSphere.time")

    def expect_at(self, row, turn=4 * HALF_STEP, origin=10.0):
        """@param origin  a bound of the coordinates relative to the page's origin [m]"""
        state = self.state(row["t"])
        self.assertEqual(state["time"], row["t"])
        for axis, name in enumerate("xy"):
            self.assertAlmostEqual(state["position"][axis], row[name], delta=origin * FLOAT, msg=str(row))
        for part, name in enumerate(("wx", "wy", "wz")):
            self.assertAlmostEqual(state["spin"][part], row[name], delta=100 * FLOAT)
        quaternion = [row[name] for name in ("qx", "qy", "qz", "qw")]
        self.assertLess(self.turn_between(state["orientation"], quaternion), turn, str(row))
        self.assertEqual(state["mode"].replace(" ", "_"), row["mode"])

    @staticmethod
    def turn_between(a, b):
        sign = 1 if sum(p * q for p, q in zip(a, b)) >= 0 else -1
        return 2 * math.asin(min(1, math.sqrt(sum((p - sign * q)**2 for p, q in zip(a, b))) / 2)) * 2

    def click(self, selector, x=None, y=None):
        """At a place in an element, from its upper left corner; without one in its middle."""
        element = self.browser.driver.find_element(By.CSS_SELECTOR, selector)
        if x is None:
            element.click()
            return
        size = element.size
        ActionChains(self.browser.driver).move_to_element_with_offset(
            element, x - size["width"] / 2, (size["height"] / 2 if y is None else y) - size["height"] / 2).click().perform()

    def press(self, *keys):
        ActionChains(self.browser.driver).send_keys(*keys).perform()


class Motion(PageTest):
    def test_the_sphere_is_where_the_table_has_it(self):
        for scene in ("paper", "conveyor", "turntable"):
            states, _ = self.opened(SCENES / (scene + ".yaml"))
            for index in (0, 123, 456, 789, 1000):
                self.expect_at(states[index])

    def test_between_outputs_it_is_on_its_way(self):
        # Straight lines and parabolas, which a cubic has exactly. The spin is linear in time: up to 10 rad/s, on a slope
        # of 0.1 m/s^2 changed by 0.0714 rad/s over a step h. Of abs(omega x change) h/12, which an integrated spin leaves
        # out (Magnus' second term), s - s^3 is left where both ends are right, at most 0.385.
        turn = 0.385 * 10 * 0.0714 * 0.1 / 12
        _, states, _ = self.simulate(SCENES / "conveyor.yaml", "--rate", "100")
        page, _, _ = self.simulate(SCENES / "conveyor.yaml", "--rate", "10")
        self.browser.open(page)
        for index in (7, 38, 169, 173, 355, 503, 661, 749):
            self.expect_at(states[index], turn=turn)

    def test_a_turn_of_more_than_half_a_circle_between_outputs_is_not_lost(self):
        scene = self.scene(SPHERE + "initial_state: {velocity: [1, 0], angular_velocity: [300, -150, 450]}\n")
        _, states, _ = self.simulate(scene, "--rate", "400", "--duration", "1")
        page, _, _ = self.simulate(scene, "--rate", "100", "--duration", "1")  # 5.6 rad between two of them
        self.browser.open(page)
        for index in (1, 2, 3, 150, 201, 399):
            # A rotation vector from binary32, over a hundredth of a second.
            self.expect_at(states[index], turn=4 * HALF_STEP + 5.6 * 2 * FLOAT)

    def test_never_goes_across_a_switch(self):
        _, states, _ = self.simulate(self.scene(BOUNCE), "--times", "0.4,0.9,1.1,1.4")
        page, _, switches = self.simulate(self.scene(BOUNCE), "--times", "0,1.5")
        self.browser.open(page)
        self.assertEqual(self.browser.run("return hybridSphere.switches"), [row["t"] for row in switches])
        for row in states:
            self.expect_at(row)
        first = switches[0]
        self.assertAlmostEqual(self.state(first["t"])["velocity"][0], first["vx2"], delta=FLOAT)
        self.assertAlmostEqual(self.state(first["t"] * (1 - 1e-9))["velocity"][0], first["vx1"], delta=4 * FLOAT)

    def test_far_away_large_and_small(self):
        for position, radius, speed in (("1e10, -1e10", 1e-3, 1), ("0, 0", 1e6, 1e5), ("-1e3, 5", 1e-12, 1e-3)):
            scene = self.scene("sphere: {mass: 1, radius: %g, body: solid}\ninitial_state: {position: [%s], velocity: "
                               "[%g, 0]}\nsurface: {base: {law: rough}}\n" % (radius, position, speed))
            states, _ = self.opened(scene, "--duration", "1e6", "--rate", "1e-3")
            self.assertTrue(self.browser.run("return hybridSphere.hasView"))
            last = states[-1]
            state = self.state(last["t"])
            self.assertAlmostEqual(state["position"][0], last["x"], delta=FLOAT * speed * 1e6 + 4e-6)
            self.assertEqual(self.browser.messages(), [])


class Handling(PageTest):
    def test_asks_nobody_and_complains_of_nothing(self):
        page, _, _ = self.simulate(SCENES / "archipelago.yaml")
        self.browser.open(page)
        self.browser.requests()
        self.browser.open(page)
        self.browser.run("hybridSphere.view('follow')")
        self.browser.run("hybridSphere.view('above')")
        requests = [url for url in self.browser.requests() if url != "about:blank"]
        self.assertEqual([url for url in requests if not url.startswith(("data:", "blob:"))], ["file://%s" % page])
        self.assertEqual(self.browser.messages(), [])
        self.assertTrue(self.browser.run("return hybridSphere.hasView"))

    def test_a_row_of_the_table_leads_to_its_switch(self):
        _, switches = self.opened(SCENES / "checkerboard.yaml")
        rows = self.browser.driver.find_elements(By.CSS_SELECTOR, "#table tbody tr")
        self.assertEqual(len(rows), len(switches))
        for index in (1, 4, 0):
            self.click("#table tbody tr:nth-child(%d)" % (index + 1))
            self.assertEqual(self.time(), switches[index]["t"])
            self.browser.wait("document.querySelectorAll('#table tbody tr')[%d].className === 'chosen'" % index)
        self.assertIn("base \u2192 square_00", rows[0].text)

    def test_a_link_leads_to_a_time(self):
        self.opened(SCENES / "paper.yaml", link="#t=1.5")
        self.assertEqual(self.time(), 1.5)
        self.browser.run("location.hash = '#t=7'")
        self.browser.wait("hybridSphere.time === 7")
        self.opened(SCENES / "paper.yaml", link="#t=nonsense")
        self.assertEqual(self.time(), 0)
        self.opened(SCENES / "paper.yaml", link="#t=1e9")
        self.assertEqual(self.time(), 10)

    def test_plays_and_pauses(self):
        self.opened(SCENES / "paper.yaml", "--duration", "5")
        self.click("#play")
        self.browser.wait("hybridSphere.time > 0.2")
        self.click("#play")
        self.assertFalse(self.browser.run("return hybridSphere.playing"))
        time = self.time()
        self.browser.run("hybridSphere.seek(4.9); hybridSphere.play()")
        self.browser.wait("hybridSphere.time === 5 && !hybridSphere.playing")
        self.assertLess(time, 5)

    def test_clicks_in_plots_and_time_line_seek(self):
        self.opened(SCENES / "bowling.yaml")
        self.assertEqual(len(self.browser.driver.find_elements(By.CSS_SELECTOR, ".plot")), 4)
        for selector, left, right in (("canvas[data-plot=speed]", 52, 6), ("#timeline", 9, 9)):
            width = self.browser.run("return document.querySelector(arguments[0]).clientWidth", selector)
            self.click(selector, left + round(0.3 * (width - left - right)))
            # A pixel, and half a one more or less.
            self.assertAlmostEqual(self.time(), 3, delta=1.5 * 10 / (width - left - right))

    def test_keys(self):
        _, switches = self.opened(SCENES / "conveyor.yaml")
        self.press(Keys.ARROW_RIGHT)
        self.assertAlmostEqual(self.time(), 10 / 200)
        self.press(Keys.ARROW_LEFT)
        self.assertEqual(self.time(), 0)
        self.press(Keys.ARROW_UP, Keys.ARROW_UP)
        self.assertEqual(self.time(), switches[1]["t"])
        self.press(Keys.ARROW_DOWN)
        self.assertEqual(self.time(), switches[0]["t"])
        self.press(Keys.SPACE)
        self.assertTrue(self.browser.run("return hybridSphere.playing"))
        self.press(Keys.SPACE)
        self.assertFalse(self.browser.run("return hybridSphere.playing"))
        self.press(Keys.END)
        self.assertEqual(self.time(), 10)

    def test_the_mouse_turns_the_view(self):
        self.opened(SCENES / "paper.yaml")
        where = "const box = document.querySelector('#stage > canvas').getBoundingClientRect(); return [box.width, box.height]"
        self.assertGreater(min(self.browser.run(where)), 300)
        canvas = self.browser.driver.find_element(By.CSS_SELECTOR, "#stage > canvas")
        label = "return document.querySelector('#labels span').style.transform"
        before = self.browser.run(label)
        ActionChains(self.browser.driver).click_and_hold(canvas).move_by_offset(80, 30).release().perform()
        self.browser.wait("document.querySelector('#labels span').style.transform !== '%s'" % before)

    def test_fits_a_phone(self):
        self.browser.set_size(390, 844, phone=True)
        self.opened(SCENES / "bowling.yaml")
        self.assertEqual(self.browser.run("return [innerWidth, document.documentElement.scrollWidth]"), [390, 390])
        overflow = """return [...document.querySelectorAll("main *")].filter((element) => !element.closest("#labels, #table-frame, svg") &&
          element.getBoundingClientRect().right > innerWidth + 0.5).map((element) => element.id || element.className)"""
        self.assertEqual(self.browser.run(overflow), [])
        box = self.browser.run("const b = document.querySelector('#timeline').getBoundingClientRect(); "
                               "return [b.left, b.top + b.height / 2, b.width]")
        touch = {"x": box[0] + 9 + (box[2] - 18) / 2, "y": box[1]}
        for kind, points in (("touchStart", [touch]), ("touchEnd", [])):
            self.browser.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        self.browser.wait("Math.abs(hybridSphere.time - 5) < 0.1")
        self.assertEqual(self.browser.messages(), [])


class Content(PageTest):
    def test_names_of_regions_are_text(self):
        evil = "</script><b>&{{three}}\u2192"
        scene = self.scene(BOUNCE.replace("name: floor", "name: '%s'" % evil).replace("-40", "0"))
        self.opened(scene, "--duration", "1.2", link="#t=1.1")
        self.assertEqual(self.state()["region"], evil)
        self.assertIn(evil, self.browser.run("return document.querySelector('#table').textContent"))
        self.assertIn(evil, self.browser.run("return document.querySelector('#legend').textContent"))
        self.assertEqual(self.browser.run("return document.querySelectorAll('b b, #table b, #legend b').length"), 0)
        self.assertEqual(self.browser.messages(), [])

    def test_says_what_it_leaves_out_and_why_it_ended(self):
        self.opened(self.scene(HALTS), "--rate", "50000", code=4)
        notes = self.browser.run("return document.querySelector('#notes').textContent")
        self.assertIn("The run was not finished: stopped at t = ", notes)
        self.assertIn("outputs the page has 10001, evenly chosen.", notes)

    def test_a_run_without_outputs_shows_its_switches(self):
        _, switches = self.opened(self.scene(HALTS), "--times", "8", code=4)
        self.assertGreater(len(switches), 0)
        self.assertEqual(self.state(switches[0]["t"])["region"], switches[0]["to_region"])
        self.assertEqual(self.browser.messages(), [])

    def test_a_run_of_nothing_is_told(self):
        page, _, _ = self.simulate(SCENES / "paper.yaml")
        text = page.read_text()
        begin = text.index('id="data">') + len('id="data">')
        end = text.index("</script>", begin)
        data = json.loads(text[begin:end])
        for table in ("states", "switches"):
            for name, column in data[table].items():
                data[table][name] = {"scale": 1, "data": ""} if isinstance(column, dict) else ""
        page.write_text(text[:begin] + json.dumps(data) + text[end:])
        self.browser.open(page)
        self.assertIn("Nothing of the motion was recorded", self.browser.run("return document.body.textContent"))
        self.press(Keys.SPACE, Keys.ARROW_UP, Keys.ARROW_LEFT)
        self.browser.run("hybridSphere.view('follow')")
        self.assertIsNone(self.state(1))
        self.assertEqual(self.browser.messages(), [])

    def test_a_run_without_a_switch_has_no_table(self):
        self.opened(self.scene(SPHERE + "surface: {base: {law: smooth}}\n"), "--times", "0")
        self.assertTrue(self.browser.run("return document.querySelector('#switches').hidden"))
        self.assertEqual(self.state()["mode"], "free")
        self.press(Keys.SPACE, Keys.ARROW_UP, Keys.ARROW_LEFT)
        self.assertEqual(self.browser.messages(), [])

    def test_many_cells_are_drawn_as_a_picture(self):
        side = 256
        rows = ("".join("255 " if (i // 2 + j // 2) % 2 else "0 " for i in range(side)) for j in range(side))
        (self.directory / "cells.pgm").write_text("P2 %d %d 255\n%s\n" % (side, side, "\n".join(rows)))
        scene = self.scene(SPHERE + "initial_state: {position: [1, 1], velocity: [2, 1]}\nsurface: {image: {file: "
                           "cells.pgm, resolution: 0.1, origin: [0, 0], rough_above: 0.5}}\n")
        self.opened(scene)
        self.assertIn("cells of the image", self.browser.run("return document.querySelector('#legend').textContent"))
        self.assertEqual(self.browser.messages(), [])


class WithoutWebGl(PageTest):
    @classmethod
    def setUpClass(cls):
        cls.directory = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.browser = Browser(webgl=False)
        cls.addClassCleanup(cls.browser.close)

    def test_says_so_and_the_rest_works(self):
        _, switches = self.opened(SCENES / "conveyor.yaml")
        self.assertFalse(self.browser.run("return hybridSphere.hasView"))
        self.assertIn("no WebGL", self.browser.driver.find_element(By.ID, "no-view").text)
        self.click("#table tbody tr:nth-child(2)")
        self.assertEqual(self.time(), switches[1]["t"])
        self.assertEqual(len(self.browser.driver.find_elements(By.CSS_SELECTOR, ".plot")), 4)


if __name__ == "__main__":
    unittest.main()
