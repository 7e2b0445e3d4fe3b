#include "compare/html.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

namespace harness {
namespace {

constexpr std::string_view page =
#include "compare/report.html.inc"
    ;

void replace(std::string& text, std::string_view mark, std::string_view value) {
    text.replace(text.find(mark), mark.size(), value);
}

std::string read_chart_js() {
    std::ifstream file(GNOMON_CHART_JS, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// JSON inside a script element: no string of it may end the element.
std::string script_safe(std::string json) {
    for (std::size_t at = json.find("</"); at != std::string::npos; at = json.find("</", at + 3)) json.replace(at, 2, "<\\/");
    return json;
}

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
    std::string html(page);
    replace(html, "{{RESULTS}}", script_safe(report.dump()));
    replace(html, "{{CHART_JS}}", read_chart_js());
    return html;
}

}  // namespace harness
