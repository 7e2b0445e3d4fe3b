// The binary container of glTF 2.0 (specification, section 4.4): a header, a JSON chunk, a BIN chunk.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace harness {

struct GlbChunks {
    std::string json;
    std::string binary;  // empty where the file has none
};

/// Not left to tinygltf 2.7, which takes a BIN chunk that ends eight bytes behind the file. Throws SceneError. Chunks of unknown
/// type are passed over, as the specification asks.
GlbChunks split_glb(std::string_view file);

/// Pads both chunks to four bytes. Throws SceneError beyond the format's 4 GiB.
std::string join_glb(const GlbChunks& chunks);

}  // namespace harness
