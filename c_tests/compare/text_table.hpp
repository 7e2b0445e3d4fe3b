// Figures in aligned columns, for a terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace harness {

/// Columns as wide as their widest cell; the first `text_columns` begin at the left, figures end at the right.
class TextTable {
public:
    using Row = std::vector<std::string>;

    TextTable(std::size_t text_columns, Row header);
    void add(Row row);
    std::string text() const;

private:
    std::size_t text_columns_;
    std::vector<std::size_t> widths_;
    std::vector<Row> rows_;
};

/// As printf() has it; "-" for what is not finite.
std::string figure(double value, const char* format);

/// "1,234,567"
std::string grouped(std::uint64_t value);

}  // namespace harness
