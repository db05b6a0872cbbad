"""Takes the pictures of scripts/render_animation: a step, a picture, a line that says what is seen.

    animation_frames.py DIRECTORY      gets frame_NN.png, the whole display, and frame_NN.txt
"""
import pathlib
import subprocess
import sys
import time

import rospy
from geometry_msgs.msg import PointStamped
from hybrid_sphere.srv import Step

PERIOD = 0.1     # s between frames
FIRST = 1.9      # s, of the scene
KICK = 4.3       # s
LAST = 7.0       # s
DRAWN = 0.25     # s of wall time in which rviz has surely drawn a frame
WORDS = {"free": "free on smooth ground", "rolling": "rolling on rough ground"}


def main():
    directory = pathlib.Path(sys.argv[1])
    rospy.init_node("animation", anonymous=True)
    rospy.wait_for_service("/hybrid_sphere/step", 20)
    step = rospy.ServiceProxy("/hybrid_sphere/step", Step)
    click = rospy.Publisher("/clicked_point", PointStamped, queue_size=1)
    while click.get_num_connections() < 1:
        time.sleep(0.05)
    state = step(FIRST).state
    time.sleep(8 * DRAWN)
    kicked = False
    number = 0
    while state.time < LAST:
        if not kicked and state.time >= KICK - PERIOD / 2:
            kicked = True
            point = PointStamped()
            point.header.frame_id = "world"
            point.point.x, point.point.y = state.pose.position.x - 3, state.pose.position.y + 1.5
            click.publish(point)
            time.sleep(DRAWN)
        state = step(PERIOD).state
        time.sleep(DRAWN)
        name = directory / ("frame_%02d" % number)
        subprocess.run(["import", "-window", "root", str(name.with_suffix(".png"))], check=True)
        text = "t = %.1f s   %s" % (state.time, WORDS.get(state.mode, state.mode))
        name.with_suffix(".txt").write_text(text + ("   (kicked by Publish Point)" if kicked else ""))
        number += 1


main()
