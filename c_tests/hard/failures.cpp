#include "hard/failures.hpp"

#include "compare/classify.hpp"
#include "compare/describe.hpp"
#include "harness/write_file.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

BuildReport report_of(const HardEngine& engine) {
    BuildReport report;
    report.engine = engine.engine;
    report.structure = engine.options.compact != 0 ? "wide_bvh" : engine.structure;
    report.quality = "medium";
    report.precision = engine.precision;
    report.isa = engine.isa;
    report.compact = engine.options.compact != 0;
    return report;
}

}  // namespace

void Failures::add(const std::string& where, const HardEngine& engine, const Scene& scene, const GnomonRay& ray,
                   const std::string& what) {
    constexpr std::size_t most_of_a_kind = 3;
    if (counts_[where + engine.label()]++ >= most_of_a_kind) return;
    std::string text = where + ", " + engine.label() + ": " + what + "\n  ray     " + ray_text(ray) + "\n";
    if (!path_.empty()) {
        std::string& file = scene_files_[where + scene.name];
        if (file.empty()) {
            file = path_ + "." + std::to_string(scene_files_.size()) + ".glb";
            write_glb(scene, file);
        }
        text += "  replay  " + replay_command(report_of(engine), file, ray) + "\n";
    }
    texts_.push_back(std::move(text));
}

void Failures::write() const {
    if (path_.empty()) return;
    std::string text;
    for (const std::string& failure : texts_) text += failure;
    write_file(path_, text);
}

}  // namespace harness
