// The five squared tracking errors; unicon/reward.py in lanes, in the order of its TrackingErrors.
#pragma once

#include "observation.hpp"

constexpr int ERRORS = 5;
constexpr float JOINTS = BODIES - 1;

INLINE Lane square(const Vec3& v) { return dot(v, v); }

// angle(a^-1 b)^2, the angle being 2 atan2(|vector part|, |w|).
INLINE Lane squared_angle(const Quaternion& a, const Quaternion& b) {
    const Quaternion turn = multiply(conjugate(a), b);
    const Lane sine = square_root(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
    const Lane angle = 2.0f * arc_tangent_of_positive(sine, absolute(turn.w));
    return angle * angle;
}

template <int AXIS>
INLINE Quaternion about_axis(Lane angle) {
    const SinCos half = sine_cosine(0.5f * angle);
    const Lane zero{};
    if constexpr (AXIS == 0) return {half.cos, half.sin, zero, zero};
    else if constexpr (AXIS == 1) return {half.cos, zero, half.sin, zero};
    else return {half.cos, zero, zero, half.sin};
}

// A body's rotation against its parent: the product of its hinges.
template <int BODY_INDEX>
INLINE Quaternion local_rotation(const State& state) {
    constexpr const BodyTable& table = BODY[BODY_INDEX];
    Quaternion q = about_axis<HINGE[table.first_hinge].axis>(state.joint_pos[table.first_hinge]);
    unroll<table.hinge_count - 1>([&](auto k) INLINE_LAMBDA {
        constexpr int hinge = table.first_hinge + 1 + k;
        q = multiply(q, about_axis<HINGE[hinge].axis>(state.joint_pos[hinge]));
    });
    return q;
}

// A body's angular velocity against its parent, in the parent's frame.
template <int BODY_INDEX>
INLINE Vec3 local_spin(const Kinematics& bodies) {
    const Body& parent = bodies.body[BODY[BODY_INDEX].parent];
    return rotate_inverse(parent.rot, bodies.body[BODY_INDEX].ang_vel_w - parent.ang_vel_w);
}

inline void measure_errors(const State& actual, const Kinematics& bodies, const State& target,
                           const Kinematics& aims, Lane* errors) {
    const Heading heading = heading_of(actual.root_quat_w), aimed_heading = heading_of(target.root_quat_w);
    Lane position{}, rotation{}, velocity{};
    unroll<BODIES - 1>([&](auto k) INLINE_LAMBDA {
        constexpr int i = k + 1;
        position += square(into_heading(aimed_heading, aims.body[i].pos_w)
                           - into_heading(heading, bodies.body[i].pos_w));
        rotation += squared_angle(local_rotation<i>(actual), local_rotation<i>(target));
        velocity += square(local_spin<i>(aims) - local_spin<i>(bodies));
    });
    errors[0] = square(target.root_pos_w - actual.root_pos_w);
    errors[1] = squared_angle(actual.root_quat_w, target.root_quat_w);
    errors[2] = position / JOINTS;
    errors[3] = rotation / JOINTS;
    errors[4] = velocity / JOINTS;
}
