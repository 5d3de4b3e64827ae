from setuptools import find_packages, setup

PACKAGE = "unicon_recorder"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + PACKAGE]),
        ("share/" + PACKAGE, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Unicon avatars maintainers",
    maintainer_email="maintainers@unicon-avatars.org",
    description="Records every topic of an avatar into a rosbag2 folder.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "recorder_node = unicon_recorder.recorder_node:main",
        ]
    },
)
