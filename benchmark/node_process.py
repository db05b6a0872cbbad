"""What the benchmarks of the node share: the workspace, a roscore of their own, processes and what they use."""
import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

TICKS = os.sysconf("SC_CLK_TCK")
PAGE = os.sysconf("SC_PAGE_SIZE")
CONFIG = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "config")


def enter_workspace(setup):
    """Runs this program again with the workspace sourced."""
    if setup and "HYBRID_SPHERE_BENCHMARK" not in os.environ:
        environment = dict(os.environ, HYBRID_SPHERE_BENCHMARK="1")
        command = '. "$0" >/dev/null; exec "$@"'
        os.execvpe("bash", ["bash", "-c", command, setup, sys.executable] + sys.argv, environment)


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("", 0))
        return any_port.getsockname()[1]


def program(name):
    import roslib.packages  # known only in the workspace
    paths = roslib.packages.find_node("hybrid_sphere", name)
    if not paths:
        sys.exit("%s is not built: configure with -DHYBRID_SPHERE_BENCHMARKS=ON" % name)
    return paths[0]


def start(command, **more):
    return subprocess.Popen(command, stderr=subprocess.DEVNULL, **dict({"stdout": subprocess.DEVNULL}, **more))


def cpu_seconds(pid):
    """User and system time of a process, all threads."""
    with open("/proc/%d/stat" % pid) as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def resident_megabytes(pid):
    with open("/proc/%d/statm" % pid) as statm:
        return int(statm.read().split()[1]) * PAGE / 1e6


def stop(process):
    process.send_signal(signal.SIGINT)
    try:
        return process.communicate(timeout=20)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        return b"0"


@contextlib.contextmanager
def master():
    """A roscore of one's own, on a free port, that leaves nothing behind."""
    scratch = tempfile.mkdtemp()
    port = free_port()
    os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=scratch)
    core = start(["roscore", "-p", str(port)])
    try:
        while subprocess.run(["rosparam", "list"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
            time.sleep(0.2)
        yield
    finally:
        stop(core)
        shutil.rmtree(scratch, ignore_errors=True)


def load_scene(scene, rate):
    """Gives /hybrid_sphere the parameters of a scene of config/."""
    # Only the node reads them: the bare publisher has the same name and leaves them alone.
    subprocess.run(["rosparam", "load", os.path.join(CONFIG, scene + ".yaml"), "/hybrid_sphere"], check=True)
    subprocess.run(["rosparam", "set", "/hybrid_sphere/rate", str(rate)], check=True)
