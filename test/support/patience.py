"""The only clocks of the Python tests. They protect against hangs; a test counts, and a benchmark measures."""
import threading
import time

PATIENCE = 120.0  # s of wall time for what has to come; only a hang takes so long


def let_pass(seconds=0.01):
    """Lets other threads and processes run. No result depends on the duration."""
    time.sleep(seconds)


def wait_for(condition, what):
    """Waits until the condition holds; returns its value. Fails after PATIENCE: something hangs."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        let_pass()
    raise AssertionError("waited %g s for %s" % (PATIENCE, what))


def lines_of(stream):
    """The lines of a stream of bytes without their ends, in a list that grows as they come: reading has no patience."""
    lines = []
    threading.Thread(target=lambda: lines.extend(line.decode().strip() for line in stream), daemon=True).start()
    return lines


def wall_time():
    """The time of the system's clock, which stamps the messages of a node [s]."""
    return time.time()
