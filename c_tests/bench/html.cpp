#include "bench/html.hpp"

#include <string_view>

#include "compare/page.hpp"

namespace harness {
namespace {

constexpr std::string_view page =
#include "bench/bench.html.inc"
    ;

}  // namespace

std::string bench_html(const nlohmann::ordered_json& results) { return fill_page(page, results); }

}  // namespace harness
