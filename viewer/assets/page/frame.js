// Frames as viewer/src/frame.rs writes them; all numbers have the lowest byte first.

const VERSION = 1;
const HEADER = 20;
const FLAGS = ["armed", "landed", "lost", "failsafe", "crashed", "tracks"];
const REALS = [
  ["position", 3], ["velocity", 3], ["quaternion", 4], ["rates", 3], ["setpoint", 3], ["setpointYaw", 1], ["thrust", 1],
  ["strongest", 1], ["rotors", 4], ["battery", 1], ["voltage", 1], ["tilt", 2], ["wind", 3],
];

/** The vehicles of a message of the stream, and where it ends. Throws if the page is older or newer than the program. */
export function decode(buffer, start = 0) {
  const data = new DataView(buffer, start);
  if (data.getUint8(0) !== VERSION) throw new Error("This page is from another version than the program: reload the page.");
  const count = data.getUint8(1);
  const stride = data.getUint8(2);
  const vehicles = [];
  for (let index = 0; index < count; index += 1) vehicles.push(vehicle(data, HEADER + index * stride));
  const end = start + HEADER + count * stride;
  return { speed: data.getFloat32(4, true), time: data.getFloat64(8, true), pace: data.getFloat32(16, true), vehicles, end };
}

function vehicle(data, start) {
  const state = { id: data.getUint8(start) };
  const flags = data.getUint8(start + 1);
  FLAGS.forEach((name, bit) => { state[name] = Boolean(flags & (1 << bit)); });
  const three = (from) => [0, 1, 2].map((index) => data.getUint8(from + index));
  state.status = three(start + 2);
  state.active = three(start + 5);
  state.iterations = [0, 1, 2].map((index) => data.getUint16(start + 8 + 2 * index, true));
  state.item = data.getUint16(start + 14, true);
  let place = start + 16;
  for (const [name, count] of REALS) {
    const values = [];
    for (let index = 0; index < count; index += 1, place += 4) values.push(data.getFloat32(place, true));
    state[name] = count === 1 ? values[0] : values;
  }
  return state;
}

/** A vehicle of which nothing is known but what is given: recordings lack much. */
export function unknown(known) {
  const state = { id: 1, item: 0 };
  for (const name of FLAGS) state[name] = false;
  for (const [name, count] of REALS) state[name] = count === 1 ? NaN : new Array(count).fill(NaN);
  for (const name of ["status", "active", "iterations"]) state[name] = [NaN, NaN, NaN];
  state.quaternion = [1, 0, 0, 0];
  return { ...state, ...known };
}

/** Roll, pitch and yaw, rad, of a quaternion, scalar first, FRD into NED. */
export function angles([w, x, y, z]) {
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x)))),
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  ];
}

/** The other way round. */
export function quaternion(roll, pitch, yaw) {
  const [cr, cp, cy] = [roll, pitch, yaw].map((angle) => Math.cos(angle / 2));
  const [sr, sp, sy] = [roll, pitch, yaw].map((angle) => Math.sin(angle / 2));
  return [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy];
}
