#include "hard/json.hpp"

#include "compare/json.hpp"

namespace harness {
namespace {

using Json = nlohmann::ordered_json;

void add_engine(Json& json, const HardEngine& engine) {
    json["engine"] = engine.engine;
    json["structure"] = engine.structure;
    json["precision"] = engine.precision;
    json["isa"] = engine.isa;
}

Json population_json(const PopulationRow& row) {
    const Errors& errors = row.errors;
    Json json = {{"name", row.name}};
    add_engine(json, row.engine);
    json.update({{"rays", errors.ray_count},
                 {"missed", errors.missed},
                 {"false_hits", errors.false_hits},
                 {"wrong_primitive", errors.wrong_primitive}});
    if (row.engine.is_gnomon()) json["outside_contract"] = errors.outside_contract;
    json.update({{"t_ulp_median", number(errors.t_ulps.median)},
                 {"t_ulp_p99", number(errors.t_ulps.p99)},
                 {"t_ulp_max", number(errors.t_ulps.max)},
                 {"uv_p99", number(errors.uv.p99)},
                 {"uv_max", number(errors.uv.max)}});
    return json;
}

Json case_json(const CaseRow& row) {
    Json json = {{"number", row.number}, {"name", row.name}};
    add_engine(json, row.engine);
    json.update({{"checked", row.checked}, {"failed", row.failed}, {"unit", row.unit}, {"bar", row.bar}, {"limit", row.limit}});
    return json;
}

}  // namespace

Json hard_json(const HardOptions& options, const HardResults& results) {
    Json json = heading_json(this_machine(), these_versions());
    json["seed"] = options.seed;
    json["rays"] = options.ray_count;
    json["seconds"] = results.seconds;
    for (const char* rows : {"populations", "cases", "bars"}) json[rows] = Json::array();
    for (const PopulationRow& row : results.populations) json["populations"].push_back(population_json(row));
    for (const CaseRow& row : results.cases) json["cases"].push_back(case_json(row));
    for (const HardBar& bar : results.bars)
        json["bars"].push_back(
            {{"id", bar.id}, {"text", bar.text}, {"measured", bar.measured}, {"bar", bar.bar}, {"pass", bar.pass}});
    return json;
}

}  // namespace harness
