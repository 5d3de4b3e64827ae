// One number for each of LANES environments, in one vector register, and the functions on them.
//
// Everything that follows is written as for one environment; the compiler's vector type does it for all
// lanes at once. No operation mixes lanes, so an environment's result does not depend on its neighbours.
#pragma once

#include <cstdint>
#include <utility>
#if defined(__AVX__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
constexpr int LANES = 16;
#elif defined(__AVX2__)
constexpr int LANES = 8;
#else
constexpr int LANES = 4;
#endif

typedef float Lane __attribute__((vector_size(LANES * sizeof(float))));
// All bits set where a condition is true, none where it is false; also the result of comparing Lanes.
typedef int32_t Mask __attribute__((vector_size(LANES * sizeof(int32_t))));

#define INLINE inline __attribute__((always_inline))
#define INLINE_LAMBDA __attribute__((always_inline))

constexpr float PI = 3.14159265358979f;

INLINE Lane fill(float x) { return x + Lane{}; }
INLINE Lane select(Mask condition, Lane yes, Lane no) { return condition ? yes : no; }
INLINE Lane minimum(Lane a, Lane b) { return a < b ? a : b; }
INLINE Lane maximum(Lane a, Lane b) { return a > b ? a : b; }
INLINE Lane absolute(Lane x) { return maximum(x, -x); }

INLINE bool any(Mask mask) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX2__)
    return _mm256_movemask_ps(reinterpret_cast<__m256>(mask)) != 0;
#else
    int32_t found = 0;
    for (int lane = 0; lane < LANES; ++lane) found |= mask[lane];
    return found != 0;
#endif
}

INLINE Lane square_root(Lane x) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    return reinterpret_cast<Lane>(_mm512_sqrt_ps(reinterpret_cast<__m512>(x)));
#elif defined(__AVX2__)
    return reinterpret_cast<Lane>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#else
    for (int lane = 0; lane < LANES; ++lane) x[lane] = __builtin_sqrtf(x[lane]);
    return x;
#endif
}

struct SinCos {
    Lane sin, cos;
};

// Sine and cosine to 1e-7 for |angle| < 1e4: the angle less a multiple k of pi/2 (in two parts, so that
// nothing is lost), the polynomials of Cephes on -pi/4..pi/4, and the quadrant k mod 4.
INLINE SinCos sine_cosine(Lane angle) {
    const Lane turns = angle * (2.0f / PI);
    const Mask k = __builtin_convertvector(turns + select(turns > 0.0f, fill(0.5f), fill(-0.5f)), Mask);
    const Lane whole = __builtin_convertvector(k, Lane);
    const Lane x = (angle - whole * 1.57079637e0f) + whole * 4.37113883e-8f;
    const Lane x2 = x * x;
    const Lane s = x + x * x2 * (-1.6666654611e-1f + x2 * (8.3321608736e-3f + x2 * -1.9515295891e-4f));
    const Lane c = 1.0f - x2 * 0.5f
                 + x2 * x2 * (4.166664568e-2f + x2 * (-1.388731625e-3f + x2 * 2.443315711e-5f));
    const Mask odd = (k & 1) != 0;
    const Lane sin = select(odd, c, s), cos = select(odd, s, c);
    return {select((k & 2) != 0, -sin, sin), select(((k + 1) & 2) != 0, -cos, cos)};
}

// atan2(y, x) for y >= 0 and x >= 0, to 2e-7: the smaller over the larger, halved once more by
// atan(t) = pi/4 + atan((t - 1)/(t + 1)) where t > tan(pi/8), and the polynomial of Cephes.
INLINE Lane arc_tangent_of_positive(Lane y, Lane x) {
    const Mask steep = y > x;
    const Lane t = select(steep, x, y) / maximum(maximum(x, y), fill(1e-30f));
    const Mask large = t > 0.414213562f;
    const Lane r = select(large, (t - 1.0f) / (t + 1.0f), t);
    const Lane r2 = r * r;
    const Lane series =
        -3.33329491e-1f + r2 * (1.99777106e-1f + r2 * (-1.38776856e-1f + r2 * 8.05374449e-2f));
    const Lane angle = select(large, fill(PI / 4), Lane{}) + (r + r * r2 * series);
    return select(steep, PI / 2 - angle, angle);
}

// Calls f with the constants 0 .. COUNT - 1, one after the other; each call is compiled by itself.
template <class F, int... I>
INLINE void unroll_sequence(F&& f, std::integer_sequence<int, I...>) {
    (f(std::integral_constant<int, I>{}), ...);
}

template <int COUNT, class F>
INLINE void unroll(F&& f) {
    unroll_sequence(f, std::make_integer_sequence<int, COUNT>{});
}
