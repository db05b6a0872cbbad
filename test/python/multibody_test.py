"""hybrid_sphere.MultibodySystem, part by part: closed forms, what is refused, memory."""
import gc
import unittest
import weakref

import numpy as np

import hybrid_sphere
from hybrid_sphere import ContactShape, MultibodySystem, Plane, Twist, Wrench, columns, force_at

ACCURACY = 1e-12
TOLERANCE = 10 * ACCURACY  # of motions whose numbers are below 10
NO_GRAVITY = (0, 0, 0)
UNIT = (1, 1, 1)  # moments of inertia


def motion_of(system, duration, velocities=None):
    motion = system.solve(duration, *system.initial(velocities or {}), accuracy=ACCURACY)
    assert motion.reason == "reached_end", motion.message
    return motion


def place(system, state):
    """q of a state."""
    return columns(state, system.coordinates)


def moving(system, state):
    """q and v of a state."""
    return columns(state, system.coordinates), columns(state, system.velocities)


def free(name="body"):
    return MultibodySystem(NO_GRAVITY).body(name, 2, UNIT, [0, 0, 0])


class Bodies(unittest.TestCase):
    def test_are_named_in_the_columns(self):
        system = MultibodySystem().body("a", 1, UNIT, [1, 2, 3]).point_mass("b", 1, [0, 0, 1])
        self.assertEqual(system.coordinates[:7], ("a.x", "a.y", "a.z", "a.qw", "a.qx", "a.qy", "a.qz"))
        self.assertEqual(system.velocities[6:], ("b.vx", "b.vy", "b.vz", "b.w1", "b.w2", "b.w3"))
        self.assertIn("MultibodySystem", repr(system))
        q, v = system.initial()
        np.testing.assert_array_equal(q[:7], [1, 2, 3, 1, 0, 0, 0])
        np.testing.assert_array_equal(v, np.zeros(12))

    def test_have_the_pose_of_their_placement(self):
        c, s = np.cos(0.3), np.sin(0.3)
        placement = np.array([[c, -s, 0, 1], [s, c, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
        system = MultibodySystem().body("a", 1, np.diag([1, 2, 2.5]), placement).body("b", 1, [1, 1, 1, 0, 0, 0.1], [0, 0, 0])
        q, v = system.initial({"a": Twist([1, 0, 0], [0, 0, 2]), "b": ([0, 1, 0], [0, 0, 0])})
        np.testing.assert_allclose(system.pose(q, "a"), placement, atol=1e-15)
        np.testing.assert_allclose(system.poses(q), [placement, np.eye(4)], atol=1e-15)
        twist = system.twist(q, v, "a")
        np.testing.assert_allclose(twist.velocity, [1, 0, 0], atol=1e-15)
        np.testing.assert_allclose(twist.angular_velocity, [0, 0, 2], atol=1e-15)
        # The point (1, 0, 0) on the body's axes is at (c, s, 0) from the centre.
        np.testing.assert_allclose(system.velocity(q, v, "a", [1, 0, 0]), [1 - 2 * s, 2 * c, 0], atol=1e-15)

    def test_fall(self):
        system = MultibodySystem([0, 0, -10]).body("a", 2, UNIT, [0, 0, 0]).thin_rod("b", 1, [0, 0, 0], [1, 0, 0])
        end = motion_of(system, 1, {"a": ([1, 0, 0], [0, 0, 0])}).at(1)
        np.testing.assert_allclose([end["a.x"], end["a.z"], end["b.z"]], [1, -5, -5], rtol=TOLERANCE)


class Forces(unittest.TestCase):
    def test_that_are_constant(self):
        for wrench in (Wrench([4, 0, 0], [0, 0, 1]), ([4, 0, 0], [0, 0, 1]), np.array([[4, 0, 0], [0, 0, 1]])):
            end = motion_of(free().apply("body", wrench), 1).at(1)
            self.assertAlmostEqual(end["body.x"], 1, delta=TOLERANCE)
            self.assertAlmostEqual(end["body.w3"], 1, delta=TOLERANCE)

    def test_of_the_state_of_a_body(self):
        # m v' = -c v, and a torque -k theta about z: v = exp(-c t / m), theta' = cos(sqrt(k) t).
        def wrench(t, body):
            angle = np.arctan2(body.pose[1, 0], body.pose[0, 0])
            return -3 * body.twist.velocity, [0, 0, -4 * angle]
        end = motion_of(free().apply("body", wrench), 1, {"body": ([1, 0, 0], [0, 0, 1])}).at(1)
        self.assertAlmostEqual(end["body.vx"], np.exp(-1.5), delta=TOLERANCE)
        self.assertAlmostEqual(end["body.w3"], np.cos(2), delta=TOLERANCE)

    def test_at_a_point(self):
        # At (0, 1, 0) on the body's axes: a torque (0, 1, 0) x (4, 0, 0) about the centre.
        def wrench(t, body):
            return force_at([4, 0, 0], body.pose[:3, 3] + [0, 1, 0], body)
        end = motion_of(free().apply("body", wrench), 1).at(1)
        self.assertAlmostEqual(end["body.x"], 1, delta=TOLERANCE)
        self.assertAlmostEqual(end["body.w3"], -4, delta=TOLERANCE)

    def test_between_two_bodies_are_those_of_a_spring_and_a_damper(self):
        def bodies():
            return MultibodySystem(NO_GRAVITY).body("a", 1, UNIT, [0, 0, 0]).body("b", 3, UNIT, [2, 0.5, 0])

        def pull(t, first, second):
            apart = second.pose[:3, 3] - first.pose[:3, 3]
            along = apart / np.linalg.norm(apart)
            rate = along @ (second.twist.velocity - first.twist.velocity)
            return -(5 * (np.linalg.norm(apart) - 1) + 0.5 * rate) * along, [0, 0, 0]
        ends = ([0, 0, 0], [2, 0.5, 0])
        written = bodies().apply("a", "b", pull)
        made = bodies().spring("spring", "a", "b", *ends, 5, 1).damper("damper", "a", "b", *ends, 0.5)
        speed = {"a": ([0, 1, 0], [0, 0, 0])}
        found, wanted = [place(system, motion_of(system, 2, speed).at(2)) for system in (written, made)]
        np.testing.assert_allclose(found, wanted, atol=TOLERANCE)
        self.assertAlmostEqual((found[1] + 3 * found[8]) / 4, (2 * 1 + 3 * 0.5) / 4, delta=TOLERANCE)

    def test_that_return_nonsense_are_refused_by_name(self):
        for result in (None, "push", [1, 2, 3], ([0, 0, 0], [0, 0])):
            system = free().apply("body", lambda t, body, result=result: result)
            with self.assertRaisesRegex(ValueError, "the result of wrench of body body"):
                motion_of(system, 1)
        system = free().apply("body", lambda t, body: ([np.nan, 0, 0], [0, 0, 0]))
        self.assertEqual(system.solve(1, *system.initial()).reason, "not_finite")


class Joints(unittest.TestCase):
    def test_a_pendulum_has_its_period(self):
        # theta0 = 1: T = 2 pi sqrt(I / (m g d)) / agm(1, cos(theta0 / 2)).
        a, b = 1.0, np.cos(0.5)
        while a - b > 1e-16:
            a, b = (a + b) / 2, np.sqrt(a * b)
        period = 2 * np.pi * np.sqrt((0.1 + 2 * 0.25) / (2 * 9.81 * 0.5)) / a
        system = MultibodySystem().body("rod", 2, [0.1, 0.1, 0.1], 0.5 * np.array([-np.sin(1), 0, -np.cos(1)]))
        system.hinge("pivot", "world", "rod", [0, 0, 0], [0, 1, 0])
        motion = motion_of(system, period)
        q, v = moving(system, motion.at(period))
        self.assertAlmostEqual(system.angle(q, "pivot"), 0, delta=TOLERANCE)
        self.assertAlmostEqual(system.angle_rate(q, v, "pivot"), 0, delta=10 * TOLERANCE)  # rates up to 4.6
        self.assertAlmostEqual(system.angle(place(system, motion.at(period / 2)), "pivot"), -2, delta=TOLERANCE)

    def test_a_motor_and_stops(self):
        # I theta'' = -k theta with I = 1: theta' = cos(2 t) up to the stop at theta = 1/4, sin(2 t) = 1/2.
        system = free().hinge("hinge", "world", "body", [0, 0, 0], [0, 0, 1])
        system.torque("hinge", lambda t, angle, rate: -4 * angle).limit("hinge", -1, 0.25, 0.5)
        motion = motion_of(system, 0.4, {"body": ([0, 0, 0], [0, 0, 1])})
        self.assertEqual(system.constraints, ("hinge", "hinge.lower", "hinge.upper"))
        self.assertEqual(motion.switches[0].applied, "")
        self.assertAlmostEqual(motion.switches[0].t, np.pi / 12, delta=TOLERANCE)
        self.assertAlmostEqual(motion.switches[0]["body.w3_after"], -np.sqrt(0.75) / 2, delta=TOLERANCE)

    def test_a_slider_with_a_force(self):
        system = free().slider("rail", "world", "body", [0, 0, 0], [1, 1, 0])
        system.force("rail", lambda t, displacement, rate: -8 * displacement)
        motion = motion_of(system, 1, {"body": ([2, 2, 0], [0, 0, 0])})
        q, v = moving(system, motion.at(1))
        self.assertAlmostEqual(system.displacement(q, "rail"), np.sqrt(2) * np.sin(2), delta=TOLERANCE)
        self.assertAlmostEqual(system.displacement_rate(q, v, "rail"), 2 * np.sqrt(2) * np.cos(2), delta=TOLERANCE)

    def test_a_rod_carries_what_turns(self):
        system = MultibodySystem(NO_GRAVITY).point_mass("bob", 2, [3, 0, 0]).rod("rod", "world", "bob", [0, 0, 0], [3, 0, 0])
        end = motion_of(system, 1, {"bob": ([0, 6, 0], [0, 0, 0])}).at(1)
        np.testing.assert_allclose([end["bob.x"], end["bob.y"]], [3 * np.cos(2), 3 * np.sin(2)], atol=TOLERANCE)
        self.assertAlmostEqual(end["lambda_rod"], -2 * 36 / 3, delta=100 * TOLERANCE)

    def test_the_others_carry_the_weight(self):
        for joint in (lambda s: s.ball("joint", "world", "a", [0, 0, 1]), lambda s: s.weld("joint", "world", "a", [0, 0, 1]),
                      lambda s: s.planar("joint", "world", "a", [0, 0, 1], [0, 0, 1])):
            system = joint(MultibodySystem([0, 0, -10]).body("a", 2, UNIT, [0, 0, 1]))
            end = motion_of(system, 1).at(1)
            force = columns(end, "lambda_joint")
            self.assertEqual(end["a.z"], 1)
            self.assertAlmostEqual(np.abs(force).max(), 20, delta=1e-12)

    def test_hold_in_their_interval_while_their_guard_is_positive(self):
        wall = lambda t, q: 1 - q[0]  # noqa: E731  # x of the body
        for when, times in ((dict(begin=0.5), [0.5]), (dict(begin=0.25, end=0.75), [0.25, 0.75]),
                            (dict(while_positive=wall), [1]), (dict(begin=0.5, while_positive=wall), [0.5, 1])):
            system = free().blade("blade", "body", [0, 0, 0], [1, 0, 0], **when)
            motion = motion_of(system, 2, {"body": ([1, 0, 0], [0, 0, 0])})
            np.testing.assert_allclose(motion.switches["t"], times, rtol=1e-12)


class Contacts(unittest.TestCase):
    def test_a_ball_rolls_down(self):
        # a = 5/7 g sin(alpha), the reaction m g cos(alpha) and the friction 2/7 m g sin(alpha) uphill.
        alpha = np.pi / 6
        normal = np.array([np.sin(alpha), 0, np.cos(alpha)])
        system = MultibodySystem([0, 0, -9.8]).body("ball", 2, 0.4 * 2 * 0.01 * np.ones(3), 0.1 * normal)
        system.rolling("ground", "ball", ContactShape.sphere(0.1), plane=Plane([0, 0, 0], normal))
        end = motion_of(system, 1).at(1)
        along = 5 / 7 * 9.8 * np.sin(alpha) / 2
        self.assertAlmostEqual(end["ball.x"], 0.1 * normal[0] + along * np.cos(alpha), delta=TOLERANCE)
        uphill = np.array([-np.cos(alpha), 0, np.sin(alpha)])
        wanted = 2 * 9.8 * (np.cos(alpha) * normal + 2 / 7 * np.sin(alpha) * uphill)
        np.testing.assert_allclose(columns(end, "lambda_ground"), wanted, atol=100 * TOLERANCE)

    def test_a_ball_lands_and_bounces(self):
        system = MultibodySystem([0, 0, -10]).body("ball", 1, UNIT, [0, 0, 6]).contact("floor", "ball", ContactShape.sphere(1), 0.5)
        motion = motion_of(system, 1.5)
        self.assertAlmostEqual(motion.switches[0].t, 1, delta=TOLERANCE)
        self.assertAlmostEqual(motion.at(1.5)["ball.z"], 1 + 2.5 - 1.25, delta=TOLERANCE)

    def test_a_ball_slides_until_it_rolls(self):
        # Until t = 2 v / (7 mu g), then with 5/7 v; with friction along y alone it slides on.
        def ball():
            system = MultibodySystem([0, 0, -10]).body("ball", 1, 0.4 * np.ones(3), [0, 0, 1])
            return system.contact("floor", "ball", ContactShape.sphere(1))
        start = {"ball": ([7, 0, 0], [0, 0, 0])}
        motion = motion_of(ball().friction("friction", "floor", 0.25, 0.5), 1, start)
        self.assertAlmostEqual(motion.switches[-1].t, 0.8, delta=TOLERANCE)
        self.assertEqual(motion.switches[-1].applied, "friction")
        self.assertAlmostEqual(motion.at(1)["ball.vx"], 5, delta=TOLERANCE)
        across = motion_of(ball().friction("friction", "floor", 0.25, direction="across"), 1, start)
        self.assertAlmostEqual(across.at(1)["ball.vx"], 7, delta=TOLERANCE)

    def test_an_upright_disk_rolls_straight_on(self):
        system = MultibodySystem().body("disk", 1, [0.25, 0.5, 0.25], [0, 0, 1])
        system.rolling("ground", "disk", ContactShape.disk(1, [0, 1, 0]))
        end = motion_of(system, 1, {"disk": ([2, 0, 0], [0, 2, 0])}).at(1)
        np.testing.assert_allclose([end["disk.x"], end["disk.z"]], [2, 1], atol=TOLERANCE)


class AsAModel(unittest.TestCase):
    def test_it_becomes_a_plant_with_an_input(self):
        plant = hybrid_sphere.Plant(free(), *free().initial(), input=True)
        plant.set_input([4, 0, 0, 0, 0, 1])
        plant.advance(1)
        self.assertAlmostEqual(plant.state["body.x"], 1, delta=TOLERANCE * 1e3)
        self.assertAlmostEqual(plant.state["body.w3"], 1, delta=TOLERANCE * 1e3)

    def test_it_has_events(self):
        system = free().event("line", lambda t, q, v: q[0] - 0.5)
        motion = motion_of(system, 1, {"body": ([1, 0, 0], [0, 0, 0])})
        self.assertEqual((motion.switches[0].events, motion.switches[0].t.round(12)), ("line", 0.5))

    def test_it_is_a_model_but_no_system(self):
        self.assertIsInstance(free(), hybrid_sphere.Model)
        self.assertNotIsInstance(free(), hybrid_sphere.System)
        with self.assertRaises(TypeError):
            hybrid_sphere.Model()

    def test_a_function_may_refer_to_it(self):
        system = free()
        system.apply("body", lambda t, body, own=system: (len(own.constraints) * body.twist.velocity, [0, 0, 0]))
        motion_of(system, 0.1)
        alive = weakref.ref(system)
        del system
        gc.collect()
        self.assertIsNone(alive())


class Refusals(unittest.TestCase):
    def test_have_the_message_of_cpp_and_change_nothing(self):
        system = free().hinge("hinge", "world", "body", [0, 0, 0], [0, 0, 1])
        for call, message in (
                (lambda: system.body("other", -1, UNIT, [0, 0, 0]), 'body "other": mass = -1 is refused; allowed: a number > 0'),
                (lambda: system.body("body", 1, UNIT, [0, 0, 0]), "a second one of this name"),
                (lambda: system.ball("ball", "world", "nobody", [0, 0, 0]), 'body = "nobody" is refused; allowed: world, body'),
                (lambda: system.hinge("hinge", "world", "body", [0, 0, 0], [0, 0, 1]), "a name that no other constraint has"),
                (lambda: system.weld("", "world", "body", [0, 0, 0]), "a name that no other constraint has"),
                (lambda: system.rod("rod", "world", "body", [0, 0], [1, 0, 0]), r"point_of_first: numbers of shape \(2,\)"),
                (lambda: system.body("other", 1, [1, 1], [0, 0, 0]), r"inertia: numbers of shape \(2,\)"),
                (lambda: system.body("other", 1, UNIT, np.ones((4, 4))), "placement: a pose with another last row"),
                (lambda: system.rolling("ground", "body", 0.5), "shape: an object of type float"),
                (lambda: system.contact("ground", "body", ContactShape.sphere(-1)), "radius = -1"),
                (lambda: system.friction("friction", "ground", 0.5), "contact = "),
                (lambda: system.limit("hinge", 1, -1), "limit of joint"),
                (lambda: system.torque("rail", lambda t, x, u: 0), "rail"),
                (lambda: system.blade("blade", "body", [0, 0, 0], [1, 0, 0], begin=2, end=1), "a begin before its end"),
                (lambda: system.initial({"body": ([1, 0, 0], [0, 0, 0])}), "hinge"),
                (lambda: system.initial({"body": [1, 0, 0]}), r'velocities\["body"\]'),
                (lambda: system.pose([1, 0], "body"), "q of 2 numbers"),
                (lambda: MultibodySystem([0, np.inf, 0]), "gravity")):
            with self.assertRaisesRegex(ValueError, message):
                call()
        self.assertEqual((system.constraints, len(system.coordinates)), (("hinge",), 7))
        for call in (lambda: system.torque("hinge", 3), lambda: system.weld("w", "world", "body", [0, 0, 0], while_positive=1)):
            with self.assertRaises(TypeError):
                call()


if __name__ == "__main__":
    unittest.main()
