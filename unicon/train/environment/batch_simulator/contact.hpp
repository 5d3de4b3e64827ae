// Contacts of the solid shapes with the floor z = 0, at the points that MuJoCo takes: both ends of a
// capsule, the four lower corners of a box, the lowest point of an ellipsoid.
//
// As in MuJoCo the cone of friction is a pyramid with four edges e = (mu t, 1), for the horizontal
// directions t along and across a capsule, or of x and y for the other shapes. Each edge is a soft
// constraint of its own (softness.hpp), which pushes along e:
//     f = sum_e f_e e,    f_e = D (drive_e - e . a) >= 0,    w_e = 2 mu^2 (1 + mu^2) w
// with a the acceleration of the point, less the part that velocities alone bring. All four push where a
// contact sticks, two or three where it slides. With M = D sum_e e e^T over those that push,
//     f = f_0 - M a,    f_0 = sum_e D drive_e e
#pragma once

#include "kinematics.hpp"
#include "softness.hpp"

constexpr int EDGES = 4;
constexpr int BOX_CORNERS = 4;
constexpr int FIRST_BOX_POINT = 2 * CAPSULES;
constexpr int FIRST_ELLIPSOID_POINT = FIRST_BOX_POINT + BOX_CORNERS * BOXES;
constexpr int POINTS = FIRST_ELLIPSOID_POINT + ELLIPSOIDS;

struct ContactPoint {
    bool near;                      // whether it touches in any lane; the rest is valid only then
    Vec3 offset_w;                  // from the body's origin
    Vec3 edge_w[EDGES];             // e
    SoftConstraint soft[EDGES];
};

struct Floor {
    Softness softness;
    ContactPoint point[POINTS];
    bool touched[BODIES];           // whether any point of the body touches in any lane
};

// Calls visit(number of the point) for each contact point of a body.
template <int BODY_INDEX, class F>
INLINE void for_each_point(F&& visit) {
    unroll<CAPSULES>([&](auto i) INLINE_LAMBDA {
        if constexpr (CAPSULE[i].body == BODY_INDEX) {
            visit(std::integral_constant<int, 2 * i>{});
            visit(std::integral_constant<int, 2 * i + 1>{});
        }
    });
    unroll<BOXES>([&](auto i) INLINE_LAMBDA {
        if constexpr (BOX[i].body == BODY_INDEX)
            unroll<BOX_CORNERS>([&](auto k) INLINE_LAMBDA {
                visit(std::integral_constant<int, FIRST_BOX_POINT + BOX_CORNERS * i + k>{});
            });
    });
    unroll<ELLIPSOIDS>([&](auto i) INLINE_LAMBDA {
        if constexpr (ELLIPSOID[i].body == BODY_INDEX)
            visit(std::integral_constant<int, FIRST_ELLIPSOID_POINT + i>{});
    });
}

// The lower one of two opposite corners: centre +- (x, +y or -y, +z or -z).
template <int CORNER>
INLINE Vec3 box_corner(const SolidTable& box, const Rotation& rot) {
    const Vec3 x = rotate(rot, box.half_axis[0]);
    const Vec3 y = rotate(rot, box.half_axis[1]) * ((CORNER & 1) ? -1.0f : 1.0f);
    const Vec3 z = rotate(rot, box.half_axis[2]) * ((CORNER & 2) ? -1.0f : 1.0f);
    const Vec3 corner = x + y + z;
    const Lane sign = select(corner.z > 0.0f, fill(-1.0f), fill(1.0f));
    return rotate(rot, box.centre) + corner * sign;
}

// centre - sum_i e_i (e_i . up) / sqrt(sum_i (e_i . up)^2), e_i the half axes.
INLINE Vec3 lowest_of_ellipsoid(const SolidTable& ellipsoid, const Rotation& rot) {
    const Vec3 x = rotate(rot, ellipsoid.half_axis[0]);
    const Vec3 y = rotate(rot, ellipsoid.half_axis[1]);
    const Vec3 z = rotate(rot, ellipsoid.half_axis[2]);
    const Lane reach = square_root(x.z * x.z + y.z * y.z + z.z * z.z);
    return rotate(rot, ellipsoid.centre) - (x * x.z + y * y.z + z * z.z) * (1.0f / reach);
}

// The lowest point of the shape there, relative to the body's origin.
template <int POINT>
INLINE Vec3 lowest_point(const Rotation& rot) {
    if constexpr (POINT < FIRST_BOX_POINT) {
        constexpr const CapsuleTable& capsule = CAPSULE[POINT / 2];
        Vec3 point = rotate(rot, capsule.end[POINT % 2]);
        point.z -= capsule.radius;
        return point;
    } else if constexpr (POINT < FIRST_ELLIPSOID_POINT) {
        constexpr int corner = POINT - FIRST_BOX_POINT;
        return box_corner<corner % BOX_CORNERS>(BOX[corner / BOX_CORNERS], rot);
    } else {
        return lowest_of_ellipsoid(ELLIPSOID[POINT - FIRST_ELLIPSOID_POINT], rot);
    }
}

// t, not yet of unit length.
template <int POINT>
INLINE Vec3 first_direction(const Rotation& rot) {
    if constexpr (POINT >= FIRST_BOX_POINT) return {fill(1.0f), Lane{}, Lane{}};
    else return rotate(rot, CAPSULE[POINT / 2].end[0]) - rotate(rot, CAPSULE[POINT / 2].end[1]);
}

// Where t is nearly vertical any direction will do; x is taken.
INLINE void set_edges(const Vec3& direction, ContactPoint& contact) {
    constexpr float mu = CONTACT_FRICTION;
    const Lane length2 = direction.x * direction.x + direction.y * direction.y;
    const Mask vertical = length2 < 1e-12f;
    const Lane scale = mu / square_root(length2);
    const Lane x = select(vertical, fill(mu), direction.x * scale);
    const Lane y = select(vertical, Lane{}, direction.y * scale);
    const Lane up = fill(1.0f);
    contact.edge_w[0] = {x, y, up}, contact.edge_w[1] = {-x, -y, up};
    contact.edge_w[2] = {-y, x, up}, contact.edge_w[3] = {y, -x, up};
}

template <int BODY_INDEX, int POINT>
INLINE void find_point(const Body& body, Lane origin_height, Floor& floor) {
    ContactPoint& contact = floor.point[POINT];
    Vec3 offset_w = lowest_point<POINT>(body.rot);
    const Lane depth = -(origin_height + offset_w.z);
    contact.near = any(depth > 0.0f);
    if (!contact.near) return;
    floor.touched[BODY_INDEX] = true;
    offset_w.z += 0.5f * depth;     // MuJoCo puts the contact half way between the surfaces
    contact.offset_w = offset_w;
    set_edges(first_direction<POINT>(body.rot), contact);
    constexpr float mu = CONTACT_FRICTION;
    constexpr float inverse_weight = 2.0f * mu * mu * (1.0f + mu * mu) * BODY[BODY_INDEX].inverse_weight;
    const Vec3 vel_w = body.lin_vel_w + cross(body.ang_vel_w, offset_w);
    for (int e = 0; e < EDGES; ++e)
        contact.soft[e] = begin(floor.softness, depth, dot(contact.edge_w[e], vel_w), inverse_weight);
}

// Finds the contacts of all bodies; once a substep.
inline void find_contacts(const Kinematics& bodies, Lane root_height, Floor& floor) {
    unroll<BODIES>([&](auto i) INLINE_LAMBDA {
        const Body& body = bodies.body[i];
        floor.touched[i] = false;
        for_each_point<i>([&](auto point) INLINE_LAMBDA {
            find_point<i, point>(body, root_height + body.pos_w.z, floor);
        });
    });
}

INLINE void add_outer(Symmetric3& sum, Lane mass, const Vec3& e) {
    const Vec3 m = e * mass;
    sum.xx += m.x * e.x, sum.yy += m.y * e.y, sum.zz += m.z * e.z;
    sum.xy += m.x * e.y, sum.xz += m.x * e.z, sum.yz += m.y * e.z;
}

// Adds a contact, soft, to the body's inertia and bias force: M at its point, and -f_0. Where
// the velocities alone accelerate the point by a_v, M (a - a_v) is what counts.
INLINE void press(const ContactPoint& contact, const Spatial& velocity_product, ArticulatedInertia& inertia,
                  Spatial& bias) {
    const Vec3 from_velocity = linear_at(velocity_product, contact.offset_w);
    Symmetric3 mass{};
    Vec3 force{};
    for (int e = 0; e < EDGES; ++e) {
        const SoftConstraint& soft = contact.soft[e];
        const Vec3& edge = contact.edge_w[e];
        const Lane pushing_mass = select(soft.pushing, soft.virtual_mass, Lane{});
        add_outer(mass, pushing_mass, edge);
        force = force + edge * (pushing_mass * (soft.drive + dot(edge, from_velocity)));
    }
    add(inertia, inertia_of_point(mass, contact.offset_w));
    bias = bias - force_at_point(force, contact.offset_w);
}

// Adds the contacts of a body, soft, for the solves that find their forces.
template <int BODY_INDEX>
INLINE void press_body(const Floor& floor, const Spatial& velocity_product, ArticulatedInertia& inertia,
                       Spatial& bias) {
    if (!floor.touched[BODY_INDEX]) return;
    for_each_point<BODY_INDEX>([&](auto point) INLINE_LAMBDA {
        if (floor.point[point].near) press(floor.point[point], velocity_product, inertia, bias);
    });
}

// Adds the forces that were found.
template <int BODY_INDEX>
INLINE void push_body(const Floor& floor, Spatial& bias) {
    if (!floor.touched[BODY_INDEX]) return;
    for_each_point<BODY_INDEX>([&](auto point) INLINE_LAMBDA {
        const ContactPoint& contact = floor.point[point];
        if (!contact.near) return;
        Vec3 force{};
        for (int e = 0; e < EDGES; ++e) force = force + contact.edge_w[e] * contact.soft[e].force;
        bias = bias - force_at_point(force, contact.offset_w);
    });
}

// After a solve, with the acceleration less the part that velocities alone bring; whether a contact is
// another one in the next.
template <int BODY_INDEX>
INLINE bool review_contacts(const Spatial& acceleration, Floor& floor) {
    if (!floor.touched[BODY_INDEX]) return false;
    bool changed = false;
    for_each_point<BODY_INDEX>([&](auto point) INLINE_LAMBDA {
        ContactPoint& contact = floor.point[point];
        if (!contact.near) return;
        const Vec3 a = linear_at(acceleration, contact.offset_w);
        for (int e = 0; e < EDGES; ++e) changed |= review(dot(contact.edge_w[e], a), contact.soft[e]);
    });
    return changed;
}
