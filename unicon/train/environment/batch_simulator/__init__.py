"""The compiled batch simulator: the humanoid's physics for many environments at once.

C++ in this folder, one idea a file. Numbers: lane.hpp (the vector type), spatial.hpp, tables.hpp. Physics:
state.hpp, kinematics.hpp, hinge.hpp, softness.hpp, contact.hpp, articulated_body.hpp (Featherstone's
algorithm), constraint_solver.hpp, integration.hpp. Results: observation.hpp, tracking_errors.hpp. Calls:
options.hpp, blocks.hpp (threads), kernel.cpp (what Python calls). tables.py writes the humanoid's
constants, build.py compiles, kernel.py loads; simulator.py has ``BatchSimulator``, which callers use.
"""
