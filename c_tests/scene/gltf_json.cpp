#include "scene/gltf_json.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/load.hpp"

namespace harness {

namespace {

using nlohmann::json;

/// Deeper than any glTF property; far less than the stack holds.
constexpr int most_nested = 64;

const std::set<std::string> geometry_at_root = {"asset",  "buffers", "bufferViews", "accessors",
                                                "meshes", "nodes",   "scenes",      "scene"};

/// These replace or multiply geometry: read without them, a file would give other triangles than it means.
const std::set<std::string> unsupported_extensions = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                                      "EXT_mesh_gpu_instancing"};

/// Of no use to geometry wherever they stand. Accessor bounds (min, max) are claims that nothing here may rely on.
const std::set<std::string> dropped_everywhere = {"extras", "min", "max", "weights", "targets"};

/// Ids, counts and byte sizes alike: tinygltf holds some of them in an int.
bool is_whole(const json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= std::uint64_t(std::numeric_limits<int>::max());
}

bool is_array_of(const json& value, bool (*is_element)(const json&)) {
    return value.is_array() && std::all_of(value.begin(), value.end(), is_element);
}

bool is_number(const json& value) { return value.is_number(); }
bool is_object(const json& value) { return value.is_object(); }
bool is_text(const json& value) { return value.is_string(); }
bool is_ids(const json& value) { return is_array_of(value, is_whole); }
bool is_numbers(const json& value) { return is_array_of(value, is_number); }
bool is_objects(const json& value) { return is_array_of(value, is_object); }
bool is_id_map(const json& value) { return value.is_object() && std::all_of(value.begin(), value.end(), is_whole); }
/// Of a primitive an accessor, of a sparse accessor an object.
bool is_id_or_object(const json& value) { return is_whole(value) || value.is_object(); }
/// Of the file the list of nodes, of a scene the ids of its roots.
bool is_ids_or_objects(const json& value) { return is_ids(value) || is_objects(value); }

struct Type {
    const char* name;
    bool (*matches)(const json&);
};

const Type whole{"a whole number from 0 to 2^31 - 1", is_whole};
const Type object{"an object", is_object}, text{"a string", is_text};
const Type ids{"an array of whole numbers from 0 to 2^31 - 1", is_ids}, numbers{"an array of numbers", is_numbers};
const Type objects{"an array of objects", is_objects};

const std::map<std::string, Type> types = {
    {"accessors", objects},
    {"asset", object},
    {"attributes", {"an object of accessor ids", is_id_map}},
    {"buffer", whole},
    {"bufferView", whole},
    {"bufferViews", objects},
    {"buffers", objects},
    {"byteLength", whole},
    {"byteOffset", whole},
    {"byteStride", whole},
    {"children", ids},
    {"componentType", whole},
    {"count", whole},
    {"extensions", object},
    {"indices", {"an accessor id, or an object in a sparse accessor", is_id_or_object}},
    {"matrix", numbers},
    {"mesh", whole},
    {"meshes", objects},
    {"mode", whole},
    {"name", text},
    {"nodes", {"an array of objects, or of ids in a scene", is_ids_or_objects}},
    {"primitives", objects},
    {"rotation", numbers},
    {"scale", numbers},
    {"scene", whole},
    {"scenes", objects},
    {"sparse", object},
    {"translation", numbers},
    {"type", text},
    {"uri", text},
    {"values", object},
    {"version", text},
};

void check_extensions(const json& extensions, const std::string& path) {
    for (const auto& [name, content] : extensions.items())
        if (unsupported_extensions.contains(name)) throw SceneError(path + ": " + name + " is not supported");
}

/// `path` names the place of `value`: "nodes[3]".
void check_types(const json& value, const std::string& path) {
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i)
            if (value[i].is_structured()) check_types(value[i], path + "[" + std::to_string(i) + "]");
    } else if (value.is_object()) {
        for (const auto& [key, member] : value.items()) {
            const std::string member_path = path.empty() ? key : path + "." + key;
            const auto type = types.find(key);
            if (type != types.end() && !type->second.matches(member))
                throw SceneError(member_path + " is not " + type->second.name);
            if (key == "extensions")
                check_extensions(member, member_path);  // what an extension means by a name is its own affair
            else
                check_types(member, member_path);
        }
    }
}

}  // namespace

json parse_gltf_json(std::string_view text, const std::set<std::string>& kept_at_root) {
    const auto keep = [&](int depth, json::parse_event_t event, json& parsed) {
        if (depth > most_nested) throw SceneError("JSON nested deeper than " + std::to_string(most_nested));
        if (event != json::parse_event_t::key) return true;
        const auto& key = parsed.get_ref<const std::string&>();
        return depth == 1 ? kept_at_root.contains(key) : !dropped_everywhere.contains(key);
    };
    json document = json::parse(text, keep);
    if (!document.is_object()) throw SceneError("the JSON is not an object");
    return document;
}

std::string geometry_json(std::string_view text) {
    const json document = parse_gltf_json(text, geometry_at_root);
    check_types(document, "");
    return document.dump();
}

}  // namespace harness
