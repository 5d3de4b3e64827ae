// What a step is told; unicon.train.environment.batch_simulator.kernel has the same fields in the same order.
#pragma once

#include <cstdint>

struct StepOptions {
    int32_t substeps;
    int32_t solves;         // at most, for the forces of contacts and stops in a substep
    int32_t servo;          // 1: the control is the angles that servos aim at, 0: torques
    float timestep;         // of a substep [s]
    float gravity;          // downwards [m/s^2]
    float damping_scale;    // times the hinges' passive damping
    float max_speed;        // a velocity above it counts as a fault [m/s, rad/s]
};
