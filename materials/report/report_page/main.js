// The page: one chosen domain, seen by the 3-D view, the charts, the table and the card of details.
"use strict";

const errors = [];
window.addEventListener("error", (event) => errors.push(event.message));
window.addEventListener("unhandledrejection", (event) => errors.push(String(event.reason)));

const data = JSON.parse(document.getElementById("data").textContent);
const D = data.domains, COUNT = D.name?.length ?? 0;
const $ = (id) => document.getElementById(id);
const groupColour = (i) => CATEGORIES[i % CATEGORIES.length];
const doubtful = (id) => D.doubt[id] !== "";
const kind = (id) => (D.leaf[id] ? "leaf" : "branch");
const modelNu = (name) => data.models.find((model) => model.name === name).nu;
const view = {};

/** What the plant can be coloured by and counted by. */
const QUANTITIES = {
  nu: { title: "frequency ν", unit: "Hz", values: D.nu, log: true },
  E: { title: "Young's modulus E", unit: "Pa", values: D.E, log: true },
  xi: { title: "damping factor ξ", unit: "", values: D.xi },
  dK: { title: "stiffness damping d_K", unit: "s", values: D.dK, log: D.dK.every((v) => v > 0) },
  level: { title: "level", unit: "", values: D.level, classes: () => [...new Set(D.level)].sort((a, b) => a - b), of: (id) => D.level[id] },
  group: { title: "material group", unit: "", classes: () => data.groups.map((g, i) => i), of: (id) => D.group[id], name: (i) => data.groups[i].name },
  route: { title: "how it was made solid", unit: "", classes: () => data.routes.map((r, i) => i), of: (id) => D.route[id], name: (i) => data.routes[i] },
  nu0: { title: "frequency of the default material ν₀", unit: "Hz", values: D.nu0, log: true },
  length: { title: "length ℓ", unit: "m", values: D.length, log: true },
  mass: { title: "mass", unit: "kg", values: D.mass, log: true },
};
for (const model of data.models)
  if (model.name !== data.model) QUANTITIES["nu " + model.name] = { title: `ν by the ${model.name} model`, unit: "Hz", values: model.nu, log: true };

function fillHeader() {
  const leaves = D.leaf.reduce((sum, leaf) => sum + leaf, 0), doubts = D.doubt.filter((text) => text).length;
  document.title = `${data.plant} – Liana bake`;
  $("title").textContent = data.plant;
  $("subtitle").textContent = `as ${data.species}, ${data.model} model · plant ${data.plant_hash.slice(0, 8)}, species ${data.species_hash.slice(0, 8)}`;
  const fact = (label, text, warn) => $("facts").append(element("div", { class: warn ? "warn" : "" }, element("dt", {}, label), element("dd", {}, text)));
  fact("branches", String(COUNT - leaves));
  fact("leaves", String(leaves));
  fact("mass", withUnit(D.mass.reduce((sum, mass) => sum + mass, 0), "kg"));
  fact("main frequency", withUnit(D.nu[0], "Hz"));
  fact("tetrahedra", readable(D.tets.reduce((sum, tets) => sum + tets, 0)));
  fact("baked in", withUnit(data.seconds.total, "s"));
  fact("doubtful", String(doubts), doubts > 0);
  fact("left out", String(data.failed.length), data.failed.length > 0);
}

// --- colours -----------------------------------------------------------------------------------------------------

function scaleOf(quantity) {
  const [least, most] = range(quantity.log ? quantity.values.filter((v) => v > 0) : quantity.values);
  const span = most > least;
  const at = (v) => (!span ? 0.5 : quantity.log ? Math.log(v / least) / Math.log(most / least) : (v - least) / (most - least));
  const inverse = (t) => (quantity.log ? least * (most / least) ** t : least + t * (most - least));
  return { least, most, at, inverse, span };
}

function classColour(classes, value) {
  const i = classes.indexOf(value);
  return rgb(CATEGORIES[i % CATEGORIES.length]);
}

function colourBy(key) {
  const quantity = QUANTITIES[key], legend = $("legend");
  legend.replaceChildren(element("b", {}, quantity.title + (quantity.unit ? `, ${quantity.unit}` : "")));
  const colours = [];
  if (quantity.classes) {
    const classes = quantity.classes();
    for (let id = 0; id < COUNT; ++id) colours.push(classColour(classes, quantity.of(id)));
    for (const value of classes.slice(0, 14))
      legend.append(element("div", { class: "swatch" }, element("i", { style: `background:rgb(${classColour(classes, value)})` }), String(quantity.name ? quantity.name(value) : value)));
    if (classes.length > 14) legend.append(`… ${classes.length - 14} more`);
  } else {
    const scale = scaleOf(quantity);
    for (let id = 0; id < COUNT; ++id) colours.push(viridis(scale.at(quantity.values[id])));
    if (scale.span) {
      const stops = VIRIDIS.map((c) => `rgb(${c})`).reverse().join(",");
      const steps = [1, 0.75, 0.5, 0.25, 0].map((t) => element("li", {}, readable(scale.inverse(t))));
      legend.append(element("div", { class: "ramp" }, element("i", { style: `background:linear-gradient(${stops})` }), element("ol", {}, ...steps)));
    } else legend.append(element("div", { class: "swatch" }, element("i", { style: `background:rgb(${viridis(0.5)})` }), readable(scale.least)));
  }
  if (data.failed.length) legend.append(element("div", { class: "swatch" }, element("i", { style: "background:rgb(200,40,60)" }), "left out"));
  view.plant?.setColours(colours);
}

// --- charts ------------------------------------------------------------------------------------------------------

const spread = (least, most, n, log) => Array.from({ length: n }, (_, i) => (log ? least * (most / least) ** (i / (n - 1)) : least + ((most - least) * i) / (n - 1)));
const idsOfGroup = (i) => [...D.group.keys()].filter((id) => D.group[id] === i);

function lawSeries() {
  const series = [];
  data.groups.forEach((group, i) => {
    const ids = idsOfGroup(i), colour = groupColour(i), [least, most] = range(ids.map((id) => D.length[id]));
    const x = spread(least / 1.15, most * 1.15, 2, true);
    series.push({ name: group.name, colour, ids, x: ids.map((id) => D.length[id]), y: ids.map((id) => D.nu[id]) });
    series.push({ with: group.name, colour, line: true, x, y: x.map((l) => group.frequency * (l / group.length) ** group.epsilon1) });
  });
  return series;
}

function modelSeries() {
  const ids = [...Array(COUNT).keys()];
  return data.models.map((model, i) => ({ name: model.name, colour: CATEGORIES[[0, 1, 3, 2][i]], ids, x: D.length, y: model.nu }));
}

/** Eq. 13 or, where d_M and d_K are constant, Eq. 12 of [Wang17]. */
function dampingFactor(law, nu) {
  if (law.dM !== undefined) return (law.dM / (2 * Math.PI * nu) + 2 * Math.PI * law.dK * nu) / 2;
  const t = (nu - law.low_frequency) / Math.max(law.high_frequency - law.low_frequency, 1e-12);
  return law.low_factor + Math.min(Math.max(t, 0), 1) * (law.high_factor - law.low_factor);
}

function dampingSeries() {
  const series = [], [least, most] = range(D.nu), x = spread(least / 1.6, most * 1.6, 240, true);
  data.groups.forEach((group, i) => {
    const ids = idsOfGroup(i), colour = groupColour(i);
    series.push({ with: group.name, colour, line: true, x, y: x.map((nu) => dampingFactor(group.damping, nu)) });
    series.push({ name: group.name, colour, ids, x: ids.map((id) => D.nu[id]), y: ids.map((id) => D.xi[id]) });
  });
  // What constant stiffness damping would be, with the main trunk's ξ: [Wang17] Figure 17.
  const dK = D.xi[0] / (Math.PI * D.nu[0]);
  series.push({ name: "constant Rayleigh", colour: "#888888", line: true, dash: [5, 4], free: true, x, y: x.map((nu) => Math.PI * dK * nu) });
  return series;
}

function histogramSpec(key) {
  const quantity = QUANTITIES[key], [least, most] = range(quantity.values), log = quantity.log && most > least;
  const n = quantity.classes ? most - least + 1 : 28;
  const edges = quantity.classes ? spread(least - 0.5, most + 0.5, n + 1, false) : most > least ? spread(least, most, n + 1, log) : [least * 0.9, least * 1.1 || 1];
  const bins = edges.slice(1).map((to, i) => ({ from: edges[i], to, counts: [0, 0] }));
  const lo = edges[0], hi = edges[edges.length - 1];
  for (let id = 0; id < COUNT; ++id) {
    const v = quantity.values[id], t = log ? Math.log(v / lo) / Math.log(hi / lo) : (v - lo) / (hi - lo);
    ++bins[Math.min(Math.max(Math.floor(t * bins.length), 0), bins.length - 1)].counts[D.leaf[id]];
  }
  const bars = (which) => bins.map(({ from, to, counts }) => ({ from, to, low: which ? counts[0] : 0, high: which ? counts[0] + counts[1] : counts[0] }));
  const series = ["branches", "leaves"].map((name, which) => ({ name, colour: which ? "#009e73" : "#8a5a2b", bars: bars(which), x: [lo, hi], y: [0, Math.max(...bins.map((b) => b.counts[0] + b.counts[1]))] }));
  return { x: { label: quantity.title + (quantity.unit ? `, ${quantity.unit}` : ""), log }, y: { label: "domains", log: false, least: 0 }, series };
}

function makeCharts() {
  const options = { onPick: choose, describe: (id) => `${D.name[id]}\nℓ ${withUnit(D.length[id], "m")}, ν ${withUnit(D.nu[id], "Hz")}, ξ ${readable(D.xi[id])}` };
  const length = { label: "length ℓ, m", log: true }, frequency = { label: "frequency ν, Hz", log: true };
  view.law = new Chart($("law-chart"), options);
  view.law.show({ x: length, y: frequency, series: lawSeries() });
  view.models = new Chart($("models-chart"), options);
  view.models.show({ x: length, y: frequency, series: modelSeries() });
  view.damping = new Chart($("damping-chart"), options);
  view.damping.show({ x: frequency, y: { label: "damping factor ξ", log: false, least: 0 }, series: dampingSeries() });
  view.histogram = new Chart($("histogram-chart"));
  view.histogram.show(histogramSpec("nu"));
  $("models-notes").textContent = data.models.flatMap((model) => model.notes).join("; ");
  $("models-notes").title = data.models.flatMap((model) => model.notes).join("\n");
}

function modelsCsv() {
  const names = data.models.map((model) => model.name), quote = (text) => `"${text.replaceAll('"', '""')}"`;
  const lines = [["id", "name", "kind", "level", "group", "length_m", "nu_default_hz", ...names.map((name) => `nu_${name}_hz`)].join()];
  for (let id = 0; id < COUNT; ++id)
    lines.push([id, quote(D.name[id]), kind(id), D.level[id], quote(data.groups[D.group[id]].name), D.length[id], D.nu0[id], ...data.models.map((model) => model.nu[id])].join());
  return lines.join("\n") + "\n";
}

function download(name, text) {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type: "text/csv" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// --- routes, notes, details --------------------------------------------------------------------------------------

function fillRoutes() {
  const counts = data.routes.map(() => 0), doubts = data.routes.map(() => false);
  D.route.forEach((route, id) => (++counts[route], (doubts[route] ||= doubtful(id))));
  const most = Math.max(...counts);
  for (const i of [...counts.keys()].sort((a, b) => doubts[b] - doubts[a] || counts[b] - counts[a]))
    $("routes").append(element("div", { class: "route" + (doubts[i] ? " warn" : ""), title: "show these in the table", onclick: () => searchFor(data.routes[i]) },
      element("span", {}, data.routes[i]), element("span", {}, String(counts[i])),
      element("div", {}, element("i", { style: `width:${(100 * counts[i]) / most}%` }))));
  for (const note of data.notes) $("notes").append(element("p", {}, note));
}

function searchFor(text) {
  $("search").value = text;
  $("search").dispatchEvent(new Event("input"));
}

/** Where to look first. */
function extremes() {
  const list = element("dl"), ids = [...Array(COUNT).keys()];
  const add = (label, values, unit, sign) => {
    const id = ids.reduce((best, other) => (sign * values[other] > sign * values[best] ? other : best), 0);
    list.append(element("div", {}, element("dt", {}, `${label}: ${withUnit(values[id], unit)}`), element("dd", {}, element("a", { onclick: () => choose(id) }, D.name[id]))));
  };
  add("slowest", D.nu, "Hz", -1);
  add("fastest", D.nu, "Hz", 1);
  add("softest", D.E, "Pa", -1);
  add("stiffest", D.E, "Pa", 1);
  add("least damped", D.xi, "", -1);
  add("most damped", D.xi, "", 1);
  add("longest", D.length, "m", 1);
  add("heaviest", D.mass, "kg", 1);
  return list;
}

function fillDetail(id) {
  const holder = $("detail");
  if (id < 0) return holder.replaceChildren(element("p", { class: "quiet" }, "Click a branch or leaf in the picture, a point of a chart or a row of the table."), extremes());
  const children = D.parent.reduce((sum, parent) => sum + (parent === id), 0), parent = D.parent[id];
  const list = element("dl"), add = (label, value) => list.append(element("div", {}, element("dt", {}, label), element("dd", {}, value)));
  add("kind, level, group", `${kind(id)}, ${D.level[id]}, ${data.groups[D.group[id]].name}`);
  add("grows on", parent < 0 ? "the ground" : element("a", { onclick: () => choose(parent) }, D.name[parent]));
  add("frequency ν", withUnit(D.nu[id], "Hz"));
  add("with the default material", withUnit(D.nu0[id], "Hz"));
  add("length ℓ", withUnit(D.length[id], "m"));
  add("mass, carried domains", `${withUnit(D.mass[id], "kg")}, ${children}`);
  add("Young's modulus", withUnit(D.E[id], "Pa"));
  add("density", withUnit(D.rho[id], "kg/m³"));
  add("damping ξ", readable(D.xi[id]));
  add("d_M, d_K", `${withUnit(D.dM[id], "1/s")}, ${withUnit(D.dK[id], "s")}`);
  add("tetrahedra", String(D.tets[id]) + (D.solved_as[id] === id ? "" : ` (as ${D.name[D.solved_as[id]]})`));
  add("made solid by", data.routes[D.route[id]]);
  holder.replaceChildren(element("span", { class: "name" }, D.name[id]), " ", doubtful(id) ? element("span", { class: "badge" }, D.doubt[id]) : "", list);
}

// --- table -------------------------------------------------------------------------------------------------------

function makeTable() {
  const number = (title, values, unit) => ({ title: unit ? `${title}, ${unit}` : title, className: "number", value: (id) => values[id], text: (id) => readable(values[id]) });
  const text = (title, of) => ({ title, value: of, text: (id) => String(of(id)), className: "" });
  const columns = [
    text("id", (id) => id), text("name", (id) => D.name[id]), text("kind", kind), text("level", (id) => D.level[id]),
    text("group", (id) => data.groups[D.group[id]].name), number("ℓ", D.length, "m"), number("mass", D.mass, "kg"),
    number("ν₀", D.nu0, "Hz"), number("ν", D.nu, "Hz"), number("E", D.E, "Pa"), number("ρ", D.rho, "kg/m³"), number("ξ", D.xi),
    { ...text("made solid by", (id) => data.routes[D.route[id]] + (doubtful(id) ? ` – ${D.doubt[id]}` : "")), className: "route-text" },
  ];
  const haystack = D.name.map((name, id) => `${name} ${data.groups[D.group[id]].name} ${data.routes[D.route[id]]} ${D.doubt[id]}`.toLowerCase());
  view.table = new Table($("table"), {
    columns, count: COUNT, failed: data.failed, doubtful, onPick: choose,
    matches: (id, wanted, show) => haystack[id].includes(wanted) && (show === "all" || (show === "doubt" ? doubtful(id) : kind(id) === show)),
    onCount: (rows, failed) => ($("row-count").textContent = `${rows} of ${COUNT} domains${failed ? `, ${failed} left out` : ""}`),
  });
  $("search").addEventListener("input", () => ((view.table.search = $("search").value), view.table.update()));
  $("show").addEventListener("change", () => ((view.table.show = $("show").value), view.table.update()));
}

/** Everywhere at once; -1 chooses none. */
function choose(id) {
  if (!(id >= 0 && id < COUNT)) id = -1;
  view.chosen = id;
  for (const part of [view.plant, view.law, view.models, view.damping, view.table]) part?.choose(id);
  fillDetail(id);
  history.replaceState(null, "", id < 0 ? location.pathname + location.search : "#domain=" + id);
}

// --- start -------------------------------------------------------------------------------------------------------

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  for (const part of [view.law, view.models, view.damping, view.histogram, view.plant]) part?.draw();
}

function makePlant() {
  try {
    view.plant = new PlantView($("plant"), data.mesh);
  } catch (error) {
    errors.push(error.message);
    $("hover").textContent = error.message;
    return;
  }
  view.plant.onPick = choose;
  let waiting = false;
  view.plant.onHover = (x, y) => {
    if (waiting) return;
    waiting = true;
    setTimeout(() => {
      waiting = false;
      const id = view.plant.pick(x, y);
      $("hover").textContent = id < 0 ? "" : `${D.name[id]} · ν ${withUnit(D.nu[id], "Hz")} · ℓ ${withUnit(D.length[id], "m")}`;
    }, 60);
  };
  $("home").addEventListener("click", () => view.plant.home());
  $("grid-size").textContent = ` · grid ${withUnit(view.plant.gridStep, "m")}`;
}

function start() {
  const theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  document.documentElement.dataset.theme = new URLSearchParams(location.search).get("theme") ?? theme;
  $("theme").addEventListener("click", () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  fillHeader();
  makePlant();
  for (const [key, quantity] of Object.entries(QUANTITIES)) {
    $("colour-by").append(element("option", { value: key }, quantity.title));
    if (quantity.values) $("histogram-of").append(element("option", { value: key }, quantity.title));
  }
  $("colour-by").addEventListener("change", () => colourBy($("colour-by").value));
  $("histogram-of").addEventListener("change", () => view.histogram.show(histogramSpec($("histogram-of").value)));
  $("models-csv").addEventListener("click", () => download("models.csv", modelsCsv()));
  const wanted = new URLSearchParams(location.search).get("colour"), first = wanted in QUANTITIES ? wanted : "nu";
  $("colour-by").value = first;
  colourBy(first);
  makeCharts();
  fillRoutes();
  makeTable();
  choose(Number(/#domain=(\d+)/.exec(location.hash)?.[1] ?? -1));
}

/** What the page found of itself, for whoever cannot look (page.html?check): counts, and whether choosing works both
 * ways. */
function selfCheck() {
  const found = { domains: COUNT, failed: data.failed.length, triangles: view.plant?.triangles ?? 0, rows: view.table.rows.length, csv_lines: modelsCsv().split("\n").length - 2 };
  if (view.plant) {
    const before = view.chosen;
    found.drawn_pixels = view.plant.drawnPixels();
    const picked = view.plant.pick(...(view.plant.somewhere() ?? [0, 0]));
    view.plant.onPick(picked);
    found.picked = picked;
    found.picked_row = Number(document.querySelector(".row.chosen")?.dataset.id ?? -1);
    const other = view.table.rows.find((row) => typeof row === "number" && row !== picked) ?? picked;
    view.table.onPick(other);
    found.row_to_view = view.plant.chosen === other;
    choose(before);
  }
  found.errors = errors;
  const node = $("self-check");
  node.textContent = JSON.stringify(found);
}

start();
if (new URLSearchParams(location.search).has("check")) requestAnimationFrame(() => setTimeout(selfCheck, 0));
