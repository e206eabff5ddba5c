// The host's profiler: told where stages begin and end.
#pragma once

#include <taut/profile.h>

#include "base/clock.h"

namespace taut {

// The host's function; null: none. What it throws is dropped.
class ProfileScopes {
public:
    void set(taut_profile_scope_fn scope, void* user_data) { scope_ = scope, user_data_ = user_data; }
    bool on() const { return scope_ != nullptr; }
    void tell(const char* name, uint32_t thread, uint32_t end) const noexcept {
        if (!scope_) return;
        try {
            scope_(name, thread, end, user_data_);
        } catch (...) {
        }
    }

private:
    taut_profile_scope_fn scope_ = nullptr;
    void* user_data_ = nullptr;
};

// From here to the end of a block.
class ProfileScope {
public:
    ProfileScope(const ProfileScopes& scopes, const char* name, uint32_t thread)
        : scopes_(scopes), name_(name), thread_(thread) {
        scopes_.tell(name_, thread_, 0);
    }
    ~ProfileScope() { scopes_.tell(name_, thread_, 1); }
    ProfileScope(const ProfileScope&) = delete;
    ProfileScope& operator=(const ProfileScope&) = delete;

private:
    const ProfileScopes& scopes_;
    const char* name_;
    uint32_t thread_;
};

// Times of the stages on the stepping thread, one after the other, each a scope.
class StageWatch {
public:
    explicit StageWatch(const ProfileScopes& scopes) : scopes_(scopes) {}
    ~StageWatch() { end(); }
    StageWatch(const StageWatch&) = delete;
    StageWatch& operator=(const StageWatch&) = delete;

    void begin(const char* name) {
        end();
        name_ = name;
        scopes_.tell(name, 0, 0);
    }
    // Microseconds since construction or the last lap.
    float lap() {
        end();
        return watch_.lap();
    }

private:
    void end() {
        if (name_) scopes_.tell(name_, 0, 1);
        name_ = nullptr;
    }

    const ProfileScopes& scopes_;
    Stopwatch watch_;
    const char* name_ = nullptr;  // of the scope that is open
};

}  // namespace taut
