// Points, lines and bars on linear or logarithmic axes, on a canvas; the nearest point answers to the mouse.
"use strict";

const INSET = { left: 48, right: 12, top: 22, bottom: 34 };

class Chart {
  /** spec: {x, y: {label, log, least, most}, series: [{name, colour, x, y, ids, line, dash, bars, hidden}]} */
  constructor(holder, { onPick = () => {}, describe = () => "" } = {}) {
    this.canvas = element("canvas");
    this.keys = element("div", { class: "keys" });
    holder.append(this.canvas, this.keys);
    this.top = INSET.top;
    this.chosen = -1;
    this.hidden = new Set();
    this.canvas.addEventListener("click", (event) => {
      const found = this.nearest(event.offsetX, event.offsetY);
      if (found) onPick(found.id);
    });
    this.canvas.addEventListener("mousemove", (event) => {
      const found = this.nearest(event.offsetX, event.offsetY);
      this.canvas.title = found ? describe(found.id) : "";
      this.canvas.style.cursor = found ? "pointer" : "default";
    });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  show(spec) {
    this.spec = spec;
    for (const axis of ["x", "y"]) {
      const wanted = spec[axis], all = range(spec.series.flatMap((s) => (s.free ? [] : range(s[axis]))));
      let [least, most] = [wanted.least ?? all[0], wanted.most ?? all[1]];
      if (!(least <= most)) [least, most] = [wanted.log ? 0.1 : 0, 1];
      if (wanted.log) {
        const pad = Math.max(0.05 * Math.log10(most / least), 0.08);
        if (wanted.least === undefined) least *= 10 ** -pad;
        if (wanted.most === undefined) most *= 10 ** pad;
      } else {
        const pad = most > least ? 0.05 * (most - least) : Math.abs(most) * 0.1 || 1;
        if (wanted.least === undefined) least -= pad;
        if (wanted.most === undefined) most += pad;
      }
      this[axis] = { ...wanted, least, most };
    }
    this.keys.replaceChildren();
    if (spec.series.filter((s) => s.name).length > 1)
      for (const s of spec.series.filter((s) => s.name))
        this.keys.append(this.key(s));
    this.draw();
  }

  key(series) {
    const made = element("span", { title: "show or hide" }, element("i", { style: `background:${series.colour}` }), series.name);
    made.classList.toggle("off", this.hidden.has(series.name));
    made.addEventListener("click", () => {
      this.hidden.has(series.name) ? this.hidden.delete(series.name) : this.hidden.add(series.name);
      made.classList.toggle("off");
      this.draw();
    });
    return made;
  }

  shown() {
    return this.spec.series.filter((s) => !this.hidden.has(s.name ?? s.with));
  }

  place(axis, value) {
    const { least, most, log } = this[axis];
    const t = log ? Math.log(value / least) / Math.log(most / least) : (value - least) / (most - least);
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    return axis === "x" ? INSET.left + t * (width - INSET.left - INSET.right) : height - INSET.bottom - t * (height - this.top - INSET.bottom);
  }

  draw() {
    if (!this.spec || !this.canvas.clientWidth) return;
    const scale = window.devicePixelRatio || 1, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    this.top = Math.max(INSET.top, this.keys.offsetHeight + 6 || 0);  // the keys may take several lines
    this.canvas.width = width * scale;
    this.canvas.height = height * scale;
    const c = (this.context = this.canvas.getContext("2d"));
    c.scale(scale, scale);
    this.drawAxes(c, width, height);
    c.save();
    c.beginPath();
    c.rect(INSET.left, this.top, width - INSET.left - INSET.right, height - this.top - INSET.bottom);
    c.clip();
    for (const series of this.shown()) {
      if (series.bars) this.drawBars(c, series);
      else if (series.line) this.drawLine(c, series);
      else this.drawPoints(c, series);
    }
    this.drawChosen(c);
    c.restore();
  }

  drawAxes(c, width, height) {
    c.font = "11px system-ui, sans-serif";
    c.lineWidth = 1;
    for (const axis of ["x", "y"]) {
      const { least, most, log, label } = this[axis];
      const spots = ticks(least, most, log, axis === "x" ? 6 : 5);
      let last = -Infinity;
      for (const value of spots) {
        const at = Math.round(this.place(axis, value)) + 0.5;
        c.strokeStyle = cssColour("--grid");
        c.beginPath();
        axis === "x" ? (c.moveTo(at, this.top), c.lineTo(at, height - INSET.bottom)) : (c.moveTo(INSET.left, at), c.lineTo(width - INSET.right, at));
        c.stroke();
        c.fillStyle = cssColour("--quiet");
        const text = readable(value);
        if (axis === "x") {
          if (at - last < c.measureText(text).width + 12) continue;
          last = at;
          c.textAlign = "center";
          c.fillText(text, at, height - INSET.bottom + 14);
        } else {
          if (Math.abs(at - last) < 13) continue;
          last = at;
          c.textAlign = "right";
          c.fillText(text, INSET.left - 6, at + 4);
        }
      }
      c.fillStyle = cssColour("--quiet");
      c.textAlign = "center";
      if (axis === "x") c.fillText(label, (INSET.left + width - INSET.right) / 2, height - 4);
      else {
        c.save();
        c.translate(10, (this.top + height - INSET.bottom) / 2);
        c.rotate(-Math.PI / 2);
        c.fillText(label, 0, 0);
        c.restore();
      }
    }
    c.strokeStyle = cssColour("--line");
    c.strokeRect(INSET.left + 0.5, this.top + 0.5, width - INSET.left - INSET.right - 1, height - this.top - INSET.bottom - 1);
  }

  drawPoints(c, series) {
    const size = series.x.length > 4000 ? 2.4 : series.x.length > 600 ? 3.4 : 5;
    c.fillStyle = series.colour;
    c.globalAlpha = series.x.length > 600 ? 0.55 : 0.8;
    for (let i = 0; i < series.x.length; ++i) {
      c.beginPath();
      c.arc(this.place("x", series.x[i]), this.place("y", series.y[i]), size / 2, 0, 7);
      c.fill();
    }
    c.globalAlpha = 1;
  }

  drawLine(c, series) {
    c.strokeStyle = series.colour;
    c.lineWidth = 1.6;
    c.setLineDash(series.dash ?? []);
    c.beginPath();
    series.x.forEach((x, i) => c.lineTo(this.place("x", x), this.place("y", series.y[i])));
    c.stroke();
    c.setLineDash([]);
  }

  drawBars(c, series) {
    c.fillStyle = series.colour;
    for (const { from, to, low, high } of series.bars) {
      if (high <= low) continue;
      const left = this.place("x", from), right = this.place("x", to), top = this.place("y", high);
      c.fillRect(left + 0.5, top, Math.max(right - left - 1, 1), this.place("y", low) - top);
    }
  }

  drawChosen(c) {
    if (this.chosen < 0) return;
    for (const series of this.shown()) {
      const i = series.ids ? series.ids.indexOf(this.chosen) : -1;
      if (i < 0) continue;
      c.strokeStyle = cssColour("--chosen");
      c.fillStyle = series.colour;
      c.lineWidth = 2.5;
      c.beginPath();
      c.arc(this.place("x", series.x[i]), this.place("y", series.y[i]), 6, 0, 7);
      c.fill();
      c.stroke();
    }
  }

  nearest(x, y) {
    let best = null, least = 14;
    for (const series of this.spec ? this.shown() : []) {
      if (!series.ids) continue;
      for (let i = 0; i < series.ids.length; ++i) {
        const distance = Math.hypot(this.place("x", series.x[i]) - x, this.place("y", series.y[i]) - y);
        if (distance < least) (least = distance), (best = { id: series.ids[i] });
      }
    }
    return best;
  }

  choose(id) {
    this.chosen = id;
    this.draw();
  }
}
