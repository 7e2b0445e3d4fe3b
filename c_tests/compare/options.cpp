#include "compare/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "backend/names.hpp"

namespace harness {
namespace {

constexpr std::array ray_kind_names = {
    NamedValue{"primary", 0},
    NamedValue{"bounce", 1},
    NamedValue{"shadow", 2},
    NamedValue{"random", 3},
};
constexpr std::array call_names = {
    NamedValue{"single", static_cast<std::uint32_t>(CallForm::fresh)},
    NamedValue{"prefilled", static_cast<std::uint32_t>(CallForm::prefilled)},
    NamedValue{"batch", static_cast<std::uint32_t>(CallForm::batch)},
};

std::string joined(std::span<const NamedValue> names) {
    std::string text;
    for (const NamedValue& named : names) text += (text.empty() ? "" : ",") + std::string(named.name);
    return text;
}

/// The values of a list's words; throws CLI::ValidationError that names the option and the word.
std::vector<std::uint32_t> values_of(const std::string& option, std::span<const NamedValue> names, const std::string& list) {
    std::vector<std::uint32_t> values;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        if (word == "all") {
            for (const NamedValue& named : names) values.push_back(named.value);
            continue;
        }
        const auto found = std::find_if(names.begin(), names.end(), [&](const NamedValue& named) { return named.name == word; });
        if (found == names.end()) throw CLI::ValidationError(option, "\"" + word + "\" is none of all," + joined(names));
        values.push_back(found->value);
    }
    if (values.empty()) throw CLI::ValidationError(option, "names nothing; there are all," + joined(names));
    return values;
}

/// "bsp_tree:150000,octree:2000000": a name, and what follows it.
std::map<std::uint32_t, std::size_t> limits_of(const std::string& option, std::span<const NamedValue> names,
                                               const std::string& list) {
    std::map<std::uint32_t, std::size_t> limits;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        const std::size_t colon = word.find(':');
        const std::string count = colon == std::string::npos ? "" : word.substr(colon + 1);
        std::size_t limit = 0;
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), limit);
        if (error != std::errc() || *end != '\0') throw CLI::ValidationError(option, "\"" + word + "\" is not STRUCTURE:COUNT");
        for (const std::uint32_t value : values_of(option, names, word.substr(0, colon))) limits[value] = limit;
    }
    return limits;
}

GnomonRay parse_ray(const std::string& text) {
    std::array<float, 8> words{};
    std::istringstream stream(text);
    std::size_t count = 0;
    for (std::string word; std::getline(stream, word, ','); ++count) {
        char* end = nullptr;
        const float value = std::strtof(word.c_str(), &end);
        if (word.empty() || *end != '\0') throw CLI::ValidationError("--replay", "\"" + word + "\" is not a float");
        if (count < words.size()) words[count] = value;
    }
    if (count != words.size()) throw CLI::ValidationError("--replay", "has " + std::to_string(count) + " floats, a ray has 8");
    return {{words[0], words[1], words[2]}, words[3], {words[4], words[5], words[6]}, words[7]};
}

/// The lists as they are typed, before their words become values.
struct Lists {
    std::string structures = "auto", precisions = "accurate", qualities = "medium";
    std::string ray_kinds = "all", calls = "single", isa = "auto", replay, most_triangles;
};

void declare(CLI::App& app, Options& options, Lists& lists) {
    const auto list = [&app](const std::string& name, std::string& text, const std::string& what,
                             std::span<const NamedValue> names) {
        app.add_option(name, text, what + ": all or some of " + joined(names))->capture_default_str();
    };
    app.add_option("SCENE", options.scenes, "a .glb or .gltf file, or gen:NAME[:TRIANGLES]")->required();
    list("--structures", lists.structures, "gnomon's acceleration structures", structure_names);
    list("--precisions", lists.precisions, "gnomon's precisions", precision_names);
    list("--quality", lists.qualities, "build qualities, of every engine", quality_names);
    list("--rays", lists.ray_kinds, "kinds of rays", ray_kind_names);
    list("--calls", lists.calls,
         "single: each ray written right before its call; prefilled: single calls over an array written before. "
         "The first listed is the one whose answers are judged",
         call_names);
    app.add_option("--ray-count", options.ray_count, "rays of each kind")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("--oracle-rays", options.oracle_ray_count, "rays of each kind that the exact oracle judges; 0: none")
        ->capture_default_str();
    app.add_option("--threads", options.threads, "threads of builds and of batch calls")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--repeats", options.repeats, "interleaved repeats; medians are shown")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--build-repeats", options.build_repeats, "interleaved builds; medians are shown")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--most-triangles", lists.most_triangles,
                   "structures that are left out of larger scenes, such as brute_force:2500,bsp_tree:150000");
    app.add_option("--isa", lists.isa, "gnomon's cap: one of " + joined(isa_names))->capture_default_str();
    app.add_flag("--compact", options.compact, "gnomon's wide BVHs with leaves of unique vertices: less memory, less speed");
    app.add_option("--json", options.json_path, "writes machine-readable results");
    app.add_option("--html", options.html_path, "writes a report with charts");
    app.add_option("--dump-failures", options.failures_path, "writes each of gnomon's faults, with the command that replays it");
    app.add_option(
        "--replay", lists.replay,
        "traces one ray through every engine, beside the oracle: origin x,y,z,t_min,direction x,y,z,t_max as eight floats, "
        "best hexadecimal, such as 0x1.8p+1,0x0p+0,-0x1p+2,0x0p+0,0x0p+0,0x0p+0,0x1p+0,inf");
}

void resolve(Options& options, const Lists& lists) {
    options.structures = values_of("--structures", structure_names, lists.structures);
    options.precisions = values_of("--precisions", precision_names, lists.precisions);
    options.qualities = values_of("--quality", quality_names, lists.qualities);
    for (const std::uint32_t kind : values_of("--rays", ray_kind_names, lists.ray_kinds)) {
        options.ray_kinds.push_back(name_of(ray_kind_names, kind));
    }
    for (const std::uint32_t call : values_of("--calls", call_names, lists.calls))
        options.calls.push_back(CallForm{static_cast<int>(call)});
    options.isa = values_of("--isa", isa_names, lists.isa).front();
    options.most_triangles = limits_of("--most-triangles", structure_names, lists.most_triangles);
    if (!lists.replay.empty()) options.replay = parse_ray(lists.replay);
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv, int& status) {
    Options options;
    Lists lists;
    CLI::App app{
        "Sets gnomon beside Embree on the same scenes and rays: speed, builds, memory, and errors against an exact oracle.\n"
        "Exit status: 0; 1 when gnomon broke its accuracy contract; 2 for unusable input.",
        "gnomon-compare"};
    declare(app, options, lists);
    try {
        app.parse(argc, argv);
        resolve(options, lists);
        return options;
    } catch (const CLI::Success& success) {
        status = app.exit(success);
    } catch (const CLI::Error& error) {
        std::fprintf(stderr, "gnomon-compare: %s\n", error.what());
        status = 2;
    }
    return {};
}

std::string call_form_name(CallForm form) { return name_of(call_names, static_cast<std::uint32_t>(form)); }

}  // namespace harness
