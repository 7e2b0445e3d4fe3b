// The timed loop that every engine's single calls run in.
#pragma once

#include <chrono>
#include <cstddef>
#include <utility>

namespace harness {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

template <class Work>
double timed(Work&& work) {
    const Clock::time_point start = Clock::now();
    std::forward<Work>(work)();
    return seconds_since(start);
}

/// Seconds for trace(0) .. trace(count - 1), one after the other. Not inlined, so that the loop is the same for every caller.
template <class Trace>
[[gnu::noinline]] double time_each(std::size_t count, Trace trace) {
    return timed([&] {
        for (std::size_t i = 0; i < count; ++i) trace(i);
    });
}

/// A store that the compiler may neither merge with its neighbours nor drop: a fresh ray reaches memory field by field, as a
/// renderer writes it.
template <class T>
void store_field(T& field, T value) {
    const_cast<volatile T&>(field) = value;
}

}  // namespace harness
