"""The executor as a ROS node."""
