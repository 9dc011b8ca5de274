// The map in 3-D: camera, trajectory, truth, key frames with their graph, landmarks, surfaces and dense map.
import {
  BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, PerspectiveCamera, Points,
  PointsMaterial, Scene, Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {moved} from './run.js';
import {surfaceColor} from './surface_colors.js';
import {VoxelLayer} from './voxel_layer.js';

const STRONG = 60;       // shared landmarks of an edge that is drawn, unless it closes a loop
const FAR_APART = 15;    // key frames between the ends of an edge that closes a loop
const FRUSTUM = 0.08;    // metres
const FIRST_VIEW = [-0.5, -0.8, -1.8];  // metres, in the camera's frame: behind it, above and to the left
const LONGEST_GAP = 5;   // frames without a pose that a line bridges

const DARK = {trajectory: 0x4db6ac, truth: 0xb0bec5, keyframe: 0x5c9ded, graph: 0x35506e, loop: 0xff9d2e,
  camera: 0xff6f61, landmark: 0x9fb4c0, doubtful: 0xd55e00};
const LIGHT = {trajectory: 0x00796b, truth: 0x78909c, keyframe: 0x1f5fae, graph: 0xb3c6dd, loop: 0xc46200,
  camera: 0xc0392b, landmark: 0x37474f, doubtful: 0xd55e00};

/** Lines that show the camera's field of view, in its own frame. */
function frustum(camera, depth) {
  const corner = (u, v) => [(u - camera.cx) / camera.fx * depth, (v - camera.cy) / camera.fy * depth, depth];
  const c = [corner(0, 0), corner(camera.width, 0), corner(camera.width, camera.height), corner(0, camera.height)];
  return [0, 1, 2, 3].flatMap((i) => [[0, 0, 0], c[i], c[i], c[(i + 1) % 4]]);
}

function setPositions(object, positions) {
  object.geometry.dispose();
  object.geometry = new BufferGeometry();
  object.geometry.setAttribute('position', new BufferAttribute(positions, 3));
  object.frustumCulled = false;
}

export class MapPanel {
  constructor() {
    this.area = document.getElementById('map');
    this.renderer = new WebGLRenderer({antialias: true, alpha: true});
    this.area.append(this.renderer.domElement);
    this.scene = new Scene();
    this.world = new Group();
    this.world.rotation.x = Math.PI;  // the world's y points down
    this.scene.add(this.world);
    this.eye = new PerspectiveCamera(55, 1, 0.05, 200);
    this.eye.position.set(-1.5, 2, 3.5);
    this.controls = new OrbitControls(this.eye, this.renderer.domElement);
    this.controls.target.set(0, 0, -1.5);
    this.controls.addEventListener('change', () => this.paint());
    this.makeObjects();
    this.makeChoices();
    this.clouds = new Map();
    new ResizeObserver(() => this.resize()).observe(this.area);
    const dark = matchMedia('(prefers-color-scheme: dark)');
    dark.addEventListener('change', () => this.recolor(dark.matches ? DARK : LIGHT));
    this.recolor(dark.matches ? DARK : LIGHT);
  }

  makeObjects() {
    const line = () => {
      const object = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
      this.world.add(object);
      return object;
    };
    this.cloudGroup = new Group();
    this.voxels = new VoxelLayer(this.eye.fov);
    this.world.add(this.cloudGroup, this.voxels.points);
    this.landmarks = new Points(new BufferGeometry(), new PointsMaterial({size: 1.6, sizeAttenuation: false}));
    this.doubtful = new Points(new BufferGeometry(), new PointsMaterial({size: 3, sizeAttenuation: false}));
    this.world.add(this.landmarks, this.doubtful);
    this.graph = line();
    this.keyframes = line();
    this.loop = line();
    this.truth = line();
    this.trajectory = line();
    this.camera = line();
  }

  makeChoices() {
    const shows = (id, ...objects) => {
      const box = document.getElementById(id);
      box.addEventListener('change', () => {
        for (const object of objects) object.visible = box.checked;
        this.paint();
      });
    };
    shows('show-landmarks', this.landmarks, this.doubtful);
    shows('show-graph', this.graph, this.keyframes, this.loop);
    shows('show-truth', this.truth);
    this.follow = document.getElementById('follow');
    this.surfaces = document.getElementById('surfaces');
    this.surfaces.addEventListener('change', () => this.chooseSurfaces());
    this.surfaceColor = document.getElementById('surface-color');
    this.surfaceColor.addEventListener('change', () => this.colorSurfaces());
    document.getElementById('from-above').addEventListener('click', () => this.lookFromAbove());
  }

  /** What of them is shown: nothing else needs to be asked for. */
  get wanted() { return {cloud: this.surfaces.value === 'clouds', voxels: this.surfaces.value === 'voxels'}; }

  chooseSurfaces() {
    this.cloudGroup.visible = this.wanted.cloud;
    this.voxels.points.visible = this.wanted.voxels;
    if (this.wanted.voxels && this.run) this.voxels.paint(this.run, this.surfaceColor.value);
    this.paint();
  }

  colorSurfaces() {
    for (const cloud of this.clouds.values()) this.colorCloud(cloud);
    if (this.wanted.voxels && this.run) this.voxels.paint(this.run, this.surfaceColor.value);
    this.paint();
  }

  recolor(colors) {
    this.colors = colors;
    for (const [object, name] of [
      [this.trajectory, 'trajectory'], [this.truth, 'truth'], [this.keyframes, 'keyframe'], [this.graph, 'graph'],
      [this.loop, 'loop'], [this.camera, 'camera'], [this.landmarks, 'landmark'], [this.doubtful, 'doubtful']])
      object.material.color.setHex(colors[name]);
    this.paint();
  }

  reset() {
    for (const {points} of this.clouds.values()) points.geometry.dispose();
    this.clouds.clear();
    this.cloudGroup.clear();
    this.followed = null;
    this.path = null;
  }

  /** `changed`: names of the records that have come. */
  show(run, changed) {
    this.run = run;
    document.getElementById('truth-choice').hidden = !run.fit;
    if (changed.has('cloud')) this.addClouds();
    if (this.wanted.voxels && (changed.has('voxels') || changed.has('voxelsRemoved')))
      this.voxels.paint(run, this.surfaceColor.value);
    if (changed.has('landmarks')) this.setLandmarks();
    if (changed.has('keyframes')) this.setKeyframes();
    if (changed.has('keyframes') || changed.has('fit')) this.path = null;  // all of it may have moved
    if (changed.has('frames')) this.setTrajectory();
    this.followCamera();
    this.paint();
  }

  setLandmarks() {
    const sure = [], doubtful = [];
    for (const {position, staticLogOdds} of this.run.landmarks.values())
      (staticLogOdds < 0 ? doubtful : sure).push(...position);
    setPositions(this.landmarks, new Float32Array(sure));
    setPositions(this.doubtful, new Float32Array(doubtful));
  }

  setKeyframes() {
    const shape = frustum(this.run.hello.camera, FRUSTUM);
    const frames = [], graph = [], loop = [];
    for (const [id, keyframe] of this.run.keyframes) {
      this.placeCloud(id);
      if (!keyframe.present) continue;
      for (const point of shape) frames.push(...moved(keyframe.pose, point));
      for (const {to, shared} of keyframe.edges) {
        const other = this.run.keyframes.get(to);
        if (!other?.present) continue;
        const closesLoop = id - to > FAR_APART;
        if (closesLoop || shared >= STRONG || to === keyframe.parent)
          (closesLoop ? loop : graph).push(...keyframe.pose.p, ...other.pose.p);
      }
    }
    setPositions(this.keyframes, new Float32Array(frames));
    setPositions(this.graph, new Float32Array(graph));
    setPositions(this.loop, new Float32Array(loop));
  }

  setTrajectory() {
    this.path ??= {frames: 0, line: [], truth: [], before: null, beforeTruth: null};
    while (this.path.frames < this.run.frames.length) this.goOnTo(this.run.frames[this.path.frames++]);
    setPositions(this.trajectory, new Float32Array(this.path.line));
    setPositions(this.truth, new Float32Array(this.path.truth));
    const last = this.run.frames.findLast((frame) => frame.state === 'tracking');
    if (!last) return;
    this.pose = this.run.poseOf(last);
    const shape = frustum(this.run.hello.camera, 0.25).flatMap((point) => moved(this.pose, point));
    setPositions(this.camera, new Float32Array(shape));
  }

  goOnTo(frame) {
    const {line, truth, before, beforeTruth} = this.path;
    const trueNow = this.run.truthOf(frame);
    if (trueNow && beforeTruth) truth.push(...beforeTruth, ...trueNow);
    this.path.beforeTruth = trueNow ?? beforeTruth;
    if (frame.state !== 'tracking') return;
    const now = {at: this.run.positionOf(frame), index: frame.index};
    if (before && now.index - before.index <= LONGEST_GAP) line.push(...before.at, ...now.at);
    this.path.before = now;
  }

  addClouds() {
    for (const cloud of this.run.clouds) {
      if (this.clouds.has(cloud.keyframe)) continue;
      const points = new Points(this.unprojected(cloud), new PointsMaterial({size: 0.035, vertexColors: true}));
      const entry = {...cloud, points};
      points.matrixAutoUpdate = false;
      this.clouds.set(cloud.keyframe, entry);
      this.cloudGroup.add(points);
      this.placeCloud(cloud.keyframe);
      this.colorCloud(entry);
    }
  }

  unprojected({step, columns, cells}) {
    const {fx, fy, cx, cy} = this.run.hello.camera;
    const view = new DataView(cells.buffer, cells.byteOffset, cells.byteLength);
    const positions = [], kept = [];
    for (let i = 0; i < cells.byteLength / 6; ++i) {
      const z = view.getUint16(6 * i, true) / 1000;
      if (z === 0) continue;
      const u = step * (i % columns) + step / 2, v = step * Math.floor(i / columns) + step / 2;
      positions.push((u - cx) / fx * z, (v - cy) / fy * z, z);
      kept.push(i);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
    geometry.setAttribute('color', new BufferAttribute(new Float32Array(positions.length), 3));
    geometry.userData.kept = kept;
    return geometry;
  }

  placeCloud(id) {
    const cloud = this.clouds.get(id);
    const keyframe = this.run.keyframes.get(id);
    if (!cloud) return;
    cloud.points.visible = !!keyframe && !keyframe.cleared;
    if (!keyframe) return;
    cloud.points.position.set(...keyframe.pose.p);
    cloud.points.quaternion.set(...keyframe.pose.q);
    cloud.points.updateMatrix();
  }

  colorCloud({cells, points}) {
    const {kept} = points.geometry.userData;
    const colors = points.geometry.attributes.color;
    const color = new Color();
    const at = new Vector3();
    kept.forEach((cell, i) => {
      const [r, g, b, label] = cells.subarray(6 * cell + 2, 6 * cell + 6);
      at.fromBufferAttribute(points.geometry.attributes.position, i).applyMatrix4(points.matrix);
      surfaceColor(this.surfaceColor.value, {rgb: [r, g, b], label, height: -at.y}, this.run.hello.classes, color);
      colors.setXYZ(i, color.r, color.g, color.b);
    });
    colors.needsUpdate = true;
  }

  /** The view goes along with the camera; where one looks from stays one's own choice. */
  followCamera() {
    if (!this.pose) return;
    const now = this.inScene([0, 0, 1.5]);
    if (!this.followed) {
      this.controls.target.copy(now);
      this.eye.position.copy(this.inScene(FIRST_VIEW));
    } else if (this.follow.checked) {
      const step = now.clone().sub(this.followed);
      this.eye.position.add(step);
      this.controls.target.add(step);
    }
    this.followed = now;
    this.controls.update();
  }

  /** A point in the camera's frame. */
  inScene(point) { return new Vector3(...moved(this.pose, point)).applyEuler(this.world.rotation); }

  lookFromAbove() {
    const distance = Math.max(3, this.eye.position.distanceTo(this.controls.target));
    this.eye.position.copy(this.controls.target).add(new Vector3(0, distance, 0.001));
    this.controls.update();
    this.paint();
  }

  resize() {
    const {clientWidth, clientHeight} = this.area;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight);
    this.eye.aspect = clientWidth / clientHeight;
    this.eye.updateProjectionMatrix();
    this.paint();
  }

  paint() {
    this.renderer.render(this.scene, this.eye);
  }
}
