// glTF files made by hand: a test begins with one triangle primitive and changes what it is about.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "scene/glb.hpp"
#include "scene/load.hpp"
#include "suites/temp_folder.hpp"

namespace harness {

/// The specification's numbers for component types and primitive modes.
enum ComponentType { byte_type = 5120, u8_type = 5121, u16_type = 5123, u32_type = 5125, float_type = 5126 };
enum Mode { points = 0, lines = 1, triangles = 4, strip = 5, fan = 6 };

struct GltfMaker {
    nlohmann::json root =
        nlohmann::json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"name": "made", "primitives": [{"attributes": {}}]}], "accessors": [], "bufferViews": []})");
    std::string binary;

    nlohmann::json& primitive() { return root["meshes"][0]["primitives"][0]; }
    nlohmann::json& node(std::size_t i) { return root["nodes"][i]; }

    template <typename T>
    int add_view(const std::vector<T>& values) {
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}});
        binary.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        return int(root["bufferViews"].size() - 1);
    }

    int add_accessor(int view, int component_type, std::size_t count, const char* type) {
        root["accessors"].push_back({{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
        return int(root["accessors"].size() - 1);
    }

    void set_positions(const std::vector<float>& positions) {
        primitive()["attributes"]["POSITION"] = add_accessor(add_view(positions), float_type, positions.size() / 3, "VEC3");
    }

    template <typename T>
    void set_indices(const std::vector<T>& indices, int component_type) {
        primitive()["indices"] = add_accessor(add_view(indices), component_type, indices.size(), "SCALAR");
    }

    std::string glb() const {
        nlohmann::json with_buffer = root;
        if (!binary.empty() && !root.contains("buffers")) with_buffer["buffers"] = {{{"byteLength", binary.size()}}};
        return join_glb({with_buffer.dump(), binary});
    }

    Scene load() const {
        const TempFolder folder;
        return load_gltf(folder.write("made.glb", glb()));
    }

    /// What the loader says, without the file's name; "loaded" when it does not mind.
    std::string error() const {
        const TempFolder folder;
        const std::string path = folder.write("made.glb", glb());
        try {
            load_gltf(path);
        } catch (const SceneError& error) {
            const std::string message = error.what();
            return message.starts_with(path + ": ") ? message.substr(path.size() + 2) : "without the file's name: " + message;
        }
        return "loaded";
    }
};

/// A unit square in the plane z = 0, counter-clockwise.
inline const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

inline GltfMaker square_file() {
    GltfMaker maker;
    maker.set_positions(square);
    maker.set_indices(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, u16_type);
    return maker;
}

}  // namespace harness
