"""Schedulers without ROS: each turns an input into target frames by time."""
