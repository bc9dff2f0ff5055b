// Tables with the FMU's outputs, as FMPy writes them: time and one column for each variable.

import { quaternion, unknown } from "./frame.js";

const NEEDED = ["time", "position.x", "position.y", "position.z"];

function cells(line) {
  return line.split(",").map((cell) => cell.trim().replace(/^"(.*)"$/, "$1"));
}

/** Times, s, and states of one vehicle. Throws with what is missing. */
export function readCsv(text) {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== "");
  const names = cells(lines[0] ?? "");
  const missing = NEEDED.filter((name) => !names.includes(name));
  if (missing.length > 0) throw new Error(`The table has no column ${missing.join(", ")}; export time, position.x, position.y and position.z from the FMU.`);
  const column = new Map(names.map((name, index) => [name, index]));
  const [times, states] = [[], []];
  for (const line of lines.slice(1)) {
    const row = cells(line);
    const value = (name) => {
      const cell = row[column.get(name)];
      if (cell === undefined || cell === "") return NaN;
      return cell === "True" ? 1 : cell === "False" ? 0 : Number(cell);
    };
    const time = value("time");
    // FMPy writes instants of events twice: the later row holds.
    if (!Number.isFinite(time)) continue;
    if (times[times.length - 1] === time) { times.pop(); states.pop(); }
    times.push(time);
    states.push(stateOf(value));
  }
  return { times, states: new Map([[1, states]]) };
}

function vector(value, name, parts = ["x", "y", "z"]) {
  return parts.map((part) => value(`${name}.${part}`));
}

function stateOf(value) {
  const laws = ["altitude", "position", "attitude"];
  const setpoint = vector(value, "setpoint.position");
  const angles = vector(value, "attitude", ["phi", "theta", "psi"]);
  const read = vector(value, "attitude", ["q0", "q1", "q2", "q3"]);
  const turned = angles.every(Number.isFinite) ? quaternion(...angles) : [1, 0, 0, 0];
  return unknown({
    position: vector(value, "position"),
    velocity: vector(value, "velocity"),
    quaternion: read.every(Number.isFinite) ? read : turned,
    setpoint,
    tracks: setpoint.every(Number.isFinite),
    rates: vector(value, "body_rate", ["p", "q", "r"]),
    battery: value("battery.remaining"),
    voltage: value("battery.voltage"),
    thrust: value("thrust"),
    armed: !(value("armed") === 0),
    landed: Math.abs(value("position.z")) < 0.01,
    // The FMU's enumeration is counted from one.
    status: laws.map((law) => Math.max(0, value(`controller.${law}.status_number`) - 1)),
    active: laws.map((law) => value(`controller.${law}.active_constraints`)),
    iterations: laws.map((law) => value(`controller.${law}.iterations`)),
  });
}
