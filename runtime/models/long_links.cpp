#include "models/long_links.h"

#include <algorithm>
#include <numeric>

#include "state/nodes.h"

namespace taut {
namespace {

// Cosine below which two links at a vertex go straight on: within an eighth of a turn.
constexpr double kStraight = -0.70710678118654752;

// Rows of vertices, one after the other.
struct Threads {
    explicit Threads(Memory& memory) : begin(memory), vertex(memory), length(memory), links(memory) {}

    uint32_t count() const { return static_cast<uint32_t>(begin.size()) - 1; }
    void clear() {
        begin.assign(1, 0);
        vertex.clear();
        length.clear();
        links.clear();
    }
    void close() { begin.push_back(static_cast<uint32_t>(vertex.size())); }

    Array<uint32_t> begin;  // [count + 1] in the others
    Array<uint32_t> vertex;
    Array<double> length;   // from the vertex before it in its thread [m]; of the first 0
    Array<uint32_t> links;  // likewise
};

// Of each key 0 to count - 1 the values put to it.
struct Lists {
    explicit Lists(Memory& memory) : begin(memory), value(memory) {}

    template <class Each>
    void build(uint32_t count, Each&& each) {
        begin.assign(count + 2, 0);
        each([&](uint32_t key, uint32_t) { ++begin[key + 2]; });
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        value.resize(begin.back());
        each([&](uint32_t key, uint32_t what) { value[begin[key + 1]++] = what; });
    }
    std::span<const uint32_t> of(uint32_t key) const { return {&value[begin[key]], begin[key + 1] - begin[key]}; }

    Array<uint32_t> begin, value;
};

class LongLinkFinder {
public:
    LongLinkFinder(std::span<const Vec3> rest, std::span<const ThreadLink> links, Memory& memory)
        : rest_(rest),
          links_(links),
          at_(memory),
          through_(memory),
          next_(memory),
          used_(memory),
          kept_(memory),
          thread_of_(memory),
          crosses_(memory),
          crossings_(memory),
          threads_(memory),
          coarser_(memory) {}

    void run(uint32_t most_levels, Array<LongLink>& out) {
        at_.build(vertices(), [&](auto&& put) {
            for (uint32_t i = 0; i < links_.size(); ++i) put(links_[i].a, i), put(links_[i].b, i);
        });
        pair_up();
        follow();
        for (uint32_t level = 1; level <= most_levels && coarsen(); ++level)
            for (uint32_t t = 0; t < threads_.count(); ++t)
                for (uint32_t i = threads_.begin[t] + 1; i < threads_.begin[t + 1]; ++i)
                    if (threads_.links[i] > 1)
                        out.push_back(
                            {threads_.vertex[i - 1], threads_.vertex[i], level, threads_.links[i], threads_.length[i]});
        std::ranges::stable_sort(out, [](const LongLink& a, const LongLink& b) { return a.level > b.level; });
    }

private:
    uint32_t vertices() const { return static_cast<uint32_t>(rest_.size()); }
    uint32_t other_end(uint32_t link, uint32_t vertex) const {
        return links_[link].a == vertex ? links_[link].b : links_[link].a;
    }
    Vec3 along(uint32_t link, uint32_t from) const { return (rest_[other_end(link, from)] - rest_[from]).normalized(); }
    // What follows a link beyond one of its ends.
    uint32_t& next(uint32_t link, uint32_t end) { return next_[2 * size_t{link} + (links_[link].b == end ? 1 : 0)]; }

    // At each vertex those that go straightest on first.
    void pair_up() {
        next_.assign(2 * links_.size(), kNone);
        for (uint32_t v = 0; v < vertices(); ++v) {
            while (true) {
                double least = kStraight;
                uint32_t pair[2] = {kNone, kNone};
                for (const uint32_t a : at_.of(v))
                    for (const uint32_t b : at_.of(v)) {
                        if (a >= b || next(a, v) != kNone || next(b, v) != kNone) continue;
                        const double cosine = along(a, v).dot(along(b, v));
                        if (cosine < least) least = cosine, pair[0] = a, pair[1] = b;
                    }
                if (pair[0] == kNone) break;
                next(pair[0], v) = pair[1];
                next(pair[1], v) = pair[0];
            }
        }
    }

    // Links in a row, from the first to the last; a ring from its first link on.
    void follow() {
        used_.assign(links_.size(), 0);
        threads_.clear();
        for (const bool rings : {false, true})
            for (uint32_t i = 0; i < links_.size(); ++i)
                for (const uint32_t start : {links_[i].a, links_[i].b})
                    if (!used_[i] && (rings || next(i, start) == kNone)) add_thread(i, start);
    }
    void add_thread(uint32_t link, uint32_t vertex) {
        add_vertex(threads_, vertex, 0, 0);
        while (link != kNone && !used_[link]) {
            used_[link] = 1;
            const uint32_t to = other_end(link, vertex);
            add_vertex(threads_, to, (rest_[to] - rest_[vertex]).norm(), 1);
            link = next(link, to);
            vertex = to;
        }
        threads_.close();
    }
    static void add_vertex(Threads& to, uint32_t vertex, double length, uint32_t links) {
        to.vertex.push_back(vertex);
        to.length.push_back(length);
        to.links.push_back(links);
    }

    template <class Act>
    void for_each_vertex(Act&& act) const {
        for (uint32_t t = 0; t < threads_.count(); ++t)
            for (uint32_t i = threads_.begin[t]; i < threads_.begin[t + 1]; ++i) act(t, i);
    }

    // False where nothing is left to coarsen.
    bool coarsen() {
        through_.build(vertices(),
                       [&](auto&& put) { for_each_vertex([&](uint32_t, uint32_t i) { put(threads_.vertex[i], i); }); });
        thread_of_.resize(threads_.vertex.size());
        for_each_vertex([&](uint32_t t, uint32_t i) { thread_of_[i] = t; });
        keep_apart();
        crossings_.assign(vertices(), 0);
        for_each_vertex([&](uint32_t t, uint32_t i) { crossings_[threads_.vertex[i]] += kept_[t] ? 1 : 0; });
        coarser_.clear();
        bool shorter = false;
        for (uint32_t t = 0; t < threads_.count(); ++t) {
            if (!kept_[t]) continue;
            double length = 0;
            uint32_t links = 0;
            for (uint32_t i = threads_.begin[t]; i < threads_.begin[t + 1]; ++i) {
                length += threads_.length[i];
                links += threads_.links[i];
                const bool end = i == threads_.begin[t] || i + 1 == threads_.begin[t + 1];
                if (end || crossings_[threads_.vertex[i]] > 1) {
                    add_vertex(coarser_, threads_.vertex[i], length, links);
                    length = 0;
                    links = 0;
                } else {
                    shorter = true;
                }
            }
            coarser_.close();
        }
        std::swap(threads_, coarser_);
        return shorter;
    }

    // Threads of which none lies beside one before it: a thread across both, on which they follow each other.
    void keep_apart() {
        kept_.assign(threads_.count(), 1);
        crosses_.assign(threads_.count(), kNone);
        for (uint32_t t = 0; t < threads_.count(); ++t) {
            for_each_through(t, [&](uint32_t place) { crosses_[thread_of_[place]] = t; });
            for_each_through(t, [&](uint32_t place) {
                if (thread_of_[place] == t) return;
                for (const uint32_t beside : {place - 1, place + 1})
                    if (beside < threads_.vertex.size() && thread_of_[beside] == thread_of_[place] &&
                        follows(t, beside))
                        kept_[t] = 0;
            });
        }
    }
    // act(place in the threads) of all threads that go through a thread's vertices.
    template <class Act>
    void for_each_through(uint32_t t, Act&& act) const {
        for (uint32_t i = threads_.begin[t]; i < threads_.begin[t + 1]; ++i)
            for (const uint32_t place : through_.of(threads_.vertex[i])) act(place);
    }
    // Whether through the vertex at a place goes a thread before t that is kept and does not cross it.
    bool follows(uint32_t t, uint32_t place) const {
        return std::ranges::any_of(through_.of(threads_.vertex[place]), [&](uint32_t other) {
            const uint32_t thread = thread_of_[other];
            return thread < t && kept_[thread] && crosses_[thread] != t;
        });
    }

    std::span<const Vec3> rest_;
    std::span<const ThreadLink> links_;
    Lists at_, through_;  // of each vertex its links; its places in threads_
    Array<uint32_t> next_;
    Array<uint8_t> used_, kept_;
    Array<uint32_t> thread_of_;  // of each place
    Array<uint32_t> crosses_;    // of each thread, the last one found to cross it
    Array<uint32_t> crossings_;  // of each vertex, by threads that are kept
    Threads threads_, coarser_;
};

}  // namespace

void find_long_links(std::span<const Vec3> rest, std::span<const ThreadLink> links, uint32_t most_levels,
                     Array<LongLink>& out) {
    LongLinkFinder(rest, links, *out.get_allocator().memory).run(most_levels, out);
}

}  // namespace taut
