#include "snapshot/compare.h"

#include <cstddef>
#include <cstring>
#include <string_view>
#include <vector>

#include "snapshot/visitor.h"

namespace taut {
namespace {

// What counts for the hash, as bytes.
class Collect : public Onlooker<Collect> {
public:
    void plain(const void* field, size_t size) {
        const auto* const from = static_cast<const std::byte*>(field);
        bytes.insert(bytes.end(), from, from + size);
    }
    template <class... Fields>
    void aside(const char*, Fields&&...) {}
    template <class List>
    void rare(const char* name, const List& list) {
        if (!list.empty()) fields(name, list);
    }

    std::vector<std::byte> bytes;
};

class Compare : public Onlooker<Compare> {
public:
    explicit Compare(const std::vector<std::byte>& with) : with_(with) {}

    template <class... Fields>
    void fields(std::string_view names, Fields&&... each) {
        const auto compare = [&](const auto& field) {
            const size_t end = std::min(names.find(','), names.size());
            path_.push_back(names.substr(0, end));
            one(field);
            path_.pop_back();
            names.remove_prefix(std::min(end + 1, names.size()));
        };
        (compare(each), ...);
    }
    template <class... Fields>
    void aside(const char*, Fields&&...) {}
    template <class List>
    void rare(const char* name, const List& list) {
        if (!list.empty()) fields(name, list);
    }
    template <class... Columns>
    void rows(const char* names, const Columns&... columns) {
        path_.push_back(names);
        Onlooker::rows(names, columns...);
        path_.pop_back();
    }
    void begin_row(uint32_t slot) { slot_ = slot; }

    void plain(const void* field, size_t size) {
        const bool same = at_ + size <= with_.size() && std::memcmp(with_.data() + at_, field, size) == 0;
        at_ += size;
        if (same || !found.empty()) return;
        for (const std::string_view name : path_) found.append(name).append("/");
        found.append(" of slot ").append(std::to_string(slot_));
    }

    std::string found;

private:
    const std::vector<std::byte>& with_;
    size_t at_ = 0;
    std::vector<std::string_view> path_;
    uint32_t slot_ = 0;
};

}  // namespace

std::string first_difference(const World& one, const World& other) {
    Collect collect;
    describe(collect, one);
    Compare compare(collect.bytes);
    describe(compare, other);
    return compare.found;
}

}  // namespace taut
