// A binary glTF 2.0 file: arrays in one buffer, and the JSON that refers to them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace demo {

class GlbFile {
public:
    // What an array is for, which decides where it lies: arrays for the same share a view of the buffer.
    enum class Use { vertices, indices, animation };

    // Numbers, `width` an element (1: SCALAR, 3: VEC3, 4: VEC4); vertices are VEC3. Returns the accessor's index.
    size_t add_floats(Use use, const std::vector<float>& values, size_t width, bool with_bounds);
    size_t add_indices(const std::vector<uint32_t>& values);
    // Into one of the arrays of the root, such as "nodes"; returns its index there.
    size_t add(const char* list, nlohmann::ordered_json entry);

    // Throws std::runtime_error where it cannot be written or would be larger than the format can tell.
    void write(const std::string& path);

    nlohmann::ordered_json root;

private:
    size_t add_accessor(Use use, const void* data, size_t bytes, nlohmann::ordered_json accessor);

    std::vector<uint8_t> data_[3];  // by use
};

}  // namespace demo
