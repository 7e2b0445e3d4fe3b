#include "render/json_object.hpp"

#include <utility>

#include "scene/load.hpp"

namespace render {

namespace {

using harness::SceneError;
using nlohmann::json;

std::string member_path(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

[[noreturn]] void fail_at(const std::string& path, const json& value, const std::string& expected) {
    constexpr std::size_t most_characters = 40;
    std::string text = value.dump();
    if (text.size() > most_characters) text = text.substr(0, most_characters) + "...";
    throw SceneError(path + " is " + text + ": not " + expected);
}

double checked(const json& value, const std::string& path, const Interval& interval) {
    if (!value.is_number()) fail_at(path, value, interval.what);
    const auto number = value.get<double>();
    const float rounded = float(number);  // as most are kept: 1e-50 is no range above 0
    const bool is_inside = interval.is_open ? rounded > interval.lower && rounded < interval.upper
                                            : rounded >= interval.lower && rounded <= interval.upper;
    if (!is_inside) fail_at(path, value, interval.what);
    return number;
}

}  // namespace

JsonObject::JsonObject(const json& value, std::string path) : value_(&value), path_(std::move(path)) {
    if (!value.is_object()) fail_at(path_, value, "an object");
}

double JsonObject::number(const char* key, double otherwise, const Interval& interval) const {
    return has(key) ? checked((*value_)[key], member_path(path_, key), interval) : otherwise;
}

std::vector<double> JsonObject::numbers(const char* key, std::vector<double> otherwise, const Interval& interval) const {
    if (!has(key)) return otherwise;
    const json& list = (*value_)[key];
    if (!list.is_array() || list.size() != otherwise.size()) fail(key, std::to_string(otherwise.size()) + " numbers");
    for (std::size_t i = 0; i < list.size(); ++i)
        otherwise[i] = checked(list[i], member_path(path_, key) + "[" + std::to_string(i) + "]", interval);
    return otherwise;
}

bool JsonObject::flag(const char* key, bool otherwise) const {
    if (!has(key)) return otherwise;
    if (!(*value_)[key].is_boolean()) fail(key, "true or false");
    return (*value_)[key].get<bool>();
}

std::string JsonObject::text(const char* key, const std::string& otherwise) const {
    if (!has(key)) return otherwise;
    if (!(*value_)[key].is_string()) fail(key, "a string");
    return (*value_)[key].get<std::string>();
}

std::optional<std::size_t> JsonObject::id(const char* key, std::size_t count, const char* list) const {
    if (!has(key)) return {};
    const json& value = (*value_)[key];
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= count)
        fail(key, "one of the file's " + std::to_string(count) + " " + list);
    return value.get<std::size_t>();
}

JsonObject JsonObject::object(const char* key) const {
    static const json nothing = json::object();
    return {has(key) ? (*value_)[key] : nothing, member_path(path_, key)};
}

std::vector<JsonObject> JsonObject::objects(const char* key) const {
    std::vector<JsonObject> list;
    if (!has(key)) return list;
    const json& values = (*value_)[key];
    if (!values.is_array()) fail(key, "an array of objects");
    for (std::size_t i = 0; i < values.size(); ++i)
        list.emplace_back(values[i], member_path(path_, key) + "[" + std::to_string(i) + "]");
    return list;
}

void JsonObject::fail(const char* key, const std::string& expected) const {
    fail_at(member_path(path_, key), (*value_)[key], expected);
}

}  // namespace render
