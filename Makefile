# Everything a developer types. Each target does its own set-up; the second time that takes a second.

SHELL := bash
PYTHON ?= python3
PYTEST_ARGS ?=
DEMO_ARGS ?=
BENCH_ARGS ?=

.DEFAULT_GOAL := help
.PHONY: help setup demo test check format doctor bench-graph bench-keyboard bench-motions bench-train clean

help: ## show this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 16

setup: ## make .venv and build the ROS workspace
	@$(PYTHON) tools/setup.py base ros

demo: setup ## 20 seconds of a live avatar: bag, video, contact sheet and report in out/demo
	@tools/run ros2 run unicon_bringup demo $(DEMO_ARGS)

test: ## run all tests
	@$(PYTHON) tools/setup.py base ros train dev
	@tools/run python -m pytest $(PYTEST_ARGS)

check: ## style, types and the import contract
	@$(PYTHON) tools/setup.py base ros train dev
	@tools/run ruff format --check .
	@tools/run ruff check .
	@tools/run pyright
	@tools/run lint-imports

format: ## bring the code into the house style
	@$(PYTHON) tools/setup.py base ros dev
	@tools/run ruff format .
	@tools/run ruff check --fix .

doctor: setup ## look whether this machine has what it takes
	@tools/run unicon doctor

bench-graph: setup ## run the graph for 60 s and write out/bench/graph.json
	@tools/run python benchmarks/graph.py

bench-keyboard: setup ## the keyboard scheduler, its reference and the avatar that follows it: out/bench/keyboard.json
	@OMP_NUM_THREADS=1 tools/run python benchmarks/keyboard.py $(BENCH_ARGS)

bench-motions: ## the motion library beside mink, bvhio and upc-pymotion: out/bench/motions_speed.json
	@$(PYTHON) tools/setup.py base ros train dev bench
	@OMP_NUM_THREADS=1 tools/run python benchmarks/motions.py $(if $(MOTIONS),--motions $(MOTIONS)) $(BENCH_ARGS)

bench-train: ## the trainer beside mujoco's rollout and stable-baselines3: out/bench/train.json
	@$(PYTHON) tools/setup.py base ros train dev bench
	@OMP_NUM_THREADS=1 tools/run python benchmarks/training.py $(BENCH_ARGS)

clean: ## remove everything that set-up and runs made
	rm -rf .venv out ros_ws/build ros_ws/install ros_ws/log
