from glob import glob

from setuptools import find_packages, setup

PACKAGE = "unicon_bringup"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + PACKAGE]),
        ("share/" + PACKAGE, ["package.xml"]),
        ("share/" + PACKAGE + "/config", glob("config/*.yaml")),
        ("share/" + PACKAGE + "/launch", glob("launch/*.launch.py")),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Unicon avatars maintainers",
    maintainer_email="maintainers@unicon-avatars.org",
    description="Starts the nodes of an avatar together.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "avatar = unicon_bringup.avatar:main",
            "demo = unicon_bringup.demo:main",
            "health = unicon_bringup.health:main",
        ]
    },
)
