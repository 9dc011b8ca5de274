"""What the node has published so far."""
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

PATIENCE = 40  # seconds; a machine may be busy


def expect(condition, text):
    print(("ok      " if condition else "FAILED  ") + text, flush=True)
    if not condition:
        raise AssertionError(text)


class Inbox:
    """The messages of each topic, and waiting for them."""
    TOPICS = {"state": DiagnosticStatus, "pose": PoseStamped, "odom": Odometry, "path": Path, "landmarks": PointCloud2,
              "dense_map": PointCloud2, "octomap": rospy.AnyMsg, "grid": OccupancyGrid}

    def __init__(self):
        self.changed = threading.Condition()
        self.messages = {}
        self.clear()
        self.subscribers = [rospy.Subscriber(f"/stillpoint/{name}", kind, self.add, name)
                            for name, kind in self.TOPICS.items()]
        self.subscribers.append(rospy.Subscriber("/tf", TFMessage, self.add, "tf"))

    def clear(self):
        with self.changed:
            self.messages = {name: [] for name in (*self.TOPICS, "tf")}

    def add(self, message, name):
        with self.changed:
            self.messages[name].append(message)
            self.changed.notify_all()

    def wait(self, name, fits, what):
        """The first message that fits."""
        with self.changed:
            self.changed.wait_for(lambda: self.first(name, fits) is not None, PATIENCE)
            message = self.first(name, fits)
        expect(message is not None, what)
        return message

    def wait_while(self, publish, name, fits, what):
        """The same; `publish` is called again and again until then."""
        end = time.monotonic() + PATIENCE
        with self.changed:
            while self.first(name, fits) is None and time.monotonic() < end:
                publish()
                self.changed.wait_for(lambda: self.first(name, fits) is not None, 0.2)
        return self.wait(name, fits, what)

    def first(self, name, fits):
        return next((message for message in self.messages[name] if fits(message)), None)
