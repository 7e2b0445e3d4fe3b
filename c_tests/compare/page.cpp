#include "compare/page.hpp"

#include <fstream>
#include <iterator>

namespace harness {
namespace {

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

}  // namespace

std::string fill_page(std::string_view page, const nlohmann::ordered_json& results) {
    std::string html(page);
    replace(html, "{{RESULTS}}", script_safe(results.dump()));
    replace(html, "{{CHART_JS}}", read_chart_js());
    return html;
}

}  // namespace harness
