// A tick: substeps of dynamics and semi-implicit Euler, as MuJoCo integrates.
#pragma once

#include "constraint_solver.hpp"

// dq += h ddq, then q += h dq; the root turns by exp(h w).
INLINE void integrate(const Dynamics& work, float h, State& state) {
    const Spatial& root = work.acceleration[0];
    state.root_lin_vel_w = state.root_lin_vel_w + root.linear * h;
    state.root_ang_vel_w = state.root_ang_vel_w + root.angular * h;
    state.root_pos_w = state.root_pos_w + state.root_lin_vel_w * h;
    const Vec3 half_turn = state.root_ang_vel_w * (0.5f * h);
    const Lane half_angle = square_root(dot(half_turn, half_turn));
    const SinCos wave = sine_cosine(half_angle);
    const Vec3 u = half_turn * select(half_angle > 1e-6f, wave.sin / half_angle, fill(1.0f));
    state.root_quat_w = normalize(multiply({wave.cos, u.x, u.y, u.z}, state.root_quat_w));
    for (int j = 0; j < HINGES; ++j) {
        state.joint_vel[j] += h * work.hinge[j].acceleration;
        state.joint_pos[j] += h * state.joint_vel[j];
    }
}

inline void tick(const Lane* control, const StepOptions& options, State& state) {
    Dynamics work(options, control, state);
    for (int i = 0; i < options.substeps; ++i) {
        find_accelerations(work);
        integrate(work, options.timestep, state);
    }
}

// Whether every number is finite and no velocity too high; comparisons with NaN are false.
INLINE Mask is_sound(const State& state, float max_speed) {
    const Lane* numbers = &state.root_pos_w.x;
    constexpr int velocities = 7, angles = 13, rates = 13 + HINGES;
    Mask sound = Mask{} == 0;
    for (int k = 0; k < ROW; ++k) {
        const bool is_velocity = (k >= velocities && k < angles) || k >= rates;
        sound &= absolute(numbers[k]) <= (is_velocity ? max_speed : 1e30f);
    }
    return sound;
}
