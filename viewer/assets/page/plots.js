// Plots of the chosen vehicle over time.

import uPlot from "../uplot/uPlot.esm.js";
import { Rarely } from "./rarely.js";

/** Between two plots: each is drawn about seven times a second, and no drawing of them all delays what moves. */
const PERIOD_MS = 30;
/** A plot that cannot be seen is drawn at most this often: what is printed or scrolled to shall have something in it. */
const UNSEEN_MS = 2000;
const HEIGHT_REM = 12;

/** What stands in place of a plot without values. */
const NO_DATA = "No data";
/**
 * Title, unit of the axis, its least height, the series (column of the history, label, colour, dashed or not), and what to say when there are no
 * values if not that. Counts have no unit.
 */
const PLOTS = [
  ["Position", "m", 1, [
    ["north", "north", "--one"], ["east", "east", "--two"], ["up", "up", "--three"],
    ["northTarget", "north set-point", "--one", true], ["eastTarget", "east set-point", "--two", true],
    ["upTarget", "up set-point", "--three", true],
  ]],
  ["Tracking error", "m", 0.02, [["northError", "north", "--one"], ["eastError", "east", "--two"], ["upError", "up", "--three"]], "No set-point"],
  ["Thrust", "N", 1, [["thrust", "thrust", "--one"], ["strongest", "strongest", "--soft", true]]],
  ["Active limits of the controllers", "", null, [
    ["altitudeActive", "altitude", "--one"], ["positionActive", "position", "--two"], ["attitudeActive", "attitude", "--three"],
  ]],
  ["Solvers", "", null, [["iterations", "iterations", "--one"], ["status", "0 optimal, 1 relaxed, 2 limit, 3 held", "--two"]]],
];

/** The ends of an axis for values between two. Counts stand on zero; what is measured needs some height, or noise would fill the plot. */
function span(low, high, least) {
  if (low === null || high === null) return [0, 1];
  if (least === null) return [0, Math.max(1, high) * 1.05];
  const margin = Math.max(0.05 * (high - low), (least - (high - low)) / 2);
  return [low - margin, high + margin];
}

/** Pixels of a rem: plots grow with the text of the page. */
function rem() {
  return Number.parseFloat(getComputedStyle(document.documentElement).fontSize);
}

export class Plots {
  constructor(parent) {
    this.parent = parent;
    this.history = null;
    this.next = new Rarely(PERIOD_MS, () => this.drawNext());
    this.seen = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        // Of plots that have been built anew since, old ones may still be told.
        const plot = this.plots.find(({ figure }) => figure === target);
        if (plot) plot.isSeen = isIntersecting;
      }
      this.next.ask();
    });
    this.build();
    new ResizeObserver(() => this.resize()).observe(parent);
  }

  /** Builds the plots, or builds them again with the colours of the style sheet. */
  build() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim();
    this.seen.disconnect();
    this.parent.replaceChildren();
    this.plots = PLOTS.map(([title, unit, least, series, nothing]) => {
      const figure = document.createElement("figure");
      const caption = document.createElement("figcaption");
      caption.textContent = unit ? `${title}, ${unit}` : title;
      const note = document.createElement("p");
      Object.assign(note, { className: "notice", textContent: nothing ?? NO_DATA });
      figure.append(caption, note);
      this.parent.append(figure);
      const axis = {
        font: `${0.75 * rem()}px system-ui, sans-serif`,
        stroke: colour("--soft"), grid: { stroke: colour("--line"), width: 1 }, ticks: { stroke: colour("--line") } };
      const options = {
        width: Math.max(100, figure.clientWidth),
        height: HEIGHT_REM * rem(),
        scales: { x: { time: false }, y: { range: (_, low, high) => span(low, high, least) } },
        cursor: { drag: { x: false, y: false } },
        axes: [{ ...axis, size: 2.2 * rem() }, { ...axis, size: 3.4 * rem() }],
        legend: { markers: { dash: (_, index) => (series[index - 1]?.[3] ? "dashed" : "solid") } },
        series: [
          { label: "time, s", value: (_, value) => value?.toFixed(2) ?? "" },
          ...series.map(([, label, name, dashed]) => ({
            label, stroke: colour(name), width: dashed ? 1 : 1.6, dash: dashed ? [5, 4] : undefined, points: { show: false },
            value: (_, value) => (value === null || value === undefined ? "" : value.toFixed(3)),
          })),
        ],
      };
      const columns = series.map(([column]) => column);
      const plot = new uPlot(options, [[], ...columns.map(() => [])], figure);
      const canvas = figure.querySelector("canvas");
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", `Plot over time, s: ${caption.textContent}`);
      // Its values are those under the mouse.
      figure.querySelector(".u-legend").setAttribute("aria-hidden", "true");
      figure.classList.add("empty");
      return { plot, figure, columns, isSeen: false, isOld: true, drawn: -Infinity };
    });
    for (const { figure } of this.plots) this.seen.observe(figure);
  }

  /** Fits the plots to their place. */
  resize() {
    for (const { plot, figure } of this.plots) {
      const width = Math.max(100, figure.clientWidth);
      if (width !== plot.width) plot.setSize({ width, height: HEIGHT_REM * rem() });
    }
  }

  /** Draws a history, soon, if there is more in it than was drawn. */
  draw(history) {
    const latest = history.time.at(-1);
    if (history !== this.history || latest !== this.latest) for (const each of this.plots) each.isOld = true;
    Object.assign(this, { history, latest });
    this.next.ask();
  }

  /** Draws one that can be seen and is old; the others have their turn. */
  drawNext() {
    const now = performance.now();
    const old = this.plots.filter(({ isSeen, isOld, drawn }) => isOld && (isSeen || now - drawn > UNSEEN_MS));
    if (!this.history || old.length === 0) return;
    const [each] = old;
    Object.assign(each, { isOld: false, drawn: now });
    // The next search begins behind it.
    this.plots.push(...this.plots.splice(0, this.plots.indexOf(each) + 1));
    const columns = each.columns.map((column) => this.history.columns[column]);
    each.figure.classList.toggle("empty", columns.every((values) => values.every((value) => value === null)));
    each.plot.setData([this.history.time, ...columns]);
    if (old.length > 1) this.next.ask();
  }
}
