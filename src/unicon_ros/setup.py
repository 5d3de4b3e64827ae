from setuptools import find_packages, setup

PACKAGE = "unicon_ros"

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
    description="What the avatar's nodes share: QoS, parameters, conversion, diagnostics, clean exit.",
    license="Apache-2.0",
)
