#include "api/replay.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <string_view>
#include <thread>

#include "base/printf_like.h"
#include "record/arguments.h"
#include "record/format.h"
#include "record/recorded.h"
#include "state/world_slot.h"

namespace taut {
namespace {

// What a call comes to; given: handles as recorded.
struct Played {
    taut_result result = TAUT_OK;
    const char* difference = nullptr;
    uint64_t expected = 0, found = 0;

    void differs(const char* what, uint64_t recorded, uint64_t now) {
        if (!difference) difference = what, expected = recorded, found = now;
    }
};

// False: that is not the arguments.
template <auto function>
bool play(Decoder& arguments, bool is_sized, Decoder* given, Played& out) {
    return Arguments<function>::call(arguments, is_sized, out.result, [&]<class Handle>(const Handle& handle) {
        if (!given) return;
        Handle expected{};
        given->one(expected);
        if (handle.bits != expected.bits) out.differs("the handle given", expected.bits, handle.bits);
    });
}

struct PlayedCall {
    std::string_view name;
    bool (*play)(Decoder&, bool, Decoder*, Played&);
};
constexpr PlayedCall kPlayedCalls[] = {
#define TAUT_CALL(function) {#function, play<&function>},
    TAUT_RECORDED_CALLS(TAUT_CALL)
#undef TAUT_CALL
};
constexpr auto kUnknownCall = static_cast<uint16_t>(Call::count);

// Whether a result is the recorded one; handles of other worlds are such of none here.
bool is_same(taut_result recorded, taut_result found) {
    const auto foreign = [](taut_result of) { return of == TAUT_FOREIGN_HANDLE ? TAUT_STALE_HANDLE : of; };
    return foreign(recorded) == foreign(found);
}

// Recorded where it came from outside of the world; nothing came of it.
bool is_of_circumstances(taut_result result) { return result == TAUT_LOCKED || result == TAUT_OUT_OF_MEMORY; }

struct Piece {
    uint32_t kind = 0;
    std::span<const std::byte> bytes;
    uint64_t next = 0;  // where the next record begins

    bool is(Record which) const { return kind == static_cast<uint32_t>(which); }
};
enum class Reading { done, cut, damaged };

Reading read_piece(std::span<const std::byte> file, uint64_t at, Piece& out) {
    constexpr uint64_t kPrefix = 12, kCheck = 4;
    if (file.size() - at < kPrefix) return Reading::cut;
    uint32_t prefix[3];
    std::memcpy(prefix, file.data() + at, kPrefix);
    if (check_of(file.subspan(at, 8)) != prefix[2]) return Reading::damaged;
    if (file.size() - at - kPrefix < prefix[1] + kCheck) return Reading::cut;
    uint32_t check;
    std::memcpy(&check, file.data() + at + kPrefix + prefix[1], sizeof check);
    out = {prefix[0], file.subspan(at + kPrefix, prefix[1]), at + kPrefix + prefix[1] + kCheck};
    return check_of(out.bytes) == check ? Reading::done : Reading::damaged;
}

// A snapshot that is restored later, from the call that takes it to the last one that restores it, by their numbers.
struct KeptSnapshot {
    uint64_t taken, last_use;
    Array<std::byte> bytes;
};

class Player {
public:
    Player(const taut_replay_def& def)
        : memory_(def.hooks),
          file_(static_cast<const std::byte*>(def.bytes), def.size),
          arena_(memory_),
          calls_(memory_),
          baked_(memory_),
          kept_(memory_),
          answers_(memory_) {}
    ~Player() {
        for (const taut_baked baked : baked_)
            if (baked.bits != 0) taut_baked_release(baked);
    }
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;

    taut_world world{};
    const taut_hooks& hooks() const { return memory_.hooks(); }

    taut_result read_head(const char* call, taut_world_def& def);
    taut_result next(const char* call, taut_replay_state& out);

private:
    Decoder decoder(std::span<const std::byte> bytes) {
        return {bytes, static_cast<uint32_t>(world.bits), baked_, arena_, answer, this};
    }
    // The end of the replay, with what is said from then on.
    TAUT_PRINTF_LIKE(3, 4) bool stop(taut_result code, const char* format, ...);
    bool damaged() {
        return stop(TAUT_INVALID_ARGUMENT, "the recording is damaged at byte %llu",
                    static_cast<unsigned long long>(offset_));
    }
    void end(bool whole) {
        is_over_ = true;
        state_.status = TAUT_REPLAY_ENDED;
        state_.whole = whole;
    }
    // One record, a call with all that belongs to it. False: the replay is over.
    bool play_piece();
    bool play_call(Call call, const Piece& piece);
    bool run(Call call, std::span<const std::byte> arguments, bool has_result, taut_result expected, Decoder* given,
             Played& played);
    bool bake(const Piece& piece);
    bool take_snapshot(taut_result expected);
    bool restore_snapshot(Decoder& arguments, taut_result expected, Played& played);
    void look_for_snapshots();

    static int32_t answer(const taut_pre_solve* contact, taut_pre_solve_answer* answer, void* self);

    Memory memory_;
    std::span<const std::byte> file_;
    Arena arena_;
    Array<uint16_t> calls_;  // by number in the file
    Array<taut_baked> baked_;
    Array<KeptSnapshot> kept_;
    Array<Answer> answers_;  // within the call that is played
    size_t answered_ = 0;
    Played* played_ = nullptr;
    uint64_t first_ = 0, offset_ = 0;
    taut_replay_state state_{};
    bool is_over_ = false;
    taut_result refusal_ = TAUT_OK;
    char text_[256] = "";
};

bool Player::stop(taut_result code, const char* format, ...) {
    is_over_ = true;
    refusal_ = code;
    va_list values;
    va_start(values, format);
    std::vsnprintf(text_, sizeof text_, format, values);
    va_end(values);
    return false;
}

// ---------------------------------------------------------------- the head

taut_result Player::read_head(const char* call, taut_world_def& def) {
    const auto no_recording = [&](const char* why) {
        return refuse(TAUT_INVALID_ARGUMENT, "%s: bytes are no recording: %s", call, why);
    };
    if (file_.size() < sizeof kRecordMagic || std::memcmp(file_.data(), kRecordMagic, sizeof kRecordMagic) != 0)
        return no_recording("they begin otherwise");
    Piece head;
    const Reading reading = read_piece(file_, sizeof kRecordMagic, head);
    if (reading != Reading::done)
        return no_recording(reading == Reading::cut ? "the head is cut" : "the head is damaged");
    if (!head.is(Record::head)) return no_recording("they have no head");
    Decoder bytes = decoder(head.bytes);
    uint32_t version = 0, library = 0, count = 0;
    bytes(version, library);
    if (version != kRecordVersion)
        return refuse(TAUT_UNSUPPORTED, "%s: the recording is of version %u of the format, this library knows %u", call,
                      version, kRecordVersion);
    if (library > taut_version())
        return refuse(TAUT_UNSUPPORTED, "%s: the recording is of version %u of the library, this one is %u", call,
                      library, taut_version());
    bytes.one(def);
    def.struct_size = sizeof def;
    bytes(count);
    for (uint32_t i = 0; i < count && !bytes.is_bad(); ++i) {
        char name[UINT8_MAX];
        uint8_t length = 0;
        bytes.one(length);
        for (uint8_t k = 0; k < length; ++k) bytes.one(name[k]);
        const auto* const known = std::find_if(std::begin(kPlayedCalls), std::end(kPlayedCalls), [&](const auto& of) {
            return of.name == std::string_view(name, length);
        });
        calls_.push_back(static_cast<uint16_t>(known - std::begin(kPlayedCalls)));
    }
    if (!bytes.is_done()) return no_recording("the head is not one");
    first_ = offset_ = head.next;
    look_for_snapshots();
    return TAUT_OK;
}

void Player::look_for_snapshots() {
    uint64_t call = 0;
    Piece piece;
    for (uint64_t at = first_; read_piece(file_, at, piece) == Reading::done; at = piece.next) {
        if (piece.kind >= calls_.size()) continue;
        ++call;
        if (calls_[piece.kind] != static_cast<uint16_t>(Call::taut_world_restore)) continue;
        uint64_t taken = 0;
        if (piece.bytes.size() < sizeof taken) continue;
        std::memcpy(&taken, piece.bytes.last(sizeof taken).data(), sizeof taken);
        kept_.push_back({taken, call, Array<std::byte>(memory_)});
    }
    const auto by_taken = [](const KeptSnapshot& a, const KeptSnapshot& b) {
        return a.taken != b.taken ? a.taken < b.taken : a.last_use > b.last_use;
    };
    std::sort(kept_.begin(), kept_.end(), by_taken);
    const auto same = [](const KeptSnapshot& a, const KeptSnapshot& b) { return a.taken == b.taken; };
    kept_.erase(std::unique(kept_.begin(), kept_.end(), same), kept_.end());
}

// ---------------------------------------------------------------- play

taut_result Player::next(const char* call, taut_replay_state& out) {
    const uint64_t before = state_.frame;
    try {
        while (!is_over_ && state_.frame == before) play_piece();
    } catch (const std::bad_alloc&) {
        stop(TAUT_OUT_OF_MEMORY, "out of memory");
    }
    if (refusal_ != TAUT_OK) return refuse(refusal_, "%s: %s", call, text_);
    out = state_;
    return TAUT_OK;
}

bool Player::play_piece() {
    arena_.clear();
    Piece piece;
    switch (read_piece(file_, offset_, piece)) {
        case Reading::cut:
            end(false);
            return false;
        case Reading::damaged:
            return damaged();
        case Reading::done:
            break;
    }
    if (piece.is(Record::end)) {
        if (!piece.bytes.empty() || piece.next != file_.size()) return damaged();
        end(true);
        return false;
    }
    if (piece.is(Record::baked)) return bake(piece);
    if (piece.is(Record::unrecorded)) {
        const size_t length = piece.bytes.empty() ? 0 : piece.bytes.size() - 1;
        return stop(TAUT_UNSUPPORTED, "after call %llu came %.*s, which changed the world and is not recorded",
                    static_cast<unsigned long long>(state_.call), static_cast<int>(std::min(length, size_t{100})),
                    length > 0 ? reinterpret_cast<const char*>(piece.bytes.data()) + 1 : "");
    }
    if (piece.kind >= calls_.size()) return damaged();
    ++state_.call;
    state_.offset = offset_;
    if (calls_[piece.kind] == kUnknownCall)
        return stop(TAUT_UNSUPPORTED, "call %llu is of a function that this library does not have",
                    static_cast<unsigned long long>(state_.call));
    return play_call(static_cast<Call>(calls_[piece.kind]), piece);
}

bool Player::play_call(Call call, const Piece& piece) {
    state_.function = kPlayedCalls[static_cast<size_t>(call)].name.data();
    // What came of it: answers, then the result, if the process lived to see it.
    answers_.clear();
    answered_ = 0;
    Piece after;
    uint64_t at = piece.next;
    Reading reading = read_piece(file_, at, after);
    for (; reading == Reading::done && after.is(Record::answer); reading = read_piece(file_, at, after)) {
        Decoder bytes = decoder(after.bytes);
        Answer said{};
        taut_collider a{}, b{};
        bytes(said.said, said.friction, said.restitution, a, b);
        if (!bytes.is_done()) return damaged();
        said.collider_a = a.bits, said.collider_b = b.bits;
        answers_.push_back(said);
        at = after.next;
    }
    const bool has_result = reading == Reading::done;
    if (reading == Reading::damaged || (has_result && !after.is(Record::result))) return damaged();
    taut_result expected = TAUT_OK;
    uint8_t has_hash = 0;
    uint64_t hash = 0;
    Decoder given = decoder(has_result ? after.bytes : std::span<const std::byte>());
    if (has_result) {
        given(expected, has_hash, hash);
        if (given.is_bad()) return damaged();
    }
    Played played;
    if (!(has_result && is_of_circumstances(expected))) {
        played_ = &played;
        const bool ran =
            run(call, piece.bytes, has_result, expected, has_result && expected == TAUT_OK ? &given : nullptr, played);
        played_ = nullptr;
        if (!ran) return false;
    }
    if (has_result && has_hash && !played.difference) {
        uint64_t found = 0;
        if (taut_world_get_state_hash(world, &found) != TAUT_OK || found != hash)
            played.differs("the hash of the state", hash, found);
    }
    if (is_step(call)) ++state_.frame;
    if (played.difference) {
        is_over_ = true;
        state_.status = TAUT_REPLAY_DIFFERS;
        state_.difference = played.difference;
        state_.expected = played.expected;
        state_.found = played.found;
        return false;
    }
    if (!has_result) {
        end(false);
        return false;
    }
    offset_ = after.next;
    return true;
}

bool Player::run(Call call, std::span<const std::byte> bytes, bool has_result, taut_result expected, Decoder* given,
                 Played& played) {
    Decoder arguments = decoder(bytes);
    if (call == Call::taut_world_save) return take_snapshot(expected);
    if (call == Call::taut_world_restore) {
        if (!restore_snapshot(arguments, expected, played)) return false;
    } else {
        if (call == Call::taut_world_add_baked && expected == TAUT_OK) {
            Decoder copy = decoder(bytes);
            taut_world to{};
            uint64_t number = 0;
            copy(to, number);
            if (number < baked_.size() && baked_[number].bits == 0)
                return stop(TAUT_UNSUPPORTED,
                            "call %llu adds a baked shape whose def was not kept: see taut_bake_keep_defs",
                            static_cast<unsigned long long>(state_.call));
        }
        const PlayedCall& of = kPlayedCalls[static_cast<size_t>(call)];
        if (!of.play(arguments, is_sized(of.name), given, played)) return damaged();
    }
    if (!has_result) return true;
    if (!is_same(expected, played.result))
        played.differs("the result", static_cast<uint64_t>(expected), static_cast<uint64_t>(played.result));
    if (played.result == TAUT_OK && !played.difference && given && !given->is_done()) return damaged();
    if (answered_ != answers_.size())
        played.differs("the number of questions of pre_solve", answers_.size(), answered_);
    return true;
}

int32_t Player::answer(const taut_pre_solve* contact, taut_pre_solve_answer* answer, void* self) {
    Player& own = *static_cast<Player*>(self);
    if (!own.played_ || own.answered_ >= own.answers_.size()) {
        ++own.answered_;
        return 1;
    }
    const Answer& said = own.answers_[own.answered_++];
    if (contact->collider_a.bits != said.collider_a)
        own.played_->differs("the first collider of a question of pre_solve", said.collider_a,
                             contact->collider_a.bits);
    if (contact->collider_b.bits != said.collider_b)
        own.played_->differs("the second collider of a question of pre_solve", said.collider_b,
                             contact->collider_b.bits);
    *answer = {said.friction, said.restitution};
    return said.said;
}

// ---------------------------------------------------------------- snapshots and baked shapes

bool Player::take_snapshot(taut_result expected) {
    const auto kept =
        std::find_if(kept_.begin(), kept_.end(), [&](const KeptSnapshot& each) { return each.taken == state_.call; });
    if (expected != TAUT_OK || kept == kept_.end()) return true;
    uint64_t size = 0;
    taut_result saved = taut_world_snapshot_size(world, &size);
    if (saved == TAUT_OK) {
        kept->bytes.resize(size);
        saved = taut_world_save(world, kept->bytes.data(), size, &size);
    }
    return saved == TAUT_OK || stop(saved, "%s", std::string_view(taut_last_error()).data());
}

bool Player::restore_snapshot(Decoder& arguments, taut_result expected, Played& played) {
    taut_world to{};
    const void* buffer = nullptr;
    uint64_t bytes = 0, taken = 0;
    arguments.one(to);
    arguments.out(buffer);
    arguments(bytes, taken);
    if (!arguments.is_done()) return damaged();
    const auto kept =
        std::find_if(kept_.begin(), kept_.end(), [&](const KeptSnapshot& each) { return each.taken == taken; });
    if (taken == 0) {
        if (expected == TAUT_OK)
            return stop(TAUT_UNSUPPORTED, "call %llu restores a snapshot that is not of this recording",
                        static_cast<unsigned long long>(state_.call));
        played.result = expected;  // of no snapshot, or a damaged one: refused before anything was looked at
        return true;
    }
    if (kept == kept_.end() || kept->bytes.empty()) return damaged();
    played.result = taut_world_restore(to, kept->bytes.data(), kept->bytes.size());
    if (kept->last_use <= state_.call) Array<std::byte>(memory_).swap(kept->bytes);
    return true;
}

bool Player::bake(const Piece& piece) {
    Decoder bytes = decoder(piece.bytes);
    BakedDef kind{};
    bytes(kind);
    taut_baked out{};
    const taut_allocator allocator{hooks().allocate, hooks().free, hooks().memory_user_data};
    taut_result result = TAUT_OK;
    const auto make = [&]<class Def>(taut_result (*build)(const Def*, const taut_allocator*, taut_baked*)) {
        Def def{};
        bytes.one(def);
        if (!bytes.is_done()) return false;
        result = build(&def, &allocator, &out);
        return true;
    };
    const bool read = kind == BakedDef::hull           ? make(&taut_bake_hull)
                      : kind == BakedDef::mesh         ? make(&taut_bake_mesh)
                      : kind == BakedDef::height_field ? make(&taut_bake_height_field)
                                                       : kind == BakedDef::not_kept && bytes.is_done();
    if (!read) return damaged();
    if (result != TAUT_OK) return stop(result, "a baked shape: %s", taut_last_error());
    baked_.push_back(out);
    offset_ = piece.next;
    return true;
}

// ---------------------------------------------------------------- the table

// Who is busy has the player for himself.
struct Stand {
    std::atomic<bool> busy{false};
    Player* player = nullptr;
};
constinit std::array<Stand, kWorldSlots> stands;
// How many there are: worlds end without a look at the table where there is none.
constinit std::atomic<uint32_t> replays{0};

void free_player(Player* player, const taut_hooks& hooks) noexcept {
    player->~Player();
    Memory(hooks).release(player, sizeof(Player), alignof(Player));
}

}  // namespace

taut_result open_replay(const char* call, const taut_replay_def& checked_def, taut_world& out) {
    const taut_hooks hooks = checked_def.hooks;
    void* const room = Memory(hooks).allocate(sizeof(Player), alignof(Player));
    const auto free = [hooks](Player* player) { free_player(player, hooks); };
    std::unique_ptr<Player, decltype(free)> player(new (room) Player(checked_def), free);
    taut_world_def def;
    taut_world_def_init(&def);
    const taut_result read = player->read_head(call, def);
    if (read != TAUT_OK) return read;
    def.threads = checked_def.threads;
    def.hooks = hooks;
    const taut_result made = taut_world_create(&def, &player->world);
    if (made != TAUT_OK) {
        char text[400];
        std::snprintf(text, sizeof text, "%s", taut_last_error());
        return refuse(made, "%s: %s", call, text);
    }
    out = player->world;
    stands[world_slot_of(static_cast<uint32_t>(out.bits))].player = player.release();
    replays.fetch_add(1, std::memory_order_relaxed);
    return TAUT_OK;
}

taut_result next_of_replay(const char* call, taut_world world, taut_replay_state& out) {
    const uint32_t id = world_of(world);
    if (!world_lives(id)) return refuse_stale(call, "world", world.bits);
    Stand& stand = stands[world_slot_of(id)];
    if (stand.busy.exchange(true, std::memory_order_acquire)) return refuse_hold(call, "world", TAUT_LOCKED);
    taut_result result = TAUT_OK;
    if (!stand.player || stand.player->world.bits != world.bits)
        result = refuse(TAUT_INVALID_ARGUMENT, "%s: world plays no recording: expected one of taut_replay_open", call);
    else
        result = stand.player->next(call, out);
    stand.busy.store(false, std::memory_order_release);
    return result;
}

void close_replay(uint32_t world) noexcept {
    if (replays.load(std::memory_order_relaxed) == 0) return;
    Stand& stand = stands[world_slot_of(world)];
    while (stand.busy.exchange(true, std::memory_order_acquire)) std::this_thread::yield();
    if (stand.player && stand.player->world.bits == world) {
        const taut_hooks hooks = stand.player->hooks();
        free_player(stand.player, hooks);
        stand.player = nullptr;
        replays.fetch_sub(1, std::memory_order_relaxed);
    }
    stand.busy.store(false, std::memory_order_release);
}

}  // namespace taut
