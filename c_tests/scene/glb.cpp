#include "scene/glb.hpp"

#include <bit>
#include <cstring>
#include <limits>

#include "scene/load.hpp"

namespace harness {

namespace {

// The format is little-endian, and so is every machine this runs on.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t magic = 0x46546C67;  // "glTF"
constexpr std::uint32_t version = 2;
constexpr std::uint32_t json_type = 0x4E4F534A;
constexpr std::uint32_t binary_type = 0x004E4942;
constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;

/// The caller has checked that four bytes are there.
std::uint32_t read_u32(std::string_view bytes, std::size_t offset) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

void append_u32(std::string& bytes, std::uint32_t value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
}

void append_chunk(std::string& file, std::uint32_t type, std::string_view data, char padding) {
    const std::size_t padded_bytes = (data.size() + 3) / 4 * 4;
    append_u32(file, std::uint32_t(padded_bytes));
    append_u32(file, type);
    file.append(data);
    file.append(padded_bytes - data.size(), padding);
}

struct Chunk {
    std::uint32_t type;
    std::string_view data;
};

/// Takes one chunk off the front of `rest`.
Chunk take_chunk(std::string_view& rest) {
    if (rest.size() < chunk_header_bytes) throw SceneError("truncated: a chunk header does not fit in the file");
    const std::size_t data_bytes = read_u32(rest, 0);
    const std::uint32_t type = read_u32(rest, 4);
    rest.remove_prefix(chunk_header_bytes);
    if (data_bytes > rest.size())
        throw SceneError("truncated: a chunk of " + std::to_string(data_bytes) + " bytes, of which only " +
                         std::to_string(rest.size()) + " are there");
    const Chunk chunk{type, rest.substr(0, data_bytes)};
    rest.remove_prefix(data_bytes);
    return chunk;
}

/// The chunks' bytes: what the header's length covers.
std::string_view check_header(std::string_view file) {
    if (file.size() < header_bytes || read_u32(file, 0) != magic)
        throw SceneError("not a binary glTF file: it does not begin with \"glTF\"");
    if (read_u32(file, 4) != version) throw SceneError("binary glTF version " + std::to_string(read_u32(file, 4)) + ", not 2");
    const std::size_t length = read_u32(file, 8);
    if (length < header_bytes || length > file.size())
        throw SceneError("truncated: the header says " + std::to_string(length) + " bytes, the file has " +
                         std::to_string(file.size()));
    return file.substr(header_bytes, length - header_bytes);
}

}  // namespace

GlbChunks split_glb(std::string_view file) {
    std::string_view rest = check_header(file);
    const Chunk json = take_chunk(rest);
    if (json.type != json_type) throw SceneError("the first chunk is not JSON");
    GlbChunks chunks{std::string(json.data), {}};
    while (!rest.empty() && chunks.binary.empty()) {
        const Chunk chunk = take_chunk(rest);
        if (chunk.type == binary_type) chunks.binary = chunk.data;
    }
    return chunks;
}

std::string join_glb(const GlbChunks& chunks) {
    constexpr std::size_t overhead_bytes = header_bytes + 2 * (chunk_header_bytes + 3);
    constexpr std::size_t most_bytes = std::numeric_limits<std::uint32_t>::max();
    if (chunks.json.size() + chunks.binary.size() > most_bytes - overhead_bytes)
        throw SceneError("too large for binary glTF, which ends at 4 GiB");
    std::string file;
    append_u32(file, magic);
    append_u32(file, version);
    append_u32(file, 0);  // the length, known at the end
    append_chunk(file, json_type, chunks.json, ' ');
    if (!chunks.binary.empty()) append_chunk(file, binary_type, chunks.binary, '\0');
    const auto length = std::uint32_t(file.size());
    std::memcpy(file.data() + 8, &length, sizeof length);
    return file;
}

}  // namespace harness
