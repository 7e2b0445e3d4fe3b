#include "compare/machine.hpp"

#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "backend/backend.hpp"
#include "backend/cpu_isa.hpp"

namespace harness {
namespace {

/// What follows `separator` in the file's first line that begins with `key`, without quotes; "unknown" where there is none.
std::string value_in(const char* path, const std::string& key, char separator) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(key)) continue;
        std::string value = line.substr(line.find(separator) + 1);
        std::erase(value, '"');
        return value.substr(std::min(value.size(), value.find_first_not_of(' ')));
    }
    return "unknown";
}

std::string operating_system() {
    utsname kernel{};
    uname(&kernel);
    return value_in("/etc/os-release", "PRETTY_NAME", '=') + ", " + kernel.sysname + " " + kernel.release;
}

}  // namespace

Machine this_machine() {
    return {value_in("/proc/cpuinfo", "model name", ':'), std::thread::hardware_concurrency(), cpu_isa(), operating_system()};
}

Versions these_versions() {
    return {gnomon_version_string(), embree_version(), GNOMON_RUSTC_VERSION, "GCC " __VERSION__, GNOMON_COMMIT};
}

}  // namespace harness
