#include "hard/engines.hpp"

#include <algorithm>

#include "backend/cpu_isa.hpp"
#include "backend/names.hpp"

namespace harness {
namespace {

const std::string compact_word = "wide_bvh_compact";

std::vector<std::string> words_but(std::span<const NamedValue> names, std::string_view left_out) {
    std::vector<std::string> words;
    for (const NamedValue& named : names)
        if (named.name != left_out) words.emplace_back(named.name);
    return words;
}

std::uint32_t value_of(std::span<const NamedValue> names, const std::string& word) {
    return std::ranges::find(names, word, &NamedValue::name)->value;
}

bool is_listed(const std::vector<std::string>& words, const std::string& word) { return std::ranges::count(words, word) != 0; }

HardEngine gnomon_engine(const std::string& structure, const std::string& precision, const std::string& isa) {
    HardEngine engine{"gnomon", structure, precision, isa, {}};
    gnomon_build_options_init(&engine.options);
    engine.options.compact = structure == compact_word ? 1 : 0;
    engine.options.structure = structure == compact_word ? GNOMON_STRUCTURE_WIDE_BVH : value_of(structure_names, structure);
    engine.options.precision = value_of(precision_names, precision);
    engine.options.isa = value_of(isa_names, isa);
    engine.options.thread_count = 1;
    engine.options.invalid_triangles = GNOMON_INVALID_SKIP;  // as Embree does
    return engine;
}

/// Of those that were asked for, from scalar up to the widest of this CPU.
std::vector<std::string> usable_isas(const HardOptions& options, std::vector<std::string>& notes) {
    std::vector<std::string> usable = isa_words();
    const auto widest = std::ranges::find(usable, cpu_isa());
    for (auto wider = widest + 1; wider != usable.end(); ++wider)
        if (is_listed(options.isas, *wider)) notes.push_back("this CPU has no " + *wider + ": not run");
    usable.erase(widest + 1, usable.end());
    std::erase_if(usable, [&](const std::string& isa) { return !is_listed(options.isas, isa); });
    return usable;
}

}  // namespace

std::string HardEngine::label() const { return is_gnomon() ? engine + " " + structure + " " + precision + " " + isa : engine; }

std::vector<std::string> structure_words() {
    std::vector<std::string> words = words_but(structure_names, "auto");
    words.push_back(compact_word);
    return words;
}

std::vector<std::string> precision_words() { return words_but(precision_names, ""); }
std::vector<std::string> isa_words() { return words_but(isa_names, "auto"); }

std::vector<HardEngine> hard_engines(const HardOptions& options, std::vector<std::string>& notes) {
    const std::vector<std::string> isas = usable_isas(options, notes);
    std::vector<HardEngine> engines;
    for (const std::string& precision : options.precisions) {
        for (const std::string& structure : structure_words()) {
            if (!is_listed(options.structures, structure)) continue;
            const bool has_kernels = structure.starts_with("wide_bvh");
            for (const std::string& isa : has_kernels ? isas : std::vector<std::string>{"scalar"})
                engines.push_back(gnomon_engine(structure, precision, isa));
        }
    }
    if (embree_version().empty()) {
        notes.push_back("built without Embree: gnomon is judged alone");
        return engines;
    }
    for (const char* name : {"embree", "embree_robust"}) engines.push_back({name, "bvh", "", cpu_isa(), {}});
    return engines;
}

std::unique_ptr<Backend> make_backend(const HardEngine& engine, const Scene& scene) {
    if (engine.is_gnomon()) return make_gnomon(scene, engine.options);
    return make_embree(scene, engine.engine == "embree_robust", GNOMON_QUALITY_MEDIUM, 1);
}

}  // namespace harness
