// Runs the scripts of a report page in node, with a document that does nothing, and prints what they count.
//   node report_page_stub.js report.html
"use strict";

const fs = require("fs"), vm = require("vm");
const html = fs.readFileSync(process.argv[2], "utf8");
const scripts = [...html.matchAll(/<script([^>]*)>([\s\S]*?)<\/script>/g)];
const json = scripts.find((s) => s[1].includes("json"))[2], code = scripts.find((s) => !s[1].includes("json"))[2];

/** An element whose properties hold what is written, and whose methods do nothing. */
function node() {
  const own = { children: [], style: {}, dataset: {}, classList: { toggle() {}, add() {} }, childNodes: [], textContent: "", value: "", clientHeight: 460, clientWidth: 0, scrollTop: 0 };
  for (const name of ["append", "replaceChildren", "addEventListener", "dispatchEvent", "setAttribute", "click"]) own[name] = () => {};
  own.getContext = () => null;
  return own;
}
const nodes = {};
const context = {
  console, atob, Uint8Array, Blob, URL, URLSearchParams, setTimeout: () => 0, requestAnimationFrame: () => 0, matchMedia: () => ({ matches: false }),
  getComputedStyle: () => ({ getPropertyValue: () => "#000000" }), location: { search: "", hash: "", pathname: "" }, history: { replaceState() {} },
  ResizeObserver: class { observe() {} }, Event: class {}, window: { addEventListener() {}, devicePixelRatio: 1 },
  document: { getElementById: (id) => (nodes[id] ??= Object.assign(node(), id === "data" ? { textContent: json } : {})), createElement: node, documentElement: node(), querySelector: () => null },
};

const questions = `
(() => {
  const sum = (spec) => spec.series.reduce((total, s) => total + s.bars.reduce((t, bar) => t + bar.high - bar.low, 0), 0);
  const worst = (values) => Math.max(...values);
  const law = (id, group = data.groups[D.group[id]]) => group.frequency * (D.length[id] / group.length) ** group.epsilon1;
  const all = [...Array(COUNT).keys()], table = view.table;
  const search = (text) => ((table.search = text), table.update(), table.rows);
  const found_trunk = D.name[search("TRUNK")[0]], found_nothing = search("no such domain").length;
  search("");
  const doubtful_first = table.rows.every((id, i, rows) => !i || doubtful(rows[i - 1]) >= doubtful(id));
  table.sort(5);
  const sorted_by_length = table.rows.every((id, i, rows) => !i || D.length[rows[i - 1]] <= D.length[id]);
  const indices = data.mesh.index_bytes === 4 ? new Uint32Array(bytesOf(data.mesh.triangles)) : new Uint16Array(bytesOf(data.mesh.triangles));
  let triangles = 0, indices_in_range = true;
  for (const [, vertices, shape] of data.mesh.pieces) {
    const [first, number] = data.mesh.shapes[shape];
    triangles += number;
    for (let k = 3 * first; k < 3 * (first + number); ++k) indices_in_range &&= indices[k] < vertices;
  }
  return { domains: COUNT, histogram_sum: sum(histogramSpec("nu")), class_histogram_sum: sum(histogramSpec("level")),
    law_error: worst(all.map((id) => Math.abs(D.nu[id] / law(id) - 1))),
    damping_error: worst(all.map((id) => Math.abs(D.xi[id] / dampingFactor(data.groups[D.group[id]].damping, D.nu[id]) - 1))),
    triangles, indices_in_range, found_trunk, found_nothing, doubtful_first, sorted_by_length,
    ticks: ticks(0.09, 6, true, 6), numbers: [8.77e9, 0.0488215, 1.76e6, 0, NaN].map(readable) };
})()`;
console.log(JSON.stringify(vm.runInNewContext(code + questions, context)));
