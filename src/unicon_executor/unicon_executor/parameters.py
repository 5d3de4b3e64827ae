"""The executor's parameters."""

from __future__ import annotations

from unicon_ros.parameters import Parameter

PARAMETERS = (
    Parameter(
        "policy",
        "tracker",
        "policy to begin with: a name under policies/, a folder, or reference_servo",
    ),
    Parameter("source", "", "source of target frames to follow; empty for whichever began last"),
    Parameter(
        "reset_after_s",
        2.0,
        "how long after a fall the avatar is put into its target; negative: never, it tries to go on",
        "s",
        -1.0,
        3600.0,
    ),
    Parameter(
        "slow_motion",
        False,
        "let simulated time slow down on a machine that cannot keep up, instead of letting the avatar fall",
    ),
    Parameter(
        "lockstep",
        False,
        "one tick for each target message, at the message's time, with /clock; the same messages "
        "give the same result to the bit",
    ),
    Parameter("markers_hz", 15.0, "rate of the markers for RViz and Foxglove; 0 for none", "Hz", 0.0, 60.0),
    Parameter(
        "realtime_priority",
        0,
        "SCHED_FIFO priority where the system allows it; 0 for the ordinary scheduler",
        "",
        0,
        50,
    ),
    Parameter(
        "dump_dir",
        "",
        "folder for the last second of states when the physics fails; empty for none",
    ),
)
