// Vectors, rotations and articulated inertias in lanes.
//
// Spatial quantities are in WORLD axes at the origin of their own body, and accelerations are classical
// (the derivative of the origin's velocity; Featherstone, Rigid Body Dynamics Algorithms (RBDA), 2008,
// section 2.11). Going from a body to its parent is therefore a mere shift along the arm between their
// origins, and a hinge, which goes through its body's origin, moves it by (axis, 0).
#pragma once

#include "lane.hpp"

struct Vec3 {
    Lane x, y, z;
};

INLINE Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
INLINE Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
INLINE Vec3 operator*(const Vec3& a, Lane s) { return {a.x * s, a.y * s, a.z * s}; }
INLINE Vec3 operator*(const Vec3& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
INLINE Lane dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A rotation by its columns: where the body's axes point in the world.
struct Rotation {
    Vec3 x, y, z;
};

INLINE Vec3 rotate(const Rotation& r, const Vec3& v) { return r.x * v.x + r.y * v.y + r.z * v.z; }
INLINE Vec3 rotate_inverse(const Rotation& r, const Vec3& v) {
    return {dot(r.x, v), dot(r.y, v), dot(r.z, v)};
}

// Turns a vector of the humanoid's table; its zeros are known to the compiler and cost nothing.
INLINE Vec3 rotate(const Rotation& r, const float (&v)[3]) {
    Vec3 sum{};
    if (v[0] != 0.0f) sum = r.x * v[0];
    if (v[1] != 0.0f) sum = sum + r.y * v[1];
    if (v[2] != 0.0f) sum = sum + r.z * v[2];
    return sum;
}

template <int AXIS>
INLINE const Vec3& axis_of(const Rotation& r) {
    if constexpr (AXIS == 0) return r.x;
    else if constexpr (AXIS == 1) return r.y;
    else return r.z;
}

// Turns a body about one of its own axes: that axis stays, the other two turn in their plane.
template <int AXIS>
INLINE Rotation turn(const Rotation& r, const SinCos& angle) {
    const Lane s = angle.sin, c = angle.cos;
    if constexpr (AXIS == 0) return {r.x, r.y * c + r.z * s, r.z * c - r.y * s};
    else if constexpr (AXIS == 1) return {r.x * c - r.z * s, r.y, r.z * c + r.x * s};
    else return {r.x * c + r.y * s, r.y * c - r.x * s, r.z};
}

struct Symmetric3 {
    Lane xx, yy, zz, xy, xz, yz;
};

INLINE Vec3 operator*(const Symmetric3& m, const Vec3& v) {
    return {m.xx * v.x + m.xy * v.y + m.xz * v.z,
            m.xy * v.x + m.yy * v.y + m.yz * v.z,
            m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

// Any 3 x 3 matrix by its rows.
struct Matrix3 {
    Vec3 x, y, z;
};

INLINE Vec3 operator*(const Matrix3& m, const Vec3& v) { return {dot(m.x, v), dot(m.y, v), dot(m.z, v)}; }
INLINE Vec3 transposed_times(const Matrix3& m, const Vec3& v) { return m.x * v.x + m.y * v.y + m.z * v.z; }

// A moment and a force, or an angular and a linear velocity or acceleration, at one point.
struct Spatial {
    Vec3 angular, linear;
};

INLINE Lane dot(const Spatial& a, const Spatial& b) {
    return dot(a.angular, b.angular) + dot(a.linear, b.linear);
}
INLINE Spatial operator+(const Spatial& a, const Spatial& b) {
    return {a.angular + b.angular, a.linear + b.linear};
}
INLINE Spatial operator-(const Spatial& a, const Spatial& b) {
    return {a.angular - b.angular, a.linear - b.linear};
}
INLINE Spatial operator*(const Spatial& a, Lane s) { return {a.angular * s, a.linear * s}; }

// The force needed for an acceleration: moment = A alpha + B a, force = B^T alpha + C a.
struct ArticulatedInertia {
    Symmetric3 a;
    Matrix3 b;
    Symmetric3 c;
};

INLINE void add(Symmetric3& sum, const Symmetric3& m) {
    sum.xx += m.xx, sum.yy += m.yy, sum.zz += m.zz, sum.xy += m.xy, sum.xz += m.xz, sum.yz += m.yz;
}

INLINE void add(ArticulatedInertia& sum, const ArticulatedInertia& m) {
    add(sum.a, m.a), add(sum.c, m.c);
    sum.b = {sum.b.x + m.b.x, sum.b.y + m.b.y, sum.b.z + m.b.z};
}

// I - U U^T / D: what remains of an inertia that a hinge carries. `scaled` is U / D.
INLINE void subtract_outer(ArticulatedInertia& m, const Spatial& u, const Spatial& scaled) {
    const Vec3 &n = u.angular, &f = u.linear, &sn = scaled.angular, &sf = scaled.linear;
    m.a.xx -= n.x * sn.x, m.a.yy -= n.y * sn.y, m.a.zz -= n.z * sn.z;
    m.a.xy -= n.x * sn.y, m.a.xz -= n.x * sn.z, m.a.yz -= n.y * sn.z;
    m.b = {m.b.x - sf * n.x, m.b.y - sf * n.y, m.b.z - sf * n.z};
    m.c.xx -= f.x * sf.x, m.c.yy -= f.y * sf.y, m.c.zz -= f.z * sf.z;
    m.c.xy -= f.x * sf.y, m.c.xz -= f.x * sf.z, m.c.yz -= f.y * sf.z;
}

// The same inertia at another origin, from which the present one is reached by `arm`:
//     C' = C,   B' = B + [arm] C,   A' = A + [arm] B^T + ([arm] B'^T)^T,   with [arm] v = arm x v
INLINE ArticulatedInertia shift(const ArticulatedInertia& m, const Vec3& arm) {
    const Vec3 cx = cross(arm, {m.c.xx, m.c.xy, m.c.xz});
    const Vec3 cy = cross(arm, {m.c.xy, m.c.yy, m.c.yz});
    const Vec3 cz = cross(arm, {m.c.xz, m.c.yz, m.c.zz});
    const Matrix3 b = {m.b.x + Vec3{cx.x, cy.x, cz.x},
                       m.b.y + Vec3{cx.y, cy.y, cz.y},
                       m.b.z + Vec3{cx.z, cy.z, cz.z}};
    const Vec3 left_x = cross(arm, m.b.x), left_y = cross(arm, m.b.y), left_z = cross(arm, m.b.z);
    const Vec3 right_x = cross(arm, b.x), right_y = cross(arm, b.y), right_z = cross(arm, b.z);
    const Symmetric3 a = {m.a.xx + left_x.x + right_x.x,
                          m.a.yy + left_y.y + right_y.y,
                          m.a.zz + left_z.z + right_z.z,
                          m.a.xy + left_y.x + right_x.y,
                          m.a.xz + left_z.x + right_x.z,
                          m.a.yz + left_z.y + right_y.z};
    return {a, b, m.c};
}

// The same force at another origin, from which the present one is reached by `arm`.
INLINE Spatial shift(const Spatial& force, const Vec3& arm) {
    return {force.angular + cross(arm, force.linear), force.linear};
}

// The velocity or acceleration of the body's point at `offset` from its origin, that from spinning left out.
INLINE Vec3 linear_at(const Spatial& motion, const Vec3& offset) {
    return motion.linear + cross(motion.angular, offset);
}

// A force on the body's point at `offset`, as a spatial force at the origin.
INLINE Spatial force_at_point(const Vec3& force, const Vec3& offset) { return {cross(offset, force), force}; }

// A mass at the body's point at `offset` that resists each direction differently, as an inertia at the
// origin: C = M, B = [offset] M, A = ([offset] B^T)^T.
INLINE ArticulatedInertia inertia_of_point(const Symmetric3& m, const Vec3& offset) {
    const Vec3 x = cross(offset, {m.xx, m.xy, m.xz});
    const Vec3 y = cross(offset, {m.xy, m.yy, m.yz});
    const Vec3 z = cross(offset, {m.xz, m.yz, m.zz});
    const Matrix3 b = {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
    const Vec3 a_x = cross(offset, b.x), a_y = cross(offset, b.y), a_z = cross(offset, b.z);
    return {{a_x.x, a_y.y, a_z.z, a_x.y, a_x.z, a_y.z}, b, m};
}
