// Numbers as people read them, and as colours.
"use strict";

const VIRIDIS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"].map(rgb);
// Okabe and Ito: told apart by every kind of colour vision.
const CATEGORIES = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a800", "#808080"];

function rgb(hex) {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
}

function viridis(t) {
  const at = Math.min(Math.max(t, 0), 1) * (VIRIDIS.length - 1);
  const i = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[i].map((low, k) => low + (VIRIDIS[i + 1][k] - low) * (at - i));
}

/** Three digits with an SI prefix: 8.77 G. Without a prefix where the number is readable as it is. */
function readable(value) {
  if (!isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e4) return String(+value.toPrecision(3));
  if (size < 1e-6 || size >= 1e13) return value.toExponential(2);
  const power = Math.floor(Math.log10(size) / 3);
  return +(value / 10 ** (3 * power)).toPrecision(3) + " " + { "-2": "µ", "-1": "m", 0: "", 1: "k", 2: "M", 3: "G", 4: "T" }[power];
}

function withUnit(value, unit) {
  if (unit === "kg" && Math.abs(value) >= 1e4) return withUnit(value / 1e3, "t");
  return unit ? readable(value).replace(/([0-9])$/, "$1 ") + unit : readable(value);
}

function range(values) {
  let least = Infinity, most = -Infinity;
  for (const v of values) {
    if (!isFinite(v)) continue;
    if (v < least) least = v;
    if (v > most) most = v;
  }
  return [least, most];
}

/** Round numbers of an axis; of a logarithmic one 1, 2, 5 in every decade, only 1 when there are many, even steps when
 * there are few. */
function ticks(least, most, log, about) {
  const found = [];
  if (log) {
    const decades = Math.log10(most / least);
    for (let power = Math.floor(Math.log10(least)); power <= Math.ceil(Math.log10(most)); ++power)
      for (const digit of decades > 3.2 ? [1] : [1, 2, 5]) {
        const value = digit * 10 ** power;
        if (value >= least * 0.999 && value <= most * 1.001) found.push(value);
      }
    if (found.length > 2 || decades > 1) return found;
    found.length = 0;
  }
  const raw = (most - least) / about, scale = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((digit) => digit * scale >= raw * 0.999) * scale;
  for (let i = Math.ceil(least / step - 1e-9); i * step <= most + 1e-9 * step; ++i) found.push(+(i * step).toPrecision(12));
  return found;
}

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (key === "style") made.style.cssText = value;
    else if (value !== undefined && value !== false) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== undefined));
  return made;
}

function cssColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
