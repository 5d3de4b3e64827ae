// Forward dynamics: Featherstone's articulated-body algorithm (RBDA, 2008, section 7.3, table 7.1).
//
// Pass 1 goes outwards and finds the velocities (kinematics.hpp). Pass 2 goes inwards: what a body and
// all that it carries feel like from its parent, as an articulated inertia I^A and a bias force p^A.
// Pass 3 goes outwards again and finds the accelerations. The names are those of the book's table:
//
//     pass 2   U = I^A S    D = S^T U    u = tau - S^T p^A
//              I^a = I^A - U D^-1 U^T
//              p^a = p^A + I^a c + U D^-1 u
//              I^A_parent += X* I^a X     p^A_parent += X* p^a
//     pass 3   a' = X a_parent + c
//              ddq = D^-1 (u - U^T a')
//              a = a' + S ddq
//
// A hinge has S = (axis, 0) and c = (w x axis dq, 0). Armature, implicit damping and stops of the hinge
// belong to D and tau (hinge.hpp), contacts to I^A and p^A (contact.hpp). X is the shift along the arm
// (spatial.hpp); since accelerations are classical, the shift itself brings c = (0, w x (w x arm)).
#pragma once

#include "contact.hpp"
#include "hinge.hpp"

// Contacts and stops are soft constraints and the damping is left out, or they are the forces that were found
// and the damping is implicit; constraint_solver.hpp says why.
enum class Stage { SOFT, DAMPED };

struct HingeSolution {
    Spatial force;          // U
    Vec3 drift;             // angular part of c
    Lane inverse_pivot;     // 1 / D
    Lane residual;          // u
    Lane acceleration;      // ddq
};

struct Dynamics {
    const StepOptions& options;
    const Lane* control;                            // of each hinge
    const State& state;
    Kinematics bodies;
    Floor floor;
    HingeStops stops;
    HingeSolution hinge[HINGES];
    ArticulatedInertia carried_inertia[BODIES];     // X* I^a X of each body, for its parent
    Spatial carried_bias[BODIES];                   // X* p^a
    Spatial acceleration[BODIES];                   // a
    Spatial velocity_product[BODIES];               // a where all ddq are zero: what velocities alone bring
    bool constrained_below[BODIES];                 // whether a contact or stop acts, in any lane, on the
                                                    // body, its hinges or what it carries

    Dynamics(const StepOptions& options, const Lane* control, const State& state)
        : options(options), control(control), state(state) {
        floor.softness = soften(CONTACT_SOFTNESS, options.timestep);
        stops.softness = soften(LIMIT_SOFTNESS, options.timestep);
    }
};

// The body by itself, with J about its origin, h = mass x centre of mass, and its weight:
//     I = [J [h]; [h]^T m],   p = (w x J w - h x g, w x (w x h) - m g)
template <int BODY_INDEX>
INLINE void weigh(const Body& body, float gravity, ArticulatedInertia& inertia, Spatial& bias) {
    constexpr const BodyTable& table = BODY[BODY_INDEX];
    constexpr const float (&i)[6] = table.inertia;
    const Rotation& r = body.rot;
    const Vec3 x = r.x * i[0] + (i[3] != 0 ? r.y * i[3] : Vec3{}) + (i[4] != 0 ? r.z * i[4] : Vec3{});
    const Vec3 y = r.y * i[1] + (i[3] != 0 ? r.x * i[3] : Vec3{}) + (i[5] != 0 ? r.z * i[5] : Vec3{});
    const Vec3 z = r.z * i[2] + (i[4] != 0 ? r.x * i[4] : Vec3{}) + (i[5] != 0 ? r.y * i[5] : Vec3{});
    inertia.a = {x.x * r.x.x + y.x * r.y.x + z.x * r.z.x, x.y * r.x.y + y.y * r.y.y + z.y * r.z.y,
                 x.z * r.x.z + y.z * r.y.z + z.z * r.z.z, x.x * r.x.y + y.x * r.y.y + z.x * r.z.y,
                 x.x * r.x.z + y.x * r.y.z + z.x * r.z.z, x.y * r.x.z + y.y * r.y.z + z.y * r.z.z};
    const Vec3 h = rotate(r, table.moment);
    const Lane m = fill(table.mass), zero{};
    inertia.b = {{zero, -h.z, h.y}, {h.z, zero, -h.x}, {-h.y, h.x, zero}};
    inertia.c = {m, m, m, zero, zero, zero};
    const Vec3& w = body.ang_vel_w;
    bias.angular = cross(w, inertia.a * w) + Vec3{h.y, -h.x, zero} * gravity;
    bias.linear = cross(w, cross(w, h)) + Vec3{zero, zero, m * gravity};
}

struct HingeLoad {
    Lane torque, inertia;       // tau, and what is added to S^T I^A S
};

// Actuator and damping, with the velocity dq + h ddq that the substep ends with when it is implicit, and
// the stop, soft or as the force that was found.
template <Stage STAGE, int HINGE_INDEX>
INLINE HingeLoad load_hinge(const Dynamics& work) {
    constexpr const HingeTable& table = HINGE[HINGE_INDEX];
    const Lane q = work.state.joint_pos[HINGE_INDEX], dq = work.state.joint_vel[HINGE_INDEX];
    const float damping = table.damping * work.options.damping_scale;
    const Lane actuator = actuate(table, work.options.servo, work.control[HINGE_INDEX], q);
    HingeLoad load = {actuator - damping * dq, fill(table.armature)};
    if (STAGE == Stage::DAMPED) load.inertia += work.options.timestep * damping;
    const HingeStop& stop = work.stops.stop[HINGE_INDEX];
    if (!stop.near) return load;
    const SoftConstraint& constraint = stop.constraint;
    if (STAGE == Stage::SOFT) {
        const Lane mass = select(constraint.pushing, constraint.virtual_mass, Lane{});
        load.inertia += mass;
        load.torque += stop.inwards * mass * constraint.drive;
    } else {
        load.torque += stop.inwards * constraint.force;
    }
    return load;
}

// Takes one hinge out of the inertia and bias that it carries (pass 2). `ang_vel_w` is that after the
// hinge, and before it on return.
template <Stage STAGE, int HINGE_INDEX>
INLINE void fold_hinge(Dynamics& work, ArticulatedInertia& inertia, Spatial& bias, Vec3& ang_vel_w) {
    HingeSolution& hinge = work.hinge[HINGE_INDEX];
    const Vec3& axis = work.bodies.hinge_axis_w[HINGE_INDEX];
    const Vec3 spin = axis * work.state.joint_vel[HINGE_INDEX];
    hinge.drift = cross(ang_vel_w, spin);
    ang_vel_w = ang_vel_w - spin;
    const HingeLoad load = load_hinge<STAGE, HINGE_INDEX>(work);
    hinge.force = {inertia.a * axis, transposed_times(inertia.b, axis)};
    hinge.inverse_pivot = 1.0f / (dot(axis, hinge.force.angular) + load.inertia);
    hinge.residual = load.torque - dot(axis, bias.angular);
    const Spatial scaled = hinge.force * hinge.inverse_pivot;
    subtract_outer(inertia, hinge.force, scaled);
    const Spatial carried = {inertia.a * hinge.drift, transposed_times(inertia.b, hinge.drift)};
    bias = bias + carried + scaled * hinge.residual;
}

// I^A and p^A of a body: its own, its contacts', and those of the bodies that it carries.
template <Stage STAGE, int BODY_INDEX>
INLINE void gather(const Dynamics& work, ArticulatedInertia& inertia, Spatial& bias) {
    weigh<BODY_INDEX>(work.bodies.body[BODY_INDEX], work.options.gravity, inertia, bias);
    if (STAGE == Stage::SOFT)
        press_body<BODY_INDEX>(work.floor, work.velocity_product[BODY_INDEX], inertia, bias);
    else
        push_body<BODY_INDEX>(work.floor, bias);
    unroll<BODIES>([&](auto i) INLINE_LAMBDA {
        if constexpr (BODY[i].parent == BODY_INDEX) {
            add(inertia, work.carried_inertia[i]);
            bias = bias + work.carried_bias[i];
        }
    });
}

// Pass 2 for a body, after those that it carries.
template <Stage STAGE, int BODY_INDEX>
inline void carry(Dynamics& work) {
    constexpr const BodyTable& table = BODY[BODY_INDEX];
    const Body& body = work.bodies.body[BODY_INDEX];
    ArticulatedInertia inertia;
    Spatial bias;
    gather<STAGE, BODY_INDEX>(work, inertia, bias);
    Vec3 ang_vel_w = body.ang_vel_w;
    unroll<table.hinge_count>([&](auto k) INLINE_LAMBDA {
        constexpr int hinge = table.first_hinge + table.hinge_count - 1 - k;
        fold_hinge<STAGE, hinge>(work, inertia, bias, ang_vel_w);
    });
    const Vec3 swing = cross(ang_vel_w, cross(ang_vel_w, body.arm_w));
    bias = bias + Spatial{inertia.b * swing, inertia.c * swing};
    work.carried_inertia[BODY_INDEX] = shift(inertia, body.arm_w);
    work.carried_bias[BODY_INDEX] = shift(bias, body.arm_w);
}

// Solves I^A a = -p^A for the free root: Gaussian elimination without pivoting, since I^A is positive
// definite.
inline Spatial solve_root(const ArticulatedInertia& inertia, const Spatial& bias) {
    const auto& [a, b, c] = inertia;
    Lane m[6][6] = {{a.xx, a.xy, a.xz, b.x.x, b.x.y, b.x.z}, {a.xy, a.yy, a.yz, b.y.x, b.y.y, b.y.z},
                    {a.xz, a.yz, a.zz, b.z.x, b.z.y, b.z.z}, {b.x.x, b.y.x, b.z.x, c.xx, c.xy, c.xz},
                    {b.x.y, b.y.y, b.z.y, c.xy, c.yy, c.yz}, {b.x.z, b.y.z, b.z.z, c.xz, c.yz, c.zz}};
    Lane x[6] = {-bias.angular.x, -bias.angular.y, -bias.angular.z,
                 -bias.linear.x, -bias.linear.y, -bias.linear.z};
    for (int k = 0; k < 6; ++k)
        for (int i = k + 1; i < 6; ++i) {
            const Lane factor = m[i][k] / m[k][k];
            for (int j = k; j < 6; ++j) m[i][j] -= factor * m[k][j];
            x[i] -= factor * x[k];
        }
    for (int k = 5; k >= 0; --k) {
        for (int j = k + 1; j < 6; ++j) x[k] -= m[k][j] * x[j];
        x[k] /= m[k][k];
    }
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

// a' = X a_parent + c without the hinges' part of c.
template <int BODY_INDEX>
INLINE Spatial carry_acceleration(const Kinematics& bodies, const Spatial& parent) {
    const Vec3& arm_w = bodies.body[BODY_INDEX].arm_w;
    const Vec3& w = bodies.body[BODY[BODY_INDEX].parent].ang_vel_w;
    return {parent.angular, linear_at(parent, arm_w) + cross(w, cross(w, arm_w))};
}

// Pass 3 for a body, after its parent.
template <int BODY_INDEX>
inline void accelerate(Dynamics& work) {
    constexpr const BodyTable& table = BODY[BODY_INDEX];
    Spatial a = carry_acceleration<BODY_INDEX>(work.bodies, work.acceleration[table.parent]);
    unroll<table.hinge_count>([&](auto k) INLINE_LAMBDA {
        constexpr int index = table.first_hinge + k;
        HingeSolution& hinge = work.hinge[index];
        a.angular = a.angular + hinge.drift;
        hinge.acceleration = (hinge.residual - dot(hinge.force, a)) * hinge.inverse_pivot;
        a.angular = a.angular + work.bodies.hinge_axis_w[index] * hinge.acceleration;
    });
    work.acceleration[BODY_INDEX] = a;
}

// The sum of a body's c: w x (w - w_parent) for each hinge, w growing from one to the next.
template <int BODY_INDEX>
inline void find_velocity_product(Dynamics& work) {
    constexpr const BodyTable& table = BODY[BODY_INDEX];
    Spatial a = carry_acceleration<BODY_INDEX>(work.bodies, work.velocity_product[table.parent]);
    Vec3 w = work.bodies.body[table.parent].ang_vel_w;
    unroll<table.hinge_count>([&](auto k) INLINE_LAMBDA {
        constexpr int hinge = table.first_hinge + k;
        const Vec3 spin = work.bodies.hinge_axis_w[hinge] * work.state.joint_vel[hinge];
        a.angular = a.angular + cross(w, spin);
        w = w + spin;
    });
    work.velocity_product[BODY_INDEX] = a;
}

// Passes 2 and 3. With `anew` false, only what leads to a contact or stop is gathered again: in a further
// solve of the same stage nothing else has changed.
template <Stage STAGE>
inline void solve(bool anew, Dynamics& work) {
    unroll<BODIES - 1>([&](auto k) INLINE_LAMBDA {
        constexpr int body = BODIES - 1 - k;
        if (anew || work.constrained_below[body]) carry<STAGE, body>(work);
    });
    ArticulatedInertia inertia;
    Spatial bias;
    gather<STAGE, 0>(work, inertia, bias);
    work.acceleration[0] = solve_root(inertia, bias);
    unroll<BODIES - 1>([&](auto k) INLINE_LAMBDA { accelerate<k + 1>(work); });
}
