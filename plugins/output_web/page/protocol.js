// Messages as the plugin's README.md lays them out: little-endian numbers in records.

export const PROTOCOL = 3;
export const OTHER_VERSION = 'this page is of another version of Stillpoint: reload it';
const ASK = 1, DO = 2;
export const COMMANDS = {pause: 1, goOn: 2, step: 3, end: 4, saveMap: 5};

/** What the page asks for: everything new of it, once. */
export function request({image, map, cloud, voxels}) {
  return new Uint8Array([PROTOCOL, ASK, (image ? 1 : 0) | (map ? 2 : 0) | (cloud ? 4 : 0) | (voxels ? 8 : 0)]);
}

/** One of COMMANDS. */
export function order(command) { return new Uint8Array([PROTOCOL, DO, command]); }

class Reader {
  constructor(buffer, begin, end) {
    this.view = new DataView(buffer, begin, end - begin);
    this.at = 0;
  }
  get left() { return this.view.byteLength - this.at; }
  u8() { return this.view.getUint8(this.at++); }
  i8() { return this.view.getInt8(this.at++); }
  u16() { this.at += 2; return this.view.getUint16(this.at - 2, true); }
  u32() { this.at += 4; return this.view.getUint32(this.at - 4, true); }
  f32() { this.at += 4; return this.view.getFloat32(this.at - 4, true); }
  f64() { this.at += 8; return this.view.getFloat64(this.at - 8, true); }
  floats(count) { return Array.from({length: count}, () => this.f32()); }
  bytes() {
    const begin = this.view.byteOffset + this.at;
    this.at = this.view.byteLength;
    return new Uint8Array(this.view.buffer, begin, this.view.byteLength - (begin - this.view.byteOffset));
  }
  text() { return new TextDecoder().decode(this.bytes()); }
  /** A position and a rotation (x, y, z, w). */
  pose() { return {p: this.floats(3), q: this.floats(4)}; }
  all(read) {
    const list = [];
    while (this.left > 0) list.push(read());
    return list;
  }
  counted(read) { return Array.from({length: this.u32()}, read); }
}

const STATES = ['waiting', 'tracking', 'lost'];
const USES = ['unmatched', 'inlier', 'outlier', 'moving'];

function frame(r) {
  const f = {index: r.u32(), time: r.f64(), state: STATES[r.u8()]};
  const flags = r.u8();
  f.keyframe = !!(flags & 1);
  f.reference = r.u32();
  f.inReference = r.pose();
  f.inWorld = r.pose();
  [f.features, f.matches, f.inliers] = [r.u16(), r.u16(), r.u16()];
  const truth = r.floats(3);
  f.truth = flags & 8 ? truth : null;
  return f;
}

function keyframe(r) {
  const id = r.u32(), presence = r.u8();
  const k = {id, present: presence === 1, cleared: presence === 2, pose: r.pose()};
  if (!k.present) return {...k, edges: []};
  return {...k, frame: r.u32(), parent: r.u32(), edges: r.counted(() => ({to: r.u32(), shared: r.u16()}))};
}

function cloud(r) {
  return {keyframe: r.u32(), step: r.u16(), columns: r.u16(), rows: r.u16(), cells: r.bytes()};
}

function mask(r) {
  const m = {columns: r.u16(), rows: r.u16()};
  m.runs = r.all(() => ({label: r.u8(), unused: r.u8(), length: r.u16()}));
  return m;
}

const pixel = (r) => r.u16() / 8;

const RECORDS = {
  1: ['hello', (r) => JSON.parse(r.text())],
  2: ['stage', (r) => ({index: r.u8(), name: r.text()})],
  3: ['frames', (r) => r.all(() => frame(r))],
  4: ['times', (r) => r.all(() => ({frame: r.u32(), stage: r.u8(), ms: r.f32()}))],
  5: ['image', (r) => ({frame: r.u32(), jpeg: r.bytes()})],
  6: ['features', (r) => r.all(() => ({
    x: pixel(r), y: pixel(r), use: USES[r.u8()], label: r.u8(), reasons: r.u8()}))],
  7: ['moving', (r) => r.all(() => ({x0: pixel(r), y0: pixel(r), x: pixel(r), y: pixel(r)}))],
  8: ['mask', mask],
  9: ['keyframes', (r) => r.counted(() => keyframe(r))],
  10: ['landmarks', (r) => r.counted(() => ({
    id: r.u32(), position: r.floats(3), staticLogOdds: r.i8() / 8, observations: r.u8()}))],
  11: ['cloud', cloud],
  12: ['loop', (r) => ({frame: r.u32(), moved: r.u32(), shift: r.f32(), count: r.u32()})],
  13: ['fit', (r) => ({worldFromTruth: r.pose(), rmse: r.f32(), pairs: r.u32()})],
  14: ['end', (r) => JSON.parse(r.text())],
  15: ['steering', (r) => JSON.parse(r.text())],
  16: ['voxels', (r) => r.all(() => ({
    position: r.floats(3), rgb: [r.u8(), r.u8(), r.u8()], label: r.u8(), occupancy: r.u8() / 15}))],
  17: ['voxelsRemoved', (r) => r.all(() => r.floats(3))],
  18: ['leftOut', (r) => r.u32()],
};

/** Calls `take(name, content)` for each record; unknown ones are left out. */
export function read(buffer, take) {
  const view = new DataView(buffer);
  if (view.getUint8(0) !== PROTOCOL) throw new Error(OTHER_VERSION);
  for (let at = 1; at < view.byteLength;) {
    const record = RECORDS[view.getUint8(at)];
    const begin = at + 5;
    const end = begin + view.getUint32(at + 1, true);
    if (record) take(record[0], record[1](new Reader(buffer, begin, end)));
    at = end;
  }
}
