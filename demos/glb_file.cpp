#include "glb_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace demo {

namespace {

using Json = nlohmann::ordered_json;

// Numbers of the specification, sections 3.6 and 4.4.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr size_t kVertexStride = 3 * sizeof(float);

const char* type_of(size_t width) { return width == 1 ? "SCALAR" : width == 3 ? "VEC3" : "VEC4"; }

void put(std::ofstream& file, uint32_t value) {  // little-endian
    const char bytes[4] = {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
                           static_cast<char>(value >> 24)};
    file.write(bytes, sizeof bytes);
}

}  // namespace

size_t GlbFile::add(const char* list, Json entry) {
    Json& entries = root[list];
    entries.push_back(std::move(entry));
    return entries.size() - 1;
}

size_t GlbFile::add_accessor(Use use, const void* data, size_t bytes, Json accessor) {
    std::vector<uint8_t>& view = data_[static_cast<size_t>(use)];
    accessor["bufferView"] = static_cast<size_t>(use);  // put right in write()
    accessor["byteOffset"] = view.size();
    view.resize(view.size() + bytes);
    std::memcpy(view.data() + view.size() - bytes, data, bytes);
    return add("accessors", std::move(accessor));
}

size_t GlbFile::add_floats(Use use, const std::vector<float>& values, size_t width, bool with_bounds) {
    Json accessor = {{"componentType", kFloat}, {"count", values.size() / width}, {"type", type_of(width)}};
    if (with_bounds) {
        std::vector<float> least(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), most = least;
        for (size_t i = 0; i < values.size(); ++i) {
            least[i % width] = std::min(least[i % width], values[i]);
            most[i % width] = std::max(most[i % width], values[i]);
        }
        // As doubles of just these values, so that the text gives back the same floats.
        accessor["min"] = std::vector<double>(least.begin(), least.end());
        accessor["max"] = std::vector<double>(most.begin(), most.end());
    }
    return add_accessor(use, values.data(), values.size() * sizeof(float), std::move(accessor));
}

size_t GlbFile::add_indices(const std::vector<uint32_t>& values) {
    return add_accessor(Use::indices, values.data(), values.size() * sizeof(uint32_t),
                        {{"componentType", kUnsignedInt}, {"count", values.size()}, {"type", "SCALAR"}});
}

// All components take four bytes, so that every offset is aligned.
void GlbFile::write(const std::string& path) {
    size_t view_of[3] = {}, offset = 0;
    for (size_t use = 0; use < 3; ++use) {
        if (data_[use].empty()) continue;
        Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", data_[use].size()}};
        if (use == static_cast<size_t>(Use::vertices)) {
            view["byteStride"] = kVertexStride;
            view["target"] = kArrayBuffer;
        } else if (use == static_cast<size_t>(Use::indices))
            view["target"] = kElementArrayBuffer;
        view_of[use] = add("bufferViews", std::move(view));
        offset += data_[use].size();
    }
    if (root.contains("accessors"))
        for (Json& accessor : root["accessors"]) accessor["bufferView"] = view_of[accessor["bufferView"].get<size_t>()];
    if (offset > 0) root["buffers"] = {{{"byteLength", offset}}};

    std::string text = root.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    const size_t binary = offset > 0 ? 8 + offset : 0, whole = 12 + 8 + text.size() + binary;
    if (whole > UINT32_MAX) throw std::runtime_error(path + " would be larger than a binary glTF file can be, 4 GB");
    std::ofstream file(path, std::ios::binary);
    put(file, kMagic);
    put(file, kVersion);
    put(file, static_cast<uint32_t>(whole));
    put(file, static_cast<uint32_t>(text.size()));
    put(file, kJsonChunk);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (offset > 0) {
        put(file, static_cast<uint32_t>(offset));
        put(file, kBinaryChunk);
        for (const std::vector<uint8_t>& data : data_)
            file.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
    }
    if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace demo
