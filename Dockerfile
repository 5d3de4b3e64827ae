# One image for every node: the same requirement files and the same set-up as on a laptop.
#
#   docker build -t unicon-avatars .
#   docker run --rm -it --ipc=host --network=host unicon-avatars ros2 pkg executables
#
# Slim carries Python with its headers; a compiler builds the messages, Mesa draws without a screen.
FROM python:3.12-slim-bookworm

RUN apt-get update \
 && apt-get install --yes --no-install-recommends g++ make libegl1 libgl1-mesa-dri \
 && rm -rf /var/lib/apt/lists/*

# Volumes take over the owner of the folder they are mounted on, hence the two empty ones.
RUN useradd --create-home --uid 1000 unicon \
 && mkdir -p /unicon /recordings /home/unicon/.cache/unicon \
 && chown -R unicon:unicon /unicon /recordings /home/unicon/.cache

USER unicon
WORKDIR /unicon
COPY --chown=unicon:unicon . .

# pip's cache is shared between builds and stays out of the image.
RUN --mount=type=cache,target=/home/unicon/.cache/pip,uid=1000,gid=1000 \
    python tools/setup.py base ros

ENV PYTHONUNBUFFERED=1
ENTRYPOINT ["/unicon/tools/run"]
CMD ["bash"]
