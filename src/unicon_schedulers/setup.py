from setuptools import find_packages, setup

PACKAGE = "unicon_schedulers"

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
    description="Schedulers: turn clips and live input into target frames.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "dataset_node = unicon_schedulers.dataset_node:main",
            "keyboard_node = unicon_schedulers.keyboard_node:main",
            "stitching_node = unicon_schedulers.stitching_node:main",
            "teleop_keyboard = unicon_schedulers.teleop_keyboard:main",
        ]
    },
)
