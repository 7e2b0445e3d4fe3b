// gnomon's faults in words, each with the command that shows it again.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "hard/engines.hpp"
#include "hard/truth.hpp"

namespace harness {

class Failures {
public:
    /// Scenes are written beside `path`; nothing is written where it is empty.
    explicit Failures(std::string path) : path_(std::move(path)) {}

    /// Keeps the first few of each place and engine. `where` names the population or the case, and tells its scenes apart.
    void add(const std::string& where, const HardEngine& engine, const Scene& scene, const GnomonRay& ray,
             const std::string& what);

    const std::vector<std::string>& texts() const { return texts_; }

    /// Writes all texts. Throws std::runtime_error that names the file.
    void write() const;

private:
    std::string path_;
    std::map<std::string, std::size_t> counts_;
    std::map<std::string, std::string> scene_files_;  // by the place and the scene's name
    std::vector<std::string> texts_;
};

}  // namespace harness
