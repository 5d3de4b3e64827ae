// MuJoCo's soft constraints, in a form that the articulated-body algorithm can carry.
//
// MuJoCo (documentation, "Computation", Solver parameters) lets a constraint that is violated by the depth
// r > 0, and from which the body moves out with the speed v, push outwards with
//     f = D (drive - acceleration) >= 0,    drive = k d(r) r - b v,    D = d(r) / (1 - d(r)) / w
// where w is the inverse mass that the constraint feels in the zero pose, d the impedance, and k and b
// follow from solref. Where it pushes, f is linear in the acceleration: a force D drive and a virtual mass
// D, which is added to the inertia. Which constraints push is not known beforehand: in the first solve
// those with a drive outwards do, in each further one those whose force was positive (an active-set
// method; the drive alone is right but for bodies that are pressed or torn by others).
#pragma once

#include "lane.hpp"
#include "tables.hpp"

struct Softness {
    float stiffness, damping;       // k [1/s^2] and b [1/s]
    SoftnessTable table;
};

// k and b; as in MuJoCo the time constant is at least two substeps.
inline Softness soften(const SoftnessTable& table, float timestep) {
    const float time = table.time_constant > 2.0f * timestep ? table.time_constant : 2.0f * timestep;
    const float rate = 1.0f / (table.impedance_to * time);
    const float ratio = 1.0f / table.damping_ratio;
    return {rate * rate * ratio * ratio, 2.0f * rate, table};
}

// d(r): from the first to the second value over the width, as two parabolas.
INLINE Lane impedance(const SoftnessTable& table, Lane depth) {
    const Lane x = minimum(depth * (1.0f / table.impedance_width), fill(1.0f));
    const Lane rest = 1.0f - x;
    const Lane share = select(x < 0.5f, 2.0f * x * x, 1.0f - 2.0f * rest * rest);
    return table.impedance_from + (table.impedance_to - table.impedance_from) * share;
}

struct SoftConstraint {
    Mask violated, pushing;
    Lane virtual_mass, drive;       // D and the drive; finite also where nothing is violated
    Lane force;                     // of the last solve
};

INLINE SoftConstraint begin(const Softness& soft, Lane depth, Lane speed, float inverse_weight) {
    const Lane d = impedance(soft.table, maximum(depth, Lane{}));
    const Lane drive = soft.stiffness * d * maximum(depth, Lane{}) - soft.damping * speed;
    const Mask violated = depth > 0.0f;
    return {violated, violated & (drive > 0.0f), d / ((1.0f - d) * inverse_weight), drive, Lane{}};
}

// After a solve: the force that it had where it pushed (never a pull), and where it should push next.
// Whether that differs in any lane.
INLINE bool review(Lane acceleration, SoftConstraint& constraint) {
    const Lane force = constraint.virtual_mass * (constraint.drive - acceleration);
    const Mask pushed = constraint.pushing, outwards = force > 0.0f;
    constraint.force = select(pushed & outwards, force, Lane{});
    constraint.pushing = constraint.violated & outwards;
    return any(constraint.pushing != pushed);
}
