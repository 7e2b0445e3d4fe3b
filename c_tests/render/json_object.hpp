// Members of a JSON object, checked where they are read.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace render {

struct Interval {
    double lower, upper;
    bool is_open;  // without its ends
    const char* what;
};
constexpr double most_float = std::numeric_limits<float>::max();
constexpr Interval positive{0, most_float, true, "a finite number above 0"};
constexpr Interval not_negative{0, most_float, false, "a finite number of at least 0"};
constexpr Interval fraction{0, 1, false, "a number from 0 to 1"};

/// An object and its place in the file: each call throws a SceneError that begins with the member, as in
/// "materials[2].emissiveFactor[0] is -1: not a finite number of at least 0". A member that is missing is `otherwise`, an object
/// that is missing has no members.
class JsonObject {
public:
    JsonObject(const nlohmann::json& value, std::string path);

    const std::string& path() const { return path_; }
    bool has(const char* key) const { return value_->contains(key); }

    double number(const char* key, double otherwise, const Interval& interval) const;
    /// As many as `otherwise` has.
    std::vector<double> numbers(const char* key, std::vector<double> otherwise, const Interval& interval) const;
    bool flag(const char* key, bool otherwise) const;
    std::string text(const char* key, const std::string& otherwise) const;
    /// Which of `count` things, of the list that is called `list`.
    std::optional<std::size_t> id(const char* key, std::size_t count, const char* list) const;
    JsonObject object(const char* key) const;
    std::vector<JsonObject> objects(const char* key) const;

    /// Throws: `key` is the culprit, and what it is not.
    [[noreturn]] void fail(const char* key, const std::string& expected) const;

private:
    const nlohmann::json* value_;
    std::string path_;
};

}  // namespace render
