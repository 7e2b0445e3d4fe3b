#include "hard/judge_population.hpp"

#include "compare/classify.hpp"
#include "compare/describe.hpp"
#include "hard/answers.hpp"
#include "hard/truth.hpp"

namespace harness {

std::vector<PopulationRow> judge_population(const Population& population, const HardOptions& options,
                                            const std::vector<HardEngine>& engines, Failures& failures) {
    Rng rng = rng_of(options, population.name);
    const Trial trial = population.make(options.ray_count, rng);
    Truth truth(trial.scene, trial.rays);
    Reference reference;
    std::vector<PopulationRow> rows;
    for (const HardEngine& engine : engines) {
        const std::unique_ptr<Backend> backend = make_backend(engine, trial.scene);
        const Answers answers = answers_of(*backend, trial.rays);
        const std::vector<Verdict> verdicts = truth.judge(answers.hits, contract_of(backend->report()));
        PopulationRow row{population.name, engine, count_errors(backend->report(), verdicts), 0, 0};
        row.errors.ray_kind = population.name;
        row.errors.ray_count = trial.rays.size();
        row.differences = reference.count_differences(engine, answers.hits);
        for (std::size_t i = 0; i < trial.rays.size(); ++i) {
            row.disagreements += !answers.agree(i);
            if (!engine.is_gnomon() || !is_fault(backend->report(), verdicts[i])) continue;
            failures.add(population.name, engine, trial.scene, trial.rays[i], truth.describe(i, answers.hits[i], verdicts[i]));
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace harness
