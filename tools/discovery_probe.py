"""Two processes that try to find each other over ROS; `unicon doctor` starts both.

usage: discovery_probe.py say TOPIC       publish until stopped
       discovery_probe.py listen TOPIC    wait for one message, print the seconds it took, exit 0
"""

from __future__ import annotations

import sys
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

GIVE_UP_AFTER_S = 10.0


def say(node: Node, topic: str) -> int:
    """Publish twenty times a second until a signal ends it."""
    publisher = node.create_publisher(String, topic, 1)
    node.create_timer(0.05, lambda: publisher.publish(String(data="hello")))
    rclpy.spin(node)
    return 0


def listen(node: Node, topic: str) -> int:
    """Wait for one message; return 0 when it came and 1 when it did not."""
    heard: list[str] = []
    node.create_subscription(String, topic, lambda message: heard.append(message.data), 1)
    start = time.monotonic()
    while not heard and time.monotonic() - start < GIVE_UP_AFTER_S:
        rclpy.spin_once(node, timeout_sec=0.05)
    if heard:
        print(f"{time.monotonic() - start:.3f}")
    return 0 if heard else 1


def main(words: list[str]) -> int:
    """Do what the words ask for; return the exit status."""
    actions = {"say": say, "listen": listen}
    if len(words) != 2 or words[0] not in actions:
        print(__doc__, file=sys.stderr)
        return 2
    rclpy.init()
    node = rclpy.create_node(f"unicon_doctor_{words[0]}")
    try:
        return actions[words[0]](node, words[1])
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
