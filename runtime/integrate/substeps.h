// The substeps of a group's frame, equal ones as long as none is halved.
#pragma once

#include <cstdint>
#include <limits>

namespace taut {

// Light links that snap taut or whip turn by radians in a substep, and its straight step then leaves their joints open
// by half a link and more. Such a substep is not kept: it is halved, three times at most, and those after it grow again
// as far as what is left of the frame can be divided by them.
class Substeps {
public:
    Substeps(double frame, uint32_t count, bool divisible)
        : frame_(frame), end_(count * kParts), least_(divisible ? 1 : kParts) {}

    bool done() const { return at_ == end_; }
    bool last() const { return at_ + size_ == end_; }
    uint32_t number() const { return number_; }                     // of those that were kept before this one
    double length() const { return time(size_); }                   // [s]
    double begin() const { return time(at_); }                      // [s], of the frame
    double end() const { return time(at_ + size_); }                // [s]
    double left() const { return 1 - double(at_ + size_) / end_; }  // share of the frame
    // By how much a lever may turn [rad].
    double most_turn() const { return size_ > least_ ? kMostTurn : std::numeric_limits<double>::infinity(); }

    void halve() { size_ /= 2; }
    // To the next one. turn: of the levers in this one, at most [rad].
    void advance(double turn) {
        at_ += size_;
        ++number_;
        for (; size_ < kParts && at_ % (2 * size_) == 0 && 2 * turn < kCalmTurn; turn *= 2) size_ *= 2;
    }

private:
    // A lever r that turns by a is r a^2 / 2 off the circle of its end. With 0.15 chains of 1 kg links that a weight of
    // 100 kg is jerked by at 20 m/s stay closed within 44 mm, with 0.3 100 mm, without 2.9 m.
    static constexpr double kMostTurn = 0.15, kCalmTurn = 0.8 * kMostTurn;  // [rad]
    static constexpr uint32_t kParts = 8;

    double time(uint32_t parts) const { return frame_ * parts / end_; }

    double frame_;
    uint32_t at_ = 0, size_ = kParts, end_, least_, number_ = 0;  // in eighths of a whole substep
};

}  // namespace taut
