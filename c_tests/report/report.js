
// ---- speed against error, of all scenes or of one

const { charts, hard_dots: hardDots, common_scenes: commonScenes } = results;
const structureName = structure => structure.replaceAll("_", " ");
const dotName = row => engineLabel(row).replace(/^gnomon /, "").replace("embree", "Embree").replace("_", " ");
const asDots = rows => rows.map(row => ({ ...row, label: dotName(row), x: row.mrays_per_s }));

const dotTable = rows => table([...rows].sort((a, b) => b.mrays_per_s - a.mrays_per_s), [
  ["engine", dotName], numeric("Mray/s", "mrays_per_s", fixed(2)), numeric("t p99, ulp", "t_ulp_p99", significant),
  numeric("judged", "rays", count), numeric("missed", "missed", count), numeric("false", "false_hits", count), numeric("wrong", "wrong_primitive", count)]);

function plotsWithHard({ scene, ray_kind, dots }) {
  const plots = plotsOf(asDots(dots));
  if (scene || ray_kind || !hardDots.length) return plots;
  const [, ...hardPlot] = plotsOf(asDots(hardDots)).at(-1);
  return [...plots, ["Wrong decisions on hard rays, all populations below together. The speed is that on the scenes.", ...hardPlot]];
}

function chartSection() {
  const { place, show } = chartPlace();
  const figures = element("details", {}, element("summary", { className: "quiet", textContent: "The same in figures" }));
  const everything = `mean of ${commonScenes.length} ${commonScenes.length === 1 ? "scene" : "scenes"}`;
  const scenes = element("select", { ariaLabel: "scene" }, ...unique(charts.map(chart => chart.scene ?? everything)).map(name => element("option", { textContent: name })));
  let shownKind = null;
  const draw = () => {
    const chart = charts.find(({ scene, ray_kind }) => (scene ?? everything) === scenes.value && (ray_kind ?? "all rays") === shownKind);
    figures.replaceChildren(figures.firstChild, dotTable(chart.dots));
    if (window.Chart) show(plotsWithHard(chart));
  };
  scenes.onchange = draw;
  const kinds = choice(unique(charts.map(chart => chart.ray_kind ?? "all rays")), kind => { shownKind = kind; draw(); });
  return captioned("Speed against error", "One dot for each engine, structure and precision, on the same rays. Both scales are logarithmic; best is at the lower right.",
    element("div", {}, element("div", { className: "bar" }, scenes, kinds), place, ...legendOf(charts.flatMap(chart => chart.dots)), figures));
}

// ---- tables of everyone's rates: engines as columns, gnomon's worst structure, and a fold-out for each of them

const engineColumnsOf = rows => [["Embree", "embree", ""], ["Embree robust", "embree_robust", ""],
  ["gnomon FAST", "gnomon", "fast"], ["ACCURATE", "gnomon", "accurate"], ["EXACT", "gnomon", "exact"]]
  .filter(([, engine, precision]) => rows.some(row => row.engine === engine && row.precision === precision));

// `groups`: [name, rows, further cells]. A cell shows the largest figure of its rows, with the words of that row under the pointer.
function foldingTable(groups, firstHeading, further, { figure, format, words, mark }) {
  const engines = engineColumnsOf(groups.flatMap(([, rows]) => rows));
  const cell = rows => {
    const worst = rows.filter(row => figure(row) != null).reduce((most, row) => !most || figure(row) > figure(most) ? row : most, null);
    if (!worst) return element("td", { className: "number zero", textContent: "–" });
    return element("td", { className: `number ${figure(worst) ? mark(worst) : "zero"}`, textContent: format(figure(worst), worst), title: words(worst) });
  };
  const cells = (rows, only) => engines.map(([, engine, precision]) => cell(rows.filter(row => row.engine === engine && row.precision === precision && only(row))));
  const body = groups.flatMap(([name, rows, more]) => {
    const variants = unique(rows.filter(row => row.engine === "gnomon").map(variantName));
    const details = variants.map(variant => element("tr", { className: "detail", hidden: true }, element("td", { textContent: variant }),
      ...cells(rows, row => row.engine === "gnomon" && variantName(row) === variant), ...more.map(() => element("td"))));
    const fold = element("button", { className: "fold", textContent: name, ariaExpanded: "false", onclick: () => {
      details.forEach(row => { row.hidden = !row.hidden; });
      fold.ariaExpanded = String(!details[0]?.hidden);
    } });
    return [element("tr", {}, element("td", {}, fold), ...cells(rows, () => true), ...more.map(text => element("td", { className: "wide", textContent: text }))), ...details];
  });
  const heading = [element("th", { textContent: firstHeading }), ...engines.map(([title]) => element("th", { className: "number", textContent: title })),
    ...further.map(title => element("th", { textContent: title }))];
  return element("div", { className: "scroll" }, element("table", {}, element("thead", {}, element("tr", {}, ...heading)), element("tbody", {}, ...body)));
}

const share = key => row => 1e6 * row[key] / row.rays;
const variantName = row => row.engine === "gnomon" ? `${structureName(row.structure)} ${row.isa}` : dotName(row);
const rateWords = row => `${variantName(row)}: ${count(row.missed)} missed, ${count(row.false_hits)} false, ${count(row.wrong_primitive)} wrong of ${count(row.rays)}`;
const ulpWords = row => `${variantName(row)}: median ${significant(row.t_ulp_median)}, 99 % ${significant(row.t_ulp_p99)}, most ${significant(row.t_ulp_max)}`;
const uvWords = row => `${variantName(row)}: 99 % ${significant(row.uv_p99)}, most ${significant(row.uv_max)}`;
const exactBad = row => row.precision === "exact" ? "bad" : "";  // the others may err within their band
const rates = { format: count, words: rateWords, mark: exactBad };
const populationFigures = {
  "wrong decisions": { ...rates, figure: row => wrongDecisions(row) * 1e6 / row.rays },
  "missed": { ...rates, figure: share("missed") }, "false": { ...rates, figure: share("false_hits") }, "wrong primitive": { ...rates, figure: share("wrong_primitive") },
  "outside contract": { ...rates, figure: row => row.engine === "gnomon" ? 1e6 * row.outside_contract / row.rays : null, mark: () => "bad" },
  "t p99": { figure: row => row.t_ulp_p99, format: significant, words: ulpWords, mark: () => "" },
  "t max": { figure: row => row.t_ulp_max, format: significant, words: ulpWords, mark: () => "" },
  "u, v max": { figure: row => row.uv_max, format: significant, words: uvWords, mark: () => "" },
};

function populationSection() {
  const names = unique(results.populations.map(row => row.name));
  const groups = names.map(name => [name, results.populations.filter(row => row.name === name), []]);
  const place = element("div");
  const figures = choice(Object.keys(populationFigures), name => place.replaceChildren(foldingTable(groups, "population", [], populationFigures[name])));
  return captioned("Populations of hard rays", `${count(Math.max(...results.populations.map(row => row.rays)))} rays each, judged by the exact oracle. Counts are per million rays, t in ulps, u and v in units of 2⁻²⁴. ` +
    "gnomon’s columns show its worst structure; a row opens to each of them.", element("div", {}, figures, place));
}

const caseFigure = {
  figure: row => row.checked ? row.failed / row.checked : null, mark: exactBad,
  format: (_, row) => `${count(row.failed)} of ${count(row.checked)}`,
  words: row => `${variantName(row)}: ${count(row.failed)} of ${count(row.checked)} ${row.unit}`,
};

function caseSection() {
  const caseName = row => `${row.number} ${row.name}`;
  const inOrder = [...results.cases].sort((a, b) => a.number - b.number);
  const groups = unique(inOrder.map(caseName)).map(name => {
    const rows = inOrder.filter(row => caseName(row) === name);
    const texts = key => unique(rows.map(row => row[key]).filter(Boolean)).join("; ");
    return [name, rows, [texts("bar"), texts("limit")]];
  });
  return captioned("Hard cases", "Failed of checked. gnomon’s columns show its worst structure; a row opens to each of them. A limit is gnomon’s own.", foldingTable(groups, "case", ["bar", "limit"], caseFigure));
}

function barSection() {
  return captioned("Bars", "What gnomon has to keep, and what was measured.", table(results.bars, [
    ["", row => row.id], ["what", row => row.text, () => "prose"], ["bar", row => row.bar, () => "prose"], ["measured", row => row.measured, () => "prose"],
    ["", row => row.pass == null ? "" : row.pass ? "kept" : "not kept", row => row.pass ? "good" : "bad"]]));
}

// ---- light

const tiny = value => value == null ? "–" : value === 0 || value >= 0.001 ? significant(value) : value.toExponential(1);

function convergenceSection() {
  return element("details", {}, element("summary", { className: "quiet", textContent: "The same in figures" }), table(results.convergence, [
    ["lamp", row => row.lamp], ["estimator", row => row.estimator], numeric("samples", "samples", count), numeric("places", "places", count),
    numeric("error", "rms_error", tiny), numeric("stated", "rms_standard_error", tiny), numeric("seconds", "seconds", tiny)]));
}

const furnaceName = { path: "path tracing", whitted: "Whitted’s method" };
const furnaceMark = (value, row) => value == null ? "" : Math.abs(value - 1) <= 4 * row.standard_error + 1e-6 ? "good" : "bad";  // pictures are in float

function furnaceSection() {
  return captioned("The furnace decides", "Bodies that reflect or pass all light, in an environment of 1 nt: all they show must be 1 nt, or the method loses or makes light. " +
    "Means of the pixels of a kind, and their standard errors.", table(results.furnace, [
    ["method", row => furnaceName[row.method]], ["pixels that show", row => row.class], numeric("count", "pixel_count", count),
    numeric("mean, nt", "mean", fixed(5), furnaceMark), numeric("standard error", "standard_error", tiny)]));
}

// ---- the page

const put = (id, ...content) => document.getElementById(id).append(...content);
put("chart", chartSection());
if (results.bars.length) put("bars", barSection());
if (results.populations.length) put("populations", populationSection());
if (results.cases.length) put("cases", caseSection());
if (results.convergence.length) put("convergence", convergenceSection());
if (results.furnace.length) put("furnace", furnaceSection());

const { settings, left_out: leftOut } = results;
const calls = { single: "each ray written right before its call", prefilled: "single calls over an array written before", batch: "one call for all rays" };
put("run", `In this run: ${count(settings.rays)} rays of each kind and scene timed, ${count(settings.judged)} of them judged; ${calls[settings.call]}, ` +
  `${settings.threads} ${settings.threads === 1 ? "thread" : "threads"}.`,
  ...Object.entries(leftOut).map(([structure, scenes]) => ` Without ${structureName(structure)}: ${scenes.join(", ")}.`));
