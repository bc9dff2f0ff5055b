// Flight logs of PX4 and of this vehicle (ULog). The form is PX4's: docs.px4.io, "ULog File Format".

import { unknown } from "./frame.js";

const MAGIC = [0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35];
const HEADER = 16;
/** Levels of logged lines are digits. */
const ZERO = "0".charCodeAt(0);
const TYPES = {
  int8_t: ["getInt8", 1], uint8_t: ["getUint8", 1], bool: ["getUint8", 1], char: ["getUint8", 1], int16_t: ["getInt16", 2],
  uint16_t: ["getUint16", 2], int32_t: ["getInt32", 4], uint32_t: ["getUint32", 4], float: ["getFloat32", 4],
  int64_t: ["getBigInt64", 8], uint64_t: ["getBigUint64", 8], double: ["getFloat64", 8],
};
/** What is read of which topic. */
const WANTED = [
  "vehicle_local_position", "vehicle_local_position_groundtruth", "vehicle_attitude", "vehicle_attitude_groundtruth",
  "vehicle_local_position_setpoint", "vehicle_status", "vehicle_land_detected", "battery_status", "wind", "lmpc_status",
];
/** PX4's numbers of modes (VehicleStatus.msg), and its names of them. */
const MODES = new Map([
  [0, "Manual"], [1, "Altitude"], [2, "Position"], [3, "Mission"], [4, "Hold"], [5, "Return"], [6, "Position Slow"], [10, "Acro"], [12, "Descend"],
  [13, "Termination"], [14, "Offboard"], [15, "Stabilized"], [17, "Takeoff"], [18, "Land"], [19, "Follow Me"], [20, "Precision Land"], [21, "Orbit"],
]);
const LAWS = ["altitude", "position", "attitude"];
/** Between samples that are no farther apart than this, µs, what is logged moves evenly. */
const SOON_US = 0.5e6;
const PERIOD_S = 1 / 30;
/** A time stamp that is later than this, s, is no flight but a broken file. */
const LONGEST_S = 86400;

/** Messages of the file: kind and bytes. What is cut off at the end is left out. */
function* messages(data) {
  let at = HEADER;
  while (at + 3 <= data.byteLength) {
    const size = data.getUint16(at, true);
    if (at + 3 + size > data.byteLength) return;
    yield [String.fromCharCode(data.getUint8(at + 2)), new DataView(data.buffer, data.byteOffset + at + 3, size)];
    at += 3 + size;
  }
}

function textOf(view, from = 0) {
  return new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + from, view.byteLength - from));
}

/** Where which field is, from a line such as `name:uint64_t timestamp;float[3] xyz;`. */
function layout(line, formats) {
  const fields = new Map();
  let at = 0;
  for (const field of line.split(";").filter(Boolean)) {
    const [type, name] = field.split(" ");
    const [, kind, count] = /^([a-zA-Z0-9_]+)(?:\[(\d+)\])?$/.exec(type) ?? [];
    const size = TYPES[kind]?.[1] ?? layout(formats.get(kind) ?? "", formats).size;
    fields.set(name, { read: TYPES[kind]?.[0], size, at, count: count ? Number(count) : 0 });
    at += size * (count ? Number(count) : 1);
  }
  return { fields, size: at };
}

function reader(view, { fields }) {
  const one = ({ read, at, size }, index) => Number(view[read](2 + at + index * size, true));
  return (name) => {
    const field = fields.get(name);
    if (!field || 2 + field.at + field.size * Math.max(1, field.count) > view.byteLength) return field?.count ? [] : NaN;
    return field.count ? Array.from({ length: field.count }, (_, index) => one(field, index)) : one(field, 0);
  };
}

/** Rows of the wanted topics by name, functions from field to value; and the lines that were logged. */
function read(data) {
  const [formats, subscribed, rows, texts] = [new Map(), new Map(), new Map(WANTED.map((name) => [name, []])), []];
  for (const [kind, view] of messages(data)) {
    if (kind === "F") {
      const [name, line] = textOf(view).split(":");
      formats.set(name, line);
    } else if (kind === "A") {
      const name = textOf(view, 3);
      // Of several instances the first is shown.
      if (rows.has(name) && view.getUint8(0) === 0) {
        subscribed.set(view.getUint16(1, true), { rows: rows.get(name), layout: layout(formats.get(name) ?? "", formats) });
      }
    } else if (kind === "D") {
      const topic = subscribed.get(view.getUint16(0, true));
      if (topic) topic.rows.push(reader(view, topic.layout));
    } else if (kind === "L" && view.byteLength > 9) {
      const [severity, time] = [view.getUint8(0) - ZERO, Number(view.getBigUint64(1, true)) / 1e6];
      texts.push({ number: texts.length + 1, time_s: time, vehicle: 1, severity, text: textOf(view, 9) });
    }
  }
  return { rows, texts };
}

/** From when on which mode was flown, as news of the vehicle. */
function modesOf(status) {
  const news = [];
  for (const row of status) {
    const number = row("nav_state");
    const mode = MODES.get(number) ?? `mode ${number}`;
    if (news.at(-1)?.mode !== mode) news.push({ id: 1, time_s: row("timestamp") / 1e6, mode });
  }
  return news;
}

/** Goes along rows in time: the latest one at each instant. */
class Latest {
  constructor(rows) {
    this.rows = rows;
    this.index = -1;
  }

  at(time) {
    while (this.index + 1 < this.rows.length && this.rows[this.index + 1]("timestamp") <= time) this.index += 1;
    return this.index < 0 ? null : this.rows[this.index];
  }

  /** Fields at a time. Topics have rates of their own: held values of two of them would differ by what is flown between samples. */
  between(time, names) {
    const row = this.at(time);
    if (!row) return names.map(() => NaN);
    const next = this.rows[this.index + 1];
    const gap = next ? next("timestamp") - row("timestamp") : Infinity;
    const share = gap <= SOON_US ? (time - row("timestamp")) / gap : 0;
    return names.map((name) => (share > 0 ? row(name) + share * (next(name) - row(name)) : row(name)));
  }
}

/** Times, s, states, modes and logged lines of one vehicle. Throws with what is wrong. */
export function readUlog(buffer) {
  const data = new DataView(buffer);
  if (data.byteLength < HEADER || MAGIC.some((byte, index) => data.getUint8(index) !== byte)) throw new Error("The file is not a ULog.");
  const { rows, texts } = read(data);
  const truth = (name) => (rows.get(`${name}_groundtruth`).length > 0 ? rows.get(`${name}_groundtruth`) : rows.get(name));
  const latest = Object.fromEntries([
    ["position", truth("vehicle_local_position")], ["attitude", truth("vehicle_attitude")],
    ["setpoint", rows.get("vehicle_local_position_setpoint")], ["status", rows.get("vehicle_status")],
    ["land", rows.get("vehicle_land_detected")], ["battery", rows.get("battery_status")], ["wind", rows.get("wind")],
    ["controllers", rows.get("lmpc_status")],
  ].map(([name, list]) => [name, new Latest(list)]));
  const places = latest.position.rows;
  if (places.length === 0) throw new Error("The log has no topic vehicle_local_position: nothing can be drawn. Open a log that contains it.");
  const first = places[0]("timestamp");
  const last = Math.min(places[places.length - 1]("timestamp"), first + LONGEST_S * 1e6);
  const [times, states] = [[], []];
  for (let time = first; time <= last; time += PERIOD_S * 1e6) {
    const now = Object.fromEntries(Object.entries(latest).map(([name, list]) => [name, list.at(time)]));
    times.push(time / 1e6);
    states.push({
      ...stateOf(now),
      position: latest.position.between(time, ["x", "y", "z"]),
      velocity: latest.position.between(time, ["vx", "vy", "vz"]),
      ...tracked(latest.setpoint.between(time, ["x", "y", "z"])),
    });
  }
  return { times, states: new Map([[1, states]]), news: modesOf(rows.get("vehicle_status")), texts };
}

function tracked(setpoint) {
  return { setpoint, tracks: setpoint.every(Number.isFinite) };
}

function stateOf({ attitude, status, land, battery, wind, controllers }) {
  const each = (row, names) => names.map((name) => (row ? row(name) : NaN));
  const turned = attitude?.("q") ?? [];
  const air = each(wind, ["windspeed_north", "windspeed_east"]);
  return unknown({
    quaternion: turned.length === 4 && turned.every(Number.isFinite) ? turned : [1, 0, 0, 0],
    thrust: controllers ? controllers("thrust_n") : NaN,
    status: each(controllers, LAWS.map((law) => `${law}_status`)),
    active: each(controllers, LAWS.map((law) => `${law}_active_constraints`)),
    iterations: each(controllers, LAWS.map((law) => `${law}_iterations`)),
    armed: status?.("arming_state") === 2,
    failsafe: status?.("failsafe") === 1,
    landed: land?.("landed") === 1,
    battery: battery ? battery("remaining") : NaN,
    voltage: battery ? battery("voltage_v") : NaN,
    wind: [...air, 0],
  });
}
