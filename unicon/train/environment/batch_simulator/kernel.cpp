// What Python calls. All arrays are contiguous float32, environments first; rows are those of state.hpp.
#include "blocks.hpp"
#include "integration.hpp"
#include "observation.hpp"
#include "tracking_errors.hpp"

extern "C" {

// How many environments share a vector register.
int unicon_lanes() { return LANES; }

// Advances `states` (envs, 83) by one tick under `control` (envs, 35); `sound` (envs) becomes 0 or 1.
void unicon_step(int envs, int threads, const StepOptions* options, float* states, const float* control,
                 uint8_t* sound) {
    for_each_block(envs, threads, [=](int first, int present) {
        State state = load_state(states + long(first) * ROW, ROW, present);
        Lane controls[HINGES];
        load_rows(control + long(first) * HINGES, HINGES, HINGES, present, controls);
        tick(controls, *options, state);
        store_state(state, present, states + long(first) * ROW);
        const Mask is_good = is_sound(state, options->max_speed);
        for (int lane = 0; lane < present; ++lane) sound[first + lane] = is_good[lane] != 0;
    });
}

// Writes s_t (envs, 197 + 206 tau) for `states` (envs, 83) and `targets` (envs, tau, 83).
void unicon_observe(int envs, int threads, int tau, const float* states, const float* targets, float* out) {
    const long width = OBSERVATION + long(tau) * (OBSERVATION + RELATION);
    for_each_block(envs, threads, [=](int first, int present) {
        Kinematics bodies;
        Lane columns[OBSERVATION + RELATION];
        float* rows = out + first * width;
        const State state = load_state(states + long(first) * ROW, ROW, present);
        place_all(state, bodies);
        Lane* end = columns;
        write_observation(state, bodies, end);
        store_rows(columns, OBSERVATION, present, rows, width);
        for (int k = 0; k < tau; ++k) {
            const float* frames = targets + (long(first) * tau + k) * ROW;
            const State target = load_state(frames, long(tau) * ROW, present);
            place_all(target, bodies);
            end = columns;
            write_observation(target, bodies, end);
            write_relation(state, target, end);
            float* place = rows + OBSERVATION + k * (OBSERVATION + RELATION);
            store_rows(columns, OBSERVATION + RELATION, present, place, width);
        }
    });
}

// Writes the five squared errors (envs, 5) between `states` and `targets`, both (envs, 83).
void unicon_errors(int envs, int threads, const float* states, const float* targets, float* out) {
    for_each_block(envs, threads, [=](int first, int present) {
        Kinematics bodies, aims;
        Lane errors[ERRORS];
        const State state = load_state(states + long(first) * ROW, ROW, present);
        const State target = load_state(targets + long(first) * ROW, ROW, present);
        place_all(state, bodies);
        place_all(target, aims);
        measure_errors(state, bodies, target, aims, errors);
        store_rows(errors, ERRORS, present, out + long(first) * ERRORS, ERRORS);
    });
}
}
