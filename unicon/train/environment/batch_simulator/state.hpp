// The state of LANES environments, and its rows in memory.
//
// A row is unicon.target_frames.pack of a CharacterState: 83 numbers. Rows are contiguous, one an
// environment; here each number becomes a Lane.
#pragma once

#include "spatial.hpp"
#include "tables.hpp"

constexpr int ROW = 3 + 4 + 3 + 3 + 2 * HINGES;

struct Quaternion {
    Lane w, x, y, z;
};

struct State {
    Vec3 root_pos_w;
    Quaternion root_quat_w;
    Vec3 root_lin_vel_w, root_ang_vel_w;
    Lane joint_pos[HINGES], joint_vel[HINGES];
};

static_assert(sizeof(State) == ROW * sizeof(Lane), "a State is its row, number by number");

// Reads `width` columns of the rows of up to LANES environments; missing ones repeat the last.
INLINE void load_rows(const float* rows, long stride, int width, int present, Lane* columns) {
    for (int lane = 0; lane < LANES; ++lane) {
        const float* row = rows + stride * (lane < present ? lane : present - 1);
        for (int k = 0; k < width; ++k) reinterpret_cast<float*>(columns + k)[lane] = row[k];
    }
}

INLINE void store_rows(const Lane* columns, int width, int present, float* rows, long stride) {
    for (int lane = 0; lane < present; ++lane) {
        float* row = rows + stride * lane;
        for (int k = 0; k < width; ++k) row[k] = reinterpret_cast<const float*>(columns + k)[lane];
    }
}

INLINE State load_state(const float* rows, long stride, int present) {
    State state;
    load_rows(rows, stride, ROW, present, &state.root_pos_w.x);
    return state;
}

INLINE void store_state(const State& state, int present, float* rows) {
    store_rows(&state.root_pos_w.x, ROW, present, rows, ROW);
}

INLINE Rotation to_rotation(const Quaternion& q) {
    const Lane xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const Lane xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const Lane wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{1.0f - 2.0f * (yy + zz), 2.0f * (xy + wz), 2.0f * (xz - wy)},
            {2.0f * (xy - wz), 1.0f - 2.0f * (xx + zz), 2.0f * (yz + wx)},
            {2.0f * (xz + wy), 2.0f * (yz - wx), 1.0f - 2.0f * (xx + yy)}};
}

INLINE Quaternion conjugate(const Quaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }

INLINE Quaternion multiply(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

INLINE Quaternion normalize(const Quaternion& q) {
    const Lane scale = 1.0f / square_root(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}
