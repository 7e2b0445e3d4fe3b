#include "compare/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace harness {

TextTable::TextTable(std::size_t text_columns, Row header) : text_columns_(text_columns) { add(std::move(header)); }

void TextTable::add(Row row) {
    widths_.resize(std::max(widths_.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths_[i] = std::max(widths_[i], row[i].size());
    rows_.push_back(std::move(row));
}

std::string TextTable::text() const {
    std::string text;
    for (const Row& row : rows_) {
        std::string line = "  ";
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string padding(widths_[i] - row[i].size(), ' ');
            line += (i < text_columns_ ? row[i] + padding : padding + row[i]) + "  ";
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string figure(double value, const char* format) {
    if (!std::isfinite(value)) return "-";
    char buffer[48];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

std::string grouped(std::uint64_t value) {
    std::string digits = std::to_string(value);
    for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
    return digits;
}

}  // namespace harness
