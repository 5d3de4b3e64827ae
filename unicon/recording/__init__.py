"""Recordings without ROS: rosbag2 folders with MCAP files, written, mended, read and simulated again."""
