// Where the bodies are and how fast they move; unicon/humanoid/kinematics.py in lanes.
//
// Outwards through the tree, with R the rotation of a body, o its offset in the parent's frame, and its
// hinges one after the other:
//     arm = R_p o      x = x_p + arm      v = v_p + w_p x arm
//     per hinge:  axis = R e,   w += axis dq,   R = R turn(e, q)
#pragma once

#include "state.hpp"

struct Body {
    Rotation rot;       // world from body
    Vec3 arm_w;         // from the parent's origin to this body's
    Vec3 pos_w;         // origin, relative to the root's
    Vec3 ang_vel_w;
    Vec3 lin_vel_w;     // of the origin
};

struct Kinematics {
    Body body[BODIES];
    Vec3 hinge_axis_w[HINGES];
};

INLINE void place_root(const State& state, Kinematics& out) {
    out.body[0] = {to_rotation(state.root_quat_w), Vec3{}, Vec3{}, state.root_ang_vel_w,
                   state.root_lin_vel_w};
}

template <int BODY_INDEX>
INLINE void place_body(const State& state, Kinematics& out) {
    constexpr const BodyTable& table = BODY[BODY_INDEX];
    const Body& parent = out.body[table.parent];
    const Vec3 arm_w = rotate(parent.rot, table.offset);
    const Vec3 lin_vel_w = parent.lin_vel_w + cross(parent.ang_vel_w, arm_w);
    Rotation rot = parent.rot;
    Vec3 ang_vel_w = parent.ang_vel_w;
    unroll<table.hinge_count>([&](auto k) INLINE_LAMBDA {
        constexpr int hinge = table.first_hinge + k;
        constexpr int axis = HINGE[hinge].axis;
        out.hinge_axis_w[hinge] = axis_of<axis>(rot);
        ang_vel_w = ang_vel_w + axis_of<axis>(rot) * state.joint_vel[hinge];
        rot = turn<axis>(rot, sine_cosine(state.joint_pos[hinge]));
    });
    out.body[BODY_INDEX] = {rot, arm_w, parent.pos_w + arm_w, ang_vel_w, lin_vel_w};
}

inline void place_all(const State& state, Kinematics& out) {
    place_root(state, out);
    unroll<BODIES - 1>([&](auto k) INLINE_LAMBDA { place_body<k + 1>(state, out); });
}
