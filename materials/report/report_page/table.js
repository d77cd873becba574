// The domains in rows: only those in sight exist, so 30,000 are no burden.
"use strict";

const ROW = 28;

class Table {
  /** columns: [{title, unit, value(id), text(id), className}]; failed: texts of what was left out, always on top. */
  constructor(holder, { columns, count, failed, doubtful, matches, onPick, onCount }) {
    Object.assign(this, { columns, count, failed, doubtful, matches, onPick, onCount });
    this.chosen = -1;
    this.sorted = null;
    this.search = "";
    this.show = "all";
    this.titles = element("div", { class: "row titles", role: "row" });
    columns.forEach((column, i) => this.titles.append(element("span", { class: column.className ?? "", title: "sort", role: "columnheader", onclick: () => this.sort(i) }, column.title)));
    this.body = element("div", { class: "body", role: "rowgroup" });
    this.grid = element("div", { class: "grid", role: "grid", tabindex: 0 }, this.titles, this.body);
    this.grid.addEventListener("scroll", () => this.render());
    this.grid.addEventListener("keydown", (event) => this.key(event));
    holder.append(this.grid);
    this.update();
  }

  sort(i) {
    this.sorted = { column: i, down: this.sorted?.column === i ? !this.sorted.down : false };
    this.titles.childNodes.forEach((title, k) => (title.textContent = this.columns[k].title + (k === i ? (this.sorted.down ? " ▾" : " ▴") : "")));
    this.update();
  }

  /** Doubtful ones first unless sorted by a column. */
  update() {
    const text = this.search.trim().toLowerCase(), ids = [];
    for (let id = 0; id < this.count; ++id) if (this.matches(id, text, this.show)) ids.push(id);
    if (this.sorted) {
      const { column, down } = this.sorted, value = this.columns[column].value;
      ids.sort((a, b) => {
        const [p, q] = [value(a), value(b)];
        return (p < q ? -1 : p > q ? 1 : a - b) * (down ? -1 : 1);
      });
    } else ids.sort((a, b) => this.doubtful(b) - this.doubtful(a) || a - b);
    const failed = this.show === "all" || this.show === "doubt" ? this.failed.filter((f) => f.toLowerCase().includes(text)) : [];
    this.rows = [...failed, ...ids];
    this.body.style.height = this.rows.length * ROW + "px";
    this.onCount(ids.length, failed.length);
    this.render();
  }

  render() {
    const first = Math.max(Math.floor(this.grid.scrollTop / ROW) - 4, 0);
    const last = Math.min(first + Math.ceil((this.grid.clientHeight || 460) / ROW) + 8, this.rows.length);
    const made = [];
    for (let i = first; i < last; ++i) {
      const row = typeof this.rows[i] === "string" ? this.failedRow(this.rows[i]) : this.row(this.rows[i]);
      row.style.top = i * ROW + "px";
      made.push(row);
    }
    this.body.replaceChildren(...made);
  }

  row(id) {
    const row = element("div", { class: "row", role: "row", "data-id": id, onclick: () => this.onPick(id) });
    row.classList.toggle("doubt", this.doubtful(id));
    row.classList.toggle("chosen", id === this.chosen);
    for (const column of this.columns) {
      const text = column.text(id);
      row.append(element("span", { class: column.className ?? "", title: text }, text));
    }
    return row;
  }

  failedRow(text) {
    return element("div", { class: "row failed", role: "row" }, element("span", {}, "–"), element("span", {}, "left out"), element("span", { class: "why", title: text }, text));
  }

  key(event) {
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 14, PageUp: -14 }[event.key];
    if (!step) return;
    event.preventDefault();
    const at = this.rows.indexOf(this.chosen), next = this.rows[Math.min(Math.max(at + step, 0), this.rows.length - 1)];
    if (typeof next === "number") this.onPick(next);
  }

  choose(id) {
    this.chosen = id;
    const at = this.rows.indexOf(id), top = at * ROW;
    if (at >= 0 && (top < this.grid.scrollTop || top + 2 * ROW > this.grid.scrollTop + this.grid.clientHeight)) this.grid.scrollTop = Math.max(top - 6 * ROW, 0);
    this.render();
  }
}
