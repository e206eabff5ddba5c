#include "solve_report.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "api/access.h"

namespace bench {

namespace {

// Rows with a force, by their yield: an octave a bin, from 1 um on, so that half the substep is two bins less; the
// first holds what yields less, the last what yields 1.05 m or more.
constexpr int kBins = 22;
constexpr double kFirst = 1e-6;  // [m]

int bin_of(double yield) {
    return std::clamp(1 + static_cast<int>(std::floor(std::log2(yield / kFirst))), 0, kBins - 1);
}

struct RowCounts {
    // swept contacts, direct contacts, swept joints, direct joints
    std::array<std::array<uint32_t, kBins>, 4> by_yield{};
    std::array<uint32_t, 4> above{};  // of contacts, those that yield more than a tenth of their margin

    void add(const taut::RowYield& row) {
        const size_t kind = (row.contact ? 0 : 2) + (row.direct ? 1 : 0);
        const auto yield = static_cast<double>(row.yield);
        ++by_yield[kind][static_cast<size_t>(bin_of(yield))];
        if (row.contact && yield > 0.1 * static_cast<double>(row.margin)) ++above[kind];
    }
};

constexpr const char* kKinds[] = {"swept_contacts", "direct_contacts", "swept_joints", "direct_joints"};
constexpr const char* kReasons[] = {"joint", "load", "hit", "tower", "pressed", "squeezed"};

}  // namespace

const char* const kReportHelp =
    "Columns of --report:\n"
    "  frame substep island bodies rows direct_rows   where, and how many bodies and scalar rows\n"
    "  substeps sweeps h                   what the rules gave the island, and the substep [s]\n"
    "  yield direct_yield                  s h^2 w |f| [m] of swept rows, and of direct ones had they been swept\n"
    "  residual linearisation energy       what the solve left [m, m, J]; see runtime/solvers/report.h\n"
    "  joint load hit tower pressed squeezed   1: by this rule rows are direct; squeezed: are not\n"
    "  above_swept above_direct            contact points that yield more than a tenth of their margin\n"
    "  swept_contacts_0 ... direct_joints_21   points and joints by yield: below 1 um, then an octave each\n";

SolveReportFile::SolveReportFile(const std::string& path) : path_(path), out_(path) {
    if (!out_) throw std::runtime_error("cannot write " + path);
    out_.precision(6);
    out_ << "frame,substep,island,bodies,rows,direct_rows,substeps,sweeps,h,yield,direct_yield,residual,linearisation,"
            "energy";
    for (const char* reason : kReasons) out_ << ',' << reason;
    out_ << ",above_swept,above_direct";
    for (const char* kind : kKinds)
        for (int bin = 0; bin < kBins; ++bin) out_ << ',' << kind << '_' << bin;
    out_ << '\n';
}

void SolveReportFile::add(taut_world world, uint32_t frame) {
    const taut::Hold hold(taut::world_of(world), taut::Use::read);
    const taut::SolveReports& reports = hold.world()->reports;
    // Rows come in the order of reports' substeps, islands mixed within each.
    std::vector<std::vector<RowCounts>> counts;
    for (const taut::IslandReport& r : reports.islands) {
        if (counts.size() <= r.island) counts.resize(r.island + 1);
        if (counts[r.island].size() <= r.substep) counts[r.island].resize(r.substep + 1);
    }
    for (const taut::RowYield& row : reports.rows) counts[row.island][row.substep].add(row);
    for (const taut::IslandReport& r : reports.islands) {
        const RowCounts& of = counts[r.island][r.substep];
        out_ << frame << ',' << r.substep << ',' << r.island << ',' << r.bodies << ',' << r.rows << ',' << r.direct_rows
             << ',' << r.substeps << ',' << r.sweeps << ',' << r.h << ',' << r.yield << ',' << r.direct_yield << ','
             << r.residual << ',' << r.linearisation << ',' << r.energy;
        for (size_t bit = 0; bit < std::size(kReasons); ++bit) out_ << ',' << (r.reasons >> bit & 1);
        out_ << ',' << of.above[0] << ',' << of.above[1];
        for (const auto& kind : of.by_yield)
            for (const uint32_t count : kind) out_ << ',' << count;
        out_ << '\n';
    }
    if (!out_) throw std::runtime_error("cannot write " + path_);
}

}  // namespace bench
