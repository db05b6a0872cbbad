#!/usr/bin/python3
"""Switches as the node publishes them, against the closed form; resets; new ground under the moving sphere."""
import unittest

import rospy
import rostest
from hybrid_sphere.msg import ConstraintSwitch, SphereState, SurfaceRegion

from node_client import Client, Impulse, half_plane, initial_state, surface

MASS, RADIUS, K2 = 2.0, 0.25, 0.4 * 0.25**2
RATE = 200.0
TOLERANCE = 1e-14  # some ten roundings of numbers of the size of 10


class Switches(unittest.TestCase):
    def setUp(self):
        self.client = Client()
        self.assertTrue(self.client.set_surface_map(surface(half_plane())).success)

    def assert_close(self, vector, wanted):
        for number, each in zip((vector.x, vector.y, vector.z), tuple(wanted) + (0,)):
            self.assertAlmostEqual(number, each, delta=TOLERANCE)

    def assert_is_impulse(self, event, velocity, omega):
        """The switch applies the constraint with the impulse of the closed form."""
        wanted = Impulse(MASS, RADIUS, K2, velocity, omega)
        px, py = wanted.impulse
        self.assertEqual((event.kind, event.from_stage, event.to_stage),
                         (ConstraintSwitch.APPLIED, ConstraintSwitch.HOLONOMIC, ConstraintSwitch.NONHOLONOMIC))
        self.assertEqual(event.header.frame_id, "world")
        self.assertEqual(event.position.z, RADIUS)
        self.assert_close(event.slip_before, wanted.slip)
        self.assert_close(event.impulse, wanted.impulse)
        self.assert_close(event.angular_impulse, (RADIUS * py, -RADIUS * px, 0))
        self.assert_close(event.twist_before.linear, velocity)
        self.assert_close(event.twist_before.angular, omega)
        self.assert_close(event.twist_after.linear, wanted.velocity)
        self.assert_close(event.twist_after.angular, wanted.omega)
        self.assertAlmostEqual(event.energy_before - event.energy_after, wanted.energy_lost, delta=TOLERANCE)

    def assert_stamped_with_its_own_instant(self, event, state):
        """A state of the same run tells what time a stamp means; both are rounded to nanoseconds."""
        stamps = (event.header.stamp - state.header.stamp).to_sec()
        self.assertAlmostEqual(stamps, event.time - state.time, delta=3e-9)

    def test_impulse_and_stamp_of_the_papers_switch(self):
        velocity, omega = (1.3, -0.7), (2.0, 1.5, -1.0)
        begin = self.client.start(initial_state((-0.4, 0.2), velocity, omega))
        event = self.client.switch_after(begin)
        time = 0.4 / 1.3
        self.assertNotEqual(event.time, round(event.time * RATE) / RATE)
        self.assertAlmostEqual(event.time, time, delta=1e-16)
        self.assertAlmostEqual(event.position.x, 0, delta=1e-16)
        self.assertAlmostEqual(event.position.y, 0.2 - 0.7 * time, delta=1e-15)
        self.assertEqual((event.from_region, event.to_region), ("base", "rough_half"))
        self.assert_is_impulse(event, velocity, omega)
        state = self.client.states.wait_for_one(lambda m: m.header.stamp > event.header.stamp)
        self.assertEqual((state.stage, state.mode, state.region), (SphereState.NONHOLONOMIC, "rolling", "rough_half"))
        self.assertEqual((state.slip.x, state.slip.y), (0, 0))
        self.assertEqual(state.twist, event.twist_after)
        self.assert_stamped_with_its_own_instant(event, state)

    def test_a_throw_back_is_two_switches_at_one_instant(self):
        begin = self.client.start(initial_state((-0.3, 0), (1, 0.25), (1, -40, 0.5)))
        applied, released = (self.client.switch_after(begin, index) for index in (0, 1))
        self.assertEqual((applied.kind, released.kind), (ConstraintSwitch.APPLIED, ConstraintSwitch.RELEASED))
        self.assertEqual(applied.header.stamp, released.header.stamp)
        self.assertEqual((released.impulse.x, released.impulse.y), (0, 0))
        self.assertLess(released.twist_after.linear.x, 0)

    def test_new_ground_is_suddenly_applied(self):
        velocity, omega = (0.5, 0.25), (3.0, -2.0, 1.0)
        begin = self.client.start(initial_state((-6, 1), velocity, omega))
        self.client.state()
        rough = surface(half_plane("rough_now", (-9, 0), (1, 0)))
        self.assertTrue(self.client.set_surface_map(rough).success)
        event = self.client.switch_after(begin)
        self.assertEqual(event.time, round(event.time * RATE) / RATE)
        self.assertAlmostEqual(event.position.x, -6 + 0.5 * event.time, delta=1e-14)
        self.assertEqual((event.from_region, event.to_region), ("base", "rough_now"))
        self.assert_is_impulse(event, velocity, omega)
        self.assertTrue(self.client.set_surface_map(surface()).success)
        event = self.client.switch_after(begin, 1)
        self.assertEqual((event.kind, event.from_region, event.to_region),
                         (ConstraintSwitch.RELEASED, "rough_now", "base"))
        self.assertEqual((event.impulse.x, event.impulse.y), (0, 0))

    def test_a_map_that_changes_no_constraint_is_no_switch(self):
        begin = self.client.start(initial_state((-6, 1), (0.5, 0)))
        self.assertTrue(self.client.set_surface_map(surface(half_plane("other", (-9, 0), (1, 0), law=0))).success)
        stamp = self.client.state().header.stamp
        self.client.states.wait_for_one(lambda m: m.header.stamp > stamp and m.region == "other")
        self.assertFalse([m for m in self.client.switches.messages if m.header.stamp > begin])

    def test_a_start_on_rough_ground_is_an_impulse_at_time_0(self):
        velocity, omega = (0.5, 0.25), (3.0, -2.0, 1.0)
        begin = self.client.start(initial_state((4, 1), velocity, omega))
        event = self.client.switch_after(begin)
        self.assertEqual((event.time, event.from_region, event.to_region), (0, "", "rough_half"))
        self.assert_is_impulse(event, velocity, omega)
        state = self.client.states.wait_for_one(lambda m: m.header.stamp > event.header.stamp)
        self.assert_stamped_with_its_own_instant(event, state)

    def test_a_reset_restores_the_state_and_not_the_clock(self):
        begin = self.client.start(initial_state((-0.1, 0.5), (2, 0)))
        first = self.client.switch_after(begin)
        last = self.client.state()
        self.assertTrue(self.client.reset().success)
        again = self.client.switches.wait_for_one(lambda m: m.header.stamp > first.header.stamp and m.index == 0)
        self.assertEqual(again.time, first.time)
        self.assertEqual(again.position, first.position)
        self.assertEqual(again.impulse, first.impulse)
        state = self.client.states.wait_for_one(lambda m: m.header.stamp > again.header.stamp)
        self.assertGreater(state.header.stamp, last.header.stamp)
        self.assert_stamped_with_its_own_instant(again, state)
        self.client.states.wait(len(self.client.states.messages) + 10)
        stamps = [m.header.stamp for m in self.client.states.messages]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))

    def test_stamps_of_switches_never_go_back(self):
        for _ in range(5):
            self.client.switch_after(self.client.start(initial_state((1, 0), (1, 0))))
            self.client.reset()
            self.client.set_surface_map(surface(base=SurfaceRegion.ROUGH))
            self.client.set_surface_map(surface(half_plane()))
        stamps = [m.header.stamp for m in self.client.switches.messages]
        self.assertTrue(all(a <= b for a, b in zip(stamps, stamps[1:])))


if __name__ == "__main__":
    rospy.init_node("switches_test")
    rostest.rosrun("hybrid_sphere", "switches_test", Switches)
