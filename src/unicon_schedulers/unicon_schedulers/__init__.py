"""Schedulers as ROS nodes."""

import os

# products this small only lose by threads, which wait for each other on a busy machine; numpy reads it once
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
