#!/usr/bin/python3
"""many.launch: three simulators at once. Each moves as it does alone, has frames and names of its own, and what is asked of
one leaves the others alone."""
import os
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from tf2_msgs.msg import TFMessage

from csv_rows import parsed, state_row, switch_row
from node_client import Client, Listener, case, circle, initial_state, simulate, surface, wait_for

SCENES = {"first": "turntable", "second": "checkerboard", "third": "conveyor"}
DISTANCE = 26
DURATION = 5  # s; each scene has switches by then


class Many(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tf = Listener("/tf", TFMessage)
        cls.directory = rospy.get_param("~directory")
        cls.clients = {name: Client("/%s/hybrid_sphere" % name) for name in SCENES}

    def setUp(self):
        for name, client in self.clients.items():
            client.pause(True)
            scene = rospy.get_param("/%s/hybrid_sphere" % name)
            state = scene["initial_state"]
            request = initial_state(state["position"], state["velocity"], state["angular_velocity"])
            client.begin = client.step(0.01).state.header.stamp
            self.assertTrue(client.set_initial_state(request).success)

    def since_begin(self, client, listener):
        return [m for m in list(listener.messages) if m.header.stamp > client.begin]

    def run_all(self):
        """All three at once and in real time, up to the duration."""
        for client in self.clients.values():
            client.pause(False)
        for client in self.clients.values():
            client.states.wait_for_one(lambda m, c=client: m.header.stamp > c.begin and m.time >= DURATION)
            client.pause(True)
            client.states_until_now()

    def test_each_moves_as_simulate_says_of_its_scene(self):
        self.run_all()
        for name, client in self.clients.items():
            with case(name=name):
                scene = os.path.join(self.directory, SCENES[name] + ".yaml")
                states = self.since_begin(client, client.states)
                self.assertGreater(len(states), 10)
                times = ",".join(repr(m.time) for m in states)
                rows = [parsed(row) for row in simulate(scene, "--times", times, "--states", "-")]
                self.assertEqual([state_row(m) for m in states], rows)
                end = repr(states[-1].time)
                rows = [parsed(row) for row in simulate(scene, "--duration", end, "--switches", "-")]
                self.assertGreater(len(rows), 1)
                wait_for(lambda: len(self.since_begin(client, client.switches)) >= len(rows), "all switches")
                self.assertEqual([switch_row(m) for m in self.since_begin(client, client.switches)], rows)

    def test_each_frame_has_one_parent_and_its_messages_are_in_its_own(self):
        self.run_all()
        places = Listener("/tf_static", TFMessage)
        wait_for(lambda: len({t.child_frame_id for m in list(places.messages) for t in m.transforms}) == 3, "/tf_static")
        placed = {t.child_frame_id: t for m in places.messages for t in m.transforms}
        self.assertEqual({child: t.header.frame_id for child, t in placed.items()},
                         {name + "/world": "map" for name in SCENES})
        at = {name: placed[name + "/world"].transform.translation for name in SCENES}
        self.assertEqual({name: (p.x, p.y, p.z) for name, p in at.items()},
                         {"first": (0, DISTANCE, 0), "second": (0, 0, 0), "third": (0, -DISTANCE, 0)})
        moved = [t for m in list(self.tf.messages) for t in m.transforms]
        self.assertEqual({(t.header.frame_id, t.child_frame_id) for t in moved},
                         {(name + "/world", name + part) for name in SCENES
                          for part in ("/sphere", "/sphere_contact", "/hybrid_sphere_view")})
        for name, client in self.clients.items():
            with case(name=name):
                stamps = [t.header.stamp for t in moved if t.child_frame_id == name + "/sphere"]
                self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
                frames = {m.header.frame_id for m in client.states.messages + client.switches.messages}
                self.assertEqual(frames, {name + "/world"})

    def test_a_simulator_has_its_own_names_but_for_tf_and_diagnostics(self):
        published, _, services = rosgraph.Master("/test").getSystemState()
        for name in SCENES:
            node = "/%s/hybrid_sphere" % name
            with case(node=node):
                topics = {topic for topic, nodes in published if node in nodes and not topic.startswith(node + "/")}
                self.assertLessEqual(topics, {"/tf", "/diagnostics", "/rosout"})
                self.assertEqual([s for s, nodes in services if node in nodes and not s.startswith(node + "/")], [])

    def test_what_is_asked_of_one_leaves_the_others_alone(self):
        before = {name: client.step(0.5).state for name, client in self.clients.items()}
        maps = {name: client.get_surface_map().map for name, client in self.clients.items()}
        counts = {name: len(client.states_until_now()) for name, client in self.clients.items()}
        asked = self.clients["second"]
        commands = rospy.Publisher("/second/hybrid_sphere/cmd_wrench", WrenchStamped, queue_size=1)
        wait_for(commands.get_num_connections, "the second on cmd_wrench")
        self.assertTrue(asked.set_surface_map(surface(circle("pond", (2, 2), 1))).success)
        self.assertTrue(asked.set_initial_state(initial_state((1, 1), (0.5, 0))).success)
        self.assertTrue(asked.reset().success)
        self.assertTrue(asked.step(1.0).success)
        asked.pause(False)
        command = WrenchStamped()
        command.wrench.force.x = 1.0
        commands.publish(command)
        begin = asked.states.messages[-1].header.stamp
        asked.states.wait_for_one(lambda m: m.header.stamp > begin and m.twist.linear.x > 1)
        for name in ("first", "third"):
            with case(name=name):
                client = self.clients[name]
                self.assertEqual(len(client.states.messages), counts[name])
                self.assertEqual(client.get_surface_map().map, maps[name])
                # On from where it stood, as if nothing had been.
                after = client.step(0.5).state
                scene = os.path.join(self.directory, SCENES[name] + ".yaml")
                times = "%r,%r" % (before[name].time, after.time)
                rows = [parsed(row) for row in simulate(scene, "--times", times, "--states", "-")]
                self.assertEqual([state_row(before[name]), state_row(after)], rows)
        self.assertTrue(asked.set_surface_map(maps["second"]).success)


if __name__ == "__main__":
    rospy.init_node("many_test")
    rostest.rosrun("hybrid_sphere", "many_test", Many)
