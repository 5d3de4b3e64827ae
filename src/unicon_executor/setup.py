from setuptools import find_packages, setup

PACKAGE = "unicon_executor"

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
    description="Simulates one avatar that follows target frames at 60 Hz.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "executor_node = unicon_executor.executor_node:main",
        ]
    },
)
