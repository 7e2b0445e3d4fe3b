#include "compare/html.hpp"

#include <cstdint>
#include <string_view>

#include "compare/page.hpp"

namespace harness {
namespace {

constexpr std::string_view page =
#include "compare/report.html.inc"
    ;

/// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? alphabet[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace

std::string to_html(const nlohmann::ordered_json& results, const std::vector<SceneResult>& scenes) {
    nlohmann::ordered_json report = results;
    report["pictures"] = nlohmann::ordered_json::object();
    for (const SceneResult& scene : scenes) {
        if (!scene.picture_png.empty()) report["pictures"][scene.name] = "data:image/png;base64," + base64(scene.picture_png);
    }
    return fill_page(page, report);
}

}  // namespace harness
