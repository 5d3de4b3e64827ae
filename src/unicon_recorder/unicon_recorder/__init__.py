"""The recorder as a ROS node."""
