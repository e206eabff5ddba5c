// Hash of everything that the future of a world depends on, in slot order.
#include <cstring>

#include "base/hash.h"
#include "snapshot/visitor.h"
#include "world.h"

namespace taut {
namespace {

class HashState : public Onlooker<HashState> {
public:
    // In words, of which the last is filled up with zeros.
    void plain(const void* field, size_t size) {
        const auto* at = static_cast<const unsigned char*>(field);
        for (; size > 0; at += std::min(size, sizeof(uint64_t)), size -= std::min(size, sizeof(uint64_t))) {
            uint64_t word = 0;
            std::memcpy(&word, at, std::min(size, sizeof word));
            hash_.add(word);
        }
    }
    template <class... Fields>
    void aside(const char*, Fields&&...) {}
    template <class List>
    void rare(const char* name, const List& list) {
        if (!list.empty()) fields(name, list);
    }
    void begin_row(uint32_t slot) { hash_.add(uint64_t{slot}); }

    uint64_t value() const { return hash_.value(); }

private:
    Hash hash_;
};

}  // namespace

uint64_t state_hash(const World& world) {
    HashState visitor;
    describe(visitor, world);
    return visitor.value();
}

}  // namespace taut
