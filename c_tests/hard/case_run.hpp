// What a hard case asks with: each engine on a scene, held against the oracle or against what must be.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hard/answers.hpp"
#include "hard/failures.hpp"
#include "hard/populations.hpp"
#include "hard/results.hpp"

namespace harness {

class CaseRun;

/// One of accuracy.md's hard cases; one with several parts has an entry for each, of the same number.
struct HardCase {
    int number;
    std::string name;
    std::string bar;
    std::function<void(CaseRun&)> run;
    std::string limit = "";  // where gnomon's own answers have one
    std::string unit = "rays";
    bool fast_is_held = true;  // FAST to its contract
};

/// A case being run. Sums up one row an engine.
class CaseRun {
public:
    CaseRun(const HardCase& hard_case, const HardOptions& options, const std::vector<HardEngine>& engines, Failures& failures);

    Rng rng;
    /// Rays of a case that shares them among `parts` scenes.
    std::size_t ray_count(std::size_t parts = 1) const;
    bool is_full() const { return options_.is_full(); }

    using Check = std::function<void(const HardEngine&, Backend&, CaseRow&)>;
    using Choice = std::function<bool(const HardEngine&)>;
    /// Calls check() for every engine, of those chosen, that can take the scene: Embree coordinates up to its limit, a BSP tree
    /// and brute force not too many triangles.
    void each_engine(
        const Scene& scene, const Check& check, const Choice& is_chosen = [](const HardEngine&) { return true; });

    /// Which decisions are wrong, by the oracle; and the contract.
    void judge(const Scene& scene, const std::vector<GnomonRay>& rays);
    void judge(const Trial& trial) { judge(trial.scene, trial.rays); }

    void expect_hits(const Scene& scene, const std::vector<GnomonRay>& rays) { expect(scene, rays, true); }
    void expect_misses(const Scene& scene, const std::vector<GnomonRay>& rays) { expect(scene, rays, false); }

    /// Counts a failure that the contract does not allow gnomon; is said in words.
    void fail(CaseRow& row, const Scene& scene, const GnomonRay& ray, const std::string& what);

    /// Closes the run.
    std::vector<CaseRow> take_rows();

private:
    void expect(const Scene& scene, const std::vector<GnomonRay>& rays, bool hit);
    bool is_held(const HardEngine& engine) const { return engine.is_exacting() || (engine.is_gnomon() && case_.fast_is_held); }
    std::string where() const { return "case " + std::to_string(case_.number) + ", " + case_.name; }

    const HardCase& case_;
    const HardOptions& options_;
    const std::vector<HardEngine>& engines_;
    Failures& failures_;
    std::vector<CaseRow> rows_;
};

}  // namespace harness
