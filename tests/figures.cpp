#include "figures.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace figures {

namespace {

struct Figure {
    double value = 0, bound = 0;
    bool above = true;

    // How far the bound is, in parts of it; of a bound of 0 in the value's own unit.
    double distance() const {
        const double apart = above ? bound - value : value - bound;
        return bound == 0 ? apart : apart / std::abs(bound);
    }
};

// Without what parametrised tests have around it: Rates/Suite.Name/3 is Suite.Name.
std::string test_name() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    if (!test) return {};
    std::string suite = test->test_suite_name(), name = test->name();
    suite.erase(0, suite.find('/') + 1);  // npos + 1 is 0
    name.erase(std::min(name.find('/'), name.size()));
    return suite + "." + name;
}

// Appended at the program's end, a line each.
class Kept {
public:
    ~Kept() {
        const char* path = std::getenv("TAUT_FIGURES");
        std::FILE* file = path ? std::fopen(path, "a") : nullptr;
        if (!file) return;
        for (const auto& [key, figure] : figures_)
            std::fprintf(file, "%s\t%s\t%.17g\t%s\t%.17g\n", key.first.c_str(), key.second.c_str(), figure.value,
                         figure.above ? "<=" : ">=", figure.bound);
        std::fclose(file);
    }

    void keep(const char* what, const Figure& figure) {
        const std::lock_guard lock(mutex_);
        const auto [at, added] = figures_.try_emplace({test_name(), what}, figure);
        if (!added && figure.distance() < at->second.distance()) at->second = figure;
    }

private:
    std::mutex mutex_;
    std::map<std::pair<std::string, std::string>, Figure> figures_;  // by test and expression
};

}  // namespace

void keep(const char* what, double value, double bound, bool above) {
    static const bool asked = std::getenv("TAUT_FIGURES") != nullptr;
    if (!asked || !std::isfinite(value) || !std::isfinite(bound)) return;
    static Kept kept;
    kept.keep(what, {value, bound, above});
}

}  // namespace figures
