/* Plots of the samples, by dygraphs. */
"use strict";

const PLOT_COLOURS = ["#5ab4ff", "#ffb454", "#7fd88a", "#ff7a90", "#c79bff", "#5fe0d0", "#f2e66b", "#d0a080"];
const KEPT_ROWS = 6000;  // of a plot
const REDRAWN_EVERY = 250;  // ms
const SHOWN_AT_FIRST = 5;

/** Half as many rows: of every four the least and the greatest of each column, as in wavetank/web/series.py. */
function thinned(rows) {
  const whole = rows.length - rows.length % 4, result = [];
  for (let begin = 0; begin < whole; begin += 4) {
    const four = rows.slice(begin, begin + 4), first = [four[0][0]], last = [four[3][0]];
    for (let column = 1; column < four[0].length; ++column) {
      const values = four.map((row) => row[column]).filter((value) => !Number.isNaN(value));
      const low = values.length ? Math.min(...values) : NaN, high = values.length ? Math.max(...values) : NaN;
      const falls = four[0][column] > four[3][column];
      first.push(falls ? high : low);
      last.push(falls ? low : high);
    }
    result.push(first, last);
  }
  return result.concat(rows.slice(whole));
}

/** Four figures that count. */
function figures(value) {
  if (Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}

function escaped(text) {
  const span = document.createElement("span");
  span.textContent = text;
  return span.innerHTML;
}

/** One instrument's columns of one unit. */
class Plot {
  constructor(name, unit, columns) {
    this.name = name;
    this.unit = unit;
    this.columns = columns;  // of the table, by number
    this.rows = [];
    this.time = null;  // of a bag: where the time mark is
    this.element = document.createElement("div");
    this.element.className = "plot";
    const heading = document.createElement("h2");
    heading.append(this.heading());
    const span = document.createElement("span");
    span.className = "unit";
    span.textContent = unit ? ` (${unit})` : "";
    heading.append(span);
    this.values = document.createElement("div");
    this.values.className = "values";
    this.drawn = document.createElement("div");
    this.drawn.className = "drawn";
    this.mark = document.createElement("div");
    this.mark.className = "mark";
    this.mark.hidden = true;
    const framed = document.createElement("div");
    framed.className = "framed";
    framed.append(this.drawn, this.mark);
    this.element.append(heading, this.values, framed);
  }

  heading() {
    const wrench = this.name.match(/^bodies\/(.*)\/wrench$/);
    if (wrench) return (this.unit === "N m" ? "torque on " : "force on ") + wrench[1];
    if (this.name === "probes") return "pressure";
    if (this.name === "gauges") return "water level";
    return this.name.replace(/^(velocities|sections|openings|bodies)\//, "").replace(/\//g, " ");
  }

  add(packet) {
    if (packet.clear) this.rows = [];
    const width = packet.columns.length;
    this.labels = this.columns.map((n) => packet.columns[n]);
    for (let i = 0; i < packet.times.length; ++i) this.rows.push([packet.times[i], ...this.columns.map((n) => packet.values[i * width + n])]);
    if (this.rows.length > KEPT_ROWS) {
      const old = this.rows.length - KEPT_ROWS / 4;
      this.rows = thinned(this.rows.slice(0, old)).concat(this.rows.slice(old));
    }
    this.changed = true;
  }

  /** The values of a bag's time, which come with its picture, since rows are thinned; of a tank the last. */
  row() {
    return this.time === null ? this.rows[this.rows.length - 1] : this.exact;
  }

  setTime(time, values) {
    this.time = time;
    if (values[this.name]) this.exact = [time, ...this.columns.map((n) => values[this.name][n] ?? NaN)];
    this.moved = true;
  }

  redraw() {
    if (!(this.changed || this.moved) || this.element.hidden || (!this.rows.length && !this.graph)) return;
    this._drawValues();
    if (this.changed) this._drawGraph();
    this.changed = this.moved = false;
    this._place();
  }

  _drawValues() {
    const row = this.row() || [];
    this.values.innerHTML = this.labels.map((label, n) =>
      `<span><i style="background:${PLOT_COLOURS[n % PLOT_COLOURS.length]}"></i>${escaped(short(label))} ${figures(row.length ? row[n + 1] : NaN)}</span>`).join("");
  }

  _drawGraph() {
    if (!this.graph) {
      this.graph = new Dygraph(this.drawn, this.rows, {
        labels: ["time (s)", ...this.labels], colors: this.labels.map((_, n) => PLOT_COLOURS[n % PLOT_COLOURS.length]), legend: "never", strokeWidth: 1.3,
        axisLineColor: "#4a6076", gridLineColor: "#25374a", xlabel: "time (s)", xLabelHeight: 15, axisLabelWidth: 56, highlightCircleSize: 3,
        axes: { x: { axisLabelFormatter: figures, pixelsPerLabel: 60, valueFormatter: figures }, y: { axisLabelFormatter: figures, valueFormatter: figures, pixelsPerLabel: 28 } },
        drawCallback: () => this._place(),
      });
    } else {
      this.graph.updateOptions({ file: this.rows.length ? this.rows : [[0, ...this.labels.map(() => NaN)]] });  // it takes no empty one
    }
  }

  /** The mark of the time, of a bag: it moves over the graph, which is not drawn again. */
  _place() {
    if (!this.graph || this.time === null) return;
    const area = this.graph.getArea(), x = this.graph.toDomXCoord(this.time);
    this.mark.hidden = x < area.x - 1 || x > area.x + area.w + 1;
    this.mark.style.transform = `translateX(${Math.round(x)}px)`;
    this.mark.style.top = area.y + "px";
    this.mark.style.height = area.h + "px";
  }
}

/** "force_x" of a plot that is called the force is x. */
function short(label) {
  return label.replace(/^(force|torque|velocity)_([xyz])$/, "$2").replace(/_/g, " ");
}

class Plots {
  constructor(element, boxes, choice, none) {
    this.element = element;
    this.boxes = boxes;
    this.choice = choice;
    this.none = none;
    this.all = new Map();
    setInterval(() => this.redraw(), REDRAWN_EVERY);
    new ResizeObserver(() => { for (const plot of this.all.values()) if (plot.graph && !plot.element.hidden) plot.graph.resize(); }).observe(element);
  }

  add(packet) {
    const units = [...new Set(packet.units)];
    for (const unit of units) {
      const key = packet.name + " " + unit, columns = packet.units.flatMap((each, n) => (each === unit ? [n] : []));
      const known = this.all.get(key);
      if (known && known.signature !== packet.columns.join()) { this._remove(key); }
      if (!this.all.has(key)) this._create(key, packet, unit, columns);
      this.all.get(key).add(packet);
    }
  }

  _create(key, packet, unit, columns) {
    const plot = new Plot(packet.name, unit, columns);
    plot.signature = packet.columns.join();
    // torques, and what is beyond the first few, are there to be asked for
    plot.element.hidden = unit === "N m" || [...this.all.values()].filter((each) => !each.element.hidden).length >= SHOWN_AT_FIRST;
    if (this.time !== undefined) plot.setTime(this.time, this.values);
    this.all.set(key, plot);
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = !plot.element.hidden;
    box.addEventListener("change", () => {
      plot.element.hidden = !box.checked;
      plot.changed = true;
      plot.redraw();
      if (plot.graph) plot.graph.resize();
    });
    label.append(box, ` ${plot.heading()}${unit ? ` (${unit})` : ""}`);
    plot.label = label;
    this._sorted();
    this.choice.hidden = false;
    this.none.hidden = true;
  }

  /** Probes, gauges, then the others by name. */
  _sorted() {
    const rank = (plot) => ["probes", "gauges"].indexOf(plot.name) + 1 || 3;
    const plots = [...this.all.values()].sort((a, b) => rank(a) - rank(b) || (a.name < b.name ? -1 : a.name > b.name ? 1 : 0));
    this.element.append(...plots.map((plot) => plot.element));
    this.boxes.append(...plots.map((plot) => plot.label));
  }

  _remove(key) {
    const plot = this.all.get(key);
    if (plot.graph) plot.graph.destroy();
    plot.element.remove();
    plot.label.remove();
    this.all.delete(key);
  }

  clear() {
    for (const key of [...this.all.keys()]) this._remove(key);
    this.none.hidden = false;
    this.choice.hidden = true;
  }

  setTime(time, values) {
    this.time = time;
    this.values = values;
    for (const plot of this.all.values()) plot.setTime(time, values);
  }

  redraw() { for (const plot of this.all.values()) plot.redraw(); }
}
