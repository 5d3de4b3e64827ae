// What acts at a hinge: its motor or servo, its passive damping, and its soft limits.
#pragma once

#include "options.hpp"
#include "softness.hpp"
#include "state.hpp"

INLINE Lane clip(Lane x, float bound) { return minimum(maximum(x, fill(-bound)), fill(bound)); }

// Motor: the control is the torque. Servo: stiffness (control - q). Both up to the effort.
INLINE Lane actuate(const HingeTable& hinge, bool servo, Lane control, Lane joint_pos) {
    return clip(servo ? hinge.stiffness * (control - joint_pos) : control, hinge.effort);
}

// The end of a hinge's range, a soft constraint (softness.hpp).
struct HingeStop {
    bool near;          // whether the hinge is beyond its range in any lane; the rest is valid only then
    Lane inwards;       // 1 where it has to turn forwards to come back, else -1
    SoftConstraint constraint;
};

struct HingeStops {
    Softness softness;
    HingeStop stop[HINGES];
};

// Finds the hinges beyond their range; once a substep.
inline void find_stops(const State& state, HingeStops& stops) {
    unroll<HINGES>([&](auto j) INLINE_LAMBDA {
        constexpr const HingeTable& table = HINGE[j];
        HingeStop& stop = stops.stop[j];
        const Lane below = table.lower - state.joint_pos[j];
        const Lane above = state.joint_pos[j] - table.upper;
        const Lane depth = maximum(below, above);
        stop.near = any(depth > 0.0f);
        if (!stop.near) return;
        stop.inwards = select(below > above, fill(1.0f), fill(-1.0f));
        const Lane speed = stop.inwards * state.joint_vel[j];
        stop.constraint = begin(stops.softness, depth, speed, table.inverse_weight);
    });
}

INLINE bool review_stop(Lane acceleration, HingeStop& stop) {
    return stop.near && review(stop.inwards * acceleration, stop.constraint);
}
