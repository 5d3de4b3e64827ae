// The accelerations of a substep, with the forces of contacts and joint stops.
//
// As in MuJoCo's implicitfast, these forces are found without the implicit damping, and then the motion is
// found with it under these forces:
//     SOFT     contacts and stops are soft constraints; D has the armature. Solved until those that push are
//              those that were taken to push, which is Newton's method on MuJoCo's convex problem.
//     DAMPED   contacts and stops are the forces of the last solve; D has the armature and h times damping.
#pragma once

#include "articulated_body.hpp"

// Finds where contacts and stops act; once a substep. Whether any does in any lane.
inline bool find_constraints(Dynamics& work) {
    find_contacts(work.bodies, work.state.root_pos_w.z, work.floor);
    find_stops(work.state, work.stops);
    for (int i = 0; i < BODIES; ++i) {
        work.constrained_below[i] = work.floor.touched[i];
        for (int k = 0; k < BODY[i].hinge_count; ++k)
            work.constrained_below[i] |= work.stops.stop[BODY[i].first_hinge + k].near;
    }
    for (int i = BODIES - 1; i > 0; --i)
        if (work.constrained_below[i]) work.constrained_below[BODY[i].parent] = true;
    return work.constrained_below[0];
}

// After a solve: whether any contact or stop in any lane has to be another one in the next.
inline bool review_constraints(Dynamics& work) {
    bool changed = false;
    unroll<BODIES>([&](auto i) INLINE_LAMBDA {
        changed |= review_contacts<i>(work.acceleration[i] - work.velocity_product[i], work.floor);
    });
    for (int j = 0; j < HINGES; ++j) changed |= review_stop(work.hinge[j].acceleration, work.stops.stop[j]);
    return changed;
}

// A lane that has settled stays the same, to the bit, in the solves that its neighbours still need.
inline void find_forces(Dynamics& work) {
    work.velocity_product[0] = Spatial{};
    unroll<BODIES - 1>([&](auto k) INLINE_LAMBDA { find_velocity_product<k + 1>(work); });
    bool changed = true;
    for (int count = 0; changed && count < work.options.solves; ++count) {
        solve<Stage::SOFT>(count == 0, work);
        changed = review_constraints(work);
    }
}

// Accelerations of the root and of all hinges.
inline void find_accelerations(Dynamics& work) {
    place_all(work.state, work.bodies);
    if (find_constraints(work)) find_forces(work);
    solve<Stage::DAMPED>(true, work);
}
