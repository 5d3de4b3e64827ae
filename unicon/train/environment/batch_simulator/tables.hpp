// The humanoid as constants: the types are here, the numbers in humanoid.hpp, which tables.py writes
// from the one definition (unicon.humanoid) and the compiled MuJoCo model before the build.
#pragma once

struct BodyTable {
    int parent;
    float offset[3];        // origin in the parent's frame [m]
    float mass;             // [kg]
    float moment[3];        // mass times centre of mass, in the body's frame [kg m]
    float inertia[6];       // about the body's ORIGIN, in its axes: xx yy zz xy xz yz [kg m^2]
    float inverse_weight;   // MuJoCo's body_invweight0: inverse of the mass felt at the body [1/kg]
    int first_hinge, hinge_count;
};

struct HingeTable {
    int axis;                              // 0 x, 1 y, 2 z of the body's frame before the hinge turns
    float lower, upper;                    // [rad]
    float effort;                          // largest torque [N m]
    float stiffness;                       // of the servo [N m/rad]
    float damping;                         // passive [N m s/rad]
    float armature;                        // [kg m^2]
    float inverse_weight;                  // MuJoCo's dof_invweight0 [1/(kg m^2)]
};

struct CapsuleTable {
    int body;
    float end[2][3];        // centres of both ends, in the body's frame [m]
    float radius;           // [m]
};

// A box or an ellipsoid: its centre and three half axes, in the body's frame [m].
struct SolidTable {
    int body;
    float centre[3];
    float half_axis[3][3];
};

// MuJoCo's solref (time constant [s], damping ratio) and solimp (from, to, width).
struct SoftnessTable {
    float time_constant, damping_ratio;
    float impedance_from, impedance_to, impedance_width;
};

#include "humanoid.hpp"
