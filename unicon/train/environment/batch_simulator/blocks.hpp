// Shares blocks of LANES environments among threads.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "lane.hpp"

// Calls work(first environment, how many) for every block. Each thread takes the next block that is left;
// blocks know nothing of each other, so the result does not depend on who takes which.
template <class F>
void for_each_block(int envs, int threads, const F& work) {
    const int blocks = (envs + LANES - 1) / LANES;
    std::atomic<int> next{0};
    const auto take_blocks = [&] {
        for (int block; (block = next.fetch_add(1)) < blocks;) {
            const int first = block * LANES;
            work(first, envs - first < LANES ? envs - first : LANES);
        }
    };
    std::vector<std::thread> others;
    for (int i = 1; i < threads && i < blocks; ++i) others.emplace_back(take_blocks);
    take_blocks();
    for (std::thread& other : others) other.join();
}
