#include "record/recorder.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <thread>

#include "base/log.h"
#include "record/arguments.h"
#include "record/format.h"
#include "record/recorded.h"
#include "state/world_slot.h"

namespace taut {

constinit std::atomic<uint32_t> recorded_worlds{0};

namespace {

struct RecordedCall {
    const char* name;
    void (*encode)(Encoder&, const void* const*);
    void (*encode_given)(Encoder&, const void* const*);
};
constexpr RecordedCall kRecordedCalls[] = {
#define TAUT_CALL(function) {#function, Arguments<&function>::encode, Arguments<&function>::encode_given},
    TAUT_RECORDED_CALLS(TAUT_CALL)
#undef TAUT_CALL
};

// A snapshot that the host took; it is found again by what it holds.
struct Snapshot {
    uint64_t bytes, hash;
    uint64_t call;  // number
};

uint64_t hash_of(std::span<const std::byte> bytes) {
    Hash hash;
    for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
        uint64_t word;
        std::memcpy(&word, bytes.data(), sizeof word);
        hash.add(word);
    }
    for (const std::byte byte : bytes) hash.add(static_cast<uint64_t>(byte));
    return hash.value();
}

// Parameter i of the call that is recorded.
template <class P>
const P& parameter(const void* const* at, size_t i) {
    return *static_cast<const P*>(at[i]);
}

class Recorder {
public:
    Recorder(const World& world, const taut_record_def& def)
        : memory_(world.memory.hooks()),
          world_(world.id),
          write_(def.write),
          user_data_(def.user_data),
          hashes_(def.hashes),
          bytes_(memory_),
          snapshots_(memory_),
          baked_(memory_) {}

    uint32_t world() const { return world_; }
    PreSolve& host() { return host_; }
    const taut_hooks& hooks() const { return memory_.hooks(); }

    bool head(const taut_world_def& def) {
        return put(Record::head, [&](Encoder& encoder) {
            encoder(kRecordVersion, taut_version());
            encoder.one(def);
            encoder(static_cast<uint32_t>(std::size(kRecordedCalls)));
            for (const RecordedCall& call : kRecordedCalls) name(encoder, call.name);
        });
    }
    bool begin(Call call, const void* const* at) {
        if (call == Call::taut_world_add_baked) learn(parameter<taut_baked>(at, 1));
        ++calls_;
        return put(static_cast<Record>(call), [&](Encoder& encoder) {
            kRecordedCalls[static_cast<size_t>(call)].encode(encoder, at);
            if (call == Call::taut_world_restore)
                encoder(number_of(parameter<const void*>(at, 1), parameter<uint64_t>(at, 2)));
        });
    }
    void end(Call call, const void* const* at, taut_result result) {
        if (call == Call::taut_world_save && result == TAUT_OK) keep(at);
        uint64_t hash = 0;
        const bool hashed = result == TAUT_OK &&
                            (hashes_ == TAUT_RECORD_HASH_CALLS || (hashes_ == TAUT_RECORD_HASH_STEPS && is_step(call)));
        const uint8_t has_hash = hashed && taut_world_get_state_hash({world_}, &hash) == TAUT_OK;
        put(Record::result, [&](Encoder& encoder) {
            encoder(result, has_hash, hash);
            if (result == TAUT_OK) kRecordedCalls[static_cast<size_t>(call)].encode_given(encoder, at);
        });
    }
    void answer(const Answer& of, taut_collider a, taut_collider b) {
        put(Record::answer, [&](Encoder& encoder) { encoder(of.said, of.friction, of.restitution, a, b); });
    }
    void unrecorded(const char* call) {
        put(Record::unrecorded, [&](Encoder& encoder) { name(encoder, call); });
    }
    // By this thread, as it has the recorder: a call that is recorded, or one of the host's function.
    void note_change_within() {
        if (writing_) fail("write changed the world");
    }
    void finish() {
        put(Record::end, [](Encoder&) {});
    }

private:
    // A record whose bytes fill(encoder) writes.
    template <class Fill>
    bool put(Record kind, Fill&& fill) noexcept {
        if (failed_) return false;
        try {
            constexpr size_t kPrefix = 12;
            bytes_.resize(kPrefix);
            Encoder encoder(bytes_, world_, baked_);
            fill(encoder);
            const size_t size = bytes_.size() - kPrefix;
            if (size > UINT32_MAX) return fail("a call has more than 4 GiB of arguments");
            const uint32_t prefix[2] = {static_cast<uint32_t>(kind), static_cast<uint32_t>(size)};
            std::memcpy(bytes_.data(), prefix, sizeof prefix);
            const auto check = [](std::span<const std::byte> of) { return check_of(of); };
            const uint32_t checks[2] = {check(std::span(bytes_).first(sizeof prefix)),
                                        check(std::span(bytes_).subspan(kPrefix))};
            std::memcpy(bytes_.data() + sizeof prefix, &checks[0], sizeof checks[0]);
            bytes_.resize(bytes_.size() + sizeof checks[1]);
            std::memcpy(bytes_.data() + bytes_.size() - sizeof checks[1], &checks[1], sizeof checks[1]);
            if (kind == Record::head && !write(kRecordMagic, sizeof kRecordMagic)) return false;
            return write(bytes_.data(), bytes_.size());
        } catch (const std::bad_alloc&) {
            return fail("out of memory");
        }
    }
    bool write(const void* bytes, uint64_t size) noexcept {
        bool written = false;
        writing_ = true;
        try {
            written = write_(bytes, size, user_data_) == 1;
        } catch (...) {  // as good as one that did not write
        }
        writing_ = false;
        return !failed_ && (written || fail("write did not write"));
    }
    bool fail(const char* why) noexcept {
        failed_ = true;
        log_line(memory_.hooks(), TAUT_LOG_WARNING, "the recording ends here: %s", why);
        return false;
    }
    static void name(Encoder& encoder, const char* text) {
        const size_t length = std::min(std::strlen(text), size_t{UINT8_MAX});
        encoder(static_cast<uint8_t>(length));
        for (size_t i = 0; i < length; ++i) encoder(text[i]);
    }
    // A baked shape, the first time that the world gets it.
    void learn(taut_baked baked) {
        if (failed_ || !taut_baked_is_valid(baked)) return;
        if (std::find(baked_.begin(), baked_.end(), baked.bits) != baked_.end()) return;
        try {
            Array<std::byte> def(memory_);
            append_baked_def(baked, def);
            put(Record::baked, [&](Encoder&) { bytes_.insert(bytes_.end(), def.begin(), def.end()); });
            baked_.push_back(baked.bits);
        } catch (const std::bad_alloc&) {
            fail("out of memory");
        }
    }
    void keep(const void* const* at) {
        const uint64_t size = *parameter<uint64_t*>(at, 3);
        const auto* const first = static_cast<const std::byte*>(parameter<void*>(at, 1));
        try {
            snapshots_.push_back({size, hash_of({first, size}), calls_});
        } catch (const std::bad_alloc&) {
            fail("out of memory");
        }
    }
    // Of the call that took a snapshot, the last one of equal ones; 0: none.
    uint64_t number_of(const void* buffer, uint64_t bytes) const {
        if (!buffer || std::none_of(snapshots_.begin(), snapshots_.end(),
                                    [&](const Snapshot& each) { return each.bytes == bytes; }))
            return 0;
        const uint64_t hash = hash_of({static_cast<const std::byte*>(buffer), bytes});
        const auto found = std::find_if(snapshots_.rbegin(), snapshots_.rend(),
                                        [&](const Snapshot& each) { return each.bytes == bytes && each.hash == hash; });
        return found == snapshots_.rend() ? 0 : found->call;
    }

    Memory memory_;
    uint32_t world_;
    taut_record_fn write_;
    void* user_data_;
    taut_record_hashes hashes_;
    PreSolve host_;
    bool failed_ = false, writing_ = false;
    uint64_t calls_ = 0;
    Array<std::byte> bytes_;
    Array<Snapshot> snapshots_;
    Array<uint64_t> baked_;
};

// ---------------------------------------------------------------- the table

// Who is busy has the recorder for himself. The lock stands here, not in the world, as that of Hold does.
struct Slot {
    std::atomic<bool> busy{false};
    Recorder* recorder = nullptr;
};
constinit std::array<Slot, kWorldSlots> slots;
// The world slot that this thread holds, 0: none.
thread_local uint32_t slot_of_thread = 0;

// The recorder of a world, for as long as this lives; null: there is none, or another call has it.
class SlotHold {
public:
    SlotHold(uint32_t world, bool waits) noexcept : slot_(slots[world_slot_of(world)]), outer_(slot_of_thread) {
        if (outer_ == world_slot_of(world)) return;
        while (slot_.busy.exchange(true, std::memory_order_acquire)) {
            if (!waits) return;
            std::this_thread::yield();
        }
        held_ = true;
        slot_of_thread = world_slot_of(world);
        if (slot_.recorder && slot_.recorder->world() == world) recorder_ = slot_.recorder;
    }
    ~SlotHold() {
        if (!held_) return;
        slot_of_thread = outer_;
        slot_.busy.store(false, std::memory_order_release);
    }
    SlotHold(const SlotHold&) = delete;
    SlotHold& operator=(const SlotHold&) = delete;

    Recorder* recorder() const { return recorder_; }
    Slot& slot() const { return slot_; }
    // Goes on holding it. Returns what slot_of_thread was before.
    uint32_t leave() {
        held_ = false;
        return outer_;
    }

private:
    Slot& slot_;
    uint32_t outer_;
    bool held_ = false;
    Recorder* recorder_ = nullptr;
};

void free_recorder(Recorder* recorder, const taut_hooks& hooks) noexcept {
    recorder->~Recorder();
    Memory(hooks).release(recorder, sizeof(Recorder), alignof(Recorder));
}

int32_t ask_recorded(const taut_pre_solve* contact, taut_pre_solve_answer* answer, void* recorder) {
    Recorder& own = *static_cast<Recorder*>(recorder);
    Answer said{-1, 0, 0, 0, 0};
    const auto write = [&] {
        said.friction = answer->friction;
        said.restitution = answer->restitution;
        own.answer(said, contact->collider_a, contact->collider_b);
    };
    try {
        said.said = own.host().ask(contact, answer, own.host().user_data);
    } catch (...) {
        write();
        throw;
    }
    write();
    return said.said;
}

}  // namespace

void Recorded::begin(Call call, uint64_t handle) noexcept {
    SlotHold hold(static_cast<uint32_t>(handle & kThisWorld), false);
    if (!hold.recorder() || !hold.recorder()->begin(call, at_)) return;
    outer_ = hold.leave();
    call_ = call;
    slot_ = slot_of_thread;
    tell_result(TAUT_OK);
}

void Recorded::end() noexcept {
    Slot& slot = slots[slot_];
    slot.recorder->end(call_, at_, told_result());
    slot_of_thread = outer_;
    slot.busy.store(false, std::memory_order_release);
}

void note_change(const char* call, uint32_t world) noexcept {
    if (slot_of_thread == world_slot_of(world)) {
        slots[slot_of_thread].recorder->note_change_within();
        return;
    }
    const SlotHold hold(world, true);
    if (hold.recorder()) hold.recorder()->unrecorded(call);
}

bool start_recording(const World& world, const taut_record_def& checked_def) {
    const taut_hooks hooks = world.memory.hooks();
    void* const room = Memory(hooks).allocate(sizeof(Recorder), alignof(Recorder));
    Recorder* const recorder = new (room) Recorder(world, checked_def);
    if (!recorder->head(world.def)) {
        free_recorder(recorder, hooks);
        return false;
    }
    const SlotHold hold(world.id, true);
    hold.slot().recorder = recorder;
    recorded_worlds.fetch_add(1, std::memory_order_relaxed);
    return true;
}

bool is_within_recording(uint32_t world) noexcept {
    return slot_of_thread != 0 && slot_of_thread == world_slot_of(world);
}

bool is_recorded(const World& world) noexcept {
    const SlotHold hold(world.id, true);
    return hold.recorder() != nullptr;
}

void end_recording(uint32_t world) noexcept {
    if (!recording()) return;
    const SlotHold hold(world, true);
    Recorder* const recorder = hold.recorder();
    if (!recorder) return;
    recorder->finish();
    hold.slot().recorder = nullptr;
    recorded_worlds.fetch_sub(1, std::memory_order_relaxed);
    const taut_hooks hooks = recorder->hooks();
    free_recorder(recorder, hooks);
}

void end_recording(World& world) noexcept {
    {
        const SlotHold hold(world.id, true);
        if (hold.recorder() && world.pre_solve.ask) world.pre_solve = hold.recorder()->host();
    }
    end_recording(world.id);
}

PreSolve recorded_pre_solve(const World& world, PreSolve host) noexcept {
    if (!recording()) return host;
    Recorder* const recorder = slots[world_slot_of(world.id)].recorder;  // held by the call that sets it
    if (!recorder || recorder->world() != world.id) return host;
    recorder->host() = host;
    return host.ask ? PreSolve{ask_recorded, recorder} : PreSolve{};
}

}  // namespace taut
