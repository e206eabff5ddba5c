// The graph of minimisation: islands of nodes that elements tie together, their elements in batches, and the pattern of
// a symmetric matrix of 3x3 blocks by rows, with the place of each element's blocks in it.
#include <algorithm>
#include <utility>

#include "partition/partition.h"
#include "solvers/minimisation.h"

namespace taut {
namespace {

class EnergyGraph {
public:
    EnergyGraph(const System& system, const Nodes& nodes, const Group& group, MinimisationMemory& memory)
        : system_(system), rows_(system.rows), node_at_(system.node_at), m_(memory) {
        m_.found_free.assign(system.node_at.size(), 0);
        for (const uint32_t node : group.nodes)
            if (nodes.mass[node].inv_mass > 0) m_.found_free[system.at(node)] = 1;
        m_.found_set.clear();
        for (const ElasticRun& run : rows_.elastic) {
            m_.found_set.push_back(run.set->serial);
            m_.found_set.push_back(run.count);
            m_.found_set.push_back(run.set->relaxation > 0 ? 1 : 0);
        }
    }

    // From here on that is what is known.
    bool is_known() {
        const auto settle = [](auto& known, const auto& found) {
            const bool same = std::ranges::equal(known, found);
            if (!same) known.assign(found.begin(), found.end());
            return same;
        };
        bool same = settle(m_.known_set, m_.found_set);
        same &= settle(m_.known_free, m_.found_free);
        same &= settle(m_.known_node, rows_.element_node);
        same &= settle(m_.known_element, rows_.element);
        same &= settle(m_.known_tie, m_.obstacles.tie);
        return same;
    }
    void build() {
        unite();
        list_elements();
        list_points();
        list_pieces();
        list_blocks();
        m_.factor.clear();
        for (size_t k = 0; k < m_.island.size(); ++k) m_.factor.emplace_back(*m_.factor.get_allocator().memory);
    }
    // A set's arrays may have moved, and its slot too.
    void find_sets() {
        for (EnergyBatch& batch : m_.batch) batch.set = rows_.elastic[batch.run].set;
    }

private:
    bool is_free(uint32_t seat) const { return m_.found_free[seat] != 0; }
    static uint32_t nodes_in(const ElasticRun& run) { return static_cast<uint32_t>(run.set->type->row.nodes); }
    std::span<const uint32_t> seats_of(const ElasticRun& run, uint32_t i) const {
        const uint32_t nodes = nodes_in(run);
        return {&rows_.element_node[run.node + size_t{i} * nodes], nodes};
    }
    uint32_t root_of(uint32_t seat) {
        Array<uint32_t>& parent = m_.scratch[0];
        while (parent[seat] != seat) seat = parent[seat] = parent[parent[seat]];
        return seat;
    }
    uint32_t island_of(std::span<const uint32_t> seats) {
        for (const uint32_t seat : seats)
            if (is_free(seat)) return m_.scratch[1][root_of(seat)];
        return kNone;
    }

    // Their common root.
    uint32_t unite(uint32_t one, uint32_t other) {
        const uint32_t a = root_of(one), b = root_of(other);
        m_.scratch[0][std::max(a, b)] = std::min(a, b);
        return std::min(a, b);
    }

    // scratch[0]: a seat that leads to the island's root; scratch[1]: of roots the island, in the order of elements.
    void unite() {
        const auto seats = static_cast<uint32_t>(m_.found_free.size());
        m_.scratch[0].resize(seats);
        for (uint32_t i = 0; i < seats; ++i) m_.scratch[0][i] = i;
        m_.scratch[1].assign(seats, kNone);
        for (const ElasticRun& run : rows_.elastic)
            for (uint32_t i = 0; i < run.count; ++i) {
                uint32_t first = kNone;
                for (const uint32_t seat : seats_of(run, i))
                    if (is_free(seat)) first = first == kNone ? root_of(seat) : unite(first, seat);
            }
        m_.tied.resize(seats);
        for (uint32_t i = 0; i < seats; ++i) m_.tied[i] = root_of(i);
        for (size_t i = 0; i < m_.obstacles.tie.size(); i += 2) {
            const uint32_t seat[2] = {system_.at(m_.obstacles.tie[i]), system_.at(m_.obstacles.tie[i + 1])};
            if (is_free(seat[0]) && is_free(seat[1])) unite(seat[0], seat[1]);
        }
        m_.island.clear();
        for (const ElasticRun& run : rows_.elastic)
            for (uint32_t i = 0; i < run.count; ++i)
                for (const uint32_t seat : seats_of(run, i))
                    if (is_free(seat) && m_.scratch[1][root_of(seat)] == kNone) {
                        m_.scratch[1][root_of(seat)] = static_cast<uint32_t>(m_.island.size());
                        m_.island.emplace_back();
                    }
    }

    // In batches, by island; scratch[2]: run of each element, scratch[3]: which of its elements, scratch[4]: where each
    // island's begin.
    void list_elements() {
        Array<uint32_t>&run_of = m_.scratch[2], &which = m_.scratch[3], &begin = m_.scratch[4];
        begin.assign(m_.island.size() + 1, 0);
        const auto for_all = [&](auto&& act) {
            for (uint32_t r = 0; r < rows_.elastic.size(); ++r)
                for (uint32_t i = 0; i < rows_.elastic[r].count; ++i)
                    if (const uint32_t island = island_of(seats_of(rows_.elastic[r], i)); island != kNone)
                        act(island, r, i);
        };
        for_all([&](uint32_t island, uint32_t, uint32_t) { ++begin[island + 1]; });
        for (size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
        run_of.resize(begin.back());
        which.resize(begin.back());
        m_.element.resize(begin.back());
        for_all([&](uint32_t island, uint32_t r, uint32_t i) {
            const uint32_t at = begin[island]++;
            run_of[at] = r;
            which[at] = i;
            m_.element[at] = rows_.element[rows_.elastic[r].element + i];
        });
        m_.batch.clear();
        uint32_t at = 0, node = 0, block = 0, frame = 0;
        for (uint32_t k = 0; k < m_.island.size(); ++k) {
            EnergyIsland& island = m_.island[k];
            island.first_batch = static_cast<uint32_t>(m_.batch.size());
            island.damped = false;
            for (; at < begin[k]; ++at) {
                const ElasticRun& run = rows_.elastic[run_of[at]];
                const bool joins = m_.batch.size() > island.first_batch && m_.batch.back().run == run_of[at] &&
                                   m_.batch.back().count < kEnergyBatch;
                if (!joins) {
                    m_.batch.push_back({run.set, run_of[at], at, 0, node, block, frame});
                    if (run.set->type->energy) ++frame;
                }
                ++m_.batch.back().count;
                node += nodes_in(run);
                block += nodes_in(run) * nodes_in(run);
                island.damped = island.damped || run.set->relaxation > 0;
            }
            island.batches = static_cast<uint32_t>(m_.batch.size()) - island.first_batch;
        }
        m_.point_of.resize(node);
        m_.block_of.resize(block);
        m_.energy.resize(m_.element.size());
        m_.frame.resize(frame * size_t{kFrameNumbers});
        m_.error.resize(m_.element.size() * kMaxRows);
        m_.force.resize(3 * size_t{node});
    }

    // Island by island, in the order of nodes, as meshes have them: neighbours are near. scratch[0], [1]: by seat its
    // point and the island that this belongs to.
    void list_points() {
        m_.scratch[1].assign(m_.found_free.size(), kNone);
        m_.scratch[0].resize(m_.found_free.size());
        m_.seat.clear();
        m_.free.clear();
        for (uint32_t k = 0; k < m_.island.size(); ++k) {
            EnergyIsland& island = m_.island[k];
            island.first_point = static_cast<uint32_t>(m_.seat.size());
            for_seats(island, [&](uint32_t seat, uint32_t) {
                if (std::exchange(m_.scratch[1][seat], k) != k) m_.seat.push_back(seat);
            });
            island.points = static_cast<uint32_t>(m_.seat.size()) - island.first_point;
            std::sort(m_.seat.begin() + island.first_point, m_.seat.end(),
                      [&](uint32_t a, uint32_t b) { return node_at_[a] < node_at_[b]; });
            for (uint32_t p = island.first_point; p < m_.seat.size(); ++p) {
                m_.scratch[0][m_.seat[p]] = p;
                m_.free.push_back(is_free(m_.seat[p]));
            }
            for_seats(island, [&](uint32_t seat, uint32_t node) { m_.point_of[node] = m_.scratch[0][seat]; });
        }
    }
    // act(seat, place in point_of) of each node of an island's elements; scratch[3] as list_elements() left it.
    template <class Act>
    void for_seats(const EnergyIsland& island, Act&& act) const {
        for (uint32_t b = island.first_batch; b < island.first_batch + island.batches; ++b) {
            const EnergyBatch& batch = m_.batch[b];
            uint32_t node = batch.node;
            for (uint32_t e = batch.first; e < batch.first + batch.count; ++e)
                for (const uint32_t seat : seats_of(rows_.elastic[batch.run], m_.scratch[3][e])) act(seat, node++);
        }
    }

    // scratch[2]: by what leads points of a piece together, the piece, or that something holds it.
    void list_pieces() {
        constexpr uint32_t kHeld = kNone - 1;
        Array<uint32_t>& piece_of = m_.scratch[2];
        piece_of.assign(m_.found_free.size(), kNone);
        for_elements([&](const EnergyBatch&, uint32_t nodes, uint32_t node, uint32_t) {
            const std::span<const uint32_t> points(&m_.point_of[node], nodes);
            if (std::ranges::all_of(points, [&](uint32_t p) { return m_.free[p]; })) return;
            for (const uint32_t p : points) piece_of[m_.tied[m_.seat[p]]] = kHeld;
        });
        m_.piece.assign(m_.seat.size(), kNone);
        uint32_t pieces = 0;
        for (EnergyIsland& island : m_.island) {
            island.first_piece = pieces;
            for (uint32_t p = island.first_point; p < island.first_point + island.points; ++p) {
                uint32_t& piece = piece_of[m_.tied[m_.seat[p]]];
                if (!m_.free[p] || piece == kHeld) continue;
                if (piece == kNone) piece = pieces++;
                m_.piece[p] = piece;
            }
            island.pieces = pieces - island.first_piece;
        }
        m_.turn.resize(pieces);
    }

    // Rows of points that share an element, ascending. scratch[0], [1]: begin and list of the places in point_of of
    // each point; [2]: size of the element of a place, and how far it is from its first one; [3]: who saw a point last.
    void list_blocks() {
        const auto points = static_cast<uint32_t>(m_.seat.size());
        Array<uint32_t>&begin = m_.scratch[0], &place = m_.scratch[1], &first = m_.scratch[2], &seen = m_.scratch[3];
        begin.assign(points + 2, 0);
        for (const uint32_t point : m_.point_of) ++begin[point + 2];
        for (uint32_t p = 2; p < begin.size(); ++p) begin[p] += begin[p - 1];
        place.resize(m_.point_of.size());
        for (uint32_t i = 0; i < m_.point_of.size(); ++i) place[begin[m_.point_of[i] + 1]++] = i;
        first.resize(2 * m_.point_of.size());
        for_elements([&](const EnergyBatch&, uint32_t nodes, uint32_t node, uint32_t) {
            for (uint32_t n = 0; n < nodes; ++n) first[2 * (node + n)] = node, first[2 * (node + n) + 1] = nodes;
        });
        seen.assign(points, kNone);
        m_.row_begin.assign(1, 0);
        m_.column.clear();
        for (uint32_t p = 0; p < points; ++p) {
            for (uint32_t k = begin[p]; k < begin[p + 1]; ++k)
                for (uint32_t i = first[2 * place[k]], end = i + first[2 * place[k] + 1]; i < end; ++i)
                    if (std::exchange(seen[m_.point_of[i]], p) != p) m_.column.push_back(m_.point_of[i]);
            std::sort(m_.column.begin() + m_.row_begin.back(), m_.column.end());
            m_.row_begin.push_back(static_cast<uint32_t>(m_.column.size()));
        }
        m_.diagonal.resize(points);
        for (uint32_t p = 0; p < points; ++p) m_.diagonal[p] = block_at(p, p);
        for_elements([&](const EnergyBatch&, uint32_t nodes, uint32_t node, uint32_t block) {
            for (uint32_t n = 0; n < nodes; ++n)
                for (uint32_t m = 0; m < nodes; ++m)
                    m_.block_of[block + n * nodes + m] = block_at(m_.point_of[node + n], m_.point_of[node + m]);
        });
    }
    uint32_t block_at(uint32_t row, uint32_t column) const {
        const auto begin = m_.column.begin() + m_.row_begin[row], end = m_.column.begin() + m_.row_begin[row + 1];
        return static_cast<uint32_t>(std::lower_bound(begin, end, column) - m_.column.begin());
    }
    // act(batch, nodes of an element, first place in point_of, first place in block_of)
    template <class Act>
    void for_elements(Act&& act) const {
        for (const EnergyBatch& batch : m_.batch) {
            const auto nodes = static_cast<uint32_t>(batch.set->type->row.nodes);
            for (uint32_t i = 0; i < batch.count; ++i)
                act(batch, nodes, batch.node + i * nodes, batch.block + i * nodes * nodes);
        }
    }

    const System& system_;
    const Rows& rows_;
    std::span<const uint32_t> node_at_;  // by seat
    MinimisationMemory& m_;
};

}  // namespace

void find_energy_graph(const System& system, const Nodes& nodes, const Group& group, MinimisationMemory& memory) {
    EnergyGraph graph(system, nodes, group, memory);
    if (!graph.is_known()) graph.build();
    graph.find_sets();
}

}  // namespace taut
