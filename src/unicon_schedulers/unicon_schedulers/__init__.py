"""Schedulers as ROS nodes."""
