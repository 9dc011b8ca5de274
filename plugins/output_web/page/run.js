// What is known of the run, as messages have told it.

/** The point `v`, rotated by the quaternion `q` (x, y, z, w). */
export function rotated(q, v) {
  const [x, y, z, w] = q;
  const tx = 2 * (y * v[2] - z * v[1]), ty = 2 * (z * v[0] - x * v[2]), tz = 2 * (x * v[1] - y * v[0]);
  return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx];
}

export function moved(pose, v) {
  const r = rotated(pose.q, v);
  return [r[0] + pose.p[0], r[1] + pose.p[1], r[2] + pose.p[2]];
}

function product(a, b) {  // of quaternions
  const [x, y, z, w] = a, [X, Y, Z, W] = b;
  return [w * X + x * W + y * Z - z * Y, w * Y - x * Z + y * W + z * X, w * Z + x * Y - y * X + z * W,
    w * W - x * X - y * Y - z * Z];
}

export class Run {
  constructor() {
    this.hello = {run: '', camera: {width: 640, height: 480, fx: 525, fy: 525, cx: 320, cy: 240}, classes: []};
    this.stages = [];     // names
    this.times = [];      // the last ones of each stage, ms
    this.frames = [];
    this.tracked = 0;
    this.timesLost = 0;
    this.keyframes = new Map();
    this.keyframeCount = 0;
    this.landmarks = new Map();
    this.clouds = [];
    this.voxels = new Map();  // by position
    this.loops = [];
    this.fit = null;
    this.leftOutSoFar = 0;
    this.end = null;
    this.picture = null;  // image, features, moving, mask of one frame
    this.tracking = [];   // ms of `track_thread` by frame: {frame, ms}
  }

  take(name, content) { this[`take_${name}`](content); }

  take_hello(hello) { this.hello = hello; }
  take_stage({index, name}) {
    this.stages[index] = name;
    this.times[index] = [];
  }
  take_frames(frames) {
    for (const frame of frames) {
      const before = this.frames.at(-1);
      if (frame.state === 'tracking') ++this.tracked;
      if (frame.state === 'lost' && before && before.state !== 'lost') ++this.timesLost;
      this.frames.push(frame);
      if (this.keyframes.get(frame.reference)?.cleared) this.loseMapOf(frame);
    }
  }
  /** The tracker has begun another map, in which the frame has no pose. */
  loseMapOf(frame) {
    if (frame.state !== 'tracking') return;
    frame.state = 'waiting';
    --this.tracked;
  }
  take_times(times) {
    for (const {frame, stage, ms} of times) {
      const list = this.times[stage];
      list.push(ms);
      if (list.length > 100) list.shift();
      if (this.stages[stage] === 'track_thread') this.tracking.push({frame, ms});
    }
  }
  take_image(image) { this.picture = {...image, features: [], moving: [], mask: null}; }
  take_features(features) { this.picture.features = features; }
  take_moving(moving) { this.picture.moving = moving; }
  take_mask(mask) { this.picture.mask = mask; }
  take_keyframes(keyframes) {
    for (const keyframe of keyframes) {
      this.keyframeCount += (keyframe.present ? 1 : 0) - (this.keyframes.get(keyframe.id)?.present ? 1 : 0);
      this.keyframes.set(keyframe.id, keyframe);
      if (keyframe.cleared)
        for (const frame of this.frames) if (frame.reference === keyframe.id) this.loseMapOf(frame);
    }
  }
  take_landmarks(landmarks) {
    for (const landmark of landmarks) {
      if (landmark.observations === 0) this.landmarks.delete(landmark.id);
      else this.landmarks.set(landmark.id, landmark);
    }
  }
  take_cloud(cloud) { this.clouds.push(cloud); }
  take_voxels(voxels) { for (const voxel of voxels) this.voxels.set(voxel.position.join(), voxel); }
  take_voxelsRemoved(positions) { for (const position of positions) this.voxels.delete(position.join()); }
  take_loop(loop) { this.loops.push(loop); }
  take_fit(fit) { this.fit = fit; }
  take_leftOut(images) { this.leftOutSoFar = images; }
  take_end(end) { this.end = end; }

  /** Of the camera, in the map as it is now; as it was tracked while its key frame is not known. */
  poseOf(frame) {
    const keyframe = this.keyframes.get(frame.reference);
    if (!keyframe) return frame.inWorld;
    return {p: moved(keyframe.pose, frame.inReference.p), q: product(keyframe.pose.q, frame.inReference.q)};
  }
  positionOf(frame) {
    const keyframe = this.keyframes.get(frame.reference);
    return keyframe ? moved(keyframe.pose, frame.inReference.p) : frame.inWorld.p;
  }
  truthOf(frame) { return frame.truth && this.fit ? moved(this.fit.worldFromTruth, frame.truth) : null; }
  /** Metres from the truth, after the alignment; null where that is not known. */
  errorOf(frame) {
    const truth = frame.state === 'tracking' ? this.truthOf(frame) : null;
    return truth ? Math.hypot(...this.positionOf(frame).map((x, i) => x - truth[i])) : null;
  }

  get seen() { return this.frames.length ? this.frames.at(-1).index + 1 : 0; }  // of the recording
  get loopsClosed() { return this.end ? this.end.loops_closed : this.loops.reduce((sum, loop) => sum + loop.count, 0); }
  get leftOut() { return this.end?.source_skipped ?? this.leftOutSoFar; }  // by the source, as far as it tells
  get dropped() { return this.end ? this.end.dropped_frames : this.seen - this.frames.length; }
}
