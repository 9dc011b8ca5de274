// The dense map, turned around with the mouse.
import {AmbientLight, BoxGeometry, BufferGeometry, Color, DirectionalLight, Float32BufferAttribute,
        InstancedMesh, Line, LineBasicMaterial, Matrix4, MeshLambertMaterial, PerspectiveCamera,
        Scene, Vector3, WebGLRenderer} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';

import {unpacked} from './data.js';
import {choice, el} from './dom.js';
import {css, fitted, heat, redrawn} from './theme.js';

/** Views into the bytes of a map, see map_bytes() of the program. */
function planes(buffer, count) {
  const axis = i => new Uint16Array(buffer, 2 * i * count, count);
  const plane = i => new Uint8Array(buffer, (6 + i) * count, count);
  return {x: axis(0), y: axis(1), z: axis(2), red: plane(0), green: plane(1), blue: plane(2),
          label: plane(3), occupancy: plane(4)};
}

function cubesOf(map, data) {
  const count = data.x.length, centre = 0.5 * map.edge, matrix = new Matrix4();
  const mesh = new InstancedMesh(new BoxGeometry(map.edge, map.edge, map.edge),
                                 new MeshLambertMaterial(), count);
  for (let i = 0; i < count; ++i)
    mesh.setMatrixAt(i, matrix.makeTranslation(map.corner[0] + map.edge * data.x[i] + centre,
                                               map.corner[1] + map.edge * data.y[i] + centre,
                                               map.corner[2] + map.edge * data.z[i] + centre));
  mesh.frustumCulled = false;
  return mesh;
}

const srgb = (r, g, b) => new Color().setRGB(r / 255, g / 255, b / 255, 'srgb');

function ways(map, data) {
  const classes = map.classes.map(c => srgb(...(c.name === 'background' ? [150, 155, 165] : c.color)));
  const ramp = Array.from({length: 256}, (_, i) => new Color(heat(Math.max(0, (i - 128) / 127))));
  return [map.colors && ['Colour', i => srgb(data.red[i], data.green[i], data.blue[i])],
          classes.length && ['Class', i => classes[data.label[i]] ?? classes[0]],
          ['Occupancy', i => ramp[data.occupancy[i]]]].filter(Boolean);
}

function paint(mesh, colourOf) {
  for (let i = 0; i < mesh.count; ++i) mesh.setColorAt(i, colourOf(i));
  mesh.instanceColor.needsUpdate = true;
}

/** From obliquely above, with all of the map in sight. */
function cameraFor(map, data, element) {
  const bound = (axis, k) => {
    let low = Infinity, high = -Infinity;
    for (const v of data[axis]) { low = Math.min(low, v); high = Math.max(high, v); }
    return [map.corner[k] + map.edge * low, map.corner[k] + map.edge * (high + 1)];
  };
  const bounds = [bound('x', 0), bound('y', 1), bound('z', 2)];
  const centre = new Vector3(...bounds.map(([a, b]) => (a + b) / 2));
  const radius = 0.5 * Math.hypot(...bounds.map(([a, b]) => b - a));
  const camera = new PerspectiveCamera(45, 16 / 9, radius / 100, radius * 20);
  camera.up.set(...map.up);
  const up = new Vector3(...map.up);
  // The first camera looks along z: from behind it.
  const ahead = new Vector3(0, 0, 1).addScaledVector(up, -up.z).normalize();
  camera.position.copy(centre).addScaledVector(ahead, -1.25 * radius).addScaledVector(up, 0.85 * radius);
  const controls = new OrbitControls(camera, element);
  controls.target.copy(centre);
  controls.update();
  return {camera, controls};
}

function legendOf(map, data, way) {
  const unit = map.shown < map.occupied ? 'cubes' : 'voxels';
  if (way === 'Occupancy') {
    const stops = [0, 0.25, 0.5, 0.75, 1].map(heat).join(',');
    return el('div', {class: 'bar-legend'}, el('span', {}, 'probability that it is occupied: 50 %'),
              el('span', {class: 'ramp', style: `background:linear-gradient(90deg,${stops})`}),
              el('span', {}, '100 %'));
  }
  if (way !== 'Class') return el('div');
  const count = new Array(256).fill(0);
  for (const label of data.label) ++count[label];
  const shown = map.classes.map((c, i) => ({...c, count: count[i]})).filter(c => c.count);
  return el('div', {class: 'legend'}, ...shown.map(c => el('span', {},
    el('i', {style: `background:rgb(${c.name === 'background' ? '150,155,165' : c.color.join(',')})`}),
    `${c.name}: ${c.count.toLocaleString('en')} ${unit}`)));
}

function trajectory(path) {
  const at = [];
  for (let i = 0; i < path.t.length; ++i) at.push(...path.estimate.map(axis => axis[i] / 1000));
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(at, 3));
  return new Line(geometry, new LineBasicMaterial({color: 0xff3b6b}));
}

/** Resolves when the map is drawn. */
export async function mapView(map, path) {
  const data = planes(await unpacked(map.id), map.shown);
  const canvas = el('canvas', {class: 'map on-screen', tabindex: 0,
                               'aria-label': 'Dense map; drag to turn, wheel to zoom'});
  let renderer;
  try {
    renderer = new WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
  } catch {
    return el('p', {class: 'quiet'}, 'This browser shows no 3-D graphics (WebGL).');
  }
  const scene = new Scene(), mesh = cubesOf(map, data), list = ways(map, data);
  const {camera, controls} = cameraFor(map, data, canvas);
  const sun = new DirectionalLight(0xffffff, 1.6);
  sun.position.set(...map.up).addScaledVector(new Vector3(0.4, 0, -0.5), 1);
  scene.add(mesh, new AmbientLight(0xffffff, 1.7), sun);
  if (path) scene.add(trajectory(path));
  const draw = () => {
    const width = canvas.clientWidth || 1100, height = Math.round(width * 9 / 16);
    renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    renderer.setClearColor(css('--plot'));
    renderer.render(scene, camera);
  };
  // Browsers print what WebGL has drawn at another size; a plain copy they print as it is.
  const copy = el('canvas', {class: 'map on-paper'});
  window.addEventListener('beforeprint', () => {
    copy.width = canvas.width;
    copy.height = canvas.height;
    copy.getContext('2d').drawImage(canvas, 0, 0);
  });
  const legend = el('div');
  const show = i => {
    paint(mesh, list[i][1]);
    legend.replaceChildren(legendOf(map, data, list[i][0]));
    draw();
  };
  controls.addEventListener('change', draw);
  fitted(canvas, draw);
  redrawn(canvas, draw);
  show(0);
  const cubes = map.shown < map.occupied
    ? `${map.occupied.toLocaleString('en')} voxels of ${(100 * map.resolution).toFixed(1)} cm, shown as `
      + `${map.shown.toLocaleString('en')} cubes of ${(100 * map.edge).toFixed(1)} cm: a page has room for no more.`
    : `${map.occupied.toLocaleString('en')} voxels of ${(100 * map.resolution).toFixed(1)} cm.`;
  return el('div', {class: 'map-view'},
            el('div', {class: 'map-bar'}, choice(list.map(([name]) => name), 0, show), legend),
            canvas, copy, el('p', {class: 'quiet'}, cubes + ' Drag to turn, wheel to zoom, right button to move. ',
                       path ? 'Pink: the camera\u2019s path.' : ''));
}
