// Plots of the chosen vehicle over time.

import uPlot from "../uplot/uPlot.esm.js";

const PERIOD_MS = 100;
const HEIGHT_REM = 12;

/** Title, unit of the axis, and the series: column of the history, label, colour, dashed or not. */
const PLOTS = [
  ["Position", "m", [
    ["north", "north", "--one"], ["east", "east", "--two"], ["up", "up", "--three"],
    ["northTarget", "north set-point", "--one", true], ["eastTarget", "east set-point", "--two", true],
    ["upTarget", "up set-point", "--three", true],
  ]],
  ["Tracking error", "m", [["northError", "north", "--one"], ["eastError", "east", "--two"], ["upError", "up", "--three"]]],
  ["Thrust", "N", [["thrust", "thrust", "--one"], ["strongest", "strongest", "--soft", true]]],
  ["Active limits of the controllers", "", [
    ["altitudeActive", "altitude", "--one"], ["positionActive", "position", "--two"], ["attitudeActive", "attitude", "--three"],
  ]],
  ["Solvers (0 optimal, 1 relaxed, 2 limit, 3 held)", "", [["iterations", "iterations", "--one"], ["status", "state", "--two"]]],
];

/** The ends of an axis for values between two. */
function span(low, high, unit) {
  if (low === null || high === null) return [0, 1];
  if (!unit) return [0, Math.max(1, high) * 1.05];
  const margin = Math.max(0.05 * (high - low), 0.01);
  return [low - margin, high + margin];
}

/** Pixels of a rem: plots grow with the text of the page. */
function rem() {
  return Number.parseFloat(getComputedStyle(document.documentElement).fontSize);
}

export class Plots {
  constructor(parent) {
    this.parent = parent;
    this.drawn = 0;
    this.build();
    new ResizeObserver(() => this.resize()).observe(parent);
  }

  /** Builds the plots, or builds them again with the colours of the style sheet. */
  build() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim();
    this.parent.replaceChildren();
    this.plots = PLOTS.map(([title, unit, series]) => {
      const figure = document.createElement("figure");
      const caption = document.createElement("figcaption");
      caption.textContent = unit ? `${title}, ${unit}` : title;
      figure.setAttribute("aria-label", `Plot over time, s: ${caption.textContent}`);
      figure.setAttribute("role", "img");
      figure.append(caption);
      this.parent.append(figure);
      const axis = {
        font: `${0.75 * rem()}px system-ui, sans-serif`,
        stroke: colour("--soft"), grid: { stroke: colour("--line"), width: 1 }, ticks: { stroke: colour("--line") } };
      const options = {
        width: Math.max(100, figure.clientWidth),
        height: HEIGHT_REM * rem(),
        // Counts stand on zero; what is measured needs some height, or noise would fill the plot.
        scales: { x: { time: false }, y: { range: (_, low, high) => span(low, high, unit) } },
        cursor: { drag: { x: false, y: false } },
        axes: [{ ...axis, size: 2.2 * rem() }, { ...axis, size: 3.4 * rem() }],
        series: [
          { label: "s", value: (_, value) => value?.toFixed(2) ?? "" },
          ...series.map(([, label, name, dashed]) => ({
            label, stroke: colour(name), width: dashed ? 1 : 1.6, dash: dashed ? [5, 4] : undefined, points: { show: false },
            value: (_, value) => (value === null || value === undefined ? "" : value.toFixed(3)),
          })),
        ],
      };
      const columns = series.map(([column]) => column);
      const plot = new uPlot(options, [[], ...columns.map(() => [])], figure);
      return { plot, figure, columns };
    });
  }

  /** Fits the plots to their place. */
  resize() {
    for (const { plot, figure } of this.plots) {
      const width = Math.max(100, figure.clientWidth);
      if (width !== plot.width) plot.setSize({ width, height: HEIGHT_REM * rem() });
    }
  }

  /** Draws a history, not more often than the eye needs. */
  draw(history, now) {
    if (now - this.drawn < PERIOD_MS) return;
    this.drawn = now;
    for (const { plot, columns } of this.plots) {
      plot.setData([history.time, ...columns.map((column) => history.columns[column])]);
    }
  }
}
