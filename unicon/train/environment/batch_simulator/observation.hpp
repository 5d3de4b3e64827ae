// The policy's input; unicon/observation.py in lanes, in the order of its OBSERVATION_LAYOUT.
#pragma once

#include "kinematics.hpp"

constexpr int OBSERVATION = 1 + 6 + 3 * (BODIES - 1) + 3 * BODIES + 3 + 2 * HINGES;
constexpr int RELATION = 3 + 6;

// The heading of a body: the turn about the vertical of its forward axis.
struct Heading {
    Lane cos, sin;
};

// Where the forward axis is vertical: the turn that remains when the tilt is taken away.
INLINE Heading heading_of(const Quaternion& q) {
    const Lane x = 1.0f - 2.0f * (q.y * q.y + q.z * q.z), y = 2.0f * (q.x * q.y + q.w * q.z);
    const Lane length2 = x * x + y * y, twist2 = q.w * q.w + q.z * q.z;
    const Mask vertical = length2 < 1e-12f, undefined = twist2 < 1e-30f;
    const Lane scale = 1.0f / square_root(length2);
    const Lane twist_cos = select(undefined, fill(1.0f), (q.w * q.w - q.z * q.z) / twist2);
    const Lane twist_sin = select(undefined, fill(0.0f), 2.0f * q.w * q.z / twist2);
    return {select(vertical, twist_cos, x * scale), select(vertical, twist_sin, y * scale)};
}

INLINE Vec3 into_heading(const Heading& h, const Vec3& v_w) {
    return {h.cos * v_w.x + h.sin * v_w.y, h.cos * v_w.y - h.sin * v_w.x, v_w.z};
}

INLINE void write(const Vec3& v, Lane*& out) { *out++ = v.x, *out++ = v.y, *out++ = v.z; }

// o(X): 197 numbers.
inline void write_observation(const State& state, const Kinematics& bodies, Lane*& out) {
    const Heading heading = heading_of(state.root_quat_w);
    *out++ = state.root_pos_w.z;
    write(into_heading(heading, bodies.body[0].rot.x), out);
    write(into_heading(heading, bodies.body[0].rot.y), out);
    for (int i = 1; i < BODIES; ++i) write(into_heading(heading, bodies.body[i].pos_w), out);
    for (int i = 0; i < BODIES; ++i) write(into_heading(heading, bodies.body[i].lin_vel_w), out);
    write(into_heading(heading, state.root_ang_vel_w), out);
    for (int j = 0; j < HINGES; ++j) *out++ = state.joint_pos[j];
    for (int j = 0; j < HINGES; ++j) *out++ = state.joint_vel[j];
}

// y(X~, X): 9 numbers, the target's root as seen from the actual one.
inline void write_relation(const State& actual, const State& target, Lane*& out) {
    const Heading heading = heading_of(actual.root_quat_w);
    write(into_heading(heading, target.root_pos_w - actual.root_pos_w), out);
    const Rotation turn = to_rotation(multiply(conjugate(actual.root_quat_w), target.root_quat_w));
    write(turn.x, out);
    write(turn.y, out);
}
