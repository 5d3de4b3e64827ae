"""The graph of one avatar: ros2 launch unicon_bringup avatar.launch.py avatar:=alice record:=true."""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from unicon_bringup.graph import (
    GraphConfig,
    choose_nodes,
    default_list,
    parameters_of,
    read_list,
)

DEFAULTS = GraphConfig()
ARGUMENTS = {
    "avatar": (DEFAULTS.avatar, "namespace of everything that belongs to this avatar"),
    "scheduler": (DEFAULTS.scheduler, 'scheduler to start, or "none"'),
    "record": (str(DEFAULTS.record).lower(), "true to record all topics of the avatar"),
    "output": (DEFAULTS.output, "folder of the recording, empty for one named by avatar and time"),
    "slow_motion": (str(DEFAULTS.slow_motion).lower(), "true to slow time down on a slow machine"),
}


def start_nodes(context: LaunchContext) -> list[Node]:
    """Return the launch actions of the chosen nodes."""
    values = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    config = GraphConfig(
        avatar=values["avatar"],
        scheduler=values["scheduler"],
        record=values["record"].lower() == "true",
        output=values["output"],
        slow_motion=values["slow_motion"].lower() == "true",
    )
    return [
        Node(
            package=entry.package,
            executable=entry.executable,
            namespace=config.avatar,
            parameters=[parameters_of(entry, config) or {"use_sim_time": False}],
            output="screen",
        )
        for entry in choose_nodes(read_list(default_list()), config)
    ]


def generate_launch_description() -> LaunchDescription:
    """Declare the arguments and start the nodes."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start_nodes)])
