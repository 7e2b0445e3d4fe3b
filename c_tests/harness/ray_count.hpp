// How many rays a suite traces: its own number, or that of GNOMON_RAYS for a shorter or a longer run.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace harness {

/// Throws std::runtime_error where GNOMON_RAYS is set to anything but a positive number.
inline std::size_t ray_count_or(std::size_t usual) {
    const char* text = std::getenv("GNOMON_RAYS");
    if (text == nullptr) return usual;
    char* end = nullptr;
    const unsigned long long count = std::strtoull(text, &end, 10);
    if (end == text || *end != '\0' || *text == '-' || count == 0)
        throw std::runtime_error("GNOMON_RAYS: \"" + std::string(text) + "\" is not a positive number of rays");
    return static_cast<std::size_t>(count);
}

}  // namespace harness
